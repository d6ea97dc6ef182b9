// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/SharpCorners.h"

#include "Base/Angles.h"
#include "Base/Error.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Features/EdgesAtVertices.h"
#include "Features/FeatureFilter.h"
#include "Mesh/Distance.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

constexpr double kSharpestCorner = 10; ///< degrees
/// Between the end of a feature and the other one, in edge lengths.
constexpr double kLeastWidth = 0.12;
/// In edge lengths; curves side by side for longer have a band between them, see removeUnresolvedFeatures.
constexpr double kLongestCut = 4;

/// Two constrained edges at a vertex with nothing between them but faces.
struct Corner
{
  double angle = 0;
  Index vertex = kInvalidIndex;
  Index right = kInvalidIndex; ///< a half-edge of one side; counterclockwise of it
  Index left = kInvalidIndex;  ///< one of the other side
};

/// That half-edge of an edge which stands for it.
Index edgeOf(const Mesh& mesh, Index h)
{
  return mesh.isBoundary(h) ? h : std::min(h, mesh.twin[h]);
}

/// One round.
class Corners
{
public:
  Corners(Mesh& mesh, double edgeLength, int threads)
    : mesh_(mesh), edgeLength_(edgeLength),
      at_(edgesAtVertices(mesh, constrainedEdges(mesh, threads)))
  {
  }

  /// Returns whether anything went.
  bool trim(SharpCornerReport& report)
  {
    std::vector<std::uint8_t> touched(mesh_.vertexCount(), 0);
    std::vector<Index> removed;
    for (const Corner& corner : find())
    {
      poll();
      if (touched[corner.vertex] != 0)
      {
        continue;
      }
      const std::vector<Index> cut = bluntBeginning(corner);
      double length = 0;
      for (const Index h : cut)
      {
        touched[mesh_.origin[h]] = touched[mesh_.target(h)] = 1;
        length += sizedLength(mesh_, h) / edgeLength_;
      }
      removed.insert(removed.end(), cut.begin(), cut.end());
      tell(corner, cut.size(), length, report);
    }
    unmarkFeatures(mesh_, removed);
    return !removed.empty();
  }

private:
  /// The most acute first.
  std::vector<Corner> find() const
  {
    std::vector<Corner> corners;
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      pollNowAndThen(h);
      if (mesh_.isConstrained(h))
      {
        const Corner corner = cornerAt(h);
        if (corner.angle < radians(kSharpestCorner))
        {
          corners.push_back(corner);
        }
      }
    }
    std::stable_sort(corners.begin(), corners.end(),
      [](const Corner& a, const Corner& b) { return a.angle < b.angle; });
    return corners;
  }

  /// From h counterclockwise to the next constrained edge, or to where the angle is large enough.
  Corner cornerAt(Index h) const
  {
    Corner corner{ 0, mesh_.origin[h], edgeOf(mesh_, h), kInvalidIndex };
    Index g = h;
    while (corner.angle < radians(kSharpestCorner))
    {
      corner.angle += angleBetween(mesh_.edgeVector(g), -mesh_.edgeVector(Mesh::previous(g)));
      const Index side = Mesh::previous(g);
      if (mesh_.isConstrained(side))
      {
        corner.left = edgeOf(mesh_, side);
        break;
      }
      g = mesh_.twin[side];
    }
    const bool isOne = corner.left != kInvalidIndex && corner.left != corner.right;
    corner.angle = isOne ? corner.angle : std::numeric_limits<double>::infinity();
    return corner;
  }

  /// Of the two sides the edges at the beginning that come too near to the other one, of the blunter side if it may
  /// change.
  std::vector<Index> bluntBeginning(const Corner& corner) const
  {
    const std::vector<Index> right = curveFrom(corner.vertex, corner.right);
    const std::vector<Index> left = curveFrom(corner.vertex, corner.left);
    std::vector<Index> rightCut = nearBeginning(corner.vertex, right, left);
    std::vector<Index> leftCut = nearBeginning(corner.vertex, left, right);
    return bendOf(rightCut) < bendOf(leftCut) ? std::move(rightCut) : std::move(leftCut);
  }

  /// Through vertices of two constrained edges, to the next node.
  std::vector<Index> curveFrom(Index v, Index first) const
  {
    std::vector<Index> curve{ first };
    v = mesh_.otherEnd(first, v);
    while (at_.degree(v) == 2)
    {
      const Index next = at_.otherThan(curve.back(), v);
      if (next == first)
      {
        break;
      }
      curve.push_back(next);
      v = mesh_.otherEnd(next, v);
    }
    return curve;
  }

  /// The first edges of `curve` that may go, up to where it is wide enough away from the beginning of `other`.
  std::vector<Index> nearBeginning(
    Index v, const std::vector<Index>& curve, const std::vector<Index>& other) const
  {
    std::vector<Index> cut;
    double length = 0, otherLength = 0;
    std::size_t beside = 0; // edges of the other one that are no further from the corner
    for (const Index h : curve)
    {
      pollNowAndThen(h);
      if (!isDetectedFeature(mesh_, h) || length > kLongestCut * edgeLength_)
      {
        break;
      }
      cut.push_back(h);
      v = mesh_.otherEnd(h, v);
      length += sizedLength(mesh_, h);
      for (; beside < other.size() && otherLength < length; ++beside)
      {
        otherLength += sizedLength(mesh_, other[beside]);
      }
      if (distanceTo(mesh_.position[v], other, beside) >=
        kLeastWidth * edgeLength_ * sizeAt(mesh_, v))
      {
        break;
      }
    }
    return cut;
  }

  double distanceTo(const Vector3& p, const std::vector<Index>& curve, std::size_t edges) const
  {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < edges; ++i)
    {
      const Vector3& from = mesh_.position[mesh_.origin[curve[i]]];
      nearest =
        std::min(nearest, distanceToSegment(p, from, mesh_.position[mesh_.target(curve[i])]));
    }
    return nearest;
  }

  /// Mean angle between the normals; infinite without edges.
  double bendOf(const std::vector<Index>& features) const
  {
    double sum = 0, length = 0;
    for (const Index h : features)
    {
      const double edgeLength = mesh_.edgeVector(h).norm();
      sum += edgeLength *
        angleBetween(
          mesh_.doubleAreaNormal(Mesh::face(h)), mesh_.doubleAreaNormal(Mesh::face(mesh_.twin[h])));
      length += edgeLength;
    }
    return features.empty() ? std::numeric_limits<double>::infinity() : sum / length;
  }

  void tell(const Corner& corner, std::size_t edges, double length, SharpCornerReport& report) const
  {
    if (edges == 0)
    {
      return;
    }
    ++report.corners;
    report.removedEdges += edges;
    report.removedLength += length;
    if (length > report.longest)
    {
      report.longest = length;
      report.place = mesh_.position[corner.vertex];
    }
  }

  Mesh& mesh_;
  double edgeLength_;
  EdgesAtVertices at_;
};

} // namespace

SharpCornerReport trimSharpCorners(Mesh& mesh, double edgeLength, int threads)
{
  if (!(edgeLength > 0))
  {
    throw InvalidInput("the edge length for corners of features must be positive");
  }
  SharpCornerReport report;
  while (hasDetectedFeature(mesh) && Corners(mesh, edgeLength, threads).trim(report))
  {
  }
  return report;
}

std::string SharpCornerReport::text() const
{
  if (corners == 0)
  {
    return {};
  }
  return "at " + std::to_string(corners) + (corners == 1 ? " place" : " places") +
    " sharp edges leave others at less than " + inEdgeLengths(kSharpestCorner) +
    " degrees, which no corner of a quad can have; the blunter ones are features only from where "
    "they are " +
    inEdgeLengths(kLeastWidth) + " edge lengths away: the longest piece without is " +
    inEdgeLengths(longest) + " edge lengths long, near " + placeText(place) +
    "; mark the edges that are to be features up to their ends";
}

} // namespace quadrille
