// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Where guides ask for which direction, to compare the quads with.
#pragma once

#include "Mesh/NearestTriangle.h"
#include "Requests/SurfacePlaces.h"

#include <vector>

namespace quadrille
{

/// A place with a direction that the quads' edges there should have.
struct GuidedPlace
{
  Index polygon = kInvalidIndex; ///< of the input, on which it lies
  Vector3 place = Vector3::Zero();
  Vector3 normal = Vector3::Zero();    ///< unit; zero where the polygon has no area
  Vector3 direction = Vector3::Zero(); ///< unit, normal to it; zero where it was along the normal
  double area = 0;                     ///< that it stands for
  double weight = 1;                   ///< in (0, 1]
};

/// That of a whole polygon, at its centre. polygon: with corners; direction: of any length but 0.
GuidedPlace guidedPolygon(
  const SurfaceInput& input, Index polygon, const Vector3& direction, double weight);

/// Places of a stroke, evenly along its course and, where the radius is above 0, beside it as far as that reaches on
/// the surface; with the direction of the part of the course next to each. course: on the surface, of 2 places or more.
std::vector<GuidedPlace> guidedAlong(const SurfaceInput& input, const SurfacePlaces& places,
  const std::vector<Vector3>& course, double weight, double radius);

/// A polyline, to be asked for what of it is next to a place.
class NearestSegments
{
public:
  struct Place
  {
    double distance = 0;
    Vector3 point = Vector3::Zero();
    Vector3 direction = Vector3::Zero(); ///< unit; zero where all points are one
  };

  /// line: of 1 point or more.
  explicit NearestSegments(const std::vector<Vector3>& line);
  Place at(const Vector3& p) const;

private:
  NearestTriangle segments_;
};

} // namespace quadrille
