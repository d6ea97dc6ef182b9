// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// FaceCurves::chooseNumbers.
#include "Base/Lists.h"
#include "Filling/FaceCurves.h"
#include "Filling/FaceGround.h"
#include "Mesh/Sizing.h"
#include "Quads/QuadShape.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <utility>

namespace quadrille
{
namespace
{

/// What each curve on the way between two odd faces costs beside what an edge more or less does to its edges.
constexpr double kCostOfStep = 0.05;

/// How far off a number of edges is for a curve of this length.
double misfit(double length, std::size_t edges)
{
  const double off = static_cast<double>(edges) - length;
  return off * off / std::max(length, 1.0);
}

} // namespace

/// Numbers of edges while they are chosen, and what they add up to.
class CurveNumbers
{
public:
  CurveNumbers(std::vector<FaceCurve>& curves, std::vector<std::size_t> givenAround,
    std::vector<std::size_t> givenAroundLoop)
    : curves_(curves), givenAround_(std::move(givenAround)),
      givenAroundLoop_(std::move(givenAroundLoop)), beside_(givenAround_.size() + 1)
  {
    for (std::size_t c = 0; c < curves_.size(); ++c)
    {
      least_.push_back(curves_[c].least);
      const auto [a, b] = sidesOf(c);
      if (a != b)
      {
        beside_[a].emplace_back(c, b);
        beside_[b].emplace_back(c, a);
      }
    }
  }

  /// Faces that would be one quad, and have edges that are not given.
  std::vector<Index> singleQuads() const
  {
    return idsWhere(
      givenAround_.size(), [&](Index f) { return around_[f] == 4 && givenAround_[f] < 4; });
  }

  /// Whether there is a curve of these faces that had fewer edges than two.
  bool askForTwo(const std::vector<Index>& faces)
  {
    bool any = false;
    for (std::size_t c = 0; c < curves_.size(); ++c)
    {
      const auto [a, b] = sidesOf(c);
      if (least_[c] < 2 && (contains(faces, a) || contains(faces, b)))
      {
        least_[c] = 2;
        any = any || curves_[c].edges < 2;
      }
    }
    return any;
  }

  /// Two more for the curve round the face that has the longest edges.
  void addTwo(Index face)
  {
    const auto edge = [](const FaceCurve& curve)
    { return curve.length / static_cast<double>(curve.edges); };
    FaceCurve* longest = nullptr;
    for (FaceCurve& curve : curves_)
    {
      const bool isLonger = longest == nullptr || edge(curve) > edge(*longest);
      longest = contains(curve.faces, face) && isLonger ? &curve : longest;
    }
    add(*longest, 2);
  }

  /// Returns the faces that are left with an odd number.
  std::vector<Index> choose()
  {
    around_ = givenAround_;
    aroundLoop_ = givenAroundLoop_;
    for (std::size_t c = 0; c < curves_.size(); ++c)
    {
      curves_[c].edges = 0;
      add(
        curves_[c], std::max(least_[c], static_cast<std::size_t>(std::llround(curves_[c].length))));
    }
    widen();
    return makeEven();
  }

private:
  void add(FaceCurve& curve, std::size_t edges)
  {
    curve.edges += edges;
    for (const std::size_t side : { 0, 1 })
    {
      if (curve.faces[side] != kInvalidIndex)
      {
        around_[curve.faces[side]] += edges;
        aroundLoop_[curve.loops[side]] += edges;
      }
    }
  }

  Index outside() const { return static_cast<Index>(givenAround_.size()); }

  std::pair<Index, Index> sidesOf(std::size_t c) const
  {
    const FaceCurve& curve = curves_[c];
    return { curve.faces[0], curve.faces[1] == kInvalidIndex ? outside() : curve.faces[1] };
  }

  bool hasFewer(const FaceCurve& curve, std::size_t least) const
  {
    return std::any_of(curve.loops.begin(), curve.loops.end(),
      [&](Index loop) { return loop != kInvalidIndex && aroundLoop_[loop] < least; });
  }

  /// Two edges round a face, or round a hole in it, would lie on each other.
  void widen()
  {
    for (FaceCurve& curve : curves_)
    {
      const bool isTight = std::any_of(curve.faces.begin(), curve.faces.end(),
        [&](Index f) { return f != kInvalidIndex && around_[f] < 4; });
      if ((isTight || hasFewer(curve, 3)) && curve.edges < 3)
      {
        add(curve, 2);
      }
    }
  }

  /// Of one edge more or less, whichever is nearer to the length, and whether it is less.
  std::pair<double, bool> costOfChange(std::size_t c) const
  {
    const FaceCurve& curve = curves_[c];
    const double now = misfit(curve.length, curve.edges);
    const double longer = misfit(curve.length, curve.edges + 1) - now;
    const double shorter = curve.edges > least_[c] && !hasFewer(curve, 4)
      ? misfit(curve.length, curve.edges - 1) - now
      : kInfinity;
    return { kCostOfStep + std::max(0.0, std::min(longer, shorter)), shorter < longer };
  }

  /// Pairs of odd faces, or of one and what is outside, along the cheapest way: each curve on it gets an edge more or
  /// less.
  std::vector<Index> makeEven()
  {
    std::vector<Index> left;
    for (Index f = 0; f < outside(); ++f)
    {
      if (around_[f] % 2 == 0)
      {
        continue;
      }
      const std::vector<std::size_t> way = wayToOdd(f);
      if (way.empty())
      {
        left.push_back(f);
      }
      for (const std::size_t c : way)
      {
        add(curves_[c], costOfChange(c).second ? std::size_t(-1) : 1);
      }
    }
    return left;
  }

  /// The curves between a face and the nearest other odd one; empty where there is none.
  std::vector<std::size_t> wayToOdd(Index from) const
  {
    constexpr double none = kInfinity;
    std::map<Index, std::pair<double, std::size_t>> best{ { from, { 0.0, curves_.size() } } };
    std::set<std::pair<double, Index>> queue{ { 0.0, from } };
    std::set<Index> done;
    while (!queue.empty())
    {
      const auto [cost, face] = *queue.begin();
      queue.erase(queue.begin());
      done.insert(face);
      if (face != from && (face == outside() || around_[face] % 2 != 0))
      {
        std::vector<std::size_t> way;
        for (Index at = face; at != from;)
        {
          const std::size_t c = best[at].second;
          way.push_back(c);
          const auto [a, b] = sidesOf(c);
          at = a == at ? b : a;
        }
        return way;
      }
      for (const auto& [c, next] : beside_[face])
      {
        const double there = cost + costOfChange(c).first;
        const auto known = best.find(next);
        const double before = known == best.end() ? none : known->second.first;
        if (done.count(next) == 0 && there < before)
        {
          queue.erase({ before, next });
          queue.insert({ there, next });
          best[next] = { there, c };
        }
      }
    }
    return {};
  }

  std::vector<FaceCurve>& curves_;
  std::vector<std::size_t> least_;                                 ///< per curve
  std::vector<std::size_t> givenAround_, givenAroundLoop_;         ///< edges that are given
  std::vector<std::size_t> around_, aroundLoop_;                   ///< per face, per loop of one
  std::vector<std::vector<std::pair<std::size_t, Index>>> beside_; ///< per face: curve, other face
};

/// Of a face with so few edges round it: the places where they meet, in order.
std::vector<Vector3> FaceCurves::cornersRound(Index face) const
{
  std::map<Index, std::vector<double>> onEdge; // by the lower half-edge
  std::set<Index> atVertex;
  Index first = kInvalidIndex;
  for (const FaceCurve& curve : curves_)
  {
    if (!contains(curve.faces, face))
    {
      continue;
    }
    for (const CurvePoint& point : pointsAlong(curve))
    {
      onEdge[point.h].push_back(point.t);
    }
    const CurveStep& begin = curve.steps.front();
    atVertex.insert({ beginOf(begin), endOf(curve.steps.back()) });
    first = curve.faces[0] == face ? begin.h : mesh_.twin[begin.h];
  }
  for (const CurvePoint& point : given_)
  {
    if (faceOf_[Mesh::face(point.h)] != face)
    {
      continue;
    }
    if (point.t > 0)
    {
      onEdge[point.h].push_back(point.t);
    }
    else
    {
      atVertex.insert(mesh_.origin[point.h]);
    }
  }
  std::vector<Vector3> corners;
  Index h = first;
  do
  {
    if (atVertex.count(mesh_.origin[h]) != 0)
    {
      corners.push_back(mesh_.position[mesh_.origin[h]]);
    }
    const bool isLower = mesh_.isBoundary(h) || h < mesh_.twin[h];
    const auto found = onEdge.find(isLower ? h : mesh_.twin[h]);
    if (found != onEdge.end())
    {
      std::vector<double>& parts = found->second;
      std::sort(parts.begin(), parts.end());
      if (!isLower)
      {
        std::reverse(parts.begin(), parts.end());
      }
      std::transform(parts.begin(), parts.end(), std::back_inserter(corners),
        [&](double t) {
          return positionOf(mesh_, CurvePoint{ found->first, t }.onSurface());
        });
    }
    h = nextOnLoop_[h];
  } while (h != first);
  return corners;
}

/// Of the faces that would be one quad those where this has a flat corner, or is folded.
std::vector<Index> FaceCurves::flatFaces(const std::vector<Index>& singleQuads) const
{
  std::vector<Vector3> normals(faces_, Vector3::Zero());
  for (Index f = 0; f < mesh_.faceCount(); ++f)
  {
    normals[faceOf_[f]] += mesh_.doubleAreaNormal(f);
  }
  std::vector<Index> flat;
  for (const Index f : singleQuads)
  {
    const std::vector<Vector3> corners = cornersRound(f);
    if (corners.size() == 4 &&
      quadShape({ corners[0], corners[1], corners[2], corners[3] }, normals[f]) < kLeastShape)
    {
      flat.push_back(f);
    }
  }
  return flat;
}

std::vector<Index> FaceCurves::chooseNumbers()
{
  std::vector<std::size_t> around(faces_, 0), aroundLoop(loops_, 0);
  for (const CurvePoint& point : given_)
  {
    around[faceOf_[Mesh::face(point.h)]] += isGiven_[point.h];
    aroundLoop[loopOf_[point.h]] += isGiven_[point.h];
  }
  CurveNumbers numbers(curves_, std::move(around), std::move(aroundLoop));
  std::vector<Index> odd = numbers.choose();
  while (numbers.askForTwo(flatFaces(numbers.singleQuads())))
  {
    odd = numbers.choose();
  }
  for (const Index f : flatFaces(numbers.singleQuads()))
  {
    numbers.addTwo(f);
  }
  return odd;
}

} // namespace quadrille
