// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Evaluation/ArrayConstraints.h"

#include "Base/DisjointSets.h"
#include "Base/Lists.h"
#include "Evaluation/ConstraintMeasures.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace quadrille
{

namespace
{

/// Points at one place count as one, or the triangles of a soup were a region each.
void joinSamePlaces(const SurfaceInput& input, const std::vector<bool>& used, DisjointSets& sets)
{
  std::vector<Index> points = idsWhere(used.size(), [&](Index i) { return used[i]; });
  const auto key = [&](Index i)
  {
    const Vector3& p = input.points[i];
    return std::make_tuple(p.x(), p.y(), p.z(), i);
  };
  std::sort(points.begin(), points.end(), [&](Index a, Index b) { return key(a) < key(b); });
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
  {
    if (input.points[points[i]] == input.points[points[i + 1]])
    {
      sets.join(points[i], points[i + 1]);
    }
  }
}

std::vector<ArrayConstraints::Region> guidedRegions(
  const SurfaceInput& input, const std::function<std::int64_t(Index)>& cellOf)
{
  std::vector<Index> guided;
  std::vector<bool> used(input.guideDirections.empty() ? 0 : input.points.size(), false);
  for (std::size_t i = 0; i < input.guideDirections.size(); ++i)
  {
    const Index begin = input.polygonOffsets[i];
    const Index end = input.polygonOffsets[i + 1];
    if (end > begin && !input.guideDirections[i].isZero(0))
    {
      guided.push_back(static_cast<Index>(i));
      for (Index k = begin; k < end; ++k)
      {
        used[input.polygonPoints[k]] = true;
      }
    }
  }
  std::vector<ArrayConstraints::Region> regions;
  if (guided.empty())
  {
    return regions;
  }
  DisjointSets sets(input.points.size(), 1);
  joinSamePlaces(input, used, sets);
  for (const Index polygon : guided)
  {
    const Index begin = input.polygonOffsets[polygon];
    for (Index i = begin + 1; i < input.polygonOffsets[polygon + 1]; ++i)
    {
      sets.join(input.polygonPoints[begin], input.polygonPoints[i]);
    }
  }
  std::map<Index, std::size_t> regionOf;
  for (const Index polygon : guided)
  {
    const Index root = sets.find(input.polygonPoints[input.polygonOffsets[polygon]]);
    const auto [found, isNew] = regionOf.emplace(root, regions.size());
    if (isNew)
    {
      regions.push_back({ cellOf ? cellOf(polygon) : std::int64_t{ polygon }, {}, {} });
    }
    regions[found->second].polygons.push_back(polygon);
  }
  const std::size_t most = mostPlacesOf(regions.size());
  for (ArrayConstraints::Region& region : regions)
  {
    const std::size_t stride = strideOf(region.polygons.size(), most);
    for (std::size_t i = 0; i < region.polygons.size(); i += stride)
    {
      const Index polygon = region.polygons[i];
      region.measured.push_back(guidedPolygon(input, polygon, input.guideDirections[polygon],
        input.guideWeights.empty() ? 1 : input.guideWeights[polygon]));
    }
  }
  return regions;
}

std::vector<ArrayConstraints::Curve> markedCurves(const SurfaceInput& input)
{
  std::vector<std::array<Index, 2>> edges;
  for (std::size_t p = 0; p < input.featureEdges.size(); ++p)
  {
    const Index begin = input.polygonOffsets[p];
    const Index corners = input.polygonOffsets[p + 1] - begin;
    for (Index i = 0; i < std::min<Index>(corners, 8); ++i) // eight bits a polygon
    {
      const Index a = input.polygonPoints[begin + i];
      const Index b = input.polygonPoints[begin + (i + 1) % corners];
      if ((input.featureEdges[p] >> i & 1) != 0 && a != b)
      {
        edges.push_back({ std::min(a, b), std::max(a, b) });
      }
    }
  }
  sortUnique(edges);
  std::vector<ArrayConstraints::Curve> curves;
  if (edges.empty())
  {
    return curves;
  }
  DisjointSets sets(input.points.size(), 1);
  std::vector<bool> used(input.points.size(), false);
  for (const auto& [a, b] : edges)
  {
    sets.join(a, b);
    used[a] = used[b] = true;
  }
  joinSamePlaces(input, used, sets);
  std::map<Index, std::size_t> curveOf;
  for (const auto& [a, b] : edges)
  {
    const auto [found, isNew] = curveOf.emplace(sets.find(a), curves.size());
    if (isNew)
    {
      curves.push_back({ static_cast<std::int64_t>(a), {} });
    }
    curves[found->second].edges.push_back({ input.points[a], input.points[b] });
  }
  return curves;
}

std::vector<ArrayConstraints::Valence> askedValences(const SurfaceInput& input)
{
  std::vector<ArrayConstraints::Valence> valences;
  if (std::all_of(
        input.targetValences.begin(), input.targetValences.end(), [](int v) { return v == 0; }))
  {
    return valences;
  }
  std::vector<bool> isUsed(input.points.size(), false);
  for (const Index p : input.polygonPoints)
  {
    isUsed[p] = true;
  }
  for (std::size_t i = 0; i < input.targetValences.size(); ++i)
  {
    if (input.targetValences[i] != 0)
    {
      valences.push_back(
        { static_cast<std::int64_t>(i), input.points[i], input.targetValences[i], isUsed[i] });
    }
  }
  return valences;
}

} // namespace

//------------------------------------------------------------------------------
ArrayConstraints arrayConstraints(
  const SurfaceInput& input, const std::function<std::int64_t(Index)>& cellOf)
{
  ArrayConstraints asked;
  asked.guides = guidedRegions(input, cellOf);
  asked.curves = markedCurves(input);
  asked.valences = askedValences(input);
  asked.sizes = !input.sizing.empty();
  return asked;
}

} // namespace quadrille
