// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "ForeignMaps/MapWelding.h"

#include "Base/Lists.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Mesh/EdgeRuns.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace quadrille
{
namespace
{

/// In quads: images of one edge that differ by less fit each other.
constexpr double kFit = 0.01;

void checkTriangles(const MappedTriangles& triangles)
{
  refuseIf(triangles.corners.size() % 3 != 0 || triangles.uv.size() != triangles.corners.size(),
    "welding: ", triangles.uv.size(), " uv for ", triangles.corners.size(), " corners");
  for (std::size_t i = 0; i < triangles.position.size(); ++i)
  {
    refuseIf(!triangles.position[i].allFinite(), "point ", i, " has a position that is not finite");
  }
  for (std::size_t h = 0; h < triangles.corners.size(); ++h)
  {
    refuseIf(triangles.corners[h] >= triangles.position.size(), "cell ", h / 3, " refers to point ",
      triangles.corners[h], " of ", triangles.position.size());
  }
}

/// Equal numbers for points at equal places: an open hash table of the first point of each.
class Places
{
public:
  explicit Places(const std::vector<Vector3>& position) : position_(position)
  {
    std::size_t size = 16;
    while (size < 2 * position.size())
    {
      size *= 2;
    }
    table_.assign(size, kInvalidIndex);
    place.reserve(position.size());
    for (Index p = 0; p < position.size(); ++p)
    {
      pollNowAndThen(p);
      place.push_back(insert(p));
    }
  }

  std::vector<Index> place; ///< #points
  Index count = 0;

private:
  Index insert(Index p)
  {
    std::size_t slot = hash(position_[p]) & (table_.size() - 1);
    while (table_[slot] != kInvalidIndex && position_[table_[slot]] != position_[p])
    {
      slot = (slot + 1) & (table_.size() - 1);
    }
    if (table_[slot] == kInvalidIndex)
    {
      table_[slot] = p;
      return count++;
    }
    return place[table_[slot]];
  }

  static std::size_t hash(const Vector3& p)
  {
    std::uint64_t mix = 0;
    for (const double coordinate : { p.x(), p.y(), p.z() })
    {
      const double x = coordinate + 0.0; // -0 equals 0
      std::uint64_t bits = 0;
      std::memcpy(&bits, &x, sizeof bits);
      mix = (mix ^ bits) * 0x9E3779B97F4A7C15U;
      mix ^= mix >> 29;
    }
    return static_cast<std::size_t>(mix);
  }

  const std::vector<Vector3>& position_;
  std::vector<Index> table_;
};

class Welder
{
public:
  explicit Welder(const MappedTriangles& triangles)
    : in_(triangles), places_(triangles.position), soup_(isSoup())
  {
    checkCorners();
    mesh_.twin.assign(in_.corners.size(), kInvalidIndex);
    mesh_.flags.assign(in_.corners.size(), 0);
    mesh_.origin.resize(in_.corners.size());
    for (std::size_t h = 0; h < in_.corners.size(); ++h)
    {
      mesh_.origin.edit()[h] = places_.place[in_.corners[h]];
    }
  }

  Mesh run()
  {
    pairEdges();
    numberVertices();
    return std::move(mesh_);
  }

private:
  bool isSoup() const
  {
    std::vector<std::uint8_t> used(in_.position.size(), 0);
    for (const Index p : in_.corners)
    {
      if (used[p]++ != 0)
      {
        return false;
      }
    }
    return true;
  }

  void checkCorners() const
  {
    for (std::size_t f = 0; 3 * f < in_.corners.size(); ++f)
    {
      const Index a = places_.place[in_.corners[3 * f]];
      const Index b = places_.place[in_.corners[3 * f + 1]];
      const Index c = places_.place[in_.corners[3 * f + 2]];
      refuseIf(a == b || b == c || c == a, "cell ", f,
        " has two corners at one place; take such cells out of the surface");
    }
  }

  Index point(Index h) const { return in_.corners[h]; }
  Index endPoint(Index h) const { return in_.corners[Mesh::next(h)]; }

  // ---------------------------------------------------------------- edges

  void pairEdges()
  {
    const EdgeRuns runs(mesh_.origin, places_.count, 1);
    runs.forEach(
      [this](const EdgeRuns::Entry* begin, const EdgeRuns::Entry* end) { pairRun(begin, end); });
  }

  /// Pairs the half-edges at one place, the surest ones first.
  void pairRun(const EdgeRuns::Entry* begin, const EdgeRuns::Entry* end)
  {
    forward_.clear();
    backward_.clear();
    for (const EdgeRuns::Entry* entry = begin; entry != end; ++entry)
    {
      const bool ascends = mesh_.origin[entry->halfEdge] < entry->other;
      (ascends ? forward_ : backward_).push_back(entry->halfEdge);
    }
    pairWhere(
      [this](Index h, Index g) { return point(h) == endPoint(g) && endPoint(h) == point(g); });
    if (forward_.size() + backward_.size() > 2)
    {
      pairWhere([this](Index h, Index g) { return isDoubled(h, g) && sameImages(h, g); });
    }
    if (forward_.size() + backward_.size() > 2)
    {
      pairWhere([this](Index h, Index g) { return isDoubled(h, g) && imagesFit(h, g); });
    }
    pairWhere([this](Index h, Index g) { return isDoubled(h, g); });
    refuseLeftOvers();
  }

  /// Pairs every half-edge that has exactly one partner of the kind, which has no other.
  template <typename Belong>
  void pairWhere(const Belong& belong)
  {
    for (std::size_t i = 0; i < forward_.size();)
    {
      const Index h = forward_[i];
      const auto isPartner = [&](Index g) { return belong(h, g); };
      const auto found = std::find_if(backward_.begin(), backward_.end(), isPartner);
      const bool unique = found != backward_.end() &&
        std::find_if(found + 1, backward_.end(), isPartner) == backward_.end() &&
        std::count_if(forward_.begin(), forward_.end(),
          [&](Index other) { return belong(other, *found); }) == 1;
      if (!unique)
      {
        ++i;
        continue;
      }
      mesh_.twin.edit()[h] = *found;
      mesh_.twin.edit()[*found] = h;
      backward_.erase(found);
      forward_.erase(forward_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  /// Is there a reason for the copies of the edge's ends other than that they are different?
  bool isDoubled(Index h, Index g) const
  {
    return soup_ || !in_.sameData || !sameVertexTwice(point(h), endPoint(g)) ||
      !sameVertexTwice(endPoint(h), point(g));
  }
  bool sameVertexTwice(Index p, Index q) const { return p == q || in_.sameData(p, q); }

  bool sameImages(Index h, Index g) const
  {
    return in_.uv[h] == in_.uv[Mesh::next(g)] && in_.uv[Mesh::next(h)] == in_.uv[g];
  }

  bool imagesFit(Index h, Index g) const
  {
    Vector2 from = in_.uv[h];
    Vector2 to = in_.uv[Mesh::next(h)];
    for (int r = 0; r < 4; ++r)
    {
      const Vector2 start = in_.uv[Mesh::next(g)] - from;
      const Vector2 end = in_.uv[g] - to;
      const Vector2 whole(std::round(start.x()), std::round(start.y()));
      if ((start - whole).norm() < kFit && (end - whole).norm() < kFit)
      {
        return true;
      }
      from = Vector2(-from.y(), from.x());
      to = Vector2(-to.y(), to.x());
    }
    return false;
  }

  /// What has no partner is a boundary, unless it cannot be one.
  void refuseLeftOvers() const
  {
    for (const std::vector<Index>* side : { &forward_, &backward_ })
    {
      const std::vector<Index>& other = side == &forward_ ? backward_ : forward_;
      for (std::size_t i = 0; i + 1 < side->size(); ++i)
      {
        const Index h = (*side)[i];
        const Index g = (*side)[i + 1];
        if (point(h) == point(g) && endPoint(h) == endPoint(g))
        {
          throw InvalidInput("cells " + std::to_string(h / 3) + " and " + std::to_string(g / 3) +
            " run along the edge from point " + std::to_string(point(h)) + " to " +
            std::to_string(endPoint(h)) +
            " in the same direction; orient the surface first, or split it there");
        }
      }
      if (!side->empty() && side->size() + other.size() > 2 && couldPair(*side, other))
      {
        std::vector<Index> all = *side;
        append(all, other);
        throw InvalidInput("cells " +
          joined(all, all.size(), [](Index h) { return std::to_string(h / 3); }) +
          " meet at one edge, and neither points nor images tell which of them belong together");
      }
      if (soup_ && side->size() > 1 && other.empty())
      {
        throw InvalidInput("cells " + std::to_string((*side)[0] / 3) + " and " +
          std::to_string((*side)[1] / 3) +
          " run along one edge in the same direction; orient the surface first");
      }
    }
  }

  bool couldPair(const std::vector<Index>& side, const std::vector<Index>& other) const
  {
    return std::any_of(side.begin(), side.end(),
      [&](Index h) {
        return std::any_of(other.begin(), other.end(), [&](Index g) { return isDoubled(h, g); });
      });
  }

  // ---------------------------------------------------------------- vertices

  void numberVertices()
  {
    mesh_.origin.assign(mesh_.origin.size(), kInvalidIndex);
    for (Index h = 0; h < mesh_.origin.size(); ++h)
    {
      pollNowAndThen(h);
      if (mesh_.origin[h] != kInvalidIndex)
      {
        continue;
      }
      const Index v = mesh_.vertexCount();
      mesh_.position.push_back(in_.position[point(h)]);
      forEachInFan(mesh_, h, [&](Index g) { mesh_.origin.edit()[g] = v; });
    }
  }

  const MappedTriangles& in_;
  Places places_;
  bool soup_;
  Mesh mesh_;
  std::vector<Index> forward_, backward_; ///< of the edge at hand, without partner so far
};

} // namespace

Mesh weldMap(const MappedTriangles& triangles)
{
  checkTriangles(triangles);
  return Welder(triangles).run();
}

} // namespace quadrille
