// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a user draws beside the surface: feature curves, guiding strokes, connections, cycles and points with valences.
/// Here they are put on the surface.
#pragma once

#include "Requests/CurveRequests.h"
#include "Requests/Guides.h"
#include "Requests/SurfacePlaces.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace quadrille
{

enum class ConstraintKind
{
  Feature = 0,
  Stroke = 1,
  Valence = 2, ///< 3 in outputs where it is not met; connections and cycles the same
  Connection = 4,
  Cycle = 6,
  Move =
    8 ///< of an irregular vertex, see Session/IrregularEdits.h; its path leads from the old place to the new one
};

/// What arrays and messages call it.
const char* nameOf(ConstraintKind kind);

/// Feature bits of one polygon (see SurfaceInput::featureEdges).
struct FeatureMark
{
  Index polygon = 0;
  std::uint8_t bits = 0;
};

/// Direction that a guiding stroke gives to one polygon.
struct GuideMark
{
  Index polygon = 0;
  Vector3 direction = Vector3::Zero(); ///< unit
  double weight = 1;                   ///< in (0, 1]
};

/// Sets directions and weights of polygons under strokes.
void addGuideMarks(SurfaceInput& input, std::size_t polygons, const std::vector<GuideMark>& marks);

/// Sets the marks' bits in input.featureEdges; throws InvalidInput for a polygon out of range.
void addFeatureMarks(
  SurfaceInput& input, std::size_t polygons, const std::vector<FeatureMark>& marks);

/// A polygon with a direction that the quads' edges there should have.
struct GuidedPolygon
{
  Index polygon = kInvalidIndex;
  Vector3 centre = Vector3::Zero();
  Vector3 normal = Vector3::Zero();    ///< unit; zero where the polygon has no area
  Vector3 direction = Vector3::Zero(); ///< unit, in its plane; zero where it is normal to that
  double area = 0;
  double weight = 1; ///< in (0, 1]
};

/// polygon: with corners; direction: of any length but 0.
GuidedPolygon guidedPolygon(
  const SurfaceInput& input, Index polygon, const Vector3& direction, double weight);

/// Where a constraint lies on the surface.
struct PlacedConstraint
{
  ConstraintKind kind = ConstraintKind::Feature;
  std::int64_t source = 0;    ///< line, or point, of its input; of a session the constraint's id
  std::vector<Vector3> given; ///< the points as they were drawn
  std::vector<Vector3> path;  ///< of one point for a valence, and for what is not followed
  double distance =
    0; ///< of the farthest given point to its place on the surface, in units of the input
  double weight = 0;                 ///< of strokes
  int valence = 0;                   ///< asked for; of a move that of its vertex
  std::vector<GuidedPolygon> guided; ///< of strokes: ascending by polygon
  std::size_t curve = 0; ///< of connections and cycles: its place in SurfaceInput::curves
  std::string whyNot;    ///< empty, or why it is not followed; its path is then a point
};

struct PlacedConstraints
{
  std::vector<PlacedConstraint> placed;
  std::vector<std::string> notices; ///< what the user should know
};

/// A polyline and the number by which messages name it.
struct DrawnLine
{
  std::int64_t source = 0;
  std::vector<Vector3> points; ///< finite
};

/// Everything that is put on a surface, until it is written to the input at once.
class ConstraintPlacement
{
public:
  /// Both stay as they are while this is used.
  ConstraintPlacement(const SurfaceInput& input, const SurfacePlaces& places)
    : input_(input), places_(places)
  {
  }

  /// Every point goes to the nearest point of the surface's polygons, and between two of them runs the path along edges
  /// that stays closest to the straight segment. Throws InvalidInput, with the places, where there is no such path;
  /// then nothing has changed.
  void addFeature(const DrawnLine& line);
  /// Every point goes to the nearest place on the surface, and the polygons under the straight segment between two get
  /// its direction. Where the way there is torn, that of a feature is taken, and addFeature's error. radius >= 0, in
  /// units of the input: polygons with their centre so near, and joined to those below by others, get the direction of
  /// the segment next to them. On a polygon under several strokes the last one counts.
  void addStroke(const DrawnLine& line, double weight, double radius = 0);
  /// The point of the surface's polygons nearest to the given one. Throws InvalidInput where it asks for another
  /// valence already, and for a corner of no quads on the boundary.
  void addValence(std::int64_t source, const Vector3& point, int valence);

  /// A valence that is not asked for, and why not: it contradicts an earlier one, say. The rest is done.
  void leaveOutValence(
    std::int64_t source, const Vector3& point, int valence, const std::string& whyNot);
  /// Stays as it is. Throws InvalidInput as checkCurve does.
  void addCurve(std::int64_t source, CurveKind kind, std::vector<Vector3> points);

  const PlacedConstraints& result() const { return result_; }
  std::vector<FeatureMark> featureMarks() const;
  std::vector<GuideMark> guideMarks() const;
  /// Sets valences, and appends curves, that were added.
  void setValences(SurfaceInput& input) const;
  void addCurves(SurfaceInput& input) const;

private:
  struct Stroke
  {
    Vector3 direction = Vector3::Zero();
    double weight = 1;
  };
  using Strokes = std::map<Index, Stroke>;

  std::vector<Index> pathBetween(
    const char* what, std::int64_t line, Index a, Index b, double haste) const;
  std::vector<SurfacePlaces::Place> sampleBetween(
    const SurfacePlaces::Place& first, const SurfacePlaces::Place& last) const;
  void guide(const SurfacePlaces::Place& place, const Stroke& stroke, Strokes& strokes) const;
  void guideAlong(const std::vector<Index>& path, const Stroke& stroke, Strokes& strokes) const;
  void guideAround(
    const std::vector<Vector3>& line, double weight, double radius, Strokes& strokes) const;
  void tellIfFar(const char* what, const PlacedConstraint& placed);
  void drop(const char* what, PlacedConstraint line, const std::string& whyNot);

  const SurfaceInput& input_;
  const SurfacePlaces& places_;
  std::map<Index, std::uint8_t> features_;
  Strokes strokes_;
  std::map<Index, int> valences_; ///< by point
  std::vector<CurveRequest> curves_;
  PlacedConstraints result_;
};

} // namespace quadrille
