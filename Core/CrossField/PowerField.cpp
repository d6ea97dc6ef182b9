// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/PowerField.h"

#include "Base/Angles.h"
#include "Base/Refuse.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>

namespace quadrille
{
namespace
{

using Complex = std::complex<double>;
constexpr int kDiffusionSteps = 8; // the singularities hardly move after these
// A guide of weight 1 against the Laplacian, times s^2: the field turns away from it within s / 4.
constexpr double kGuideStrengthOfField = 16;

// Unknown index of each free face, and whether its component (across unconstrained edges) holds a fixed face.
struct FreeFaces
{
  std::vector<Index> unknown; // #F, kInvalidIndex when fixed
  std::vector<Index> face;    // #unknowns
  std::vector<Index> loose;   // #unknowns; id of the component without fixed faces or kInvalidIndex
  Index looseCount = 0;
  std::vector<std::uint8_t> guided; // #looseCount; whether it has guides

  bool looseWithoutGuides(std::size_t i) const
  {
    return loose[i] != kInvalidIndex && guided[loose[i]] == 0;
  }
  bool anyGuided() const
  {
    return std::find(guided.begin(), guided.end(), std::uint8_t{ 1 }) != guided.end();
  }
};

FreeFaces numberFreeFaces(const Mesh& mesh, const FieldConstraints& constraints)
{
  FreeFaces free;
  free.unknown.assign(mesh.faceCount(), kInvalidIndex);
  const std::vector<Index> region = regionsOf(mesh);
  std::vector<std::uint8_t> isHeld(mesh.faceCount(), 0); // per region
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    isHeld[region[f]] |= constraints.fixed[f];
  }
  std::vector<Index> looseOf(mesh.faceCount(), kInvalidIndex); // per region
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    if (region[f] == f && isHeld[f] == 0)
    {
      looseOf[f] = free.looseCount++;
    }
    if (constraints.fixed[f] == 0)
    {
      free.unknown[f] = static_cast<Index>(free.face.size());
      free.face.push_back(f);
      free.loose.push_back(looseOf[region[f]]);
    }
  }
  free.guided.assign(free.looseCount, 0);
  for (std::size_t i = 0; i < free.face.size(); ++i)
  {
    if (free.loose[i] != kInvalidIndex && constraints.strength(free.face[i]) > 0)
    {
      free.guided[free.loose[i]] = 1;
    }
  }
  return free;
}

// The connection Laplacian of the fourth power on the free faces, and what fixed faces put on the right.
class ConnectionSystem
{
public:
  ConnectionSystem(
    const FieldTopology& topology, const FreeFaces& free, const FieldConstraints& constraints)
    : size_(static_cast<Eigen::Index>(free.face.size())), mass_(size_),
      fixedPart_(Eigen::VectorXcd::Zero(size_)), guides_(Eigen::VectorXd::Zero(size_)),
      guidePart_(Eigen::VectorXcd::Zero(size_))
  {
    Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(size_);
    for (const std::array<Index, 2>& edge : topology.edges)
    {
      assembleEdge(topology, free, constraints.angle, edge, diagonal);
    }
    for (Eigen::Index i = 0; i < size_ && !constraints.guideStrength.empty(); ++i)
    {
      const Index f = free.face[i];
      guides_(i) = constraints.guideStrength[f];
      guidePart_(i) = guides_(i) * std::polar(1.0, 4 * constraints.guideAngle[f]);
    }
    for (Eigen::Index i = 0; i < size_; ++i)
    {
      mass_(i) = topology.area[free.face[i]];
      entries_.emplace_back(i, i, diagonal(i));
    }
    laplacian_.resize(size_, size_);
    laplacian_.setFromTriplets(entries_.begin(), entries_.end());
  }

  Eigen::Index size() const { return size_; }
  const Eigen::VectorXd& mass() const { return mass_; }
  const Eigen::VectorXcd& fixedPart() const { return fixedPart_; }
  const Eigen::VectorXcd& guidePart() const { return guidePart_; }

  // Factors laplaceWeight L + massWeight M + guideWeight G; the symbolic part is done once.
  void factorize(double laplaceWeight, double massWeight, double guideWeight)
  {
    Eigen::SparseMatrix<Complex> matrix = laplaceWeight * laplacian_;
    for (Eigen::Index i = 0; i < size_; ++i)
    {
      matrix.coeffRef(i, i) += massWeight * mass_(i) + guideWeight * guides_(i);
    }
    if (!analyzed_)
    {
      solver_.analyzePattern(matrix);
      analyzed_ = true;
    }
    solver_.factorize(matrix);
    if (solver_.info() != Eigen::Success)
    {
      throw std::logic_error("cross field: a positive definite system could not be factored");
    }
  }
  Eigen::VectorXcd solve(const Eigen::VectorXcd& right) const { return solver_.solve(right); }

private:
  void assembleEdge(const FieldTopology& topology, const FreeFaces& free,
    const std::vector<double>& fixedAngle, const std::array<Index, 2>& edge,
    Eigen::VectorXd& diagonal)
  {
    const Index f = Mesh::face(edge[0]);
    const Index g = Mesh::face(edge[1]);
    const Index i = free.unknown[f];
    const Index j = free.unknown[g];
    const double w = topology.edgeWeight[edge[0]];
    const Complex carry =
      std::polar(1.0, 4 * topology.transport[edge[0]]); // frame of f -> frame of g
    if (i != kInvalidIndex)
    {
      diagonal(i) += w;
    }
    if (j != kInvalidIndex)
    {
      diagonal(j) += w;
    }
    if (i != kInvalidIndex && j != kInvalidIndex)
    {
      // The lower triangle is all that the factorization reads.
      const Complex entry = i < j ? -w * carry : -w * std::conj(carry);
      entries_.emplace_back(std::max(i, j), std::min(i, j), entry);
    }
    else if (j != kInvalidIndex)
    {
      fixedPart_(j) += w * carry * std::polar(1.0, 4 * fixedAngle[f]);
    }
    else if (i != kInvalidIndex)
    {
      fixedPart_(i) += w * std::conj(carry) * std::polar(1.0, 4 * fixedAngle[g]);
    }
  }

  Eigen::Index size_;
  Eigen::VectorXd mass_;
  Eigen::VectorXcd fixedPart_;
  Eigen::VectorXd guides_;
  Eigen::VectorXcd guidePart_;
  std::vector<Eigen::Triplet<Complex>> entries_;
  Eigen::SparseMatrix<Complex> laplacian_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<Complex>> solver_;
  bool analyzed_ = false;
};

// Sum over the edges of face f of bend x length along the edge, as a second power: the deviator of the
// curvature tensor, which turns by twice the angle of its principal directions.
Complex bendingDeviator(const Mesh& mesh, const FieldTopology& topology, Index f)
{
  Complex sum = 0;
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    if (mesh.isBoundary(h))
    {
      continue;
    }
    const Vector3 a = mesh.doubleAreaNormal(f);
    const Vector3 b = mesh.doubleAreaNormal(Mesh::face(mesh.twin[h]));
    const Vector3 axis = a.cross(b);
    const double bend = std::atan2(axis.norm(), a.dot(b)); // convex: axis along h
    const double sign = axis.dot(mesh.edgeVector(h)) < 0 ? -1.0 : 1.0;
    sum += sign * bend * topology.edgeLength[h] * std::polar(1.0, 2 * topology.direction[h]);
  }
  return sum;
}

// Principal directions as a fourth-power field, strong where curvature is anisotropic: a start for
// components without constraints that turns with the mesh.
Eigen::VectorXcd principalField(
  const Mesh& mesh, const FieldTopology& topology, const FreeFaces& free)
{
  std::vector<Complex> deviator(mesh.faceCount());
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    deviator[f] = bendingDeviator(mesh, topology, f);
  }
  // Three edges are few directions to fit a tensor to: take in two rings of neighbours.
  constexpr int kPasses = 2;
  for (int pass = 0; pass < kPasses; ++pass)
  {
    std::vector<Complex> sum = deviator;
    for (const std::array<Index, 2>& edge : topology.edges)
    {
      const Complex carry = std::polar(1.0, 2 * topology.transport[edge[0]]);
      sum[Mesh::face(edge[1])] += carry * deviator[Mesh::face(edge[0])];
      sum[Mesh::face(edge[0])] += std::conj(carry) * deviator[Mesh::face(edge[1])];
    }
    deviator.swap(sum);
  }
  Eigen::VectorXcd field(static_cast<Eigen::Index>(free.face.size()));
  double largest = 0;
  for (std::size_t i = 0; i < free.face.size(); ++i)
  {
    const Complex d = deviator[free.face[i]];
    field(static_cast<Eigen::Index>(i)) = std::abs(d) > 0 ? d * d / std::abs(d) : Complex(0);
    largest = std::max(largest, std::abs(d));
  }
  // A symmetric mesh may have no part of the smoothest field in its principal directions (an icosahedral
  // sphere has none): a weak field that knows no symmetry brings it in.
  const Vector3 skew =
    Vector3(0.48, 0.60, 0.64) * std::sqrt(std::sqrt(largest > 0 ? 1e-3 * largest : 1));
  for (std::size_t i = 0; i < free.face.size(); ++i)
  {
    const Vector3 x = mesh.edgeVector(3 * free.face[i]).normalized();
    const Vector3 n = x.cross(mesh.edgeVector(3 * free.face[i] + 1)).normalized();
    const Complex tangent(skew.dot(x), skew.dot(n.cross(x)));
    field(static_cast<Eigen::Index>(i)) += tangent * tangent * tangent * tangent;
  }
  return field;
}

// What `source` puts on the right in components without constraints (and, if asked, without guides); the fixed faces
// and guides elsewhere.
Eigen::VectorXcd rightSide(const ConnectionSystem& system, const FreeFaces& free,
  const Eigen::VectorXcd& source, bool followGuides)
{
  Eigen::VectorXcd right = system.fixedPart() + (followGuides ? 1.0 : 0.0) * system.guidePart();
  for (Eigen::Index i = 0; i < right.size(); ++i)
  {
    if (followGuides ? free.looseWithoutGuides(i) : free.loose[i] != kInvalidIndex)
    {
      right(i) = system.mass()(i) * source(i);
    }
  }
  return right;
}

// Scales each component without constraints to a unit sum of squares.
void normalizeLoose(const FreeFaces& free, Eigen::VectorXcd& field)
{
  std::vector<double> norm(free.looseCount, 0.0);
  for (Eigen::Index i = 0; i < field.size(); ++i)
  {
    if (free.loose[i] != kInvalidIndex)
    {
      norm[free.loose[i]] += std::norm(field(i));
    }
  }
  for (Eigen::Index i = 0; i < field.size(); ++i)
  {
    if (free.loose[i] != kInvalidIndex)
    {
      field(i) /= std::sqrt(std::max(norm[free.loose[i]], 1e-300));
    }
  }
}

// Harmonic where constraints reach. Elsewhere two candidates: principal directions, carried from where
// curvature is strongly anisotropic to where it is not, and the smoothest eigenfield, by power iterations. Where only
// guides reach, there is a third one, which comes first: harmonic between them.
std::vector<Eigen::VectorXcd> initialFields(ConnectionSystem& system, const FreeFaces& free,
  const Eigen::VectorXcd& principal, double totalArea)
{
  constexpr int kPowerSteps = 10;
  // A screening far below what constraints put in; it also keeps L invertible without any.
  system.factorize(1.0, 1.0 / totalArea, 1.0);
  std::vector<Eigen::VectorXcd> fields{ system.solve(rightSide(system, free, principal, true)) };
  if (free.anyGuided())
  {
    system.factorize(1.0, 1.0 / totalArea, 0.0);
    fields.push_back(system.solve(rightSide(system, free, principal, false)));
  }
  if (free.looseCount > 0)
  {
    Eigen::VectorXcd field = fields.back();
    for (int step = 0; step < kPowerSteps; ++step)
    {
      normalizeLoose(free, field);
      field = system.solve(rightSide(system, free, field, !free.anyGuided()));
    }
    fields.push_back(std::move(field));
  }
  return fields;
}

void normalizeEach(Eigen::VectorXcd& field)
{
  for (Eigen::Index i = 0; i < field.size(); ++i)
  {
    const double length = std::abs(field(i));
    field(i) = length > 1e-300 ? field(i) / length : Complex(1.0);
  }
}

// The system has to be factored as time (L + G) + M.
void diffuseAndNormalize(const ConnectionSystem& system, Eigen::VectorXcd& field, double time)
{
  for (int step = 0; step < kDiffusionSteps; ++step)
  {
    normalizeEach(field);
    const Eigen::VectorXcd right = (system.mass().array() * field.array()).matrix() +
      time * (system.fixedPart() + system.guidePart());
    field = system.solve(right);
  }
}

} // namespace

FieldConstraints fieldConstraints(const Mesh& mesh, const FieldTopology& topology)
{
  FieldConstraints constraints;
  constraints.fixed.assign(mesh.faceCount(), 0);
  constraints.angle.assign(mesh.faceCount(), 0.0);
  constraints.alignment.assign(mesh.halfEdgeCount(), -1);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const int count = constrainedEdges(mesh, f);
    constraints.fixed[f] = count > 0 ? 1 : 0;
    for (Index h = 3 * f; h < 3 * f + 3 && count > 0; ++h)
    {
      const Index previous = Mesh::previous(h);
      if (!mesh.isConstrained(h) || (count == 2 && !mesh.isConstrained(previous)))
      {
        continue;
      }
      const double lean = count == 2 ? 0.5 * topology.cornerAngle[h] - 0.25 * kPi : 0.0;
      constraints.angle[f] = topology.direction[h] + lean;
      constraints.alignment[h] = 0;
      if (count >= 2)
      {
        // One quarter turn from h to the other edge, which comes in: 1 + 2 modulo 4.
        constraints.alignment[previous] = 3;
      }
      if (count == 3)
      {
        constraints.alignment[Mesh::next(h)] = 1;
      }
      break;
    }
  }
  return constraints;
}

void addGuides(const Mesh& mesh, const FieldTopology& topology, const std::vector<Guide>& guides,
  double length, FieldConstraints& constraints)
{
  refuseIf(guides.size() != mesh.faceCount(), "cross field: ", guides.size(), " guides for ",
    mesh.faceCount(), " faces");
  constraints.guideAngle.assign(mesh.faceCount(), 0.0);
  constraints.guideStrength.assign(mesh.faceCount(), 0.0);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    if (guides[f].isFree() || constraints.fixed[f] != 0)
    {
      continue;
    }
    const Vector3 x = mesh.edgeVector(3 * f).normalized();
    const Vector3 y = x.cross(mesh.edgeVector(3 * f + 1)).normalized().cross(x);
    constraints.guideAngle[f] = std::atan2(guides[f].direction.dot(y), guides[f].direction.dot(x));
    constraints.guideStrength[f] =
      kGuideStrengthOfField * double{ guides[f].weight } * topology.area[f] / (length * length);
  }
}

PowerFields powerFields(const Mesh& mesh, const FieldTopology& topology,
  const FieldConstraints& constraints, const PowerFieldOptions& options)
{
  PowerFields result;
  const FreeFaces free = numberFreeFaces(mesh, constraints);
  result.looseComponents = free.looseCount;
  result.looseComponent.assign(mesh.faceCount(), kInvalidIndex);
  if (free.face.empty())
  {
    result.candidates.push_back(constraints.angle);
    return result;
  }
  ConnectionSystem system(topology, free, constraints);
  report(options.progress, 0.1, "cross field: start");
  std::vector<Eigen::VectorXcd> fields =
    initialFields(system, free, principalField(mesh, topology, free), topology.totalArea);

  // Below the mesh's own edges there is nothing to smooth that rounding could see.
  const double length = std::max(options.smoothingLength, topology.meanEdgeLength);
  const double time = 4 * length * length;
  report(options.progress, 0.3, "cross field: diffusion");
  system.factorize(time, 1.0, time);
  for (Eigen::VectorXcd& field : fields)
  {
    diffuseAndNormalize(system, field, time);
    result.candidates.push_back(constraints.angle);
    for (std::size_t i = 0; i < free.face.size(); ++i)
    {
      result.candidates.back()[free.face[i]] = 0.25 * std::arg(field(static_cast<Eigen::Index>(i)));
    }
  }
  for (std::size_t i = 0; i < free.face.size(); ++i)
  {
    result.looseComponent[free.face[i]] = free.loose[i];
  }
  return result;
}

double edgeResidual(const FieldTopology& topology, const std::vector<double>& angle,
  const Mesh& mesh, Index h, int jump)
{
  return angle[Mesh::face(h)] + topology.transport[h] - angle[Mesh::face(mesh.twin[h])] -
    0.5 * kPi * jump;
}

std::vector<double> solveAngles(const Mesh& mesh, const FieldTopology& topology,
  const FieldConstraints& constraints, const std::vector<int>& jump,
  const std::vector<double>& start)
{
  std::vector<double> angle = start;
  const FreeFaces free = numberFreeFaces(mesh, constraints);
  const Eigen::Index size = static_cast<Eigen::Index>(free.face.size());
  if (size == 0)
  {
    return angle;
  }
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(size);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  std::vector<Eigen::Triplet<double>> entries;
  for (const std::array<Index, 2>& edge : topology.edges)
  {
    const Index i = free.unknown[Mesh::face(edge[0])];
    const Index j = free.unknown[Mesh::face(edge[1])];
    const double w = topology.edgeWeight[edge[0]];
    // Unknown is the change against `angle`, so the residual at the start is the whole right side.
    const double residual = w * edgeResidual(topology, angle, mesh, edge[0], jump[edge[0]]);
    if (i != kInvalidIndex)
    {
      diagonal(i) += w;
      right(i) -= residual;
    }
    if (j != kInvalidIndex)
    {
      diagonal(j) += w;
      right(j) += residual;
    }
    if (i != kInvalidIndex && j != kInvalidIndex)
    {
      entries.emplace_back(std::max(i, j), std::min(i, j), -w);
    }
  }
  for (Eigen::Index i = 0; i < size; ++i)
  {
    const Index f = free.face[i];
    if (constraints.strength(f) > 0)
    {
      const double away = angle[f] - constraints.guideAngle[f];
      diagonal(i) += constraints.guideStrength[f];
      right(i) -=
        constraints.guideStrength[f] * (away - 0.5 * kPi * std::round(away / (0.5 * kPi)));
    }
  }
  // A component without constraints and guides may turn as a whole: its first face is held (softly, which is
  // exact because the right side sums to zero there).
  std::vector<std::uint8_t> held(free.looseCount, 0);
  for (Eigen::Index i = 0; i < size; ++i)
  {
    const Index loose = free.loose[i];
    if (free.looseWithoutGuides(i) && held[loose] == 0)
    {
      held[loose] = 1;
      diagonal(i) *= 2;
    }
    entries.emplace_back(i, i, diagonal(i));
  }
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  if (solver.info() != Eigen::Success)
  {
    throw std::logic_error("cross field: the system of the angles could not be factored");
  }
  const Eigen::VectorXd change = solver.solve(right);
  for (Eigen::Index i = 0; i < size; ++i)
  {
    angle[free.face[i]] += change(i);
  }
  return angle;
}

} // namespace quadrille
