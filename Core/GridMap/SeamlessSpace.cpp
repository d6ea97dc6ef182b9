// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/SeamlessSpace.h"

#include "Base/Lists.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"
#include "Requests/SeamRequests.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

namespace quadrille
{
namespace
{

/// The equations of a seamless map. Variables: u and v of every wedge, then both coordinates of the
/// translation of every segment.
class Equations
{
public:
  Equations(const Mesh& mesh, const CrossField& field, const CutGraph& graph,
    const std::vector<std::uint8_t>& rank)
    : mesh_(mesh), field_(field), graph_(graph)
  {
    fixOneWedgePerComponent(rank);
    joinSegments();
    alignConstrainedEdges();
    for (const SeamEdges& seam : field.seams)
    {
      addSeam(seam);
    }
  }

  Index variables() const
  {
    return 2 * (graph_.wedges + static_cast<Index>(graph_.rotation.size()));
  }
  const std::vector<IntegerRow>& rows() const { return rows_; }

private:
  void fixOneWedgePerComponent(const std::vector<std::uint8_t>& rank)
  {
    std::vector<Index> corner(graph_.components, kInvalidIndex);
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      Index& best = corner[graph_.component[Mesh::face(h)]];
      if (best == kInvalidIndex ||
        (!rank.empty() && rank[mesh_.origin[h]] > rank[mesh_.origin[best]]))
      {
        best = h;
      }
    }
    for (const Index h : corner)
    {
      rows_.push_back({ { 2 * graph_.wedge[h], 1 } });
      rows_.push_back({ { 2 * graph_.wedge[h] + 1, 1 } });
    }
  }

  /// Right image = R90^r left image + translation.
  void join(Index left, Index right, Index segment)
  {
    const Index t = 2 * (graph_.wedges + segment);
    for (Index i = 0; i < 2; ++i)
    {
      rows_.push_back({ { 2 * right + i, 1 }, { t + i, -1 },
        turnedTerm(2 * left, graph_.rotation[segment], i, -1) });
    }
  }

  void joinSegments()
  {
    Index last = kInvalidIndex;
    for (const Index h : graph_.path)
    {
      const Index g = mesh_.twin[h];
      const Index segment = graph_.segment[h];
      if (segment != last)
      {
        join(graph_.wedge[h], graph_.wedge[Mesh::next(g)], segment);
      }
      join(graph_.wedge[Mesh::next(h)], graph_.wedge[g], segment);
      last = segment;
    }
  }

  void alignConstrainedEdges()
  {
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      if (!mesh_.isConstrained(h) || (!mesh_.isBoundary(h) && mesh_.twin[h] < h))
      {
        continue; // the twin says the same through the seam
      }
      const int axis = (field_.alignment[h] + graph_.comb[Mesh::face(h)]) & 1;
      const Index coordinate = static_cast<Index>(1 - axis);
      const Index a = graph_.wedge[h], b = graph_.wedge[Mesh::next(h)];
      rows_.push_back({ { 2 * a + coordinate, 1 }, { 2 * b + coordinate, -1 } });
    }
  }

  /// Both parts are equally long.
  void addSeam(const SeamEdges& seam)
  {
    std::map<Index, std::int64_t> row;
    const auto add = [&](Index h, std::int64_t sign)
    {
      const int direction = (field_.alignment[h] + graph_.comb[Mesh::face(h)]) & 3;
      const Index coordinate = static_cast<Index>(direction & 1);
      const std::int64_t along = direction < 2 ? sign : -sign;
      row[2 * graph_.wedge[Mesh::next(h)] + coordinate] += along;
      row[2 * graph_.wedge[h] + coordinate] -= along;
    };
    for (const Index h : seam.left)
    {
      add(h, 1);
    }
    for (const Index h : seam.right)
    {
      add(h, -1);
    }
    IntegerRow terms;
    for (const auto& [variable, factor] : row)
    {
      if (factor != 0)
      {
        terms.emplace_back(variable, factor);
      }
    }
    if (!terms.empty())
    {
      rows_.push_back(std::move(terms));
    }
  }

  /// Of sign * R90^rotation (u, v) one coordinate.
  static std::pair<Index, std::int64_t> turnedTerm(
    Index u, int rotation, Index coordinate, std::int64_t sign)
  {
    switch (rotation & 3)
    {
      case 1:
        return coordinate == 0 ? std::pair(u + 1, -sign) : std::pair(u, sign);
      case 2:
        return { u + coordinate, -sign };
      case 3:
        return coordinate == 0 ? std::pair(u + 1, sign) : std::pair(u, -sign);
      default:
        return { u + coordinate, sign };
    }
  }

  const Mesh& mesh_;
  const CrossField& field_;
  const CutGraph& graph_;
  std::vector<IntegerRow> rows_;
};

/// A linear form of the free unknowns, exact: numerators over a common denominator that is left out.
using Form = IntegerRow;

/// a - b up to a positive factor.
Form difference(const ExactBasis::Row& a, const ExactBasis::Row& b, std::int64_t common)
{
  Form result;
  for (const auto& [id, numerator] : a.numerators)
  {
    result.emplace_back(id, numerator * (common / a.denominator));
  }
  for (const auto& [id, numerator] : b.numerators)
  {
    const auto found = std::lower_bound(result.begin(), result.end(), id,
      [](const auto& term, Index wanted) { return term.first < wanted; });
    const std::int64_t value = -numerator * (common / b.denominator);
    if (found != result.end() && found->first == id)
    {
      found->second += value;
    }
    else
    {
      result.insert(found, { id, value });
    }
  }
  eraseIf(result, [](const auto& term) { return term.second == 0; });
  return result;
}

bool areEqual(const ExactBasis::Row& a, const ExactBasis::Row& b)
{
  return a.denominator == b.denominator && a.numerators == b.numerators;
}

bool areParallel(const Form& a, const Form& b)
{
  if (a.empty() || b.empty())
  {
    return true;
  }
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    if (a.size() != b.size() || a[i].first != b[i].first ||
      Int128{ a[i].second } * b[0].second != Int128{ b[i].second } * a[0].second)
    {
      return false;
    }
  }
  return true;
}

} // namespace

SeamlessSpace::SeamlessSpace(const Mesh& mesh, const CrossField& field, double edgeLength,
  const std::vector<std::uint8_t>& rank)
  : mesh_(mesh), graph_(cutAlongField(mesh, field))
{
  const Equations equations(mesh, field, graph_, rank);
  std::optional<ExactBasis> basis = eliminateExactly(equations.variables(), equations.rows());
  if (basis)
  {
    basis_ = std::move(*basis);
    buildProblem(field, edgeLength);
  }
}

void SeamlessSpace::buildProblem(const CrossField& field, double edgeLength)
{
  const Index coordinates = 2 * graph_.wedges;
  std::vector<Eigen::Triplet<double>> triplets;
  for (Index i = 0; i < coordinates; ++i)
  {
    for (const auto& [id, numerator] : basis_.rows[i].numerators)
    {
      triplets.emplace_back(static_cast<int>(i), static_cast<int>(id),
        static_cast<double>(numerator) / static_cast<double>(basis_.rows[i].denominator));
    }
  }
  problem_.basis.resize(coordinates, basis_.free.size());
  problem_.basis.setFromTriplets(triplets.begin(), triplets.end());
  problem_.offset = Eigen::VectorXd::Zero(coordinates);
  for (Index f = 0; f < mesh_.faceCount(); ++f)
  {
    const Index* wedge = &graph_.wedge[3 * f];
    addTriangle(
      problem_, { wedge[0], wedge[1], wedge[2] }, mesh_, field, f, graph_.comb[f], edgeLength);
  }
  guardEdges(problem_,
    guardedEdges(
      mesh_, field, edgeLength, [&](Index h) { return graph_.wedge[h]; },
      [&](Index f) { return graph_.comb[f]; }));
}

std::vector<Index> SeamlessSpace::collapsedFaces(const std::vector<Index>& candidates) const
{
  std::vector<Index> result;
  for (const Index f : candidates)
  {
    const Index* w = &graph_.wedge[3 * f];
    std::int64_t common = 1;
    for (int i = 0; i < 6; ++i)
    {
      common = std::lcm(common, basis_.rows[2 * w[i / 2] + i % 2].denominator);
    }
    const auto edge = [&](int corner, int coordinate)
    {
      return difference(
        basis_.rows[2 * w[corner] + coordinate], basis_.rows[2 * w[0] + coordinate], common);
    };
    const Form u1 = edge(1, 0), v1 = edge(1, 1), u2 = edge(2, 0), v2 = edge(2, 1);
    const bool edgeIsPoint =
      (u1.empty() && v1.empty()) || (u2.empty() && v2.empty()) || (u1 == u2 && v1 == v2);
    const bool noExtent = (u1.empty() && u2.empty()) || (v1.empty() && v2.empty());
    const bool proportional = u1 == v1 && u2 == v2 && areParallel(u1, v1);
    if (edgeIsPoint || noExtent || proportional)
    {
      result.push_back(f);
    }
  }
  return result;
}

std::vector<Index> SeamlessSpace::flattenedChords() const
{
  const std::vector<std::uint8_t> onCurve = constrainedVertices(mesh_);
  std::vector<Index> result;
  for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
  {
    if (mesh_.isConstrained(h) || mesh_.twin[h] < h || onCurve[mesh_.origin[h]] == 0 ||
      onCurve[mesh_.target(h)] == 0)
    {
      continue;
    }
    const Index a = 2 * graph_.wedge[h], b = 2 * graph_.wedge[Mesh::next(h)];
    if (areEqual(basis_.rows[a], basis_.rows[b]) ||
      areEqual(basis_.rows[a + 1], basis_.rows[b + 1]))
    {
      result.push_back(h);
    }
  }
  return result;
}

double SeamlessSpace::area(const Eigen::VectorXd& y) const
{
  const Eigen::VectorXd x = problem_.basis * y;
  double area = 0;
  for (Index f = 0; f < mesh_.faceCount(); ++f)
  {
    const auto point = [&](int i)
    { return Vector2(x.segment<2>(2 * Eigen::Index(graph_.wedge[3 * f + i]))); };
    area += parallelogram(point(1) - point(0), point(2) - point(0)) / 2;
  }
  return area;
}

std::vector<FixedVec2> SeamlessSpace::snap(const Eigen::VectorXd& y) const
{
  std::vector<std::int64_t> fixed(y.size());
  for (Eigen::Index i = 0; i < y.size(); ++i)
  {
    const double step = static_cast<double>(basis_.step[i]);
    fixed[i] = std::llround(y[i] * static_cast<double>(kOne) / step) * basis_.step[i];
  }
  std::vector<std::int64_t> x(2 * std::size_t{ graph_.wedges });
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    Int128 sum = 0;
    for (const auto& [id, numerator] : basis_.rows[i].numerators)
    {
      sum += Int128{ numerator } * fixed[id];
    }
    x[i] = static_cast<std::int64_t>(sum / basis_.rows[i].denominator);
  }
  std::vector<FixedVec2> uv(mesh_.origin.size());
  for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
  {
    const Index w = graph_.wedge[h];
    uv[h] = rotate({ x[2 * w], x[2 * w + 1] }, -graph_.comb[Mesh::face(h)]);
  }
  return uv;
}

} // namespace quadrille
