// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/SizeCones.h"

#include "Base/Angles.h"
#include "Base/Progress.h"
#include "Mesh/Topology.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace quadrille
{
namespace
{

/// Least cotangent, so that slivers leave the matrix positive, and largest one, beside which the pull is not lost.
constexpr double kLeastCotangent = 1e-3;
constexpr double kMostCotangent = 1e6;
/// Share of a vertex in the area of its component, in its row: only to make the matrix positive, the mean is taken off
/// afterwards. A share of the whole area would be lost in rounding where a component is a tiny part of the surface.
constexpr double kPull = 1e-6;
/// Vertices that turns may move between, about; each is a solve.
constexpr std::size_t kMostConePlaces = 500;
/// Columns of a product that are computed at once.
constexpr Eigen::Index kBlock = 64;

/// The conformal factor as a function of the turns.
class ConformalFactor
{
public:
  ConformalFactor(const Mesh& mesh, const FieldTopology& topology)
    : mass_(Eigen::VectorXd::Zero(mesh.vertexCount())),
      component_(mesh.vertexCount(), kInvalidIndex)
  {
    const std::vector<Index> ofFace = faceComponents(mesh, components_);
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      component_[mesh.origin[h]] = ofFace[Mesh::face(h)];
    }
    std::vector<Eigen::Triplet<double>> entries;
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      const int a = static_cast<int>(mesh.origin[h]);
      const int b = static_cast<int>(mesh.target(h));
      const double cotangent = 1 / std::tan(topology.cornerAngle[Mesh::previous(h)]);
      const double weight = 0.5 * std::clamp(cotangent, kLeastCotangent, kMostCotangent);
      entries.emplace_back(a, a, weight);
      entries.emplace_back(b, b, weight);
      entries.emplace_back(a, b, -weight);
      entries.emplace_back(b, a, -weight);
      mass_(a) += topology.area[Mesh::face(h)] / (3 * topology.totalArea);
    }
    const std::vector<double> whole = massOfComponents();
    for (int v = 0; v < static_cast<int>(mass_.size()); ++v)
    {
      const Index component = component_[static_cast<std::size_t>(v)];
      const double share = component != kInvalidIndex && mass_(v) > 0 ? whole[component] : 0;
      entries.emplace_back(v, v, share > 0 ? kPull * (mass_(v) / share) : 1.0);
    }
    Eigen::SparseMatrix<double> matrix(mass_.size(), mass_.size());
    matrix.setFromTriplets(entries.begin(), entries.end());
    solver_.compute(matrix);
    if (solver_.info() != Eigen::Success)
    {
      throw std::logic_error("cross field: the system of the sizes could not be factored");
    }
  }

  /// Of all turns of a field.
  Eigen::VectorXd ofTurns(const FieldTopology& topology, const std::vector<int>& turns) const
  {
    Eigen::VectorXd right = Eigen::VectorXd::Zero(mass_.size());
    for (std::size_t i = 0; i < turns.size(); ++i)
    {
      const Fan& fan = topology.fans[i];
      right(fan.vertex) += turns[i] * kRightAngle - fan.angle;
    }
    return withoutMeans(solver_.solve(right));
  }
  /// Of one quarter turn at a vertex.
  Eigen::VectorXd ofVertex(Index v) const
  {
    Eigen::VectorXd right = Eigen::VectorXd::Zero(mass_.size());
    right(v) = kRightAngle;
    return withoutMeans(solver_.solve(right));
  }
  /// Shares of the area, per vertex.
  const Eigen::VectorXd& mass() const { return mass_; }
  double meanSquare(const Eigen::VectorXd& factor) const { return factor.cwiseAbs2().dot(mass_); }

private:
  /// 1 where there is only one.
  std::vector<double> massOfComponents() const
  {
    std::vector<double> whole(components_, components_ == 1 ? 1.0 : 0.0);
    for (Eigen::Index v = 0; v < mass_.size() && components_ > 1; ++v)
    {
      const Index component = component_[static_cast<std::size_t>(v)];
      if (component != kInvalidIndex)
      {
        whole[component] += mass_(v);
      }
    }
    return whole;
  }

  /// A factor that is constant on a component says nothing: the scale of the map is free.
  Eigen::VectorXd withoutMeans(Eigen::VectorXd factor) const
  {
    std::vector<double> sum(components_, 0.0), share(components_, 0.0);
    for (Eigen::Index v = 0; v < factor.size(); ++v)
    {
      if (component_[static_cast<std::size_t>(v)] != kInvalidIndex)
      {
        sum[component_[static_cast<std::size_t>(v)]] += mass_(v) * factor(v);
        share[component_[static_cast<std::size_t>(v)]] += mass_(v);
      }
    }
    for (Eigen::Index v = 0; v < factor.size(); ++v)
    {
      const Index component = component_[static_cast<std::size_t>(v)];
      factor(v) -= component != kInvalidIndex ? sum[component] / share[component] : 0.0;
    }
    return factor;
  }

  Eigen::VectorXd mass_;
  std::vector<Index> component_; ///< of vertices
  Index components_ = 0;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

/// A vertex that turns may move to and from.
struct ConePlace
{
  Index fan = 0;
  Index vertex = 0;
  Index region = 0; ///< turns cannot cross constrained edges
  int turns = 4;
};

/// Per region, whether features or boundaries bound it.
std::vector<std::uint8_t> regionsWithSides(const Mesh& mesh, const std::vector<Index>& region)
{
  std::vector<std::uint8_t> hasSides(region.size(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isConstrained(h))
    {
      hasSides[region[Mesh::face(h)]] = 1;
    }
  }
  return hasSides;
}

/// The irregular vertices, and others evenly in the order of the mesh, which runs along a space-filling curve. Where
/// sizes are asked for at places they are those of other sizes than 1: the rest of the quads stays as it is. Where they
/// are not asked for at all, those of regions without sides.
std::vector<ConePlace> placesOf(const Mesh& mesh, const FieldTopology& topology,
  const std::vector<int>& turns, const std::vector<int>& asked, SizeWish sizes)
{
  const std::vector<Index> region = regionsOf(mesh);
  const std::vector<std::uint8_t> hasSides = regionsWithSides(mesh, region);
  std::vector<ConePlace> all;
  for (Index i = 0; i < topology.fans.size(); ++i)
  {
    const Fan& fan = topology.fans[i];
    const bool isElsewhere = sizes == SizeWish::AtPlaces
      ? mesh.sizing[fan.vertex] == 1
      : sizes == SizeWish::None && hasSides[region[Mesh::face(fan.first)]] != 0;
    const bool free = (asked.empty() || asked[fan.vertex] == 0) && !isElsewhere;
    // With fewer triangles there is hardly room for five quarter turns.
    if (!fan.sector && free && fan.corners >= 4)
    {
      all.push_back({ i, fan.vertex, region[Mesh::face(fan.first)], turns[i] });
    }
  }
  std::sort(all.begin(), all.end(),
    [](const ConePlace& a, const ConePlace& b) { return a.vertex < b.vertex; });
  const std::size_t step = all.size() / kMostConePlaces + 1;
  std::vector<ConePlace> places;
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    if (all[i].turns != 4 || i % step == 0)
    {
      places.push_back(all[i]);
    }
  }
  return places;
}

/// Moves quarter turns between places, the best move first.
class TurnPlacement
{
public:
  TurnPlacement(const Mesh& mesh, std::vector<ConePlace> places, const ConformalFactor& factor,
    const Eigen::VectorXd& start, double worth)
    : places_(std::move(places)), gain_(places_.size()), worth_(worth)
  {
    const auto size = static_cast<Eigen::Index>(places_.size());
    Eigen::MatrixXd columns(mesh.vertexCount(), size);
    for (Eigen::Index i = 0; i < size; ++i)
    {
      poll();
      columns.col(i) = factor.ofVertex(places_[static_cast<std::size_t>(i)].vertex);
    }
    const Eigen::MatrixXd weighted = factor.mass().asDiagonal() * columns;
    multiply(columns, weighted);
    gain_ = weighted.transpose() * start;
    findNeighbours(mesh);
  }

  bool improve()
  {
    bool any = false;
    while (moveBest())
    {
      poll();
      any = true;
    }
    return any;
  }
  const std::vector<ConePlace>& places() const { return places_; }

private:
  /// product_ = columns^T weighted, which is symmetric: the blocks on the diagonal and above.
  void multiply(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& weighted)
  {
    const Eigen::Index size = columns.cols();
    product_.resize(size, size);
    for (Eigen::Index i = 0; i < size; i += kBlock)
    {
      poll();
      const Eigen::Index width = std::min(kBlock, size - i);
      product_.block(i, i, width, size - i).noalias() =
        columns.middleCols(i, width).transpose() * weighted.rightCols(size - i);
    }
    for (Eigen::Index j = 0; j < size; ++j)
    {
      for (Eigen::Index i = j + 1; i < size; ++i)
      {
        product_(i, j) = product_(j, i);
      }
    }
  }

  void findNeighbours(const Mesh& mesh)
  {
    std::vector<Index> placeOf(mesh.vertexCount(), kInvalidIndex);
    for (Index i = 0; i < places_.size(); ++i)
    {
      placeOf[places_[i].vertex] = i;
    }
    neighbours_.resize(places_.size());
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      const Index a = placeOf[mesh.origin[h]];
      const Index b = placeOf[mesh.target(h)];
      if (a != kInvalidIndex && b != kInvalidIndex)
      {
        neighbours_[a].push_back(b);
        neighbours_[b].push_back(a);
      }
    }
  }

  /// Whether place i may have so many turns: 3 to 5, and no irregular vertex next to another one.
  bool mayHave(Index i, int turns) const
  {
    if (turns < 3 || turns > 5)
    {
      return false;
    }
    return turns == 4 ||
      std::all_of(neighbours_[i].begin(), neighbours_[i].end(),
        [&](Index j) { return places_[j].turns == 4; });
  }

  bool moveBest()
  {
    const Index count = static_cast<Index>(places_.size());
    std::vector<std::uint8_t> mayGain(count), mayLose(count);
    for (Index i = 0; i < count; ++i)
    {
      mayGain[i] = mayHave(i, places_[i].turns + 1) ? 1 : 0;
      mayLose[i] = mayHave(i, places_[i].turns - 1) ? 1 : 0;
    }
    double best = -kRounding * worth_; // less would go to and fro
    Index to = kInvalidIndex, from = kInvalidIndex;
    for (Index i = 0; i < count; ++i)
    {
      for (Index j = 0; j < count && mayGain[i] != 0; ++j)
      {
        if (mayLose[j] == 0 || i == j || places_[i].region != places_[j].region)
        {
          continue;
        }
        const double change = product_(i, i) + product_(j, j) - 2 * product_(i, j) +
          2 * (gain_(i) - gain_(j)) +
          worth_ * ((places_[i].turns < 4 ? -1 : 1) + (places_[j].turns > 4 ? -1 : 1));
        if (change < best)
        {
          best = change;
          to = i;
          from = j;
        }
      }
    }
    if (to == kInvalidIndex)
    {
      return false;
    }
    ++places_[to].turns;
    --places_[from].turns;
    gain_ += product_.col(to) - product_.col(from);
    return true;
  }

  std::vector<ConePlace> places_;
  std::vector<std::vector<Index>> neighbours_; ///< places joined by an edge
  Eigen::MatrixXd product_;                    ///< of the factors of single turns
  Eigen::VectorXd gain_;                       ///< products with the factor of all turns
  double worth_;
};

/// What an irregular vertex more has to take off the mean square of the error: as much as 20 % too large quads on a
/// fortieth of the surface.
constexpr double kWorthOfVertex = 1e-3;
/// Where sizes are asked for at places: as much as a factor of kMetFactor on so many quads.
constexpr double kQuadsOfVertex = 5;

double worthOfVertex(const SizeConeOptions& options)
{
  const double each = std::log(kMetFactor) * std::log(kMetFactor);
  return options.sizes == SizeWish::AtPlaces
    ? std::min(kWorthOfVertex, kQuadsOfVertex * each / std::max(options.quads, 1.0))
    : kWorthOfVertex;
}

} // namespace

double sizeError(const Mesh& mesh, const FieldTopology& topology, const std::vector<int>& turns)
{
  const ConformalFactor factor(mesh, topology);
  return std::sqrt(factor.meanSquare(factor.ofTurns(topology, turns)));
}

std::vector<int> valencesForSizes(const Mesh& mesh, const FieldTopology& topology,
  const std::vector<int>& turns, const std::vector<int>& asked, const SizeConeOptions& options)
{
  std::vector<ConePlace> places = placesOf(mesh, topology, turns, asked, options.sizes);
  if (places.empty())
  {
    return {};
  }
  const ConformalFactor factor(mesh, topology);
  TurnPlacement placement(
    mesh, std::move(places), factor, factor.ofTurns(topology, turns), worthOfVertex(options));
  if (!placement.improve())
  {
    return {};
  }
  // All are fixed: what is left free would be moved by the flow, which knows nothing of sizes.
  std::vector<int> targets = asked;
  targets.resize(mesh.vertexCount(), 0);
  for (std::size_t i = 0; i < turns.size(); ++i)
  {
    int& target = targets[topology.fans[i].vertex];
    target = !topology.fans[i].sector && target == 0 ? turns[i] : target;
  }
  for (const ConePlace& place : placement.places())
  {
    targets[place.vertex] = place.turns;
  }
  return targets;
}

} // namespace quadrille
