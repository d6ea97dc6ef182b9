// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/MapShape.h"

#include "Base/Angles.h"
#include "Base/Refuse.h"
#include "Mesh/Sizing.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

/// Least height of a reference over its longest edge: the references of needles, or of triangles without
/// area, stay invertible.
constexpr double kLeastShapeHeight = 1e-2;

/// The same with lengths over the sizes that are wanted there.
Eigen::Matrix2d flattenSized(const Mesh& mesh, Index f)
{
  const SizedTriangle triangle = sizedTriangle(mesh, f);
  const double longest = std::max(
    { triangle.width, triangle.apex.norm(), (triangle.apex - Vector2(triangle.width, 0)).norm() });
  Eigen::Matrix2d result;
  result << std::max(triangle.width, kLeastShapeHeight * longest), triangle.apex.x(), 0,
    std::max(triangle.apex.y(), kLeastShapeHeight * longest);
  return result;
}

/// The derivative by J of the component off its axis of what the map makes of the guide of face f.
Eigen::Vector4d offAxisOf(const FieldGuide& guide, double fieldAngle, int quarterTurns)
{
  const double against = guide.angle - fieldAngle;
  // The field is within an eighth of a turn of one of the guide's four directions.
  const double axis = (quarterTurns + std::round(against / kRightAngle)) * kRightAngle;
  const double along = quarterTurns * kRightAngle + against;
  const Vector2 normal = std::sqrt(guide.weight) * Vector2(-std::sin(axis), std::cos(axis));
  Eigen::Vector4d result;
  result << std::cos(along) * normal, std::sin(along) * normal;
  return result;
}

} // namespace

Eigen::Matrix2d flattenFace(const Mesh& mesh, Index f)
{
  if (!mesh.sizing.empty())
  {
    return flattenSized(mesh, f);
  }
  const Vector3 a = mesh.edgeVector(3 * f);
  const Vector3 b = -mesh.edgeVector(3 * f + 2);
  const double longest = std::max({ a.norm(), b.norm(), (b - a).norm() });
  const double width = std::max(a.norm(), kLeastShapeHeight * longest);
  const double along = a.norm() > 0 ? a.dot(b) / a.norm() : 0;
  const double height = std::max(a.cross(b).norm() / width, kLeastShapeHeight * longest);
  Eigen::Matrix2d result;
  result << width, along, 0, height;
  return result;
}

Eigen::Matrix2d mappedEdges(const std::vector<FixedVec2>& uv, Index f)
{
  Eigen::Matrix2d edges;
  edges << toDouble(uv[3 * f + 1] - uv[3 * f]), toDouble(uv[3 * f + 2] - uv[3 * f]);
  return edges;
}

double mappedArea(const std::vector<FixedVec2>& uv, Index f)
{
  return parallelogram(toDouble(uv[3 * f + 1] - uv[3 * f]), toDouble(uv[3 * f + 2] - uv[3 * f])) /
    2;
}

double shareBeyondRatio(const Mesh& mesh, const std::vector<FixedVec2>& uv, double limit)
{
  refuseIf(!(limit >= 1) || !std::isfinite(limit) || uv.size() != mesh.origin.size(),
    "share beyond a ratio: the ratio must be a number from 1 on, and the map of the mesh's size");
  double area = 0, beyond = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Eigen::Matrix2d reference = flattenFace(mesh, f);
    if (!(reference.determinant() > 0))
    {
      continue; // a point
    }
    const Eigen::Matrix2d j = mappedEdges(uv, f) * reference.inverse();
    area += reference.determinant();
    const double d = j.determinant();
    if (!(d > 0 && j.squaredNorm() <= (limit + 1 / limit) * d))
    {
      beyond += reference.determinant();
    }
  }
  return area > 0 ? beyond / area : 0;
}

void checkAnisotropyLimit(double limit)
{
  refuseIf(limit != 0 && !(limit >= 1 && std::isfinite(limit)),
    "the anisotropy limit must be 0 (none) or a number from 1 on");
}

double areaStretch(const CrossField& field, Index f)
{
  return field.stretch.empty() ? 1.0 : field.stretch[f].determinant();
}

double stretchedArea(const Mesh& mesh, const CrossField& field)
{
  if (field.stretch.empty())
  {
    return sizedArea(mesh);
  }
  double area = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    area += areaStretch(field, f) * sizedArea(mesh, f);
  }
  return area;
}

double stretchedLength(const Mesh& mesh, const CrossField& field, Index h)
{
  const double length = sizedLength(mesh, h);
  if (field.stretch.empty())
  {
    return length;
  }
  double sum = 0;
  int sides = 0;
  for (const Index side : { h, mesh.twin[h] })
  {
    if (side != kInvalidIndex)
    {
      const Index f = Mesh::face(side);
      const Eigen::Matrix2d shape = flattenFace(mesh, f);
      const Vector2 edges[3] = { shape.col(0), shape.col(1) - shape.col(0), -shape.col(1) };
      const Vector2& edge = edges[side % 3];
      sum += edge.norm() > 0 ? (field.stretch[f] * edge).norm() / edge.norm() : 1;
      ++sides;
    }
  }
  return length * sum / sides;
}

void addTriangle(UntangleProblem& problem, const std::array<Index, 3>& points, const Mesh& mesh,
  const CrossField& field, Index f, int quarterTurns, double edgeLength)
{
  const double rotation = quarterTurns * kRightAngle - field.angle[f];
  const Eigen::Matrix2d flat = flattenFace(mesh, f);
  const Eigen::Matrix2d shape =
    field.stretch.empty() ? flat : Eigen::Matrix2d(field.stretch[f] * flat);
  const Eigen::Matrix2d reference =
    Eigen::Rotation2Dd(rotation).toRotationMatrix() * shape / edgeLength;
  problem.triangles.push_back(points);
  problem.inverseReference.push_back(reference.inverse());
  problem.weight.push_back(reference.determinant() / 2);
  if (!field.guides.empty())
  {
    problem.offAxis.push_back(field.guides[f].weight > 0
        ? offAxisOf(field.guides[f], field.angle[f], quarterTurns)
        : Eigen::Vector4d::Zero());
  }
}

UntangleProblem referToMap(const UntangleProblem& problem, const CarriedMap& carried,
  const std::vector<FixedVec2>& uv, const std::vector<std::uint8_t>& quarterTurns, double scale)
{
  UntangleProblem result = problem;
  for (Index f = 0; f < carried.known.size(); ++f)
  {
    if (carried.known[f] == 0)
    {
      continue;
    }
    const int turns = quarterTurns.empty() ? 0 : quarterTurns[f];
    const Eigen::Rotation2Dd rotation(carried.fieldRotation[f] + turns * kRightAngle);
    result.inverseReference[f] =
      (scale * rotation.toRotationMatrix() * mappedEdges(uv, f)).inverse();
  }
  return result;
}

CornerAxis cornerAxis(int axis, int rotation)
{
  const FixedVec2 along = rotate(axis == 0 ? FixedVec2{ 1, 0 } : FixedVec2{ 0, 1 }, rotation);
  return { along.u != 0 ? 0 : 1, static_cast<double>(along.u + along.v) };
}

void guardEdges(UntangleProblem& problem, const std::vector<GuardedEdge>& edges)
{
  const Eigen::Index rows = problem.offset.size();
  const Eigen::SparseMatrix<double, Eigen::RowMajor> basis = problem.basis;
  std::vector<Eigen::Triplet<double>> triplets;
  for (Eigen::Index row = 0; row < rows + 2 * Eigen::Index(edges.size()); ++row)
  {
    const Eigen::Index source =
      row < rows ? row : 2 * Eigen::Index(edges[(row - rows) / 2].from) + (row - rows) % 2;
    for (decltype(basis)::InnerIterator entry(basis, source); entry; ++entry)
    {
      triplets.emplace_back(static_cast<int>(row), static_cast<int>(entry.col()), entry.value());
    }
  }
  problem.basis.resize(rows + 2 * Eigen::Index(edges.size()), basis.cols());
  problem.basis.setFromTriplets(triplets.begin(), triplets.end());
  problem.offset.conservativeResize(problem.basis.rows());
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    const GuardedEdge& edge = edges[i];
    const Eigen::Matrix2d frame =
      edge.length * Eigen::Rotation2Dd(edge.axis * kRightAngle).toRotationMatrix();
    const Eigen::Index point = rows / 2 + static_cast<Eigen::Index>(i);
    problem.offset.segment<2>(2 * point) =
      problem.offset.segment<2>(2 * Eigen::Index(edge.from)) + frame.col(1);
    problem.triangles.push_back({ edge.from, edge.to, static_cast<Index>(point) });
    problem.inverseReference.push_back(frame.inverse());
    problem.weight.push_back(kGuardWeight * edge.length * edge.length);
  }
}

} // namespace quadrille
