// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Puts what a user draws beside a surface on it.
#pragma once

#include "Prepare/SurfacePaths.h"
#include "Requests/DrawnConstraints.h"
#include "Requests/InsertPlaces.h"
#include "Requests/SurfacePlaces.h"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille
{

/// A polyline and the number by which messages name it.
struct DrawnLine
{
  std::int64_t source = 0;
  std::vector<Vector3> points; ///< finite
};

/// Everything that is drawn on a surface, as requests at points and along paths of it.
class ConstraintPlacement
{
public:
  /// All stay as they are while this is used. places, paths: of the input. sameWithin: places that are no farther apart
  /// are one, see kOnePlace; in units of the input.
  ConstraintPlacement(const SurfaceInput& input, const SurfacePlaces& places,
    const SurfacePaths& paths, double sameWithin = 0)
    : input_(input), places_(places), paths_(paths), sameWithin_(sameWithin)
  {
  }

  /// Every point goes to the nearest place on the surface, and between two of them the line runs straight over the
  /// faces. Between two on different parts of the surface it is not followed, and neither is a line without length: the
  /// result tells so.
  void addFeature(const DrawnLine& line);
  /// The same, and the faces below get the line's direction, and those that are joined to them within the radius, in
  /// units of the input. Where strokes overlap see StrokeRequest::order.
  void addStroke(const DrawnLine& line, double weight, double radius = 0, int order = 0);
  /// The nearest place on the surface. Throws InvalidInput where it asks for another valence already, and for a corner
  /// of no quads on the boundary.
  void addValence(std::int64_t source, const Vector3& point, int valence);
  /// The nearest place on the surface, see SizeRequest. Throws InvalidInput where the radius is negative or the factor
  /// is not positive.
  void addSize(
    std::int64_t source, const Vector3& point, double radius, double factor, int order = 0);

  /// The nearest place on the surface, where no feature is to be.
  void addCleared(std::int64_t source, const Vector3& point);

  /// A valence that is not asked for, and why not: it contradicts an earlier one, say. The rest is done.
  void leaveOutValence(
    std::int64_t source, const Vector3& point, int valence, const std::string& whyNot);
  /// Stays as it is. Throws InvalidInput as checkCurve does.
  void addCurve(std::int64_t source, CurveKind kind, std::vector<Vector3> points);

  const PlacedConstraints& result() const { return result_; }
  const DrawnRequests& requests() const { return requests_; }
  const std::vector<CurveRequest>& curves() const { return curves_; }
  /// Appends what was added.
  void addTo(SurfaceInput& input) const;

private:
  /// Fills given, path, distance and remark, or whyNot with the place as its path; course, where given, gets its course
  /// on each part of the surface. Returns the points of the line on the surface, those that follow at the same place
  /// once.
  std::vector<Vector3> follow(const DrawnLine& line, PlacedConstraint& placed,
    std::vector<std::vector<Vector3>>* course = nullptr) const;
  /// Whether the line is followed; if not it is told.
  bool take(PlacedConstraint line);

  const SurfaceInput& input_;
  const SurfacePlaces& places_;
  const SurfacePaths& paths_;
  double sameWithin_;
  DrawnRequests requests_;
  std::vector<CurveRequest> curves_;
  PlacedConstraints result_;
};

/// The course of a connection or cycle on the surface; that of a cycle ends where it begins.
std::vector<Vector3> courseOf(
  const CurveRequest& curve, const SurfacePlaces& places, const SurfacePaths& paths);

/// The valence that the array asks for at a place; 0: none.
int arrayValenceAt(const SurfaceInput& input, const SurfacePlaces::Place& place, double sameWithin);

} // namespace quadrille
