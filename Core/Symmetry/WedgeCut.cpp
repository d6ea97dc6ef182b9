// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/WedgeCut.h"

#include "Base/Lists.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "Mesh/Topology.h"
#include "Symmetry/SeamMarks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

namespace quadrille
{

namespace
{

/// Half planes that are measured, over one step.
constexpr int kHalfPlanes = 48;
/// Of them, the shortest that are cut.
constexpr std::size_t kMostCuts = 12;

class WedgeBuilder
{
public:
  WedgeBuilder(const Mesh& mesh, const Isometry& rotation, double startAngle, double tolerance,
    const WedgeReach& reach)
    : mesh_(mesh), rotation_(rotation), axis_(rotation.axis()), tolerance_(tolerance), reach_(reach)
  {
    wedge_.startAngle = startAngle;
    const Vector3 start = axis_.turned(axis_.direction.unitOrthogonal(), startAngle);
    radial_ = { start, rotation.imageOf(start) };
    planes_[0] = { axis_.origin, axis_.direction.cross(radial_[0]) };
    planes_[1] = { axis_.origin, -axis_.direction.cross(radial_[1]) };
  }

  SurfacePart build()
  {
    const double startAngle = wedge_.startAngle;
    wedge_ = cutByPlane(mesh_, planes_[0], tolerance_);
    if (rotation_.order == 2)
    {
      splitAtAxis();
    }
    else
    {
      cutAgain();
    }
    wedge_.planes.assign(planes_.begin(), planes_.end());
    wedge_.startAngle = startAngle;
    if (wedge_.face.empty())
    {
      wedge_.mismatch = "nothing of the surface lies in a wedge";
      return std::move(wedge_);
    }
    cut_ = connectTriangles(wedge_.input);
    findSides();
    findPoles();
    SeamMarks marks(cut_, rotation_, tolerance_, reach_.ofFeatures);
    matchChains(marks);
    splitForMarks(marks.splits());
    return std::move(wedge_);
  }

private:
  /// What is in front of the second half plane, too.
  void cutAgain()
  {
    SurfacePart second = cutByPlane(connectTriangles(wedge_.input), planes_[1], tolerance_);
    for (std::size_t t = 0; t < second.face.size(); ++t)
    {
      const Index before = second.face[t];
      second.face[t] = wedge_.face[before];
      second.weights[t] = composed(second.weights[t], wedge_.weights[before]);
    }
    for (Index& v : second.vertex)
    {
      v = v == kInvalidIndex ? v : wedge_.vertex[v];
    }
    wedge_ = std::move(second);
  }

  /// Of two wedges the halves of one plane are the sides: where its curve crosses the axis they meet in a point.
  void splitAtAxis()
  {
    SurfaceInput& input = wedge_.input;
    const Mesh connected = connectTriangles(input);
    for (Index h = 0; h < connected.halfEdgeCount(); ++h)
    {
      const Index from = connected.origin[h], to = connected.target(h);
      if (!connected.isBoundary(h) || !isIn(0, from) || !isIn(0, to))
      {
        continue;
      }
      const double a = radial_[0].dot(input.points[from] - axis_.origin);
      const double b = radial_[0].dot(input.points[to] - axis_.origin);
      if (std::min(a, b) < -tolerance_ && std::max(a, b) > tolerance_)
      {
        const double share = a / (a - b);
        splitEdge(h, axis_.foot(input.points[from] + share * connected.edgeVector(h)), share);
      }
    }
  }

  /// The triangle (p, q, c) with the edge from p to q becomes (p, x, c), and (x, q, c) a new one.
  void splitEdge(Index h, const Vector3& place, double share)
  {
    SurfaceInput& input = wedge_.input;
    const Index t = Mesh::face(h);
    const std::size_t i = h % 3, j = (i + 1) % 3, k = (i + 2) % 3;
    const Index q = input.polygonPoints[3 * t + j], c = input.polygonPoints[3 * t + k];
    const auto x = static_cast<Index>(input.points.size());
    input.points.push_back(place);
    wedge_.vertex.push_back(kInvalidIndex);
    input.polygonPoints.edit()[3 * t + j] = x;
    const std::uint8_t bits = input.featureEdges[t];
    const auto bit = [&](std::size_t edge) { return static_cast<unsigned>(bits >> edge & 1U); };
    input.featureEdges[t] = static_cast<std::uint8_t>(bits & ~(1U << j));
    input.polygonPoints.append({ x, q, c });
    input.polygonOffsets.push_back(static_cast<Index>(input.polygonPoints.size()));
    input.featureEdges.push_back(static_cast<std::uint8_t>(bit(i) | bit(j) << 1U));
    const FaceWeights weights = wedge_.weights[t];
    std::array<double, 3> at{};
    for (std::size_t corner = 0; corner < 3; ++corner)
    {
      at[corner] = (1 - share) * weights[i][corner] + share * weights[j][corner];
    }
    wedge_.weights.push_back({ at, weights[j], weights[k] });
    wedge_.weights[t][j] = at;
    wedge_.face.push_back(wedge_.face[t]);
  }

  bool isIn(std::size_t side, Index point) const
  {
    return std::abs(planes_[side].height(wedge_.input.points[point])) <= tolerance_;
  }

  void findSides()
  {
    sides_.assign(cut_.halfEdgeCount(), 0);
    for (Index h = 0; h < cut_.halfEdgeCount(); ++h)
    {
      if (!cut_.isBoundary(h))
      {
        continue;
      }
      const Vector3 middle = (cut_.position[cut_.origin[h]] + cut_.position[cut_.target(h)]) / 2;
      const auto lies = [&](std::size_t side)
      {
        return isIn(side, cut_.origin[h]) && isIn(side, cut_.target(h)) &&
          radial_[side].dot(middle - axis_.origin) > 0;
      };
      sides_[h] = lies(0) ? 1 : lies(1) ? 2 : 0;
    }
  }

  void findPoles()
  {
    for (Index h = 0; h < cut_.halfEdgeCount(); ++h)
    {
      const Index next = sides_[h] != 0 ? nextOnBoundary(cut_, h) : h;
      if (sides_[next] != 0 && sides_[next] != sides_[h])
      {
        wedge_.poles.push_back(cut_.position[cut_.origin[next]]);
      }
    }
  }

  /// Mean over the length.
  Vector3 middle(const BorderChain& chain) const
  {
    double whole = 0;
    Vector3 sum = Vector3::Zero();
    for (const Index h : chain.edges)
    {
      const double length = cut_.edgeVector(h).norm();
      whole += length;
      sum += length / 2 * (cut_.position[cut_.origin[h]] + cut_.position[cut_.target(h)]);
    }
    return sum / std::max(whole, std::numeric_limits<double>::min());
  }

  /// How far the image of a chain in the first half plane is from one in the second.
  double distance(const BorderChain& first, const BorderChain& second) const
  {
    if (first.closed != second.closed)
    {
      return kInfinity;
    }
    const auto apart = [&](const Vector3& here, const Vector3& there)
    { return (rotation_.image(here) - there).norm(); };
    const double ofMiddles = apart(middle(first), middle(second));
    return first.closed
      ? ofMiddles
      : std::max({ ofMiddles, apart(first.place(cut_, 0), second.place(cut_, second.edges.size())),
          apart(first.place(cut_, first.edges.size()), second.place(cut_, 0)) });
  }

  void matchChains(SeamMarks& marks)
  {
    std::array<std::vector<BorderChain>, 2> chains; // in the first and in the second half plane
    for (BorderChain& chain : borderChains(cut_, sides_))
    {
      chains[sides_[chain.edges.front()] - 1U].push_back(std::move(chain));
    }
    Index count = 0;
    const std::vector<Index> component = faceComponents(cut_, count);
    std::vector<std::uint8_t> isTaken(chains[1].size(), 0);
    const auto missing = [&](const BorderChain& chain)
    {
      return "the cut near " + placeText(chain.place(cut_, 0)) +
        " has no image on the other side of its wedge";
    };
    for (const BorderChain& first : chains[0])
    {
      std::size_t best = chains[1].size();
      double least = kInfinity;
      for (std::size_t i = 0; i < chains[1].size(); ++i)
      {
        const double apart = isTaken[i] == 0 ? distance(first, chains[1][i]) : least;
        best = apart < least ? i : best;
        least = std::min(apart, least);
      }
      if (best == chains[1].size() || !(least <= reach_.ofCuts))
      {
        wedge_.mismatch = missing(first);
        return;
      }
      isTaken[best] = 1;
      const BorderChain& second = chains[1][best];
      if (component[Mesh::face(first.edges.front())] != component[Mesh::face(second.edges.front())])
      {
        wedge_.mismatch = "the part of the surface at the cut near " +
          placeText(first.place(cut_, 0)) +
          " does not reach from one side of its wedge to the other";
        return;
      }
      marks.add(first, second, wedge_);
    }
    const auto left = std::find(isTaken.begin(), isTaken.end(), 0);
    if (left != isTaken.end())
    {
      wedge_.mismatch = missing(chains[1][static_cast<std::size_t>(left - isTaken.begin())]);
    }
  }

  /// Vertices of marks between those of the surface. Of several on an edge the last one first, so that the rest of it
  /// stays where it was.
  void splitForMarks(std::vector<SeamMarks::Split> splits)
  {
    std::sort(splits.begin(), splits.end(),
      [](const SeamMarks::Split& a, const SeamMarks::Split& b)
      { return a.halfEdge != b.halfEdge ? a.halfEdge < b.halfEdge : a.share > b.share; });
    double rest = 1;
    for (std::size_t i = 0; i < splits.size(); ++i)
    {
      const SeamMarks::Split& split = splits[i];
      const bool isFirst = i == 0 || splits[i - 1].halfEdge != split.halfEdge;
      if (!isFirst && splits[i - 1].share == split.share)
      {
        continue;
      }
      rest = isFirst ? 1 : splits[i - 1].share;
      const auto triangle = static_cast<Index>(wedge_.face.size());
      const Index after = Mesh::next(split.halfEdge);
      splitEdge(split.halfEdge, split.place, split.share / rest);
      for (SeamMarks::Split& other : splits)
      {
        // Another edge of the triangle has become one of the new triangle.
        other.halfEdge = other.halfEdge == after ? 3 * triangle + 1 : other.halfEdge;
      }
    }
  }

  const Mesh& mesh_;
  const Isometry& rotation_;
  RotationAxis axis_;
  double tolerance_;
  const WedgeReach& reach_;
  std::array<Vector3, 2> radial_;
  std::array<MirrorPlane, 2> planes_;
  SurfacePart wedge_;
  Mesh cut_;                        ///< the wedge
  std::vector<std::uint8_t> sides_; ///< per half-edge: 1 in the first half plane, 2 in the second
};

/// Length of the curve that a half plane cuts out of the surface; none where faces lie in it.
std::vector<std::optional<double>> cutLengths(
  const Mesh& mesh, const RotationAxis& axis, const std::vector<double>& angles, double tolerance)
{
  std::vector<std::optional<double>> lengths(angles.size(), 0.0);
  for (std::size_t k = 0; k < angles.size(); ++k)
  {
    const Vector3 radial = axis.turned(axis.direction.unitOrthogonal(), angles[k]);
    const MirrorPlane plane{ axis.origin, axis.direction.cross(radial) };
    for (Index f = 0; f < mesh.faceCount() && lengths[k]; ++f)
    {
      pollNowAndThen(f);
      std::array<double, 3> heights{};
      for (Index i = 0; i < 3; ++i)
      {
        heights[i] = plane.height(mesh.position[mesh.origin[3 * f + i]]);
      }
      const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
      if (*high < -tolerance || *low > tolerance)
      {
        continue;
      }
      std::vector<Vector3> ends;
      for (Index i = 0; i < 3; ++i)
      {
        const double a = heights[i], b = heights[(i + 1) % 3];
        if ((a > 0) != (b > 0))
        {
          ends.push_back(
            mesh.position[mesh.origin[3 * f + i]] + a / (a - b) * mesh.edgeVector(3 * f + i));
        }
      }
      if (*low >= -tolerance && *high <= tolerance &&
        radial.dot(mesh.middleOfFace(f) - axis.origin) > 0)
      {
        lengths[k].reset();
      }
      else if (ends.size() == 2 && radial.dot(ends[0] + ends[1] - 2 * axis.origin) > 0)
      {
        *lengths[k] += (ends[1] - ends[0]).norm();
      }
    }
  }
  return lengths;
}

} // namespace

SurfacePart cutWedge(const Mesh& mesh, const Isometry& rotation, double tolerance,
  const WedgeReach& reach, std::optional<double> startAngle)
{
  if (startAngle)
  {
    return WedgeBuilder(mesh, rotation, *startAngle, tolerance, reach).build();
  }
  std::vector<double> angles;
  angles.reserve(kHalfPlanes);
  for (int k = 0; k < kHalfPlanes; ++k)
  {
    // Not through the vertices of evenly divided circles.
    angles.push_back((k + 0.5) / kHalfPlanes * 2 * kPi / rotation.order);
  }
  const std::vector<std::optional<double>> lengths =
    cutLengths(mesh, rotation.axis(), angles, tolerance);
  std::vector<Index> byLength =
    idsWhere(angles.size(), [&](Index k) { return lengths[k].has_value(); });
  // Lengths that differ by rounding are equal.
  const double unit = std::max(tolerance, std::numeric_limits<double>::min());
  std::stable_sort(byLength.begin(), byLength.end(),
    [&](Index a, Index b)
    { return std::floor(*lengths[a] / unit) < std::floor(*lengths[b] / unit); });
  std::optional<SurfacePart> best;
  bool isOther = false;
  for (std::size_t i = 0; i < std::min(kMostCuts, byLength.size()); ++i)
  {
    countTry(Try::OtherHalfPlane, i > 0 ? 1 : 0);
    SurfacePart wedge = WedgeBuilder(mesh, rotation, angles[byLength[i]], tolerance, reach).build();
    const bool isBetter = !best || (!best->mismatch.empty() && wedge.mismatch.empty()) ||
      (best->mismatch.empty() == wedge.mismatch.empty() && wedge.loneFeatures < best->loneFeatures);
    if (isBetter)
    {
      best = std::move(wedge);
      isOther = i > 0;
    }
    if (best->mismatch.empty() && best->loneFeatures == 0)
    {
      break;
    }
  }
  if (!best)
  {
    best.emplace();
    best->mismatch = "faces of the surface lie in every half plane that could cut it";
  }
  countTryLed(Try::OtherHalfPlane, isOther && best->mismatch.empty() ? 1 : 0);
  return std::move(*best);
}

} // namespace quadrille
