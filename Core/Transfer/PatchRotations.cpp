// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/PatchRotations.h"

#include "Base/Angles.h"
#include "Base/ChartRotation.h"
#include "Transfer/PlaneReplay.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <optional>

namespace quadrille
{
namespace
{

/// Edges of slivers join their faces no more than so many times as much, or as little, as others.
constexpr double kMostWeight = 100;

/// Half-edge h where its face is laid out.
Complex alongEdge(const Mesh& mesh, Index h)
{
  const std::array<Complex, 3> p = layOut(mesh, Mesh::face(h));
  return p[(h + 1) % 3] - p[h % 3];
}

/// The rotation that is nearest to the map of a face; none where it has no area here or there.
std::optional<Complex> rotationOf(const Mesh& mesh, const std::vector<FixedVec2>& uv, Index f)
{
  const std::array<Complex, 3> p = layOut(mesh, f);
  const Vector2 a = toDouble(uv[3 * f + 1] - uv[3 * f]), b = toDouble(uv[3 * f + 2] - uv[3 * f]);
  const double area = p[1].real() * p[2].imag();
  if (!(determinant(uv[3 * f], uv[3 * f + 1], uv[3 * f + 2]) > 0) || !(area > 0))
  {
    return std::nullopt;
  }
  // J = [a b] [p1 p2]^-1; its rotation is that of (J00 + J11) + i (J10 - J01).
  const Vector2 jx = a / p[1].real();
  const Vector2 jy = (b - jx * p[2].real()) / p[2].imag();
  const Complex turned(jx.x() + jy.y(), jx.y() - jy.x());
  const double size = std::abs(turned);
  return size > 0 && std::isfinite(size) ? std::optional<Complex>(turned / size) : std::nullopt;
}

/// By what a rotation in face(h) is multiplied for the same one in the face of its twin.
std::optional<Complex> carriedAcross(const Mesh& mesh, const std::vector<FixedVec2>& uv, Index h)
{
  const Index g = mesh.twin[h];
  const std::optional<int> quarters =
    rotationBetween(uv[Mesh::next(h)] - uv[h], uv[g] - uv[Mesh::next(g)]);
  const Complex here = alongEdge(mesh, h), there = -alongEdge(mesh, g);
  const Complex carried = here * std::conj(there);
  const double size = std::abs(carried);
  if (!quarters || !(size > 0))
  {
    return std::nullopt;
  }
  return carried / size * std::polar(1.0, *quarters * kRightAngle);
}

double weightOf(const Mesh& mesh, Index h)
{
  const double areas = mesh.doubleAreaNormal(Mesh::face(h)).norm() +
    mesh.doubleAreaNormal(Mesh::face(mesh.twin[h])).norm();
  const double weight = areas > 0 ? mesh.edgeVector(h).squaredNorm() / areas : kMostWeight;
  return std::clamp(weight, 1 / kMostWeight, kMostWeight);
}

} // namespace

double directionOf(const Mesh& mesh, Index h)
{
  return std::arg(alongEdge(mesh, h));
}

std::vector<double> patchRotations(const Mesh& mesh, const std::vector<FixedVec2>& uv,
  const std::vector<Index>& patch, const std::vector<std::uint8_t>& inPatch)
{
  const auto idOf = [&](Index f)
  { return static_cast<int>(std::lower_bound(patch.begin(), patch.end(), f) - patch.begin()); };
  const Eigen::Index count = static_cast<Eigen::Index>(patch.size());
  std::vector<Eigen::Triplet<Complex>> entries;
  Eigen::VectorXcd right = Eigen::VectorXcd::Zero(count);
  bool known = false;
  for (int i = 0; i < count; ++i)
  {
    for (Index h = 3 * patch[i]; h < 3 * patch[i] + 3; ++h)
    {
      const Index g = mesh.twin[h];
      if (g == kInvalidIndex)
      {
        continue;
      }
      const std::optional<Complex> across = carriedAcross(mesh, uv, g);
      if (!across)
      {
        continue;
      }
      // |z_i - across z_g|^2, half of it where the twin adds the other half.
      const double weight = weightOf(mesh, h);
      if (inPatch[Mesh::face(g)] != 0)
      {
        entries.emplace_back(i, i, weight);
        entries.emplace_back(i, idOf(Mesh::face(g)), -weight * *across);
      }
      else if (const std::optional<Complex> outside = rotationOf(mesh, uv, Mesh::face(g)))
      {
        entries.emplace_back(i, i, weight);
        right[i] += weight * *across * *outside;
        known = true;
      }
    }
  }
  if (!known)
  {
    return {};
  }
  Eigen::SparseMatrix<Complex> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<Complex>> solver(matrix);
  if (solver.info() != Eigen::Success)
  {
    return {};
  }
  const Eigen::VectorXcd z = solver.solve(right);
  if (!z.allFinite())
  {
    return {};
  }
  std::vector<double> rotations(patch.size());
  for (Eigen::Index i = 0; i < count; ++i)
  {
    rotations[static_cast<std::size_t>(i)] = std::arg(z[i]);
  }
  return rotations;
}

} // namespace quadrille
