// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/FeatureEnds.h"

#include "Base/Lists.h"
#include "Base/PlaceText.h"
#include "Mesh/Topology.h"

#include <cstdlib>

namespace quadrille
{
namespace
{

/// The two feature edges of a vertex go straight on where as many axes lie on both sides.
/// start: a corner of the vertex on a feature; the whole fan is inside.
bool goesStraightOn(const ExactMap& map, Index start)
{
  int total = 0;
  int toSecond = 0;
  forEachFrom(map.mesh, start,
    [&](Index h)
    {
      if (h != start && map.mesh.isFeature(h))
      {
        toSecond = total;
      }
      const FixedVec2 left = map.at(Mesh::previous(h)) - map.at(h);
      for (int axis = firstAxis(map.edge(h)); orientation(axisVector(axis), left) > 0; ++axis)
      {
        ++total;
      }
    });
  return total == 2 * toSecond;
}

/// Does a feature end, fork or turn at the vertex of corner h (as of outgoingHalfEdges)?
bool endsAt(const ExactMap& map, Index h)
{
  int features = 0;
  Index onFeature = kInvalidIndex;
  const bool isInside = forEachFrom(map.mesh, h,
    [&](Index g)
    {
      if (map.mesh.isFeature(g) && !map.mesh.isBoundary(g))
      {
        ++features;
        onFeature = g;
      }
    });
  if (features == 0)
  {
    return false;
  }
  return !isInside || features != 2 || !goesStraightOn(map, onFeature);
}

} // namespace

FeatureEnds findFeatureEnds(const ExactMap& map)
{
  FeatureEnds ends;
  const std::vector<Index> outgoing = outgoingHalfEdges(map.mesh);
  for (const Index h : outgoing)
  {
    if (h != kInvalidIndex && !isInteger(map.at(h)) && endsAt(map, h))
    {
      ends.nonInteger.push_back(map.mesh.origin[h]);
    }
  }
  ends.offIsolines = idsWhere(map.mesh.halfEdgeCount(),
    [&](Index h)
    {
      return map.mesh.isFeature(h) && h < map.mesh.twin[h] && !map.mesh.isBoundary(h) &&
        !map.isOnIsoline(h);
    });
  return ends;
}

std::string FeatureEnds::text(const Mesh& mesh) const
{
  std::string result;
  const auto add = [&](const std::vector<Index>& list, const char* what, const auto& vertexOf)
  {
    if (list.empty())
    {
      return;
    }
    result += (result.empty() ? "" : ", ") + std::to_string(list.size()) + " " + what + " (near " +
      joined(list, kMostTold, [&](Index id) { return placeText(mesh.position[vertexOf(id)]); }) +
      ")";
  };
  add(nonInteger, "ends, corners or junctions of features that are no integer points",
    [](Index v) { return v; });
  add(offIsolines, "feature edges off the integer isolines",
    [&mesh](Index h) { return mesh.origin[h]; });
  return result;
}

} // namespace quadrille
