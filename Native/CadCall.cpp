// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Native/CadCall.h"

#include "Base/Refuse.h"
#include "Cad/Calls.h"
#include "Cad/CellValues.h"
#include "Cad/PlacedQuads.h"
#include "Native/Arrays.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

namespace quadrille::native
{

namespace
{

/// In the field data, as of vtkQuadrilleCADReader: options of the tessellation, and whether tangent edges are followed.
constexpr std::size_t kTessellationNumbers = 4;

std::vector<std::uint8_t> coloursOf(const CadPart& part)
{
  constexpr std::array<double, 3> kGrey{ 0.8, 0.8, 0.8 };
  std::vector<std::uint8_t> colours;
  for (const auto& colour : part.faceColours)
  {
    for (const double value : colour.value_or(kGrey))
    {
      colours.push_back(static_cast<std::uint8_t>(std::round(255 * value)));
    }
  }
  return colours;
}

py::dict dictOf(const CadPart& part, const TessellationOptions& options, CadFollow follow)
{
  const CadSurface& surface = part.surface;
  const CadCells cells = cadCells(surface, follow);
  std::vector<std::string> names, kinds;
  for (std::size_t f = 0; f < surface.surfaceKinds.size(); ++f)
  {
    names.push_back(nameOfFace(part, f));
    kinds.emplace_back(wordOf(surface.surfaceKinds[f]));
  }
  py::dict result;
  result["name"] = part.name;
  result["points"] = arrayFrom(surface.points);
  result["triangles"] = rowsFrom<std::int64_t>(surface.triangles);
  result["face"] = castArrayFrom<std::int32_t>(surface.faceOf);
  result["feature_edges"] = arrayFrom(cells.features);
  result["known_curvature"] = rowsFrom<float>(cells.curvatures);
  result["names"] = names;
  result["kinds"] = kinds;
  result["colours"] = arrayFrom(coloursOf(part), 3);
  const CadLines lines = cadLines(surface);
  result["CadEdgeNames"] = part.edgeNames;
  result["CadVertexNames"] = part.vertexNames;
  result["CadEdgeEnds"] = rowsFrom<std::int32_t>(lines.ends);
  result["CadEdgeCounts"] = arrayFrom(lines.counts);
  result["CadEdgePoints"] = arrayFrom(lines.points);
  result["CadVertexPoints"] = arrayFrom(lines.vertexPoints);
  result["shape"] = arrayFrom(cadCalls().bytesOfShape(part.shape));
  result["tessellation"] = arrayFrom(std::vector<double>{
    options.chordError, options.angle, options.sharpAngle, follow == CadFollow::All ? 1.0 : 0.0 });
  return result;
}

py::tuple readCad(
  const std::string& path, double chordError, double sharpAngle, int follow, bool joined)
{
  CadReadOptions options;
  options.joined = joined;
  options.tessellation.chordError = chordError;
  options.tessellation.sharpAngle = sharpAngle;
  const CadFile file = [&]
  {
    const py::gil_scoped_release others;
    return cadCalls().readCadFile(path, options);
  }();
  py::list parts;
  for (const CadPart& part : file.parts)
  {
    parts.append(dictOf(part, options.tessellation, static_cast<CadFollow>(follow)));
  }
  return py::make_tuple(parts, file.unit, file.notices);
}

/// Points, what each is on (CadPlaceKind), its id or -1, normals and both curvatures.
/// faces: of the cells, or empty.
py::tuple placeOnCad(const ArrayOf<std::uint8_t>& shape, const ArrayOf<double>& tessellation,
  const ArrayOf<double>& points, const ArrayOf<std::int64_t>& corners,
  const ArrayOf<std::int64_t>& faces)
{
  refuseIf(static_cast<std::size_t>(tessellation.size()) != kTessellationNumbers ||
      corners.ndim() != 2 || corners.shape(1) != 4 ||
      (faces.size() != 0 && faces.size() != corners.shape(0)),
    "what the mesh has of its CAD file is damaged");
  CadQuads quads;
  quads.points = vectorsFrom(points);
  quads.corners.resize(static_cast<std::size_t>(corners.shape(0)));
  for (std::size_t i = 0; i < 4 * quads.corners.size(); ++i)
  {
    quads.corners[i / 4][i % 4] = static_cast<Index>(corners.data()[i]);
  }
  quads.faces.resize(faces.size() == 0 ? 0 : quads.points.size(), kInvalidIndex);
  for (std::size_t i = 0; i < 4 * quads.corners.size() && !quads.faces.empty(); ++i)
  {
    quads.faces[quads.corners[i / 4][i % 4]] = static_cast<Index>(faces.data()[i / 4]);
  }
  TessellationOptions options;
  options.chordError = tessellation.data()[0];
  options.angle = tessellation.data()[1];
  options.sharpAngle = tessellation.data()[2];
  PlacementOptions placement;
  placement.tangentEdges = tessellation.data()[3] != 0;
  const std::vector<std::uint8_t> bytes = valuesFrom(shape);
  const std::vector<CadPlace> places = [&]
  {
    const py::gil_scoped_release others;
    return placeQuads(cadCalls().shapeOfBytes(bytes), options, quads, placement).places;
  }();
  std::vector<Vector3> placed, normals;
  std::vector<std::uint8_t> kinds;
  std::vector<std::int32_t> ids;
  std::vector<std::array<double, 2>> curvatures;
  for (const CadPlace& place : places)
  {
    placed.push_back(place.point);
    normals.push_back(place.normal);
    kinds.push_back(static_cast<std::uint8_t>(place.kind));
    ids.push_back(place.kind == CadPlaceKind::None ? -1 : static_cast<std::int32_t>(place.id));
    curvatures.push_back(place.curvatures);
  }
  return py::make_tuple(arrayFrom(placed), arrayFrom(kinds), arrayFrom(ids), arrayFrom(normals),
    rowsFrom<double>(curvatures));
}

} // namespace

void bindCad(py::module_& module)
{
  module.def("read_cad", &readCad);
  module.def("place_on_cad", &placeOnCad);
}

} // namespace quadrille::native
