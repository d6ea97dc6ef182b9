// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/RotationCut.h"

#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "Mesh/Topology.h"
#include "Symmetry/MirrorCut.h"
#include "Symmetry/SeamMarks.h"

#include <algorithm>
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

using CornerWeights = SurfaceWedge::CornerWeights;

enum class WedgeSide : std::uint8_t
{
  Inside,
  First,  ///< in the first half plane
  Second, ///< in the second one
  Own     ///< a boundary of the surface
};

/// Twins by the ids of points. featureEdges become requested features.
Mesh connectTriangles(const SurfaceInput& input)
{
  Mesh mesh;
  mesh.position = input.points;
  mesh.origin = input.polygonPoints;
  mesh.twin.assign(mesh.origin.size(), kInvalidIndex);
  mesh.flags.assign(mesh.origin.size(), 0);
  std::vector<std::array<Index, 3>> edges; // lower and upper end, half-edge
  edges.reserve(mesh.origin.size());
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const auto [low, high] = std::minmax({ mesh.origin[h], mesh.target(h) });
    edges.push_back({ low, high, h });
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 1; i < edges.size(); ++i)
  {
    const Index g = edges[i - 1][2], h = edges[i][2];
    const bool isSame = edges[i - 1][0] == edges[i][0] && edges[i - 1][1] == edges[i][1];
    if (isSame && mesh.origin[g] != mesh.origin[h])
    {
      mesh.twin.edit()[g] = h;
      mesh.twin.edit()[h] = g;
    }
  }
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if ((input.featureEdges[Mesh::face(h)] & 1U << h % 3) != 0)
    {
      mesh.flags.edit()[h] |= kFeatureEdge | kRequestedFeature;
      if (mesh.twin[h] != kInvalidIndex)
      {
        mesh.flags.edit()[mesh.twin[h]] |= kFeatureEdge | kRequestedFeature;
      }
    }
  }
  return mesh;
}

class WedgeBuilder
{
public:
  WedgeBuilder(const Mesh& mesh, const RotationAxis& axis, int order, double startAngle,
    double tolerance, const WedgeReach& reach)
    : mesh_(mesh), axis_(axis), order_(order), tolerance_(tolerance), reach_(reach.ofCuts),
      alignReach_(reach.ofFeatures)
  {
    wedge_.startAngle = startAngle;
    const Vector3 start = axis.turned(axis.direction.unitOrthogonal(), startAngle);
    radial_ = { start, axis.imageOf(start, 1, order) };
    planes_[0] = { axis.origin, axis.direction.cross(radial_[0]) };
    planes_[1] = { axis.origin, -axis.direction.cross(radial_[1]) };
    wedge_.planes = planes_;
  }

  SurfaceWedge build()
  {
    if (order_ == 2)
    {
      takeHalf(cutByMirror(mesh_, planes_[0], tolerance_));
      splitAtAxis();
    }
    else
    {
      const MirrorHalf half = cutByMirror(mesh_, planes_[0], tolerance_);
      const Mesh connected = connectTriangles(half.input);
      takeSecond(half, connected, cutByMirror(connected, planes_[1], tolerance_));
    }
    if (wedge_.face.empty())
    {
      wedge_.mismatch = "nothing of the surface lies in a wedge";
      return std::move(wedge_);
    }
    cut_ = connectTriangles(wedge_.input);
    findSides();
    findPoles();
    findChains();
    SeamMarks marks(cut_, axis_, order_, tolerance_, alignReach_);
    matchChains(marks);
    splitForMarks(marks.splits());
    return std::move(wedge_);
  }

private:
  void takeHalf(MirrorHalf half)
  {
    for (Index t = 0; t < half.face.size(); ++t)
    {
      wedge_.weights.push_back(half.cornerWeights(mesh_, t));
    }
    wedge_.input = std::move(half.input);
    wedge_.face = std::move(half.face);
  }

  void takeSecond(const MirrorHalf& half, const Mesh& connected, MirrorHalf second)
  {
    for (Index t = 0; t < second.face.size(); ++t)
    {
      const Index before = second.face[t];
      const CornerWeights inHalf = second.cornerWeights(connected, t);
      const CornerWeights corners = half.cornerWeights(mesh_, before);
      CornerWeights weights{};
      for (std::size_t i = 0; i < 3; ++i)
      {
        for (std::size_t k = 0; k < 3; ++k)
        {
          for (std::size_t j = 0; j < 3; ++j)
          {
            weights[i][j] += inHalf[i][k] * corners[k][j];
          }
        }
      }
      wedge_.face.push_back(half.face[before]);
      wedge_.weights.push_back(weights);
    }
    wedge_.input = std::move(second.input);
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

  /// The triangle (p, q, c) with the edge from p to q becomes (p, x, c), and (x, q, c) a new one. Returns x.
  Index splitEdge(Index h, const Vector3& place, double share)
  {
    SurfaceInput& input = wedge_.input;
    const Index t = Mesh::face(h);
    const std::size_t i = h % 3, j = (i + 1) % 3, k = (i + 2) % 3;
    const Index q = input.polygonPoints[3 * t + j], c = input.polygonPoints[3 * t + k];
    const auto x = static_cast<Index>(input.points.size());
    input.points.push_back(place);
    input.polygonPoints.edit()[3 * t + j] = x;
    const std::uint8_t bits = input.featureEdges[t];
    const auto bit = [&](std::size_t edge) { return static_cast<unsigned>(bits >> edge & 1U); };
    input.featureEdges[t] = static_cast<std::uint8_t>(bits & ~(1U << j));
    input.polygonPoints.append({ x, q, c });
    input.polygonOffsets.push_back(static_cast<Index>(input.polygonPoints.size()));
    input.featureEdges.push_back(static_cast<std::uint8_t>(bit(i) | bit(j) << 1U));
    const CornerWeights weights = wedge_.weights[t];
    std::array<double, 3> at{};
    for (std::size_t corner = 0; corner < 3; ++corner)
    {
      at[corner] = (1 - share) * weights[i][corner] + share * weights[j][corner];
    }
    wedge_.weights.push_back({ at, weights[j], weights[k] });
    wedge_.weights[t][j] = at;
    wedge_.face.push_back(wedge_.face[t]);
    return x;
  }

  bool isIn(std::size_t side, Index point) const
  {
    return std::abs(planes_[side].height(wedge_.input.points[point])) <= tolerance_;
  }

  void findSides()
  {
    sides_.assign(cut_.halfEdgeCount(), WedgeSide::Inside);
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
      sides_[h] = lies(0) ? WedgeSide::First : lies(1) ? WedgeSide::Second : WedgeSide::Own;
    }
  }

  Index nextOnBoundary(Index h) const
  {
    h = Mesh::next(h);
    while (!cut_.isBoundary(h))
    {
      h = Mesh::next(cut_.twin[h]);
    }
    return h;
  }

  static bool isCut(WedgeSide side)
  {
    return side == WedgeSide::First || side == WedgeSide::Second;
  }

  void findPoles()
  {
    for (Index h = 0; h < cut_.halfEdgeCount(); ++h)
    {
      const Index next = isCut(sides_[h]) ? nextOnBoundary(h) : h;
      if (isCut(sides_[next]) && sides_[next] != sides_[h])
      {
        wedge_.poles.push_back(cut_.position[cut_.origin[next]]);
      }
    }
  }

  void findChains()
  {
    std::vector<std::uint8_t> isDone(cut_.halfEdgeCount(), 0);
    const auto collect = [&](Index first)
    {
      WedgeChain chain;
      Index h = first;
      do
      {
        isDone[h] = 1;
        chain.edges.push_back(h);
        h = nextOnBoundary(h);
      } while (sides_[h] == sides_[first] && h != first);
      chain.closed = h == first;
      chains_[sides_[first] == WedgeSide::First ? 0 : 1].push_back(std::move(chain));
    };
    std::vector<std::uint8_t> isLater(cut_.halfEdgeCount(), 0);
    for (Index h = 0; h < cut_.halfEdgeCount(); ++h)
    {
      if (isCut(sides_[h]))
      {
        const Index next = nextOnBoundary(h);
        isLater[next] = sides_[next] == sides_[h] ? 1 : 0;
      }
    }
    for (const bool closed : { false, true })
    {
      for (Index h = 0; h < cut_.halfEdgeCount(); ++h)
      {
        if (isCut(sides_[h]) && isDone[h] == 0 && (closed || isLater[h] == 0))
        {
          collect(h);
        }
      }
    }
    for (std::vector<WedgeChain>& side : chains_)
    {
      for (WedgeChain& chain : side)
      {
        measure(chain);
      }
    }
  }

  void measure(WedgeChain& chain) const
  {
    for (const Index h : chain.edges)
    {
      const double length = cut_.edgeVector(h).norm();
      chain.length += length;
      chain.middle += length / 2 * (cut_.position[cut_.origin[h]] + cut_.position[cut_.target(h)]);
    }
    chain.middle /= std::max(chain.length, std::numeric_limits<double>::min());
  }

  const Vector3& place(const WedgeChain& chain, std::size_t i) const
  {
    return chain.place(cut_, i);
  }

  Vector3 imageOf(const Vector3& p) const { return axis_.image(p, 1, order_); }

  /// How far the image of a chain in the first half plane is from one in the second.
  double distance(const WedgeChain& first, const WedgeChain& second) const
  {
    if (first.closed != second.closed)
    {
      return std::numeric_limits<double>::infinity();
    }
    double farthest = (imageOf(first.middle) - second.middle).norm();
    if (!first.closed)
    {
      farthest =
        std::max({ farthest, (imageOf(place(first, 0)) - place(second, second.edges.size())).norm(),
          (imageOf(place(first, first.edges.size())) - place(second, 0)).norm() });
    }
    return farthest;
  }

  void matchChains(SeamMarks& marks)
  {
    Index count = 0;
    const std::vector<Index> component = faceComponents(cut_, count);
    std::vector<std::uint8_t> isTaken(chains_[1].size(), 0);
    for (const WedgeChain& first : chains_[0])
    {
      std::size_t best = chains_[1].size();
      for (std::size_t i = 0; i < chains_[1].size(); ++i)
      {
        const bool isNearer = best == chains_[1].size() ||
          distance(first, chains_[1][i]) < distance(first, chains_[1][best]);
        best = isTaken[i] == 0 && isNearer ? i : best;
      }
      if (best == chains_[1].size() || !(distance(first, chains_[1][best]) <= reach_))
      {
        wedge_.mismatch = "the cut near " + placeText(place(first, 0)) +
          " has no image on the other side of its wedge";
        return;
      }
      isTaken[best] = 1;
      const WedgeChain& second = chains_[1][best];
      if (component[Mesh::face(first.edges.front())] != component[Mesh::face(second.edges.front())])
      {
        wedge_.mismatch = "the part of the surface at the cut near " + placeText(place(first, 0)) +
          " does not reach from one side of its wedge to the other";
        return;
      }
      marks.add(first, second, wedge_);
    }
    if (chains_[0].size() != chains_[1].size())
    {
      const std::size_t i =
        static_cast<std::size_t>(std::find(isTaken.begin(), isTaken.end(), 0) - isTaken.begin());
      wedge_.mismatch = "the cut near " + placeText(place(chains_[1][i], 0)) +
        " has no image on the other side of its wedge";
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
  const RotationAxis& axis_;
  int order_;
  double tolerance_, reach_, alignReach_;
  std::array<Vector3, 2> radial_;
  std::array<MirrorPlane, 2> planes_;
  SurfaceWedge wedge_;
  Mesh cut_; ///< the wedge
  std::vector<WedgeSide> sides_;
  std::array<std::vector<WedgeChain>, 2> chains_; ///< in the first and in the second half plane
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
      const Vector3 centre =
        (mesh.position[mesh.origin[3 * f]] + mesh.position[mesh.origin[3 * f + 1]] +
          mesh.position[mesh.origin[3 * f + 2]]) /
        3;
      if (*low >= -tolerance && *high <= tolerance && radial.dot(centre - axis.origin) > 0)
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

SurfaceWedge cutWedge(const Mesh& mesh, const RotationAxis& axis, int order, double tolerance,
  const WedgeReach& reach, std::optional<double> startAngle)
{
  if (startAngle)
  {
    return WedgeBuilder(mesh, axis, order, *startAngle, tolerance, reach).build();
  }
  std::vector<double> angles;
  angles.reserve(kHalfPlanes);
  for (int k = 0; k < kHalfPlanes; ++k)
  {
    // Not through the vertices of evenly divided circles.
    angles.push_back((k + 0.5) / kHalfPlanes * 2 * kPi / order);
  }
  const std::vector<std::optional<double>> lengths = cutLengths(mesh, axis, angles, tolerance);
  std::vector<std::size_t> byLength;
  for (std::size_t k = 0; k < angles.size(); ++k)
  {
    if (lengths[k])
    {
      byLength.push_back(k);
    }
  }
  // Lengths that differ by rounding are equal.
  const double unit = std::max(tolerance, std::numeric_limits<double>::min());
  std::stable_sort(byLength.begin(), byLength.end(),
    [&](std::size_t a, std::size_t b)
    { return std::floor(*lengths[a] / unit) < std::floor(*lengths[b] / unit); });
  std::optional<SurfaceWedge> best;
  bool isOther = false;
  for (std::size_t i = 0; i < std::min(kMostCuts, byLength.size()); ++i)
  {
    countTry(Try::OtherHalfPlane, i > 0 ? 1 : 0);
    SurfaceWedge wedge =
      WedgeBuilder(mesh, axis, order, angles[byLength[i]], tolerance, reach).build();
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
