// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/IntegerMap.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{

namespace
{

constexpr double kPi = 3.14159265358979323846;

double angleBetween(const Vector2& a, const Vector2& b)
{
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
}

/// Quarter turns round every vertex; every determinant must be positive for this to mean anything.
template <typename VectorOf>
std::vector<int> windings(const IntegerDomain& domain, VectorOf vectorOf)
{
  const Index vertices =
    domain.origin.empty() ? 0 : *std::max_element(domain.origin.begin(), domain.origin.end()) + 1;
  std::vector<double> angle(vertices, 0);
  for (Index h = 0; h < domain.halfEdgeCount(); ++h)
  {
    angle[domain.origin[h]] += angleBetween(vectorOf(h), -vectorOf(Mesh::previous(h)));
  }
  std::vector<int> turns(vertices);
  std::transform(angle.begin(), angle.end(), turns.begin(),
    [](double a) { return static_cast<int>(std::lround(a / (kPi / 2))); });
  return turns;
}

/// Weights near the Dirichlet energy of the difference of the two maps, that is the squared relative error
/// of every quad's size; divided by the length so that short edges do not grow for nothing.
void setWeights(IntegerDomain& domain)
{
  std::vector<double> cotangent(domain.halfEdgeCount());
  for (Index h = 0; h < domain.halfEdgeCount(); ++h)
  {
    const Vector2 a = -domain.wanted[Mesh::next(h)], b = domain.wanted[Mesh::previous(h)];
    cotangent[h] = b.dot(a) / (b.x() * a.y() - b.y() * a.x());
  }
  domain.weight.resize(domain.halfEdgeCount());
  for (Index h = 0; h < domain.halfEdgeCount(); ++h)
  {
    const Index g = domain.twin[h];
    const double sum = cotangent[h] + (g == kInvalidIndex ? cotangent[h] : cotangent[g]);
    domain.weight[h] = std::clamp(sum, 0.1, 4.0) / std::max(domain.wanted[h].norm(), 0.25);
  }
}

std::int64_t awayFromZero(double x)
{
  const std::int64_t n = std::llround(x);
  return n != 0 ? n : (x < 0 ? -1 : 1);
}

FixedVec2 nearestNonZero(const Vector2& p, IntegerDomain::Axis axis)
{
  if (axis == IntegerDomain::kOnlyU)
  {
    return { awayFromZero(p.x()), 0 };
  }
  if (axis == IntegerDomain::kOnlyV)
  {
    return { 0, awayFromZero(p.y()) };
  }
  const FixedVec2 n{ std::llround(p.x()), std::llround(p.y()) };
  if (n != FixedVec2{})
  {
    return n;
  }
  return std::abs(p.x()) >= std::abs(p.y()) ? FixedVec2{ awayFromZero(p.x()), 0 }
                                            : FixedVec2{ 0, awayFromZero(p.y()) };
}

} // namespace

IntegerDomain IntegerDomain::from(const UvMesh& mesh)
{
  IntegerDomain domain;
  std::vector<Index> compact(mesh.origin.size(), kInvalidIndex);
  for (Index h = 0; h < mesh.origin.size(); ++h)
  {
    if (mesh.alive[Mesh::face(h)])
    {
      compact[h] = static_cast<Index>(domain.slot.size());
      domain.slot.push_back(h);
    }
  }
  for (const Index h : domain.slot)
  {
    const bool boundary = mesh.twin[h] == kInvalidIndex;
    domain.hasBoundary = domain.hasBoundary || boundary;
    domain.origin.push_back(mesh.origin[h]);
    domain.twin.push_back(boundary ? kInvalidIndex : compact[mesh.twin[h]]);
    domain.rotation.push_back(mesh.rotation[h]);
    const FixedVec2 d = mesh.vector(h);
    domain.wanted.push_back(toDouble(d));
    const bool constrained = boundary || (mesh.flags[h] & kUvConstrained) != 0;
    domain.axis.push_back(!constrained ? kFree : d.v == 0 ? kOnlyU : kOnlyV);
  }
  setWeights(domain);
  domain.turns = windings(domain, [&](Index h) { return domain.wanted[h]; });
  return domain;
}

void IntegerMap::round(double scale)
{
  for (Index h = 0; h < domain_->halfEdgeCount(); ++h)
  {
    const Index g = domain_->twin[h];
    if (g == kInvalidIndex || h < g)
    {
      q_[h] = nearestNonZero(scale * domain_->wanted[h], domain_->axis[h]);
    }
    if (g != kInvalidIndex && h < g)
    {
      q_[g] = -rotate(q_[h], domain_->rotation[h]);
    }
  }
}

void IntegerMap::shift(Index h, FixedVec2 e)
{
  q_[h] = q_[h] + e;
  const Index g = domain_->twin[h];
  if (g != kInvalidIndex)
  {
    q_[g] = q_[g] - rotate(e, domain_->rotation[h]);
  }
}

bool IntegerMap::mayShift(Index h, FixedVec2 e) const
{
  const IntegerDomain::Axis axis = domain_->axis[h];
  return axis == IntegerDomain::kFree || (axis == IntegerDomain::kOnlyU ? e.v == 0 : e.u == 0);
}

double IntegerMap::energyChange(Index h, FixedVec2 e) const
{
  const double du = static_cast<double>(e.u), dv = static_cast<double>(e.v);
  const Vector2& wanted = domain_->wanted[h];
  return domain_->weight[h] *
    (du * (2 * (static_cast<double>(q_[h].u) - wanted.x()) + du) +
      dv * (2 * (static_cast<double>(q_[h].v) - wanted.y()) + dv));
}

double IntegerMap::energy() const
{
  double sum = 0;
  for (Index h = 0; h < domain_->halfEdgeCount(); ++h)
  {
    const Vector2 q(static_cast<double>(q_[h].u), static_cast<double>(q_[h].v));
    const double share = domain_->twin[h] == kInvalidIndex ? 1.0 : 0.5;
    sum += share * domain_->weight[h] * (q - domain_->wanted[h]).squaredNorm();
  }
  return sum;
}

double IntegerMap::area() const
{
  double sum = 0;
  for (Index f = 0; f < domain_->faceCount(); ++f)
  {
    sum += 0.5 * static_cast<double>(determinant(f));
  }
  return sum;
}

bool IntegerMap::isValid() const
{
  for (Index f = 0; f < domain_->faceCount(); ++f)
  {
    if (defect(f) != FixedVec2{} || determinant(f) <= 0)
    {
      return false;
    }
  }
  return windings(*domain_,
           [&](Index h) {
             return Vector2(static_cast<double>(q_[h].u), static_cast<double>(q_[h].v));
           }) == domain_->turns;
}

} // namespace quadrille
