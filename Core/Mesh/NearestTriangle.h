// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The triangle nearest to a place.
#pragma once

#include "Base/Types.h"
#include "Mesh/BoxTree.h"
#include "Mesh/Mesh.h"

#include <array>
#include <optional>
#include <vector>

namespace quadrille
{

/// Triangles by point ids; one with two equal ids is a segment.
struct TriangleList
{
  std::vector<Vector3> points;
  std::vector<std::array<Index, 3>> corners;

  /// With points of its own.
  void add(const Vector3& a, const Vector3& b, const Vector3& c);
  void addSegment(const Vector3& a, const Vector3& b);
};

TriangleList trianglesOf(const Mesh& mesh);

/// Several threads may ask; the answers depend on the triangles alone.
class NearestTriangle
{
public:
  struct Place
  {
    Index triangle = kInvalidIndex;
    std::array<double, 3> weights{}; ///< barycentric, in [0, 1], sum 1
    Vector3 point = Vector3::Zero();
    double distance = 0;
  };

  explicit NearestTriangle(TriangleList triangles);

  /// None where there is no triangle within the distance. facing: only triangles whose normal is less than a right
  /// angle from it count, such that places on a thin wall do not find the other side; of segments (a, b, a) those that
  /// lead this way from a to b. Zero: all.
  std::optional<Place> at(
    const Vector3& p, const Vector3& facing = Vector3::Zero(), double within = kInfinity) const;
  /// All that are no farther away, ascending.
  std::vector<Index> within(const Vector3& p, double distance) const;
  /// Of one triangle.
  Place on(Index triangle, const Vector3& p) const;
  const TriangleList& triangles() const { return triangles_; }
  std::size_t bytes() const;

private:
  TriangleList triangles_;
  BoxTree tree_;
};

} // namespace quadrille
