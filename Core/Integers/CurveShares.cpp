// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/CurveShares.h"

#include "Integers/IntegerMap.h"
#include "Mesh/BentCurves.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <tuple>

namespace quadrille
{
namespace
{

/// #V: the map has no corner there.
std::vector<std::uint8_t> smoothVertices(const Mesh& mesh, const CrossField& field)
{
  std::vector<std::uint8_t> smooth(mesh.vertexCount(), 1);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isConstrained(h) && field.sectorTurns[h] != 2)
    {
      smooth[mesh.origin[h]] = 0;
    }
  }
  return smooth;
}

/// Edges of curves of the mesh, each by its lower half-edge, at their vertices.
std::vector<std::vector<Index>> curveEdgesAt(const Mesh& mesh)
{
  std::vector<std::vector<Index>> edges(mesh.vertexCount());
  for (const Index h : constrainedEdges(mesh))
  {
    edges[mesh.origin[h]].push_back(h);
    edges[mesh.target(h)].push_back(h);
  }
  return edges;
}

} // namespace

std::vector<CurveShare> sharesOfCurves(const Mesh& mesh, const CrossField& field,
  const std::vector<FixedVec2>& seamlessUv, double edgeLength, const UvMesh& decimated)
{
  const std::vector<double> quads = quadsAlongCurves(mesh, edgeLength, smoothVertices(mesh, field));
  const std::vector<std::vector<Index>> edges = curveEdgesAt(mesh);
  const auto isLeft = [&](Index v) { return decimated.outgoing[v] != kInvalidIndex; };

  // An edge of the decimated map is a part of a curve between two vertices that are left. Others between the same two
  // have another length in the map, or are as good.
  std::map<std::tuple<Index, Index, std::int64_t>, CurveShare> shareOf;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    for (Index edge : isLeft(v) ? edges[v] : std::vector<Index>{})
    {
      Index at = v;
      double length = 0;
      CurveShare asked{ 0, 0 };
      std::int64_t inMap = 0;
      while (true)
      {
        const double straight = sizedLength(mesh, edge) / edgeLength;
        length += straight;
        // A part of a curve bends where it gets more edges than its length is worth.
        (quads[edge] > (1 + kRounding) * straight ? asked.bent : asked.rest) += quads[edge];
        inMap += IntegerMap::lengthOf(seamlessUv[Mesh::next(edge)] - seamlessUv[edge]);
        at = mesh.otherEnd(edge, at);
        if (isLeft(at) || edges[at].size() != 2)
        {
          break;
        }
        edge = edges[at][0] == edge ? edges[at][1] : edges[at][0];
      }
      CurveShare& share = shareOf[{ v, at, inMap }];
      if (asked.all() / length > share.all())
      {
        share = { asked.bent / length, asked.rest / length };
      }
    }
  }

  std::vector<CurveShare> shares(decimated.origin.size());
  for (Index h = 0; h < shares.size(); ++h)
  {
    const bool isCurve = decimated.alive[Mesh::face(h)] != 0 &&
      (decimated.twin[h] == kInvalidIndex || (decimated.flags[h] & kUvConstrained) != 0);
    if (isCurve)
    {
      const auto found = shareOf.find(
        { decimated.origin[h], decimated.target(h), IntegerMap::lengthOf(decimated.vector(h)) });
      shares[h] = found == shareOf.end() ? CurveShare{} : found->second;
    }
  }
  return shares;
}

} // namespace quadrille
