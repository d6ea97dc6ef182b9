// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/RoundedMap.h"

#include "Base/Progress.h"
#include "Mesh/Topology.h"
#include "Numerics/ReducedTriangles.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace quadrille
{
namespace
{

constexpr Index kFreeUnknown = kInvalidIndex; ///< a variable that need not be whole
constexpr Index kZero = kInvalidIndex - 1;    ///< one that is 0 whatever the unknowns are

/// An integer vertex lies best at the origin, else a vertex of an isoline: then what must be whole is so.
std::vector<std::uint8_t> rankOf(const Mesh& mesh, const std::vector<std::uint8_t>& integerVertex)
{
  std::vector<std::uint8_t> rank = constrainedVertices(mesh);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    rank[v] = integerVertex[v] != 0 ? 2 : rank[v];
  }
  return rank;
}

} // namespace

RoundedMap::RoundedMap(const Mesh& mesh, const CrossField& field, double edgeLength)
  : mesh_(mesh), integerVertex_(integerVertices(mesh, field)),
    space_(mesh, field, edgeLength, rankOf(mesh, integerVertex_))
{
  if (!space_.solved())
  {
    status_ = { StatusCode::NotConverged,
      "the equations need more than 63 bits; fewer singularities would help" };
    return;
  }
  collectForms(field);
  std::optional<IntegerLattice> lattice =
    integerLattice(static_cast<Index>(space_.basis().free.size()), forms_, derived_);
  if (!lattice)
  {
    status_ = { StatusCode::NotConverged,
      "the integers need more than 63 bits; fewer singularities would help" };
    return;
  }
  lattice_ = std::move(*lattice);
  if (!solvePoisson())
  {
    status_ = { StatusCode::NotConverged, "the Poisson equation has no unique solution" };
    return;
  }
  relateIntegers();
}

/// What must be whole: translations, one image of each integer vertex (the others follow), and the
/// coordinate across each constrained edge. Variables that are always equal share a form.
void RoundedMap::collectForms(const CrossField& field)
{
  const CutGraph& graph = space_.graph();
  const ExactBasis& basis = space_.basis();
  std::vector<std::uint8_t> whole(basis.rows.size(), 0);
  std::vector<bool> seen(mesh_.vertexCount(), false);
  for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
  {
    const Index v = mesh_.origin[h];
    if (integerVertex_[v] != 0 && !seen[v])
    {
      seen[v] = true;
      whole[2 * graph.wedge[h]] = whole[2 * graph.wedge[h] + 1] = 1;
    }
    if (mesh_.isConstrained(h))
    {
      const int axis = (field.alignment[h] + graph.comb[Mesh::face(h)]) & 1;
      const Index across = static_cast<Index>(1 - axis);
      whole[2 * graph.wedge[h] + across] = whole[2 * graph.wedge[Mesh::next(h)] + across] = 1;
    }
  }
  std::fill(whole.begin() + 2 * graph.wedges, whole.end(), std::uint8_t{ 1 });

  std::map<std::pair<IntegerRow, std::int64_t>, Index> known;
  form_.assign(basis.rows.size(), kFreeUnknown);
  for (std::size_t i = 0; i < whole.size(); ++i)
  {
    pollNowAndThen(i);
    const ExactBasis::Row& row = basis.rows[i];
    if (whole[i] != 0)
    {
      const auto [place, added] =
        known.insert({ { row.numerators, row.denominator }, static_cast<Index>(forms_.size()) });
      form_[i] = row.numerators.empty() ? kZero : place->second;
      if (added && !row.numerators.empty())
      {
        forms_.push_back(row);
        derived_.push_back(i >= 2 * std::size_t{ graph.wedges } ? 1 : 0);
      }
    }
  }
}

bool RoundedMap::solvePoisson()
{
  ReducedTriangles system(space_.problem());
  assembleFit(space_.problem(), system);
  if (system.unknowns() == 0)
  {
    return false;
  }
  poisson_.analyze(system.hessian());
  if (!poisson_.factorize(system.hessian(), kLastDigits * system.hessian().diagonal().mean()))
  {
    return false;
  }
  solution_ = -poisson_.solve(system.gradient());
  return solution_.allFinite();
}

void RoundedMap::relateIntegers()
{
  std::vector<Eigen::Triplet<double>> triplets;
  for (std::size_t k = 0; k < lattice_.coordinates.size(); ++k)
  {
    for (const auto& [form, factor] : lattice_.coordinates[k])
    {
      const ExactBasis::Row& row = forms_[form];
      for (const auto& [unknown, numerator] : row.numerators)
      {
        triplets.emplace_back(static_cast<int>(unknown), static_cast<int>(k),
          factor * static_cast<double>(numerator) / static_cast<double>(row.denominator));
      }
    }
  }
  coordinates_.resize(solution_.size(), static_cast<Eigen::Index>(lattice_.coordinates.size()));
  coordinates_.setFromTriplets(triplets.begin(), triplets.end());
  schur_ = poisson_.schur(coordinates_);
}

std::vector<FixedVec2> RoundedMap::make(double targetQuads, RoundingOrder order) const
{
  const double area = space_.area(solution_);
  const double scale = targetQuads > 0 && area > 0 ? std::sqrt(targetQuads / area) : 1.0;
  const Eigen::VectorXd start = scale * solution_;
  const RoundedForms rounded =
    roundForms(schur_, coordinates_.transpose() * start, lattice_.composite, order);
  return unfold(start + poisson_.solve(coordinates_ * rounded.multiplier), rounded.value);
}

/// One image of each vertex is rounded to the grid; the others follow by whole transitions, which close round every
/// vertex because the forms fulfil the equations exactly.
std::vector<FixedVec2> RoundedMap::unfold(
  const Eigen::VectorXd& y, const std::vector<std::int64_t>& coordinates) const
{
  const CutGraph& graph = space_.graph();
  const Eigen::VectorXd x = space_.problem().basis * y;
  std::vector<std::int64_t> value(forms_.size(), 0);
  for (std::size_t f = 0; f < forms_.size(); ++f)
  {
    for (const auto& [coordinate, factor] : lattice_.forms[f])
    {
      value[f] += factor * coordinates[coordinate] * kOne;
    }
  }
  const auto valueOf = [&](Index variable)
  { return form_[variable] == kZero ? 0 : value[form_[variable]]; };
  const auto alongSegment = [&](Index h)
  {
    const Index s = graph.segment[h], t = 2 * (graph.wedges + s);
    return Transition{ graph.rotation[s], { valueOf(t), valueOf(t + 1) } };
  };
  const auto across = [&](Index h)
  {
    if (graph.segment[h] != kInvalidIndex)
    {
      return alongSegment(h);
    }
    const Index g = mesh_.twin[h];
    return graph.segment[g] != kInvalidIndex ? alongSegment(g).inverse() : Transition();
  };

  std::vector<FixedVec2> uv(mesh_.origin.size());
  const std::vector<Index> outgoing = outgoingHalfEdges(mesh_);
  std::vector<std::pair<Index, Transition>> fan;
  for (Index v = 0; v < mesh_.vertexCount(); ++v)
  {
    if (outgoing[v] == kInvalidIndex)
    {
      continue;
    }
    fan.assign(1, { outgoing[v], Transition() });
    for (Index h = mesh_.rotateCounterclockwise(outgoing[v]);
         h != kInvalidIndex && h != outgoing[v]; h = mesh_.rotateCounterclockwise(h))
    {
      // From the face before, over the edge that both share.
      fan.emplace_back(h, across(Mesh::previous(fan.back().first)).after(fan.back().second));
    }
    const Eigen::Index first = 2 * Eigen::Index{ graph.wedge[outgoing[v]] };
    FixedVec2 master = toFixed(Vector2(x.segment<2>(first)));
    for (const auto& [corner, place] : fan)
    {
      for (Index i = 0; i < 2; ++i)
      {
        const Index variable = 2 * graph.wedge[corner] + i;
        if (form_[variable] == kFreeUnknown)
        {
          continue;
        }
        // The coordinate of this corner, taken back into the chart of the first one.
        FixedVec2 p = -place.translation;
        (i == 0 ? p.u : p.v) += valueOf(variable);
        p = rotate(p, -place.rotation);
        const bool alongU = ((static_cast<int>(i) + place.rotation) & 1) == 0;
        (alongU ? master.u : master.v) = alongU ? p.u : p.v;
      }
    }
    for (const auto& [corner, place] : fan)
    {
      uv[corner] = rotate(place.apply(master), -graph.comb[Mesh::face(corner)]);
    }
  }
  return uv;
}

} // namespace quadrille
