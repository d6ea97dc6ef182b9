// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
// The points of both cuts of a wedge that are each other's images: pairSeams.
#include "Base/Lists.h"
#include "Base/PlaceText.h"
#include "Quads/QuadTopology.h"
#include "Requests/SeamRequests.h"
#include "Symmetry/Seams.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace quadrille
{

namespace
{

/// Points of a seam's part in the order of the boundary.
using SeamChain = std::vector<Index>;

/// By part, 2 i the left one of seam i and 2 i + 1 the right one; closed ones end with their first point. Empty for one
/// in several pieces.
std::vector<SeamChain> seamChains(
  const QuadMesh& quads, const Mesh& mesh, const std::vector<SeamEdges>& seams)
{
  const std::size_t none = 2 * seams.size();
  std::vector<std::size_t> partOf(mesh.halfEdgeCount(), none);
  for (std::size_t i = 0; i < none; ++i)
  {
    for (const Index h : i % 2 == 0 ? seams[i / 2].left : seams[i / 2].right)
    {
      partOf[h] = i;
    }
  }
  std::map<std::pair<Index, Index>, std::size_t> partOfEdge;
  for (const QuadLine& line : quads.lines)
  {
    if (line.boundary && partOf[line.halfEdge] != none)
    {
      partOfEdge[std::minmax(line.a, line.b)] = partOf[line.halfEdge];
    }
  }
  const auto partAt = [&](Index h)
  {
    const auto edge = partOfEdge.find(std::minmax(quads.origin(h), quads.target(h)));
    return edge == partOfEdge.end() ? none : edge->second;
  };
  std::vector<SeamChain> chains(none);
  std::vector<std::uint8_t> isBroken(none, 0);
  for (std::vector<Index> loop : boundaryLoops(analyzeQuads(quads.quads, quads.points.size())))
  {
    // From where a part begins, or from the lowest point of a closed one.
    auto first = std::min_element(loop.begin(), loop.end(),
      [&](Index g, Index h) { return quads.origin(g) < quads.origin(h); });
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      const bool isBegin = partAt(loop[i]) != partAt(loop[i == 0 ? loop.size() - 1 : i - 1]);
      first = isBegin ? loop.begin() + static_cast<std::ptrdiff_t>(i) : first;
    }
    std::rotate(loop.begin(), first, loop.end());
    for (const Index h : loop)
    {
      const std::size_t part = partAt(h);
      if (part != none)
      {
        SeamChain& chain = chains[part];
        isBroken[part] |= !chain.empty() && chain.back() != quads.origin(h) ? 1 : 0;
        chain.resize(std::max<std::size_t>(chain.size(), 1), quads.origin(h));
        chain.push_back(quads.target(h));
      }
    }
  }
  for (std::size_t i = 0; i < none; ++i)
  {
    chains[i] = isBroken[i] != 0 ? SeamChain{} : std::move(chains[i]);
  }
  return chains;
}

/// What points of the second half plane are at the same place as points of the first one: the right chain goes
/// backwards. Closed ones are turned against each other until they are nearest.
class ChainPairs
{
public:
  ChainPairs(const QuadMesh& quads, const Isometry& rotation) : quads_(quads), rotation_(rotation)
  {
  }

  std::vector<SamePoints> pair(SeamChain left, SeamChain right) const
  {
    std::reverse(right.begin(), right.end());
    const bool closed = left.size() > 2 && left.front() == left.back();
    if (closed)
    {
      turnToNearest(left, right);
    }
    // Between two poles either part may be the one that the other is the image of. Of order 2 each is that of the
    // other.
    const bool isImage = distance(left, right) <= 2 * distance(right, left);
    std::vector<SamePoints> pairs;
    for (std::size_t i = 0; i < left.size(); ++i)
    {
      pairs.push_back(isImage ? SamePoints{ left[i], right[i] } : SamePoints{ right[i], left[i] });
    }
    return pairs;
  }

private:
  double distance(const SeamChain& first, const SeamChain& second) const
  {
    double sum = 0;
    for (std::size_t i = 0; i < first.size(); ++i)
    {
      const Vector3 image = rotation_.image(quads_.points[first[i]]);
      sum += (image - quads_.points[second[i]]).squaredNorm();
    }
    return sum;
  }

  void turnToNearest(const SeamChain& left, SeamChain& right) const
  {
    SeamChain best = right;
    for (std::size_t k = 0; k + 1 < right.size(); ++k)
    {
      right.pop_back();
      std::rotate(right.begin(), right.begin() + 1, right.end());
      right.push_back(right.front());
      if (distance(left, right) < distance(left, best))
      {
        best = right;
      }
    }
    right = std::move(best);
  }

  const QuadMesh& quads_;
  const Isometry& rotation_;
};

} // namespace

WedgeSeams pairSeams(const QuadMesh& quads, const Mesh& mesh,
  const std::vector<SeamRequest>& requests, const Isometry& rotation)
{
  WedgeSeams result;
  const std::vector<SeamEdges> seams = findSeams(mesh, requests);
  const std::vector<SeamChain> chains = seamChains(quads, mesh, seams);
  const ChainPairs pairing(quads, rotation);
  for (std::size_t i = 0; i < seams.size(); ++i)
  {
    const SeamChain &left = chains[2 * i], &right = chains[2 * i + 1];
    if (left.empty() || left.size() != right.size())
    {
      result.pairs.clear();
      result.status = { StatusCode::NotConverged,
        "ask for smaller quads, or choose the method scale aware: the two cuts of a wedge near " +
          placeText(requests[i].from) + " have " +
          std::to_string(std::max<std::size_t>(left.size(), 1) - 1) + " and " +
          std::to_string(std::max<std::size_t>(right.size(), 1) - 1) +
          " edges of quads, so that wedges do not fit together" };
      return result;
    }
    const std::vector<SamePoints> pairs = pairing.pair(left, right);
    result.pairs.insert(result.pairs.end(), pairs.begin(), pairs.end());
  }
  sortUniqueBy(
    result.pairs, [](const SamePoints& pair) { return std::pair(pair.first, pair.second); });
  return result;
}

} // namespace quadrille
