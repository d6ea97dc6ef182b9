// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/FaceGround.h"

#include "Base/Angles.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{

namespace
{

/// Pins closer together than this share of the edge length make the quads near them smaller, by this factor at most.
constexpr double kFineSpacing = 0.8, kSmallest = 0.05;
/// By how much sizes grow with the distance from such pins.
constexpr double kGrowthFromPins = 0.4;

/// Weighted by the angles at the vertex, so that they do not depend on how the surface is cut into triangles.
std::vector<Vector3> vertexNormals(const Mesh& mesh)
{
  std::vector<Vector3> normals(mesh.vertexCount(), Vector3::Zero());
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3 normal = mesh.doubleAreaNormal(Mesh::face(h)).normalized();
    normals[mesh.origin[h]] +=
      angleBetween(mesh.edgeVector(h), -mesh.edgeVector(Mesh::previous(h))) * normal;
  }
  for (Vector3& normal : normals)
  {
    normal.normalize();
  }
  return normals;
}

} // namespace

FaceGround::FaceGround(const Mesh& face, const std::vector<std::uint8_t>& isPin, double edgeLength)
  : face_(face), edgeLength_(edgeLength), nearest_(trianglesOf(face)),
    normals_(vertexNormals(face)), nextPin_(face.vertexCount(), kInvalidIndex),
    angles_(face.vertexCount(), 2 * kPi)
{
  std::vector<std::uint8_t> walked(face.halfEdgeCount(), 0);
  for (Index h = 0; h < face.halfEdgeCount(); ++h)
  {
    if (face.isBoundary(h) && walked[h] == 0)
    {
      walkLoop(h, isPin, walked);
    }
  }
  measureAngles();
  measureSizes();
}

FaceGround::FaceGround(const Mesh& face)
  : face_(face), edgeLength_(0), nearest_(trianglesOf(face)), normals_(vertexNormals(face))
{
  measureSizes();
}

void FaceGround::walkLoop(
  Index first, const std::vector<std::uint8_t>& isPin, std::vector<std::uint8_t>& walked)
{
  std::vector<Index> pins;
  for (Index h = first; walked[h] == 0;)
  {
    walked[h] = 1;
    if (isPin[face_.origin[h]] != 0)
    {
      pins.push_back(face_.origin[h]);
    }
    h = nextOnBoundary(face_, h);
  }
  for (std::size_t i = 0; i < pins.size(); ++i)
  {
    nextPin_[pins[i]] = pins[(i + 1) % pins.size()];
  }
  pinsOfLoops_.push_back(pins.size());
}

void FaceGround::measureAngles()
{
  std::vector<double> sums(face_.vertexCount(), 0);
  for (Index h = 0; h < face_.halfEdgeCount(); ++h)
  {
    sums[face_.origin[h]] +=
      angleBetween(face_.edgeVector(h), -face_.edgeVector(Mesh::previous(h)));
  }
  for (Index u = 0; u < face_.vertexCount(); ++u)
  {
    if (!isPin(u))
    {
      continue;
    }
    const Index v = nextPin_[u];
    const Vector3& normal = normals_[v];
    const Vector3 back = face_.position[u] - face_.position[v];
    const Vector3 on = face_.position[nextPin_[v]] - face_.position[v];
    // In the tangent plane: lines between pins may leave it steeply.
    double angle =
      std::atan2(normal.dot(on.cross(back)), on.dot(back) - normal.dot(on) * normal.dot(back));
    // Of a cusp, the turn that the face has there.
    if (std::abs(angle + 2 * kPi - sums[v]) < std::abs(angle - sums[v]))
    {
      angle += 2 * kPi;
    }
    angles_[v] = std::max(angle, 0.1);
  }
}

std::vector<FaceGround::FinePin> FaceGround::finePins() const
{
  std::vector<double> spacing(face_.vertexCount(), 0);
  for (Index v = 0; v < face_.vertexCount(); ++v)
  {
    if (isPin(v))
    {
      const double length = (face_.position[nextPin_[v]] - face_.position[v]).norm() / edgeLength_;
      spacing[v] += length / 2;
      spacing[nextPin_[v]] += length / 2;
    }
  }
  std::vector<FinePin> pins;
  for (Index v = 0; v < face_.vertexCount(); ++v)
  {
    if (isPin(v) && spacing[v] < kFineSpacing * sizeAt(face_, v))
    {
      pins.push_back({ face_.position[v], std::max(spacing[v], kSmallest * sizeAt(face_, v)) });
    }
  }
  std::sort(pins.begin(), pins.end(),
    [](const FinePin& a, const FinePin& b) { return a.place.x() < b.place.x(); });
  return pins;
}

void FaceGround::measureSizes()
{
  const std::vector<FinePin> pins = finePins();
  double finest = kInfinity;
  for (const FinePin& pin : pins)
  {
    finest = std::min(finest, pin.size);
  }
  for (Index v = 0; v < face_.vertexCount(); ++v)
  {
    const Vector3& p = face_.position[v];
    double size = sizeAt(face_, v);
    // Of farther ones none makes it smaller.
    const double reach = (1 + kRounding) * (size - finest) / kGrowthFromPins * edgeLength_;
    auto pin = std::lower_bound(pins.begin(), pins.end(), p.x() - reach,
      [](const FinePin& a, double x) { return a.place.x() < x; });
    for (; pin != pins.end() && pin->place.x() <= p.x() + reach; ++pin)
    {
      size = std::min(size, pin->size + kGrowthFromPins * (pin->place - p).norm() / edgeLength_);
    }
    sizes_.push_back(size);
  }
}

std::optional<FaceGround::Spot> FaceGround::at(
  const Vector3& p, const Vector3& facing, const Vector3& near) const
{
  auto place = nearest_.at(p, facing, 1.1 * (p - near).norm());
  if (!place)
  {
    place = nearest_.at(p, facing);
  }
  if (!place)
  {
    return std::nullopt;
  }
  Spot spot{ place->triangle, place->weights, place->point, Vector3::Zero(), 0 };
  for (Index i = 0; i < 3; ++i)
  {
    const Index v = face_.origin[3 * spot.face + i];
    spot.normal += spot.weights[i] * normals_[v];
    spot.size += spot.weights[i] * sizes_[v];
  }
  spot.normal.normalize();
  return spot;
}

double FaceGround::angleAt(Index v) const
{
  return v < angles_.size() ? angles_[v] : 2 * kPi;
}

double triangleShape(const std::array<Vector3, 3>& corners, const Vector3& normal)
{
  const Vector3 a = corners[1] - corners[0], b = corners[2] - corners[0];
  const double squares = a.squaredNorm() + b.squaredNorm() + (b - a).squaredNorm();
  const double length = normal.norm();
  return squares > 0 && length > 0
    ? 2 * std::sqrt(3.0) * normal.dot(a.cross(b)) / (squares * length)
    : 0;
}

double quadShape(const std::array<Vector3, 4>& corners, const Vector3& normal)
{
  const double length = normal.norm();
  double worst = 1;
  for (std::size_t i = 0; i < 4; ++i)
  {
    const Vector3 in = corners[i] - corners[(i + 3) % 4];
    const Vector3 out = corners[(i + 1) % 4] - corners[i];
    const double scale = length * in.norm() * out.norm();
    worst = std::min(worst, scale > 0 ? normal.dot(in.cross(out)) / scale : 0.0);
  }
  return worst;
}

} // namespace quadrille
