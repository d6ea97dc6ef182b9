// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/SurfaceStretch.h"

#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Hierarchy/LogRecords.h"
#include "Transfer/PlaneReplay.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace quadrille
{

namespace
{

using Polygon = std::vector<Complex>;

/// Steps from triangle to triangle after which a walk stays where it is, as only triangles without area make it go in
/// circles, and a face reaches no farther.
constexpr int kMostCircleSteps = 64;

double cross(Complex a, Complex b)
{
  return a.real() * b.imag() - a.imag() * b.real();
}

/// A change of the chart.
struct Motion
{
  Complex rotation = 1;
  Complex translation = 0;
  Complex operator()(Complex p) const { return rotation * p + translation; }
};

/// The coarse triangles, each in its own plane.
class CoarsePlanes
{
public:
  explicit CoarsePlanes(const Mesh& mesh)
    : mesh_(mesh), corner_(mesh.halfEdgeCount()), across_(mesh.halfEdgeCount())
  {
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      const std::array<Complex, 3> corners = layOut(mesh, f);
      std::copy(corners.begin(), corners.end(), &corner_[3 * std::size_t{ f }]);
    }
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      if (!mesh.isBoundary(h))
      {
        const Index twin = mesh.twin[h];
        const Complex rotation = rotationBetween(edge(h), -edge(twin));
        across_[h] = { rotation, corner_[Mesh::next(twin)] - rotation * corner_[h] };
      }
    }
  }

  const Mesh& mesh() const { return mesh_; }
  Complex corner(Index h) const { return corner_[h]; }
  Complex edge(Index h) const { return corner_[Mesh::next(h)] - corner_[h]; }
  /// From the plane of the face of h to that of the face across h, which must not be a boundary.
  const Motion& across(Index h) const { return across_[h]; }
  /// Above 0 on the side of h on which its face is.
  double side(Index h, Complex p) const { return cross(edge(h), p - corner_[h]); }

  /// The half-edge of f that p lies beyond, the one it lies farthest beyond; none inside, and at boundaries.
  Index exit(Index f, Complex p) const
  {
    Index result = kInvalidIndex;
    double farthest = 0;
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      const double length = std::abs(edge(h));
      const double distance = length > 0 ? side(h, p) / length : 0;
      if (!mesh_.isBoundary(h) && distance < farthest)
      {
        farthest = distance;
        result = h;
      }
    }
    return result;
  }

private:
  const Mesh& mesh_;
  std::vector<Complex> corner_; ///< #H
  std::vector<Motion> across_;  ///< #H
};

/// The finer faces on the coarse planes, while the log goes back.
class Layout
{
public:
  Layout(const CoarsePlanes& planes, Index faces)
    : planes_(planes), corner_(3 * std::size_t{ faces }), home_(faces, kInvalidIndex),
      star_(corner_)
  {
  }
  Layout(const Layout&) = delete;
  Layout& operator=(const Layout&) = delete;

  /// Face f is the coarse face.
  void place(Index f, Index coarseFace)
  {
    for (Index i = 0; i < 3; ++i)
    {
      corner_[3 * f + i] = planes_.corner(3 * coarseFace + i);
    }
    home_[f] = coarseFace;
  }

  /// slotOf: the corner here of a corner slot of the log.
  template <typename SlotOf>
  void goBack(const BlockRecords& records, const SlotOf& slotOf)
  {
    readBackwards(
      records, record_,
      [&](Index fineH, Index fineG)
      {
        const Index h = slotOf(fineH);
        const Index g = slotOf(fineG);
        star_.unflip(h, g);
        goHome(h / 3);
        goHome(g / 3);
      },
      [&]
      {
        std::for_each(record_.slot.begin(), record_.slot.begin() + record_.faces,
          [&](Index& slot) { slot = slotOf(slot); });
        uncollapse();
      });
  }

  const Complex* corners(Index f) const { return &corner_[3 * std::size_t{ f }]; }
  /// The coarse face in whose plane the corners of f are; it holds about the middle of f.
  Index home(Index f) const { return home_[f]; }

private:
  void uncollapse()
  {
    const Complex p = star_.unfold(record_);
    star_.write(record_, intoKernel(star_.ring().data(), record_, p));
    const int first = record_.firstSurvivor();
    const int last = record_.lastSurvivor();
    if (first == 1)
    {
      home_[faceOf(0)] = home_[faceOf(first)];
    }
    if (last == record_.faces - 2)
    {
      home_[faceOf(record_.faces - 1)] = home_[faceOf(last)];
    }
    for (int i = 0; i < record_.faces; ++i)
    {
      goHome(faceOf(i));
    }
  }

  /// To the plane of the coarse face that holds the middle of f. Done whenever f moves, as a way that is short does not
  /// pass a cone on the wrong side.
  void goHome(Index f)
  {
    Complex* const p = &corner_[3 * std::size_t{ f }];
    for (int step = 0; step < kMostCircleSteps; ++step)
    {
      const Index h = planes_.exit(home_[f], (p[0] + p[1] + p[2]) / 3.0);
      if (h == kInvalidIndex)
      {
        return;
      }
      std::transform(p, p + 3, p, planes_.across(h));
      home_[f] = Mesh::face(planes_.mesh().twin[h]);
    }
  }

  Index faceOf(int i) const { return record_.slot[static_cast<std::size_t>(i)] / 3; }

  const CoarsePlanes& planes_;
  std::vector<Complex> corner_;
  std::vector<Index> home_;
  StarReplay<PlaneCharts> star_;
  CollapseRecord record_;
};

/// Sums over a coarse face.
struct Share
{
  Eigen::Matrix2d stretch = Eigen::Matrix2d::Zero();
  double covered = 0;
  double surface = 0;
};

Eigen::Matrix2d rotated(const Eigen::Matrix2d& symmetric, Complex r)
{
  Eigen::Matrix2d rotation;
  rotation << r.real(), -r.imag(), r.imag(), r.real();
  return rotation * symmetric * rotation.transpose();
}

/// A fourth power of a direction, in another chart.
Complex rotated(Complex fourthPower, Complex r)
{
  const Complex square = r * r;
  return fourthPower * square * square;
}

/// Gives each coarse face its part of a finer face.
class PolygonSpread
{
public:
  explicit PolygonSpread(const CoarsePlanes& planes) : planes_(planes) {}

  /// add(f, area, value): what of the polygon lies on coarse face f, and the value in its plane. What lies beyond an
  /// edge goes to the face there; `entered` is the edge of f that the polygon came in by.
  template <typename Value, typename Add>
  void operator()(Index f, Index entered, Polygon polygon, const Value& value, const Add& add,
    int depth = 0) const
  {
    for (Index h = 3 * f; h < 3 * f + 3 && depth < kMostCircleSteps; ++h)
    {
      if (h == entered || planes_.mesh().isBoundary(h))
      {
        continue;
      }
      Polygon beyond = cut(polygon, h);
      if (beyond.size() >= 3)
      {
        const Motion& across = planes_.across(h);
        const Index twin = planes_.mesh().twin[h];
        std::transform(beyond.begin(), beyond.end(), beyond.begin(), across);
        (*this)(Mesh::face(twin), twin, std::move(beyond), rotated(value, across.rotation), add,
          depth + 1);
      }
    }
    double area = 0;
    for (std::size_t i = 2; i < polygon.size(); ++i)
    {
      area += 0.5 * cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
    }
    add(f, area, value);
  }

private:
  /// Leaves what is on the inner side of h and returns the rest.
  Polygon cut(Polygon& polygon, Index h) const
  {
    Polygon inside, beyond;
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
      const Complex p = polygon[i];
      const Complex q = polygon[(i + 1) % polygon.size()];
      const double sideP = planes_.side(h, p);
      const double sideQ = planes_.side(h, q);
      if (sideP >= 0)
      {
        inside.push_back(p);
      }
      if (sideP <= 0)
      {
        beyond.push_back(p);
      }
      if ((sideP > 0 && sideQ < 0) || (sideP < 0 && sideQ > 0))
      {
        const Complex between = p + sideP / (sideP - sideQ) * (q - p);
        inside.push_back(between);
        beyond.push_back(between);
      }
    }
    polygon = std::move(inside);
    return beyond;
  }

  const CoarsePlanes& planes_;
};

/// The map from a finer face's place on the coarse plane to its own plane; none for one that has no area there.
std::optional<Eigen::Matrix2d> jacobianOf(
  const Complex* flat, const std::array<Complex, 3>& surface)
{
  if (!(cross(flat[1] - flat[0], flat[2] - flat[0]) > 0))
  {
    return std::nullopt;
  }
  Eigen::Matrix2d from;
  from << (flat[1] - flat[0]).real(), (flat[2] - flat[0]).real(), (flat[1] - flat[0]).imag(),
    (flat[2] - flat[0]).imag();
  Eigen::Matrix2d to;
  to << surface[1].real(), surface[2].real(), surface[1].imag(), surface[2].imag();
  return Eigen::Matrix2d(to * from.inverse());
}

/// Gives each coarse face the stretch of its part of a finer face.
class Distributor
{
public:
  explicit Distributor(const CoarsePlanes& planes)
    : spread_(planes), shares_(planes.mesh().faceCount())
  {
  }

  /// Corners of the finer face in the plane of coarse face `home` and in its own. One that has no area there counts
  /// nothing.
  void add(Index home, const Complex* flat, const std::array<Complex, 3>& surface)
  {
    const std::optional<Eigen::Matrix2d> map = jacobianOf(flat, surface);
    if (!map)
    {
      return;
    }
    const Eigen::Matrix2d& jacobian = *map;
    const Eigen::Matrix2d metric = jacobian.transpose() * jacobian;
    const double ratio = std::max(jacobian.determinant(), 0.0); // of areas
    const double root = std::sqrt(metric.trace() + 2 * ratio);
    if (!(root > 0) || !std::isfinite(root))
    {
      return;
    }
    spread_(home, kInvalidIndex, { flat[0], flat[1], flat[2] },
      Eigen::Matrix2d((metric + ratio * Eigen::Matrix2d::Identity()) / root),
      [&](Index f, double area, const Eigen::Matrix2d& stretch)
      {
        Share& share = shares_[f];
        share.stretch += area * stretch;
        share.covered += area;
        share.surface += area * ratio;
      });
  }

  const std::vector<Share>& shares() const { return shares_; }

private:
  PolygonSpread spread_;
  std::vector<Share> shares_;
};

void checkLevel(const Level& level, const DecimationLog& log)
{
  const bool fits = level.fineFace.size() == level.mesh.faceCount() &&
    std::all_of(
      level.fineFace.begin(), level.fineFace.end(), [&](Index f) { return f < log.fineFaces; });
  refuseIf(!fits, "A level of ", level.mesh.faceCount(), " faces is not one of the surface of ",
    log.fineFaces, " faces that the decimation log was made for.");
}

/// The intermediate level on the planes of the coarse one.
void layOutLevel(
  const Level& intermediate, const Level& coarse, const DecimationLog& log, Layout& layout)
{
  checkLevel(intermediate, log);
  checkLevel(coarse, log);
  std::vector<Index> faceOf(log.fineFaces, kInvalidIndex);
  for (Index f = 0; f < intermediate.mesh.faceCount(); ++f)
  {
    faceOf[intermediate.fineFace[f]] = f;
  }
  const auto localFace = [&](Index fineFace)
  {
    const Index f = faceOf[fineFace];
    refuseIf(f == kInvalidIndex, "Face ", fineFace,
      " of the surface is in the end of the decimation log, but not on the intermediate level.");
    return f;
  };
  for (Index f = 0; f < coarse.mesh.faceCount(); ++f)
  {
    layout.place(localFace(coarse.fineFace[f]), f);
  }
  for (std::size_t round = log.rounds.size(); round-- > log.intermediateRounds;)
  {
    const DecimationLog::Round& blocks = log.rounds[round];
    for (std::size_t i = blocks.firstBlock + blocks.blockCount; i-- > blocks.firstBlock;)
    {
      layout.goBack(log.blocks[i], [&](Index slot) { return 3 * localFace(slot / 3) + slot % 3; });
    }
  }
}

/// The fourth power of what the guide of a finer face is on the coarse plane; 0 where it is nothing.
Complex guideOnPlane(
  const Mesh& mesh, Index f, const Guide& guide, const Eigen::Matrix2d& fromPlane)
{
  const Vector3 x = mesh.edgeVector(3 * f).normalized();
  const Vector3 y = x.cross(mesh.edgeVector(3 * f + 1)).normalized().cross(x);
  const Vector2 flat =
    fromPlane.inverse() * Vector2(guide.direction.dot(x), guide.direction.dot(y));
  const double length = flat.norm();
  if (!(length > 0) || !std::isfinite(length))
  {
    return 0;
  }
  const Complex unit(flat.x() / length, flat.y() / length);
  return unit * unit * unit * unit;
}

/// sum: over the face, of area times weight times the fourth powers of directions.
Guide guideInSpace(const Mesh& mesh, Index f, Complex sum)
{
  const Vector3 x = mesh.edgeVector(3 * f).normalized();
  const Vector3 y = x.cross(mesh.edgeVector(3 * f + 1)).normalized().cross(x);
  const double angle = 0.25 * std::arg(sum);
  return { std::cos(angle) * x + std::sin(angle) * y,
    static_cast<float>(std::min(std::abs(sum) / mesh.faceArea(f), 1.0)) };
}

} // namespace

std::vector<Guide> gatherGuides(
  const Level& intermediate, const Level& coarse, const DecimationLog& log)
{
  if (intermediate.guides.empty())
  {
    return {};
  }
  const CoarsePlanes planes(coarse.mesh);
  Layout layout(planes, intermediate.mesh.faceCount());
  layOutLevel(intermediate, coarse, log, layout);
  const PolygonSpread spread(planes);
  std::vector<Complex> sums(coarse.mesh.faceCount(), 0);
  for (Index f = 0; f < intermediate.mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    const Guide& guide = intermediate.guides[f];
    if (guide.isFree())
    {
      continue;
    }
    const Complex* const flat = layout.corners(f);
    const std::optional<Eigen::Matrix2d> map = jacobianOf(flat, layOut(intermediate.mesh, f));
    if (!map || !(map->determinant() > 0))
    {
      continue;
    }
    spread(layout.home(f), kInvalidIndex, { flat[0], flat[1], flat[2] },
      guideOnPlane(intermediate.mesh, f, guide, *map),
      [&](Index c, double area, Complex direction)
      { sums[c] += area * double{ guide.weight } * direction; });
  }
  std::vector<Guide> guides(coarse.mesh.faceCount());
  for (Index f = 0; f < coarse.mesh.faceCount(); ++f)
  {
    if (std::abs(sums[f]) > 0 && coarse.mesh.faceArea(f) > 0)
    {
      guides[f] = guideInSpace(coarse.mesh, f, sums[f]);
    }
  }
  return guides;
}

std::vector<Eigen::Matrix2d> measureStretch(
  const Level& intermediate, const Level& coarse, const DecimationLog& log)
{
  const CoarsePlanes planes(coarse.mesh);
  Layout layout(planes, intermediate.mesh.faceCount());
  layOutLevel(intermediate, coarse, log, layout);
  Distributor distributor(planes);
  for (Index f = 0; f < intermediate.mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    distributor.add(layout.home(f), layout.corners(f), layOut(intermediate.mesh, f));
  }
  std::vector<Eigen::Matrix2d> result;
  for (const Share& share : distributor.shares())
  {
    Eigen::Matrix2d stretch = share.stretch;
    const double determinant = stretch.determinant();
    const bool covered = share.covered > 0 && share.surface > 0 && determinant > 0;
    stretch = covered
      ? Eigen::Matrix2d(stretch * std::sqrt(share.surface / share.covered / determinant))
      : Eigen::Matrix2d(Eigen::Matrix2d::Identity());
    result.push_back(stretch);
  }
  return result;
}

} // namespace quadrille
