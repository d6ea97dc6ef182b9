// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/MirrorCut.h"

#include "Base/Progress.h"

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
class HalfBuilder
{
public:
  HalfBuilder(const Mesh& mesh, const MirrorPlane& plane, double tolerance)
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

  MirrorHalf build()
  {
    half_.input.polygonOffsets.push_back(0);
    for (Index f = 0; f < mesh_.faceCount(); ++f)
    {
      pollNowAndThen(f);
      addFace(f);
    }
    return std::move(half_);
  }

private:
  /// A corner of the part in front, and the half-edge along which the part goes on; none along the plane.
  struct Corner
  {
    Index point = kInvalidIndex;
    Index halfEdge = kInvalidIndex;
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
        corners.push_back({ pointOfVertex(mesh_.origin[h]), to >= 0 ? h : kInvalidIndex });
      }
      if ((from > 0 && to < 0) || (from < 0 && to > 0))
      {
        corners.push_back({ pointOfCut(h), to > 0 ? h : kInvalidIndex });
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
    { return half_.input.points[corners[i].point]; };
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
    }
  }

  void addTriangle(
    Index f, const std::array<Index, 3>& points, const std::array<Index, 3>& halfEdges)
  {
    SurfaceInput& input = half_.input;
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
    half_.face.push_back(f);
  }

  /// In the plane it becomes a boundary, which by its angle would be none.
  bool isKeptFeature(Index h) const
  {
    const bool inPlane = height(h) == 0 && height(Mesh::next(h)) == 0;
    return mesh_.isFeature(h) && (inPlane || (mesh_.flags[h] & kRequestedFeature) != 0);
  }

  Index add(const Vector3& p, const CutPoint& origin)
  {
    half_.input.points.push_back(p);
    half_.origin.push_back(origin);
    return static_cast<Index>(half_.origin.size() - 1);
  }

  Index pointOfVertex(Index v)
  {
    if (pointOf_[v] == kInvalidIndex)
    {
      const Vector3& p = mesh_.position[v];
      pointOf_[v] = add(heights_[v] == 0 ? plane_.foot(p) : p, { v, v, 0 });
    }
    return pointOf_[v];
  }

  Index pointOfCut(Index h)
  {
    const Index twin = mesh_.twin[h];
    if (cutOf_[h] == kInvalidIndex)
    {
      const Index from = mesh_.origin[h];
      const Index to = mesh_.target(h);
      const double share = heights_[from] / (heights_[from] - heights_[to]);
      const Vector3 p = mesh_.position[from] + share * mesh_.edgeVector(h);
      cutOf_[h] = add(plane_.foot(p), { from, to, share });
      if (twin != kInvalidIndex)
      {
        cutOf_[twin] = cutOf_[h];
      }
    }
    return cutOf_[h];
  }

  const Mesh& mesh_;
  const MirrorPlane& plane_;
  std::vector<double> heights_;
  std::vector<Index> pointOf_; ///< per vertex
  std::vector<Index> cutOf_;   ///< per half-edge
  MirrorHalf half_;
};

} // namespace

std::array<std::array<double, 3>, 3> MirrorHalf::cornerWeights(const Mesh& mesh, Index t) const
{
  std::array<std::array<double, 3>, 3> weights{};
  for (std::size_t i = 0; i < 3; ++i)
  {
    const CutPoint& at = origin[input.polygonPoints[3 * t + i]];
    for (std::size_t k = 0; k < 3; ++k)
    {
      const Index corner = mesh.origin[3 * std::size_t{ face[t] } + k];
      weights[i][k] += corner == at.from ? 1 - at.share : 0;
      weights[i][k] += corner == at.to ? at.share : 0;
    }
  }
  return weights;
}

MirrorHalf cutByMirror(const Mesh& mesh, const MirrorPlane& plane, double tolerance)
{
  return HalfBuilder(mesh, plane, tolerance).build();
}

} // namespace quadrille
