// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/GivenUpFeatures.h"

#include "Base/Error.h"
#include "Base/Progress.h"
#include "Features/EdgeCurves.h"
#include "Mesh/Sizing.h"

#include <cstddef>

namespace quadrille
{

namespace
{

struct LossText
{
  const char* name;
  const char* whyNot;
};
/// In the order of FeatureLoss.
constexpr LossText kLossTexts[] = {
  { "unresolved",
    "not followed: below the smallest detail, as an end, a group or a side of a band" },
  { "no crease", "not followed: its curve is no crease as a whole" },
  { "failed map", "not followed: with it there was no map, or no quads" },
  { "mid-line", "not followed: it lies in the mirror plane, which quads straddle" },
};

} // namespace

const char* nameOf(FeatureLoss reason)
{
  return kLossTexts[static_cast<std::size_t>(reason)].name;
}

std::vector<Index> lostFeatures(const Mesh& mesh, const std::vector<std::uint8_t>& flagsBefore)
{
  if (flagsBefore.size() != mesh.flags.size())
  {
    throw InvalidInput("lost features: flags of another mesh");
  }
  std::vector<Index> lost;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    const bool was = (flagsBefore[h] & kFeatureEdge) != 0;
    if (was && !mesh.isFeature(h) && !mesh.isBoundary(h) && h < mesh.twin[h])
    {
      lost.push_back(h);
    }
  }
  return lost;
}

std::vector<GivenUpCurve> givenUpCurves(
  const Mesh& mesh, const std::vector<Index>& halfEdges, double edgeLength, FeatureLoss reason)
{
  if (!(edgeLength > 0))
  {
    throw InvalidInput("the edge length for telling of features must be positive");
  }
  std::vector<GivenUpCurve> curves;
  for (const std::vector<Index>& edges : curvesOfEdges(mesh, halfEdges))
  {
    GivenUpCurve curve;
    curve.reason = reason;
    curve.edges = edges.size();
    const Index middle = edges[edges.size() / 2];
    curve.place = 0.5 * (mesh.position[mesh.origin[middle]] + mesh.position[mesh.target(middle)]);
    for (const Index h : edges)
    {
      curve.length += mesh.edgeVector(h).norm();
      curve.lengthInQuads += sizedLength(mesh, h) / edgeLength;
    }
    curves.push_back(curve);
  }
  return curves;
}

const char* whyNotFollowed(FeatureLoss reason)
{
  return kLossTexts[static_cast<std::size_t>(reason)].whyNot;
}

} // namespace quadrille
