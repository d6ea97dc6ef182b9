// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Details/HandleStubs.h"

#include "Mesh/AskedVertices.h"
#include "Mesh/SurfaceEdit.h"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <queue>
#include <set>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace quadrille
{

namespace
{

/// In girths: the longest edge of a disc that is taken out, and the one from which a disc has opened into a surface.
constexpr double kWidestMouth = 1.5;
constexpr double kOpen = 3;
/// Vertices of the largest disc that is looked at; stubs are shorter than quads, or thin.
constexpr std::size_t kMostVertices = 20000;

/// A fan over the edge of a disc.
struct MouthFan
{
  std::vector<Index>
    run; ///< half-edges of what is outside, each of which ends where the next one begins
  Vector3 middle = Vector3::Zero();
  double area = 0;
};

class StubSearch
{
public:
  StubSearch(const PreparedSurface& surface, Index h, double girth, double opening)
    : surface_(surface), mesh_(surface.mesh), girth_(girth), open_(std::min(kOpen * girth, opening))
  {
    reached_.push({ 0, mesh_.origin[h] });
    leaving_[mesh_.origin[h]] = { 0, h };
  }

  /// False where discs do not open. One has opened where its edge stays that long for as far as its longest edge leads:
  /// along a tube of long triangles it zigzags between two rings of vertices until it has all of the next one.
  bool run()
  {
    double openUntil = kInfinity;
    while (!reached_.empty() && inside_.size() < kMostVertices && reached_.top().first <= openUntil)
    {
      const auto [distance, v] = reached_.top();
      reached_.pop();
      if (inside_.count(v) == 0 && !enter(v))
      {
        return openUntil < kInfinity;
      }
      if (length_ <= open_)
      {
        openUntil = kInfinity;
      }
      else if (openUntil == kInfinity)
      {
        openUntil = distance + longestOfEdge();
      }
      if (length_ > 0 && length_ <= std::min(kWidestMouth * girth_, open_))
      {
        measure();
      }
    }
    return length_ > open_;
  }

  /// The faces to take out, and the fan in their place; none where there is no pit.
  std::optional<std::pair<std::vector<Index>, MouthFan>> best() const
  {
    // In areas of the fan: what a disc has to have beyond it to be a pit, and what counts as no more.
    constexpr double kLeastPit = 0.5;
    constexpr double kNoMore = 0.05;
    const auto beyond = [](const Disc& disc) { return disc.area - disc.fan.area; };
    const auto most = std::max_element(discs_.begin(), discs_.end(),
      [&](const Disc& a, const Disc& b) { return beyond(a) < beyond(b); });
    if (most == discs_.end() || beyond(*most) < kLeastPit * most->fan.area)
    {
      return std::nullopt;
    }
    const auto first = std::find_if(discs_.begin(), discs_.end(),
      [&](const Disc& disc) { return beyond(disc) >= beyond(*most) - kNoMore * most->fan.area; });
    return std::pair(std::vector<Index>(
                       faces_.begin(), faces_.begin() + static_cast<std::ptrdiff_t>(first->faces)),
      first->fan);
  }

private:
  struct Disc
  {
    std::size_t faces = 0; ///< the first ones
    double area = 0;
    MouthFan fan;
  };

  using Reached = std::pair<double, Index>; ///< distance, vertex

  /// The vertex and the faces that have all their corners in then; false where they may not be taken out.
  bool enter(Index v)
  {
    const auto [distance, first] = leaving_.at(v);
    inside_.insert(v);
    Index g = first;
    do
    {
      if (mesh_.isBoundary(g) || isAskedFor(surface_, v))
      {
        return false;
      }
      const Index w = mesh_.target(g);
      const double there = distance + mesh_.edgeVector(g).norm();
      const auto known = leaving_.find(w);
      if (known == leaving_.end() || there < known->second.first)
      {
        leaving_[w] = { there, Mesh::next(g) };
        reached_.push({ there, w });
      }
      if (inside_.count(w) != 0 && inside_.count(mesh_.origin[Mesh::previous(g)]) != 0 &&
        !take(Mesh::face(g)))
      {
        return false;
      }
      g = mesh_.rotateCounterclockwise(g);
    } while (g != kInvalidIndex && g != first);
    return g == first;
  }

  bool take(Index f)
  {
    faces_.push_back(f);
    area_ += mesh_.faceArea(f);
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      if ((mesh_.flags[h] & kRequestedFeature) != 0 || mesh_.isBoundary(h))
      {
        return false;
      }
      corners_.insert(mesh_.origin[h]);
      const Index outside = mesh_.twin[h];
      const double length = mesh_.edgeVector(h).norm();
      if (edge_.erase(h) != 0) // it was outside
      {
        length_ -= length;
      }
      else
      {
        edge_.insert(outside);
        length_ += length;
      }
    }
    return true;
  }

  double longestOfEdge() const
  {
    double longest = 0;
    for (const Index h : edge_)
    {
      longest = std::max(longest, mesh_.edgeVector(h).norm());
    }
    return longest;
  }

  void measure()
  {
    Disc disc;
    disc.faces = faces_.size();
    disc.area = area_;
    if ((discs_.empty() || discs_.back().faces < disc.faces) && isDisc() && makeFan(disc.fan))
    {
      discs_.push_back(std::move(disc));
    }
  }

  bool isDisc() const
  {
    const std::size_t edges = (3 * faces_.size() + edge_.size()) / 2;
    return corners_.size() + faces_.size() == edges + 1;
  }

  /// False where the edge is not one loop, or the fan would fold.
  bool makeFan(MouthFan& fan) const
  {
    std::map<Index, Index> from;
    for (const Index h : edge_)
    {
      from[mesh_.origin[h]] = h;
    }
    Vector3 normal = Vector3::Zero();
    const Index first = *edge_.begin();
    Index h = first;
    do
    {
      fan.run.push_back(h);
      fan.middle += mesh_.position[mesh_.origin[h]];
      normal += mesh_.position[mesh_.target(h)].cross(mesh_.position[mesh_.origin[h]]);
      h = from.at(mesh_.target(h));
    } while (h != first && fan.run.size() <= edge_.size());
    if (fan.run.size() != edge_.size() || fan.run.size() < 3)
    {
      return false;
    }
    fan.middle /= static_cast<double>(fan.run.size());
    // The least cosine between the normals of a triangle and of the whole fan.
    constexpr double kLeastFacing = 0.1;
    return std::all_of(fan.run.begin(), fan.run.end(),
      [&](Index edge)
      {
        const Vector3 triangle = (mesh_.position[mesh_.target(edge)] - fan.middle)
                                   .cross(mesh_.position[mesh_.origin[edge]] - fan.middle);
        fan.area += triangle.norm() / 2;
        return triangle.dot(normal) > kLeastFacing * triangle.norm() * normal.norm();
      });
  }

  const PreparedSurface& surface_;
  const Mesh& mesh_;
  double girth_, open_;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> reached_;
  std::unordered_map<Index, std::pair<double, Index>>
    leaving_; ///< distance, a half-edge from there
  std::unordered_set<Index> inside_, corners_;
  std::set<Index> edge_; ///< half-edges of what is outside
  std::vector<Index> faces_;
  std::vector<Disc> discs_;
  double length_ = 0; ///< of the edge
  double area_ = 0;
};

} // namespace

bool removeStub(PreparedSurface& surface, Index h, double girth, double opening)
{
  Mesh& mesh = surface.mesh;
  if (mesh.origin[h] == kInvalidIndex)
  {
    return false; // it was in another one
  }
  StubSearch search(surface, h, girth, opening);
  if (!search.run())
  {
    return false;
  }
  const auto stub = search.best();
  if (!stub)
  {
    return false;
  }
  const auto& [faces, fan] = *stub;
  for (const Index f : faces)
  {
    surface.area -= mesh.faceArea(f);
  }
  for (const Index f : faces)
  {
    removeFace(surface, f);
  }
  fillWithFan(surface, fan.run, fan.middle);
  surface.area += fan.area;
  return true;
}

} // namespace quadrille
