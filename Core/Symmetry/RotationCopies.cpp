// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/RotationCopies.h"

#include "Base/PlaceText.h"
#include "Requests/SeamRequests.h"
#include "Symmetry/CutLines.h"

#include <algorithm>
#include <array>
#include <cstddef>
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

/// Of quads: along the boundary from each point to the next one, by the part of a seam that it lies on.
class SeamChains
{
public:
  SeamChains(const QuadMesh& quads, const Mesh& mesh, const std::vector<SeamEdges>& seams)
    : quads_(quads), next_(2 * seams.size())
  {
    std::vector<std::size_t> partOf(mesh.halfEdgeCount(), next_.size());
    for (std::size_t i = 0; i < seams.size(); ++i)
    {
      for (const Index h : seams[i].left)
      {
        partOf[h] = 2 * i;
      }
      for (const Index h : seams[i].right)
      {
        partOf[h] = 2 * i + 1;
      }
    }
    std::map<std::pair<Index, Index>, std::size_t> edges;
    for (const QuadLine& line : quads.lines)
    {
      if (line.boundary && partOf[line.halfEdge] < next_.size())
      {
        edges[std::minmax(line.a, line.b)] = partOf[line.halfEdge];
      }
    }
    for (const std::array<Index, 4>& quad : quads.quads)
    {
      for (std::size_t i = 0; i < 4; ++i)
      {
        const Index a = quad[i], b = quad[(i + 1) % 4];
        const auto edge = edges.find(std::minmax(a, b));
        if (edge != edges.end())
        {
          next_[edge->second][a] = b;
        }
      }
    }
  }

  /// Of part i; a closed one ends with its first point.
  SeamChain chain(std::size_t i) const
  {
    const std::map<Index, Index>& next = next_[i];
    if (next.empty())
    {
      return {};
    }
    std::map<Index, Index> before;
    for (const auto& [a, b] : next)
    {
      before[b] = a;
    }
    Index start = next.begin()->first;
    for (const auto& edge : next)
    {
      start = before.count(edge.first) == 0 ? edge.first : start;
    }
    SeamChain points{ start };
    for (auto at = next.find(start); at != next.end() && points.size() <= next.size();
         at = next.find(points.back()))
    {
      points.push_back(at->second);
    }
    return points.size() == next.size() + 1 ? points : SeamChain{};
  }

private:
  const QuadMesh& quads_;
  std::vector<std::map<Index, Index>>
    next_; ///< by part: 2 i the left one of seam i, 2 i + 1 the right one
};

/// What points of the second half plane are at the same place as points of the first one: the right chain goes
/// backwards. Closed ones are turned against each other until they are nearest.
class ChainPairs
{
public:
  ChainPairs(const QuadMesh& quads, const MadeRotation& rotation)
    : quads_(quads), rotation_(rotation)
  {
  }

  std::vector<SeamPoints> pair(SeamChain left, SeamChain right) const
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
    std::vector<SeamPoints> pairs;
    for (std::size_t i = 0; i < left.size(); ++i)
    {
      pairs.push_back(isImage ? SeamPoints{ left[i], right[i] } : SeamPoints{ right[i], left[i] });
    }
    return pairs;
  }

private:
  double distance(const SeamChain& first, const SeamChain& second) const
  {
    double sum = 0;
    for (std::size_t i = 0; i < first.size(); ++i)
    {
      const Vector3 image = rotation_.axis.image(quads_.points[first[i]], 1, rotation_.order);
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
  const MadeRotation& rotation_;
};

/// Numbers of the points of all wedges: those of the first one, then those that each one after it adds.
class TurnedPoints
{
public:
  TurnedPoints(std::size_t points, const std::vector<SeamPoints>& pairs, int order)
    : order_(order), firstOf_(points, kInvalidIndex), place_(points, 0)
  {
    for (const SeamPoints& pair : pairs)
    {
      firstOf_[pair.second] = pair.first;
    }
    std::size_t others = 0;
    inImages_.assign(points, 0);
    for (Index p = 0; p < points; ++p)
    {
      if (firstOf_[p] == kInvalidIndex || firstOf_[p] == p)
      {
        place_[p] = static_cast<Index>(base_++);
        inImages_[p] = static_cast<Index>(others);
        others += firstOf_[p] == p ? 0 : 1;
      }
    }
    added_ = others;
  }

  bool isPole(Index p) const { return firstOf_[p] == p; }
  /// Whether it has a number of its own in each wedge.
  bool isOwn(Index p) const { return firstOf_[p] == kInvalidIndex; }
  std::size_t ofWedge() const { return base_; }
  std::size_t count() const { return base_ + static_cast<std::size_t>(order_ - 1) * added_; }

  Index operator()(int step, Index p) const
  {
    if (!isOwn(p) && !isPole(p))
    {
      p = firstOf_[p];
      ++step;
    }
    step %= order_;
    if (step == 0 || isPole(p))
    {
      return place_[p];
    }
    return static_cast<Index>(base_ + static_cast<std::size_t>(step - 1) * added_ + inImages_[p]);
  }

private:
  int order_;
  std::vector<Index> firstOf_; ///< of points in the second half plane: that in the first one
  std::vector<Index> place_, inImages_;
  std::size_t base_ = 0, added_ = 0;
};

} // namespace

WedgeSeams pairSeams(const QuadMesh& quads, const Mesh& mesh,
  const std::vector<SeamRequest>& requests, const MadeRotation& rotation)
{
  WedgeSeams result;
  const std::vector<SeamEdges> seams = findSeams(mesh, requests);
  const SeamChains chains(quads, mesh, seams);
  const ChainPairs pairing(quads, rotation);
  for (std::size_t i = 0; i < seams.size(); ++i)
  {
    const SeamChain left = chains.chain(2 * i), right = chains.chain(2 * i + 1);
    if (left.empty() || left.size() != right.size())
    {
      result.pairs.clear();
      result.status = { StatusCode::NotConverged,
        "the two cuts of a wedge near " + placeText(requests[i].from) + " have " +
          std::to_string(std::max<std::size_t>(left.size(), 1) - 1) + " and " +
          std::to_string(std::max<std::size_t>(right.size(), 1) - 1) +
          " edges of quads, so that wedges do not fit together: choose the method scale aware, or "
          "ask for smaller quads" };
      return result;
    }
    const std::vector<SeamPoints> pairs = pairing.pair(left, right);
    result.pairs.insert(result.pairs.end(), pairs.begin(), pairs.end());
  }
  const auto order = [](const SeamPoints& a, const SeamPoints& b)
  { return std::pair(a.first, a.second) < std::pair(b.first, b.second); };
  const auto same = [](const SeamPoints& a, const SeamPoints& b)
  { return a.first == b.first && a.second == b.second; };
  std::sort(result.pairs.begin(), result.pairs.end(), order);
  result.pairs.erase(
    std::unique(result.pairs.begin(), result.pairs.end(), same), result.pairs.end());
  return result;
}

DoubledQuads turnQuads(const QuadMesh& wedge, const Mesh& mesh,
  const std::vector<SeamPoints>& pairs, const MadeRotation& rotation)
{
  const TurnedPoints numbers(wedge.points.size(), pairs, rotation.order);
  const CutLines cut(wedge.points.size(), pairs);
  DoubledQuads result;
  result.halfPoints = static_cast<Index>(numbers.ofWedge());
  result.halfQuads = static_cast<Index>(wedge.quads.size());
  result.image.assign(numbers.count(), kInvalidIndex);
  QuadMesh& quads = result.quads;
  quads.points.resize(numbers.count());
  quads.sourceFace.resize(numbers.count());
  quads.sourceWeights.resize(numbers.count());
  for (int step = 0; step < rotation.order; ++step)
  {
    const Index firstFace = static_cast<Index>(step) * mesh.faceCount();
    for (Index p = 0; p < wedge.points.size(); ++p)
    {
      const bool isHere = numbers.isOwn(p) || (numbers.isPole(p) && step == 0);
      if (isHere)
      {
        const Index id = numbers(step, p);
        quads.points[id] = rotation.axis.image(wedge.points[p], step, rotation.order);
        quads.sourceFace[id] = firstFace + wedge.sourceFace[p];
        quads.sourceWeights[id] = wedge.sourceWeights[p];
        result.image[id] = numbers(step + 1, p);
      }
    }
    for (std::size_t q = 0; q < wedge.quads.size(); ++q)
    {
      std::array<Index, 4> quad{};
      std::transform(wedge.quads[q].begin(), wedge.quads[q].end(), quad.begin(),
        [&](Index p) { return numbers(step, p); });
      quads.quads.push_back(quad);
      quads.quadSourceFace.push_back(firstFace + wedge.quadSourceFace[q]);
      quads.quadSourceWeights.push_back(wedge.quadSourceWeights[q]);
    }
    for (const QuadLine& line : wedge.lines)
    {
      const bool isFeature = cut.inFirst(line) && mesh.isFeature(line.halfEdge);
      if (!cut.has(line) || isFeature)
      {
        quads.lines.push_back({ numbers(step, line.a), numbers(step, line.b),
          3 * firstFace + line.halfEdge, line.boundary && !isFeature });
      }
    }
  }
  const Index crowded = countEdges(quads);
  if (crowded != kInvalidIndex)
  {
    result.status = { StatusCode::NotConverged,
      "a wedge is one quad wide near " + placeText(quads.points[crowded]) +
        ", so that with its images it would be two quads round: it needs more quads" };
  }
  return result;
}

CopiedMesh turnMesh(const Mesh& wedge, const std::vector<FixedVec2>& uv,
  const std::vector<int>& turns, const MadeRotation& rotation)
{
  CopiedMesh copied;
  copied.partFaces = wedge.faceCount();
  Mesh& mesh = copied.mesh;
  for (int step = 0; step < rotation.order; ++step)
  {
    const auto firstVertex = static_cast<Index>(mesh.position.size());
    const auto firstHalfEdge = static_cast<Index>(mesh.origin.size());
    for (const Vector3& p : wedge.position)
    {
      mesh.position.push_back(rotation.axis.image(p, step, rotation.order));
    }
    for (Index h = 0; h < wedge.halfEdgeCount(); ++h)
    {
      mesh.origin.push_back(firstVertex + wedge.origin[h]);
      mesh.twin.push_back(wedge.isBoundary(h) ? kInvalidIndex : firstHalfEdge + wedge.twin[h]);
    }
    mesh.flags.append(wedge.flags.begin(), wedge.flags.end());
    mesh.sizing.append(wedge.sizing.begin(), wedge.sizing.end());
    copied.uv.insert(copied.uv.end(), uv.begin(), uv.end());
    copied.turns.insert(copied.turns.end(), turns.begin(), turns.end());
  }
  return copied;
}

} // namespace quadrille
