// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/PlaneCut.h"

#include "Base/Progress.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille
{

namespace
{

/// One face after the other becomes the part of it that is in front:
///
///      +             +            +             +
///     / \           / \          /|\           / \         +: in front, -: behind, 0: in the plane
///    /   \         x---x        / | \         /   \        x: cut
///   0-----+       /     \      /  |  \       x-----x       fans of triangles, from the first corner that is kept
///    kept        -       -    -   0   +     /  ...  +
class FrontBuilder
{
public:
  FrontBuilder(const Mesh& mesh, const MirrorPlane& plane, double tolerance)
    : mesh_(mesh), plane_(plane), pointOf_(mesh.vertexCount(), kInvalidIndex),
      cutOf_(mesh.halfEdgeCount(), kInvalidIndex)
  {
    heights_.reserve(mesh.position.size());
    for (const Vector3& p : mesh.position)
    {
      const double height = plane.height(p);
      heights_.push_back(std::abs(height) > tolerance ? height : 0);
    }
  }

  SurfacePart build()
  {
    part_.planes = { plane_ };
    part_.input.polygonOffsets.push_back(0);
    for (Index f = 0; f < mesh_.faceCount(); ++f)
    {
      pollNowAndThen(f);
      addFace(f);
    }
    return std::move(part_);
  }

private:
  /// A corner of the part in front, and the half-edge along which the part goes on; none along the plane.
  struct Corner
  {
    Index point = kInvalidIndex;
    Index halfEdge = kInvalidIndex;
    std::array<double, 3> weights{}; ///< in the face
  };

  double height(Index h) const { return heights_[mesh_.origin[h]]; }

  void addFace(Index f)
  {
    if (!(std::max({ height(3 * f), height(3 * f + 1), height(3 * f + 2) }) > 0))
    {
      return;
    }
    std::vector<Corner> corners;
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      const double from = height(h);
      const double to = height(Mesh::next(h));
      if (from >= 0)
      {
        corners.push_back({ pointOfVertex(mesh_.origin[h]), to >= 0 ? h : kInvalidIndex, {} });
        corners.back().weights[h % 3] = 1;
      }
      if ((from > 0 && to < 0) || (from < 0 && to > 0))
      {
        corners.push_back({ pointOfCut(h), to > 0 ? h : kInvalidIndex, weightsOfCut(h) });
        if (to < 0)
        {
          // The edge runs along h up to here.
          corners[corners.size() - 2].halfEdge = h;
        }
      }
    }
    addFan(f, std::move(corners));
  }

  /// Two triangles along the shorter diagonal.
  void addFan(Index f, std::vector<Corner> corners)
  {
    const auto place = [&](std::size_t i) -> const Vector3&
    { return part_.input.points[corners[i].point]; };
    if (corners.size() == 4 &&
      (place(1) - place(3)).squaredNorm() < (place(0) - place(2)).squaredNorm())
    {
      std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    }
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    {
      const std::array<Index, 3> sides{ i == 1 ? corners[0].halfEdge : kInvalidIndex,
        corners[i].halfEdge, i + 2 == corners.size() ? corners[i + 1].halfEdge : kInvalidIndex };
      addTriangle(f, { corners[0].point, corners[i].point, corners[i + 1].point }, sides);
      part_.weights.push_back({ corners[0].weights, corners[i].weights, corners[i + 1].weights });
    }
  }

  void addTriangle(
    Index f, const std::array<Index, 3>& points, const std::array<Index, 3>& halfEdges)
  {
    SurfaceInput& input = part_.input;
    input.polygonPoints.append(points.begin(), points.end());
    input.polygonOffsets.push_back(static_cast<Index>(input.polygonPoints.size()));
    std::uint8_t bits = 0;
    for (std::size_t i = 0; i < 3; ++i)
    {
      if (halfEdges[i] != kInvalidIndex && isKeptFeature(halfEdges[i]))
      {
        bits = static_cast<std::uint8_t>(bits | 1U << i);
      }
    }
    input.featureEdges.push_back(bits);
    part_.face.push_back(f);
  }

  /// In the plane it becomes a boundary, which by its angle would be none.
  bool isKeptFeature(Index h) const
  {
    const bool inPlane = height(h) == 0 && height(Mesh::next(h)) == 0;
    return mesh_.isFeature(h) && (inPlane || (mesh_.flags[h] & kRequestedFeature) != 0);
  }

  Index add(const Vector3& p, Index vertex)
  {
    part_.input.points.push_back(p);
    part_.vertex.push_back(vertex);
    return static_cast<Index>(part_.vertex.size() - 1);
  }

  Index pointOfVertex(Index v)
  {
    if (pointOf_[v] == kInvalidIndex)
    {
      const Vector3& p = mesh_.position[v];
      pointOf_[v] = add(heights_[v] == 0 ? plane_.foot(p) : p, v);
    }
    return pointOf_[v];
  }

  /// Of the edge of h the half-edge of the face that comes first, and the place of the cut on it.
  std::pair<Index, double> cutOn(Index h) const
  {
    const Index first = mesh_.isBoundary(h) ? h : std::min(h, mesh_.twin[h]);
    return { first, height(first) / (height(first) - height(Mesh::next(first))) };
  }

  Index pointOfCut(Index h)
  {
    const auto [first, share] = cutOn(h);
    if (cutOf_[first] == kInvalidIndex)
    {
      const Vector3 p = mesh_.position[mesh_.origin[first]] + share * mesh_.edgeVector(first);
      cutOf_[first] = add(plane_.foot(p), kInvalidIndex);
    }
    return cutOf_[first];
  }

  std::array<double, 3> weightsOfCut(Index h) const
  {
    const auto [first, share] = cutOn(h);
    std::array<double, 3> weights{};
    weights[h % 3] = first == h ? 1 - share : share;
    weights[Mesh::next(h) % 3] = first == h ? share : 1 - share;
    return weights;
  }

  const Mesh& mesh_;
  const MirrorPlane& plane_;
  std::vector<double> heights_;
  std::vector<Index> pointOf_; ///< per vertex
  std::vector<Index> cutOf_;   ///< per half-edge, the lower one of its edge
  SurfacePart part_;
};

} // namespace

FaceWeights composed(const FaceWeights& inner, const FaceWeights& outer)
{
  FaceWeights weights{};
  for (std::size_t i = 0; i < 3; ++i)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      for (std::size_t j = 0; j < 3; ++j)
      {
        weights[i][j] += inner[i][k] * outer[k][j];
      }
    }
  }
  return weights;
}

void requestCutFeatures(Mesh& mesh, const MirrorPlane& plane, double tolerance)
{
  std::vector<Index> featuresAt(mesh.vertexCount(), 0);
  std::vector<Index> next;
  const auto take = [&](Index h)
  {
    for (const Index side : { h, mesh.twin[h] })
    {
      mesh.flags.edit()[side] |= kRequestedFeature;
    }
    next.push_back(h);
  };
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isBoundary(h) || !mesh.isFeature(h))
    {
      continue;
    }
    ++featuresAt[mesh.origin[h]];
    const double from = plane.height(mesh.position[mesh.origin[h]]);
    const double to = plane.height(mesh.position[mesh.target(h)]);
    if (h < mesh.twin[h] && std::min(from, to) <= tolerance && std::max(from, to) >= -tolerance)
    {
      take(h);
    }
  }
  const std::vector<Index> outgoing = outgoingHalfEdges(mesh);
  while (!next.empty())
  {
    const Index h = next.back();
    next.pop_back();
    for (const Index v : { mesh.origin[h], mesh.target(h) })
    {
      const auto takeMore = [&](Index g)
      {
        if (!mesh.isBoundary(g) && mesh.isFeature(g) && (mesh.flags[g] & kRequestedFeature) == 0)
        {
          take(g);
        }
      };
      if (featuresAt[v] == 2)
      {
        forEachInFan(mesh, outgoing[v], takeMore);
      }
    }
  }
}

SurfacePart cutByPlane(const Mesh& mesh, const MirrorPlane& plane, double tolerance)
{
  return FrontBuilder(mesh, plane, tolerance).build();
}

} // namespace quadrille
