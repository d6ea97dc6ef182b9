// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/ConeStart.h"

#include "Base/Angles.h"
#include "Base/ChartRotation.h"
#include "Numerics/Untangler.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace quadrille
{

namespace
{

/// How far the angles along the border may add up to something else than the turns: rounding only.
constexpr double kAngleTolerance = 1e-6;

double crossOf(const Vector2& a, const Vector2& b)
{
  return a.x() * b.y() - a.y() * b.x();
}

/// From a to b, in (-pi, pi].
double angleBetween(const Vector2& a, const Vector2& b)
{
  return std::atan2(crossOf(a, b), a.dot(b));
}

class FlatCone
{
public:
  explicit FlatCone(const ConePatch& patch)
    : patch_(patch), mesh_(patch.mesh), cones_(patch.faces.size())
  {
  }

  /// False where the patch cannot be laid flat.
  bool prepare()
  {
    numberVertices();
    return followBorder() && isDisc() && followStar() && placeCones() && placeBorder();
  }

  /// Wanted are triangles of one shape: slivers of the surface would reach round the cone.
  UntangleProblem problem() const
  {
    UntangleProblem problem;
    const Index points = static_cast<Index>(vertices_.size());
    problem.offset = Eigen::VectorXd::Zero(2 * points);
    std::vector<Eigen::Triplet<double>> entries;
    // The first two unknowns turn and scale the star.
    int unknowns = 2;
    for (Index i = 0; i < points; ++i)
    {
      if (const auto on = std::find(star_.begin(), star_.end(), i); on != star_.end())
      {
        const double angle =
          2 * kPi * static_cast<double>(on - star_.begin()) / static_cast<double>(star_.size());
        entries.emplace_back(2 * i, 0, std::cos(angle));
        entries.emplace_back(2 * i, 1, -std::sin(angle));
        entries.emplace_back(2 * i + 1, 0, std::sin(angle));
        entries.emplace_back(2 * i + 1, 1, std::cos(angle));
      }
      else if (isBorder_[i] == 0 && vertices_[i] != patch_.cone)
      {
        entries.emplace_back(2 * i, unknowns, 1.0);
        entries.emplace_back(2 * i + 1, unknowns + 1, 1.0);
        unknowns += 2;
      }
      else
      {
        problem.offset.segment<2>(2 * i) = flat_[i];
      }
    }
    problem.basis.resize(2 * points, unknowns);
    problem.basis.setFromTriplets(entries.begin(), entries.end());
    const Eigen::Matrix2d inverse = equilateral(
      std::sqrt(flatArea() / (kEquilateralArea * static_cast<double>(patch_.faces.size()))))
                                      .inverse();
    for (const Index f : patch_.faces)
    {
      problem.triangles.push_back({ numberOf(mesh_.origin[3 * f]),
        numberOf(mesh_.origin[3 * f + 1]), numberOf(mesh_.origin[3 * f + 2]) });
      problem.inverseReference.push_back(inverse);
      problem.weight.push_back(0.5 / inverse.determinant());
    }
    return problem;
  }

  /// Places in the charts of the faces, of a valid map into the disc; empty where it is none.
  std::vector<Vector2> bringBack(const UntangleProblem& problem, const Eigen::VectorXd& y)
  {
    const Eigen::VectorXd x = problem.basis * y + problem.offset;
    for (Index i = 0; i < vertices_.size(); ++i)
    {
      flat_[i] = x.segment<2>(2 * static_cast<Eigen::Index>(i));
    }
    if (!unroll())
    {
      return {};
    }
    std::vector<Vector2> places;
    for (Index i = 0; i < patch_.faces.size(); ++i)
    {
      const Sheet& sheet = *sheets_[i];
      for (Index k = 0; k < 3; ++k)
      {
        const Index v = mesh_.origin[3 * patch_.faces[i] + k];
        const Index n = numberOf(v);
        const double radius = largest_ * std::pow(flat_[n].norm(), power());
        const double angle = firstAngle_ + sheet.angle[k] * power() + sheet.rotation * kRightAngle;
        const bool isKept = v == patch_.cone || isBorder_[n] != 0;
        places.push_back(isKept
            ? toDouble(patch_.uv[3 * patch_.faces[i] + k])
            : Vector2(toDouble(*cones_[i]) + radius * Vector2(std::cos(angle), std::sin(angle))));
      }
    }
    return places;
  }

private:
  /// A face laid out along a way from the first one: the angles of its corners in the disc, which go on from those
  /// of the face before, and the rotation of its chart against the first one's.
  struct Sheet
  {
    std::array<double, 3> angle{};
    int rotation = 0;
  };

  double power() const { return patch_.turns / 4.0; }

  void numberVertices()
  {
    for (const Index f : patch_.faces)
    {
      vertices_.insert(
        vertices_.end(), mesh_.origin.begin() + 3 * f, mesh_.origin.begin() + 3 * f + 3);
    }
    std::sort(vertices_.begin(), vertices_.end());
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
    isBorder_.assign(vertices_.size(), 0);
    flat_.assign(vertices_.size(), Vector2::Zero());
  }

  Index numberOf(Index v) const
  {
    return static_cast<Index>(
      std::lower_bound(vertices_.begin(), vertices_.end(), v) - vertices_.begin());
  }

  std::optional<Index> placeOf(Index f) const
  {
    const auto at = std::lower_bound(patch_.faces.begin(), patch_.faces.end(), f);
    return at != patch_.faces.end() && *at == f
      ? std::optional<Index>(static_cast<Index>(at - patch_.faces.begin()))
      : std::nullopt;
  }

  bool isInside(Index h) const
  {
    return !mesh_.isBoundary(h) && placeOf(Mesh::face(mesh_.twin[h])).has_value();
  }

  /// The half-edges of the border in their order; false where they are not one loop that passes no vertex twice.
  bool followBorder()
  {
    std::size_t count = 0;
    Index first = kInvalidIndex;
    for (const Index f : patch_.faces)
    {
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        if (!isInside(h))
        {
          first = count++ == 0 ? h : first;
        }
      }
    }
    Index h = first;
    while (count > 0 && border_.size() < count)
    {
      const Index n = numberOf(mesh_.origin[h]);
      if (isBorder_[n] != 0)
      {
        return false;
      }
      isBorder_[n] = 1;
      border_.push_back(h);
      h = Mesh::next(h);
      while (isInside(h))
      {
        h = Mesh::next(mesh_.twin[h]);
      }
    }
    return count > 2 && h == first;
  }

  bool isDisc() const
  {
    const std::size_t edges = (3 * patch_.faces.size() + border_.size()) / 2;
    return vertices_.size() + patch_.faces.size() == edges + 1 &&
      isBorder_[numberOf(patch_.cone)] == 0;
  }

  /// The vertices round the cone in their order. They stay a regular polygon in the disc: where triangles are slivers one
  /// might get an angle at the cone that the power makes more than half a turn.
  bool followStar()
  {
    for (const Index f : patch_.faces)
    {
      for (Index first = 3 * f; first < 3 * f + 3 && star_.empty(); ++first)
      {
        for (Index h = first; mesh_.origin[first] == patch_.cone && (h != first || star_.empty());
             h = mesh_.rotateCounterclockwise(h))
        {
          star_.push_back(numberOf(mesh_.target(h)));
        }
      }
    }
    return 2 * star_.size() > static_cast<std::size_t>(patch_.turns) &&
      std::all_of(star_.begin(), star_.end(), [this](Index i) { return isBorder_[i] == 0; });
  }

  /// The rotation from the chart of h to that of its twin; none where the edge has no length.
  std::optional<int> rotationAcross(Index h) const
  {
    const Index g = mesh_.twin[h];
    return rotationBetween(
      patch_.uv[Mesh::next(h)] - patch_.uv[h], patch_.uv[g] - patch_.uv[Mesh::next(g)]);
  }

  /// Calls visit(i, h, j, rotation) for each face j beside a face i that was visited, from the first one on; the faces
  /// are over h. False where some are not reached.
  template <typename Visit>
  bool spread(Index first, Visit visit) const
  {
    std::vector<Index> queue{ first };
    std::vector<std::uint8_t> seen(patch_.faces.size(), 0);
    seen[first] = 1;
    for (std::size_t at = 0; at < queue.size(); ++at)
    {
      const Index i = queue[at];
      for (Index h = 3 * patch_.faces[i]; h < 3 * patch_.faces[i] + 3; ++h)
      {
        const std::optional<Index> j =
          isInside(h) ? placeOf(Mesh::face(mesh_.twin[h])) : std::optional<Index>();
        if (!j || seen[*j] != 0)
        {
          continue;
        }
        if (const std::optional<int> rotation = rotationAcross(h))
        {
          seen[*j] = 1;
          queue.push_back(*j);
          visit(i, h, *j, *rotation);
        }
      }
    }
    return queue.size() == patch_.faces.size();
  }

  /// Where the cone is in the chart of each face: the same on all ways, as a way round it only turns the chart there.
  bool placeCones()
  {
    for (Index i = 0; i < patch_.faces.size(); ++i)
    {
      for (Index h = 3 * patch_.faces[i]; h < 3 * patch_.faces[i] + 3; ++h)
      {
        if (mesh_.origin[h] == patch_.cone)
        {
          cones_[i] = patch_.uv[h];
          return spread(i,
            [this](Index from, Index over, Index to, int rotation)
            {
              const Index end = Mesh::next(mesh_.twin[over]); // leaves the origin of `over`
              cones_[to] = patch_.uv[end] + rotate(*cones_[from] - patch_.uv[over], rotation);
            });
        }
      }
    }
    return false;
  }

  /// From the cone to the origin of the half-edge, in the chart of its face.
  Vector2 fromCone(Index h) const
  {
    return toDouble(patch_.uv[h] - *cones_[*placeOf(Mesh::face(h))]);
  }

  bool placeBorder()
  {
    std::vector<double> angle;
    double sum = 0;
    for (const Index h : border_)
    {
      angle.push_back(sum);
      largest_ = std::max(largest_, fromCone(h).norm());
      sum += angleBetween(fromCone(h), fromCone(Mesh::next(h)));
    }
    if (std::abs(sum - patch_.turns * kRightAngle) > kAngleTolerance || largest_ <= 0)
    {
      return false;
    }
    for (std::size_t i = 0; i < border_.size(); ++i)
    {
      const double radius = std::pow(fromCone(border_[i]).norm() / largest_, 1 / power());
      flat_[numberOf(mesh_.origin[border_[i]])] =
        radius * Vector2(std::cos(angle[i] / power()), std::sin(angle[i] / power()));
    }
    const Vector2 first = fromCone(border_.front());
    firstAngle_ = std::atan2(first.y(), first.x());
    return flatArea() > 0;
  }

  double flatArea() const
  {
    double area = 0;
    for (const Index h : border_)
    {
      area += crossOf(flat_[numberOf(mesh_.origin[h])], flat_[numberOf(mesh_.target(h))]) / 2;
    }
    return area;
  }

  bool unroll()
  {
    sheets_.assign(patch_.faces.size(), std::nullopt);
    const Index h = border_.front();
    const Index first = *placeOf(Mesh::face(h));
    sheets_[first] = Sheet{};
    for (const Index corner : { Mesh::next(h), Mesh::previous(h) })
    {
      sheets_[first]->angle[corner % 3] = angleOn(h, 0, corner);
    }
    return spread(first,
      [this](Index from, Index over, Index to, int rotation)
      {
        const Index back = mesh_.twin[over];
        Sheet sheet;
        sheet.rotation = sheets_[from]->rotation + rotation;
        sheet.angle[back % 3] = sheets_[from]->angle[Mesh::next(over) % 3];
        sheet.angle[Mesh::next(back) % 3] = sheets_[from]->angle[over % 3];
        const Index known = mesh_.origin[back] == patch_.cone ? Mesh::next(back) : back;
        sheet.angle[Mesh::previous(back) % 3] =
          angleOn(known, sheet.angle[known % 3], Mesh::previous(back));
        sheets_[to] = sheet;
      });
  }

  /// The angle of a corner in the disc, from that of another one of its face; no triangle of a valid map spans more
  /// than half a turn seen from the cone. The cone itself has none.
  double angleOn(Index known, double angle, Index corner) const
  {
    return mesh_.origin[corner] == patch_.cone ? angle
                                               : angle +
        angleBetween(flat_[numberOf(mesh_.origin[known])], flat_[numberOf(mesh_.origin[corner])]);
  }

  const ConePatch& patch_;
  const Mesh& mesh_;
  std::vector<Index> vertices_; ///< ascending
  std::vector<std::uint8_t> isBorder_;
  std::vector<Vector2> flat_;
  std::vector<Index> border_;
  std::vector<Index> star_; ///< numbers of the vertices round the cone
  std::vector<std::optional<FixedVec2>> cones_;
  std::vector<std::optional<Sheet>> sheets_;
  double largest_ = 0;    ///< distance from the cone, of the border
  double firstAngle_ = 0; ///< of the border's first vertex, in its chart
};

} // namespace

Eigen::Matrix2d equilateral(double side)
{
  Eigen::Matrix2d edges;
  edges << side, 0.5 * side, 0, 0.8660254037844386 * side;
  return edges;
}

ConeStart startRoundCone(const ConePatch& patch, int maximumSteps)
{
  ConeStart start;
  FlatCone flat(patch);
  if (!flat.prepare())
  {
    return start;
  }
  const UntangleProblem problem = flat.problem();
  UntangleOptions options;
  options.maximumSteps = maximumSteps;
  const UntangleResult result = untangle(problem, fitHarmonic(problem), options);
  start.steps = result.steps;
  if (result.inverted.empty() && result.y.allFinite())
  {
    start.places = flat.bringBack(problem, result.y);
  }
  return start;
}

} // namespace quadrille
