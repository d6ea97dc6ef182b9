// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Native/Results.h"

#include "GridMap/Certificate.h"
#include "Native/Arrays.h"
#include "Quads/QuadLayout.h"

#include <cmath>
#include <cstdint>

namespace quadrille::native
{

namespace
{

using Id = std::int64_t;

void addSources(const Remeshed& remeshed, py::dict& dict)
{
  const std::vector<SourceLocation> sources = remeshed.made.pointSources(remeshed.options.threads);
  std::vector<Id> polygons;
  std::vector<std::array<Index, 3>> points;
  std::vector<std::array<double, 3>> weights;
  for (const SourceLocation& at : sources)
  {
    polygons.push_back(at.polygon);
    points.push_back(at.points);
    weights.push_back(at.weights);
  }
  dict["point_source"] =
    py::make_tuple(arrayFrom(polygons), rowsFrom<Id>(points), rowsFrom<double>(weights));
  dict["quad_source"] = castArrayFrom<Id>(remeshed.made.quadPolygons(sources));
}

py::dict layoutFields(const QuadLayout& layout)
{
  std::vector<int> shapes;
  std::vector<std::array<Index, 2>> sizes;
  for (const LayoutPatch& patch : layout.patches)
  {
    shapes.push_back(static_cast<int>(patch.shape));
    sizes.push_back(patch.size);
  }
  py::dict fields;
  fields["LayoutPatchShape"] = arrayFrom(shapes);
  fields["LayoutPatchSize"] = rowsFrom<Id>(sizes);
  return fields;
}

void addFields(const RunFields& fields, py::dict& dict)
{
  for (const RunField& field : fields)
  {
    dict[py::str(field.name)] =
      std::visit([](const auto& values) { return py::object(py::cast(values)); }, field.values);
  }
}

void addSymmetryFields(const MadeSymmetry& made, py::dict& fields)
{
  const auto numbers = [](const Vector3& v) { return py::make_tuple(v.x(), v.y(), v.z()); };
  if (made.rotation)
  {
    fields["SymmetryOrigin"] = numbers(made.rotation->axis.origin);
    fields["SymmetryDirection"] = numbers(made.rotation->axis.direction);
    fields["SymmetryOrder"] = py::make_tuple(made.rotation->order);
  }
  else
  {
    fields["SymmetryOrigin"] = numbers(made.plane.origin);
    fields["SymmetryNormal"] = numbers(made.plane.normal);
  }
  fields["SymmetryDeviation"] =
    py::make_tuple(made.deviation.rms / made.diagonal, made.deviation.maximum / made.diagonal);
  fields["SymmetryMovedPoints"] = py::make_tuple(made.movedPoints);
  fields["SymmetryFarthestMoved"] = py::make_tuple(made.farthestMoved / made.diagonal);
}

py::object knownNumber(double value)
{
  return std::isnan(value) ? py::object(py::none()) : py::object(py::float_(value));
}

py::dict wordDict(const ConstraintWord& word, std::size_t id)
{
  py::dict dict;
  dict["id"] = id;
  dict["kind"] = word.kind;
  dict["source_id"] = word.source;
  dict["met"] = word.isMet;
  dict["deviation"] = knownNumber(word.deviation);
  dict["deviation_95"] = knownNumber(word.deviation95);
  dict["unit"] = word.unit;
  dict["reason"] = word.reason;
  dict["remark"] = word.remark;
  dict["place"] = py::make_tuple(word.place.x(), word.place.y(), word.place.z());
  return dict;
}

py::list constraintDicts(std::vector<ConstraintWord> words, const Remeshed& remeshed)
{
  if (remeshed.made.symmetry)
  {
    words.push_back(judgeSymmetry(*remeshed.made.symmetry));
  }
  py::list list;
  for (const ConstraintWord& word : words)
  {
    list.append(wordDict(word, list.size()));
  }
  return list;
}

py::list detailDicts(const RemeshResult& result)
{
  py::list list;
  const auto add = [&list](const char* kind, double size, const char* decision,
                     const std::string& became, const Vector3& place)
  {
    py::dict dict;
    dict["kind"] = kind;
    dict["size"] = size;
    dict["decision"] = decision;
    dict["result"] = became;
    dict["place"] = py::make_tuple(place.x(), place.y(), place.z());
    list.append(dict);
  };
  for (const SmallDetail& detail : result.details)
  {
    add(nameOf(detail.kind), detail.size, nameOf(detail.decision), detail.result, detail.place);
  }
  for (const GivenUpCurve& curve : result.givenUpFeatures)
  {
    add("feature", curve.lengthInQuads, nameOf(DetailDecision::Simplify),
      whyNotFollowed(curve.reason), curve.place);
  }
  return list;
}

/// Only the points that cells use, in the order of their first use, and the cells by these.
py::dict usedPointsDict(const QuadMesh& quads, std::vector<Id> corners)
{
  std::vector<Id> newId(quads.points.size(), -1);
  std::vector<Id> used;
  std::vector<Vector3> points;
  for (Id& corner : corners)
  {
    Id& id = newId[static_cast<std::size_t>(corner)];
    if (id < 0)
    {
      id = static_cast<Id>(used.size());
      used.push_back(corner);
      points.push_back(quads.points[static_cast<std::size_t>(corner)]);
    }
    corner = id;
  }
  py::dict pointData;
  pointData["QuadPointId"] = arrayFrom(used);
  py::dict dict;
  dict["points"] = arrayFrom(points);
  dict["corners"] = arrayFrom(corners);
  dict["point_data"] = pointData;
  return dict;
}

py::dict linesDict(const QuadMesh& quads, const QuadLayout& layout)
{
  std::vector<Id> corners, offsets{ 0 };
  std::vector<std::uint8_t> boundary;
  for (const QuadLine& line : quads.lines)
  {
    corners.insert(corners.end(), { line.a, line.b });
    offsets.push_back(static_cast<Id>(corners.size()));
    boundary.push_back(line.boundary ? 1 : 0);
  }
  py::dict dict = usedPointsDict(quads, std::move(corners));
  py::dict cellData;
  cellData["Boundary"] = arrayFrom(boundary);
  cellData["Separatrix"] = arrayFrom(layout.lineOnSeparatrix);
  dict["offsets"] = arrayFrom(offsets);
  dict["cell_data"] = cellData;
  return dict;
}

py::dict separatricesDict(const QuadMesh& quads, const QuadLayout& layout)
{
  std::vector<Id> offsets{ 0 };
  std::vector<std::uint8_t> start, end, feature, separatrix;
  for (const LayoutLine& line : layout.lines)
  {
    offsets.push_back(static_cast<Id>(line.first + line.count));
    start.push_back(static_cast<std::uint8_t>(line.start));
    end.push_back(static_cast<std::uint8_t>(line.end));
    feature.push_back(line.feature ? 1 : 0);
    separatrix.push_back(line.separatrix ? 1 : 0);
  }
  py::dict dict = usedPointsDict(quads, { layout.linePoints.begin(), layout.linePoints.end() });
  py::dict cellData;
  cellData["StartKind"] = arrayFrom(start);
  cellData["EndKind"] = arrayFrom(end);
  cellData["Feature"] = arrayFrom(feature);
  cellData["Separatrix"] = arrayFrom(separatrix);
  dict["offsets"] = arrayFrom(offsets);
  dict["cell_data"] = cellData;
  return dict;
}

/// The surface that was mapped: its triangles with IGM, the two coordinates of each corner.
py::dict surfaceDict(const RemeshResult& result)
{
  const Mesh& mesh = result.surface.mesh;
  std::vector<double> uv;
  for (const FixedVec2& corner : result.uv)
  {
    uv.insert(uv.end(), { toDouble(corner.u), toDouble(corner.v) });
  }
  std::vector<Id> offsets;
  for (std::size_t f = 0; f <= mesh.faceCount(); ++f)
  {
    offsets.push_back(static_cast<Id>(3 * f));
  }
  py::dict cellData, pointData, dict;
  cellData["IGM"] = arrayFrom(uv, 6);
  cellData["SourceCellId"] = castArrayFrom<Id>(result.surface.sourcePolygon);
  dict["points"] = arrayFrom(mesh.position);
  dict["corners"] = castArrayFrom<Id>(mesh.origin);
  dict["offsets"] = arrayFrom(offsets);
  dict["point_data"] = pointData;
  dict["cell_data"] = cellData;
  return dict;
}

/// Sizes that were asked for, carried to the points of the quads.
std::vector<double> sizesAtPoints(const Remeshed& remeshed)
{
  std::vector<double> sizes;
  if (remeshed.sizing.empty() || remeshed.options.preview)
  {
    return sizes;
  }
  for (const SourceLocation& at : remeshed.made.pointSources(remeshed.options.threads))
  {
    double size = 0;
    for (std::size_t i = 0; i < 3; ++i)
    {
      size += at.weights[i] == 0 ? 0 : at.weights[i] * double{ remeshed.sizing[at.points[i]] };
    }
    sizes.push_back(size);
  }
  return sizes;
}

} // namespace

py::tuple quadArrays(const QuadMesh& quads)
{
  return py::make_tuple(arrayFrom(quads.points), rowsFrom<Id>(quads.quads));
}

py::dict resultDict(const Remeshed& remeshed)
{
  const RemeshResult& result = remeshed.made.remeshed;
  py::dict dict, pointData, cellData, fields;
  dict["points"] = arrayFrom(result.quads.points);
  dict["quads"] = rowsFrom<Id>(result.quads.quads);
  pointData["Valence"] = arrayFrom(result.quads.valence);
  pointData["OnBoundary"] = arrayFrom(result.quads.onBoundary);
  addFields(runFields(result), fields);
  if (!remeshed.options.preview)
  {
    addSources(remeshed, dict);
    const QuadLayout layout = layoutOf(result.quads, remeshed.options.threads);
    cellData["FeatureEdges"] = arrayFrom(featureEdgeBits(result.quads));
    cellData["LayoutPatch"] = castArrayFrom<int>(layout.patchOf);
    fields.attr("update")(layoutFields(layout));
    addFields(methodFields(remeshed.options.method), fields);
    addFields(
      anisotropyFields(remeshed.options.anisotropyLimit, result.beyondAnisotropyLimit), fields);
    if (const auto& symmetry = remeshed.made.symmetry)
    {
      const bool turns = symmetry->rotation.has_value();
      pointData[turns ? "RotatedPoint" : "MirrorPoint"] =
        castArrayFrom<Id>(turns ? symmetry->rotatedPoint : symmetry->mirrorPoint);
      addSymmetryFields(*symmetry, fields);
    }
    if (remeshed.everything)
    {
      dict["lines"] = linesDict(result.quads, layout);
      dict["separatrices"] = separatricesDict(result.quads, layout);
      dict["surface"] = surfaceDict(result);
    }
  }
  std::vector<std::string> notices = remeshed.notices;
  const std::vector<ConstraintWord> words =
    judgeConstraints(remeshed.asked, result.quads, sizesAtPoints(remeshed));
  const std::vector<std::string> off = offSurfaceNotices(words);
  notices.insert(notices.end(), off.begin(), off.end());
  const std::vector<std::string> unmet = unmetNotices(words, remeshed.asked);
  notices.insert(notices.end(), unmet.begin(), unmet.end());
  fields["Notices"] = notices;
  dict["point_data"] = pointData;
  dict["cell_data"] = cellData;
  dict["fields"] = fields;
  dict["constraints"] = constraintDicts(words, remeshed);
  dict["details"] = detailDicts(result);
  return dict;
}

} // namespace quadrille::native
