// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Native/SizesCall.h"

#include "Base/Lists.h"
#include "Base/Refuse.h"
#include "Native/Arrays.h"
#include "Sizes/NamedSizes.h"

#include <algorithm>
#include <string>

namespace quadrille::native
{

namespace
{

template <class Value>
std::vector<Value> valuesOr(const py::dict& from, const char* name)
{
  return from.contains(name) ? valuesFrom(from[name].cast<ArrayOf<Value>>()) : std::vector<Value>();
}

std::vector<std::string> stringsOr(const py::dict& from, const char* name)
{
  return from.contains(name) ? from[name].cast<std::vector<std::string>>()
                             : std::vector<std::string>();
}

std::vector<Vector3> vectorsOr(const py::dict& from, const char* name)
{
  return from.contains(name) ? vectorsFrom(from[name].cast<ArrayOf<double>>())
                             : std::vector<Vector3>();
}

NamedSurface namedSurface(const py::dict& from)
{
  NamedSurface surface;
  surface.points = vectorsOr(from, "points");
  const auto corners = valuesOr<std::int64_t>(from, "triangles");
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
  {
    surface.triangles.push_back({ static_cast<Index>(corners[i]),
      static_cast<Index>(corners[i + 1]), static_cast<Index>(corners[i + 2]) });
  }
  surface.faceNames = stringsOr(from, "face_names");
  surface.sizes = valuesOr<float>(from, "sizing");
  surface.featureEdges = valuesOr<std::uint8_t>(from, "feature_edges");
  const auto known = valuesOr<float>(from, "known_curvature");
  surface.knownCurvature.resize(known.size() / 6);
  for (std::size_t i = 0; i < 6 * surface.knownCurvature.size(); ++i)
  {
    surface.knownCurvature[i / 6][i % 6] = known[i];
  }
  surface.edgeNames = stringsOr(from, "edge_names");
  const std::vector<Vector3> linePoints = vectorsOr(from, "edge_points");
  std::size_t at = 0;
  for (const std::int64_t count : valuesOr<std::int64_t>(from, "edge_counts"))
  {
    std::vector<Vector3>& line = surface.edgeLines.emplace_back();
    const auto size = static_cast<std::size_t>(count);
    refuseIf(size > linePoints.size() - at, "what the mesh has of its CAD file is damaged");
    const auto begin = linePoints.begin() + static_cast<std::ptrdiff_t>(at);
    line.assign(begin, begin + static_cast<std::ptrdiff_t>(size));
    at += size;
  }
  surface.vertexNames = stringsOr(from, "vertex_names");
  surface.vertexPoints = vectorsOr(from, "vertex_points");
  refuseIf(surface.edgeLines.size() != surface.edgeNames.size() ||
      surface.vertexPoints.size() != surface.vertexNames.size(),
    "what the mesh has of its CAD file is damaged");
  return surface;
}

py::dict dictOf(const SizedTriangles& sized)
{
  py::dict result;
  result["points"] = arrayFrom(sized.points);
  result["middles"] = rowsFrom<std::int64_t>(sized.middles);
  result["triangles"] = rowsFrom<std::int64_t>(sized.triangles);
  result["parents"] = castArrayFrom<std::int64_t>(sized.parents);
  result["sizing"] = arrayFrom(sized.sizes);
  if (!sized.featureEdges.empty())
  {
    result["feature_edges"] = arrayFrom(sized.featureEdges);
  }
  if (!sized.knownCurvature.empty())
  {
    result["known_curvature"] = rowsFrom<float>(sized.knownCurvature);
  }
  return result;
}

/// Of all surfaces together, as a name that one lacks may be in another one. prefixes: of each surface's names.
py::list sizesByName(const std::vector<py::dict>& surfaces,
  const std::vector<std::string>& prefixes, const std::string& text)
{
  const std::vector<NamedSize> sizes = namedSizesOf(text);
  std::vector<bool> isUsed(sizes.size(), false);
  std::vector<std::string> names;
  py::list results;
  for (std::size_t i = 0; i < surfaces.size(); ++i)
  {
    NamedParts parts(namedSurface(surfaces[i]), prefixes[i]);
    parts.ask(sizes, isUsed);
    append(names, parts.names());
    const SizedTriangles sized = [&]
    {
      const py::gil_scoped_release others;
      return parts.sized();
    }();
    results.append(dictOf(sized));
  }
  refuseUnknownNames(sizes, isUsed, names);
  return results;
}

} // namespace

void bindSizes(py::module_& module)
{
  module.def("sizes_by_name", &sizesByName);
}

} // namespace quadrille::native
