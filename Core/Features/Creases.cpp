// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/Creases.h"

#include "Base/Angles.h"
#include "Base/DisjointSets.h"
#include "Base/LargeArray.h"
#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace quadrille
{
namespace
{

/// Rings of vertices round an edge whose edges are looked at.
constexpr int kCreaseRings = 2;
/// The search does not go on from vertices with more edges, as the tip of a fan is near to all of its rim.
constexpr std::size_t kMostEdges = 32;
/// Edges above this part of the feature angle are blunt ones and not flat.
constexpr double kBlunt = 0.6;
/// Edges below this part of the angle of another one do not matter to it.
constexpr double kComparable = 0.4;
/// The part of the weight that blunt edges may have beside a crease.
constexpr double kMostBlunt = 0.1;
/// A line of so many edges is one, whatever is beside it.
constexpr std::size_t kLongLine = 12;
const double kStraight = std::cos(radians(20));

/// A detected feature edge.
struct SharpEdge
{
  Index halfEdge = kInvalidIndex;
  double angle = 0;
  double length = 0;
  Vector3 direction = Vector3::Zero(); ///< unit, along the half-edge
};

/// A sharp edge near another one, with its weight.
struct Neighbour
{
  Index edge;
  float weight;
};

class Facets
{
public:
  Facets(
    const Mesh& mesh, double featureAngle, const std::function<double(Index)>& angleOf, int threads)
    : mesh_(mesh), bluntAngle_(kBlunt * featureAngle), angleOf_(angleOf)
  {
    for (const Index h : constrainedEdges(mesh, threads))
    {
      if (isDetected(h))
      {
        const Vector3 along = mesh.edgeVector(h);
        const double length = along.norm();
        edges_.push_back({ h, angleOf(h), length, along / std::max(length, 1e-300) });
      }
    }
  }

  std::vector<Index> find(int threads)
  {
    if (edges_.empty())
    {
      return {};
    }
    fillLarge(indexOf_, mesh_.halfEdgeCount(), kInvalidIndex, threads);
    for (Index i = 0; i < edges_.size(); ++i)
    {
      indexOf_[edges_[i].halfEdge] = i;
      indexOf_[mesh_.twin[edges_[i].halfEdge]] = i;
    }
    outgoing_ = outgoingHalfEdges(mesh_, threads);
    lookRound(threads);
    keepLines();
    while (dropOnce())
    {
      poll();
    }
    dropRemnants();
    std::vector<Index> result;
    for (Index i = 0; i < edges_.size(); ++i)
    {
      if (kept_[i] == 0)
      {
        result.push_back(edges_[i].halfEdge);
      }
    }
    return result;
  }

private:
  bool isDetected(Index h) const
  {
    return !mesh_.isBoundary(h) && mesh_.isFeature(h) && (mesh_.flags[h] & kRequestedFeature) == 0;
  }

  void lookRound(int threads)
  {
    near_.resize(edges_.size());
    blunt_.assign(edges_.size(), 0.0);
    parallelForEach(edges_.size(), kHeavyChunk, threads,
      [&](std::size_t i) { lookRound(static_cast<Index>(i)); });
  }

  void lookRound(Index i)
  {
    const SharpEdge& edge = edges_[i];
    std::vector<Index> found;
    for (const Index v : verticesNear(edge.halfEdge))
    {
      forEachEdgeInFan(mesh_, outgoing_[v],
        [&](Index h) { found.push_back(mesh_.isBoundary(h) ? h : std::min(h, mesh_.twin[h])); });
    }
    sortUnique(found);
    for (const Index h : found)
    {
      if (mesh_.isBoundary(h) || (mesh_.isFeature(h) && indexOf_[h] == kInvalidIndex))
      {
        continue; // asked for
      }
      const double angle = indexOf_[h] != kInvalidIndex ? edges_[indexOf_[h]].angle : angleOf_(h);
      if (!(angle > kComparable * edge.angle && angle > bluntAngle_))
      {
        continue;
      }
      const Vector3 along = mesh_.edgeVector(h);
      const double dot = along.dot(edge.direction);
      const double weight = dot * dot / std::max(along.norm(), 1e-300);
      if (indexOf_[h] != kInvalidIndex)
      {
        near_[i].push_back({ indexOf_[h], static_cast<float>(weight) });
      }
      else
      {
        blunt_[i] += weight;
      }
    }
  }

  std::vector<Index> verticesNear(Index h) const
  {
    std::vector<Index> vertices{ mesh_.origin[h], mesh_.target(h) };
    std::size_t begin = 0;
    for (int ring = 0; ring < kCreaseRings; ++ring)
    {
      const std::size_t end = vertices.size();
      for (std::size_t k = begin; k < end; ++k)
      {
        const Index v = vertices[k];
        const std::size_t before = vertices.size();
        forEachEdgeInFan(
          mesh_, outgoing_[v], [&](Index g) { vertices.push_back(mesh_.otherEnd(g, v)); });
        if (vertices.size() - before > kMostEdges)
        {
          vertices.resize(before);
        }
      }
      std::sort(vertices.begin() + static_cast<std::ptrdiff_t>(end), vertices.end());
      vertices.erase(
        std::unique(vertices.begin() + static_cast<std::ptrdiff_t>(end), vertices.end()),
        vertices.end());
      begin = end;
    }
    sortUnique(vertices);
    return vertices;
  }

  /// Of the sharp edges at v the one that goes on straightest from edge i; kInvalidIndex where all bend too far.
  Index straightOn(Index i, Index v) const
  {
    const auto away = [&](Index k) -> Vector3
    {
      return mesh_.origin[edges_[k].halfEdge] == v ? edges_[k].direction
                                                   : Vector3(-edges_[k].direction);
    };
    const Vector3 forward = -away(i);
    Index best = kInvalidIndex;
    double most = kStraight;
    forEachEdgeInFan(mesh_, outgoing_[v],
      [&](Index h)
      {
        const Index k = indexOf_[h];
        if (k != kInvalidIndex && k != i && forward.dot(away(k)) > most)
        {
          most = forward.dot(away(k));
          best = k;
        }
      });
    return best;
  }

  /// Long chains in which each edge is the straightest continuation of the next one, too.
  void keepLines()
  {
    kept_.assign(edges_.size(), 1);
    isLine_.assign(edges_.size(), 0);
    std::vector<std::uint8_t> seen(edges_.size(), 0);
    for (Index i = 0; i < edges_.size(); ++i)
    {
      if (seen[i] != 0)
      {
        continue;
      }
      seen[i] = 1;
      std::vector<Index> line{ i };
      for (const Index start :
        { mesh_.origin[edges_[i].halfEdge], mesh_.target(edges_[i].halfEdge) })
      {
        Index current = i;
        Index v = start;
        Index next = straightOn(current, v);
        while (next != kInvalidIndex && seen[next] == 0 && straightOn(next, v) == current)
        {
          seen[next] = 1;
          line.push_back(next);
          current = next;
          v = mesh_.otherEnd(edges_[current].halfEdge, v);
          next = straightOn(current, v);
        }
      }
      for (const Index k : line)
      {
        isLine_[k] = line.size() >= kLongLine ? 1 : 0;
      }
    }
  }

  bool dropOnce()
  {
    std::vector<double> part(edges_.size(), 0.0);
    for (Index i = 0; i < edges_.size(); ++i)
    {
      double sharp = 0, blunt = blunt_[i];
      for (const Neighbour& other : near_[i])
      {
        (kept_[other.edge] != 0 ? sharp : blunt) += double{ other.weight };
      }
      part[i] = blunt / std::max(sharp + blunt, 1e-300);
    }
    std::vector<Index> drop;
    for (Index i = 0; i < edges_.size(); ++i)
    {
      double sum = 0, length = 0;
      for (const Neighbour& other : near_[i])
      {
        if (kept_[other.edge] != 0)
        {
          sum += edges_[other.edge].length * part[other.edge];
          length += edges_[other.edge].length;
        }
      }
      if (kept_[i] != 0 && isLine_[i] == 0 && sum > kMostBlunt * length)
      {
        drop.push_back(i);
      }
    }
    for (const Index i : drop)
    {
      kept_[i] = 0;
    }
    return !drop.empty();
  }

  /// Edges that are left among more that have gone: connected ones, no line among them, with less length than what went
  /// near them.
  void dropRemnants()
  {
    DisjointSets sets(edges_.size(), 1);
    for (Index i = 0; i < edges_.size(); ++i)
    {
      for (const Index v : { mesh_.origin[edges_[i].halfEdge], mesh_.target(edges_[i].halfEdge) })
      {
        forEachEdgeInFan(mesh_, outgoing_[v],
          [&](Index h)
          {
            const Index k = indexOf_[h];
            if (k != kInvalidIndex && kept_[i] != 0 && kept_[k] != 0)
            {
              sets.join(i, k);
            }
          });
      }
    }
    std::vector<std::vector<Index>> members(edges_.size());
    for (Index i = 0; i < edges_.size(); ++i)
    {
      if (kept_[i] != 0)
      {
        members[sets.find(i)].push_back(i);
      }
    }
    const std::vector<std::uint8_t> before = kept_;
    std::vector<Index> seenBy(edges_.size(), kInvalidIndex);
    for (Index r = 0; r < members.size(); ++r)
    {
      double here = 0, gone = 0;
      bool isLine = false;
      for (const Index i : members[r])
      {
        here += edges_[i].length;
        isLine = isLine || isLine_[i] != 0;
        for (const Neighbour& other : near_[i])
        {
          if (before[other.edge] == 0 && seenBy[other.edge] != r)
          {
            seenBy[other.edge] = r;
            gone += edges_[other.edge].length;
          }
        }
      }
      for (std::size_t k = 0; k < members[r].size() && !isLine && gone > here; ++k)
      {
        kept_[members[r][k]] = 0;
      }
    }
  }

  const Mesh& mesh_;
  double bluntAngle_;
  const std::function<double(Index)>& angleOf_;
  std::vector<SharpEdge> edges_;
  std::vector<Index> indexOf_;  ///< #H, of detected features
  std::vector<Index> outgoing_; ///< #V
  std::vector<std::vector<Neighbour>> near_;
  std::vector<double> blunt_; ///< weight of blunt edges that were never sharp
  std::vector<std::uint8_t> kept_, isLine_;
};

} // namespace

std::vector<Index> edgesOfFacets(
  const Mesh& mesh, double featureAngle, const std::function<double(Index)>& angleOf, int threads)
{
  return Facets(mesh, featureAngle, angleOf, threads).find(threads);
}

} // namespace quadrille
