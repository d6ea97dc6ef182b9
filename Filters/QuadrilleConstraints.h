// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a user draws beside the surface: feature curves, guiding strokes, connections, cycles and points with valences.
/// They are put on the surface, and what became of them is shown.
#pragma once

#include "Extraction/Extraction.h"
#include "GridMap/CurveIsolines.h"
#include "QuadrilleConvert.h"

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkPolyData;

namespace quadrille
{

/// Null inputs ask for nothing.
struct ConstraintInputs
{
  /// Polylines that become features. A line cell array ConstraintType may say 1: this one is a guiding stroke; 2: a
  /// connection; 3: a cycle.
  vtkPolyData* curves = nullptr;
  /// Polylines whose direction the quads follow. A line cell array GuidingWeight goes before strokeWeight.
  vtkPolyData* strokes = nullptr;
  /// Points for which a valence is asked. A point array TargetValence goes before valence; 0 there: nothing is asked.
  /// Two points with the same value of a point array ConnectId, other than 0, are joined; without TargetValence no
  /// valence is asked for at these.
  vtkPolyData* points = nullptr;
  vtkPolyData* connections = nullptr; ///< polylines, whatever their ConstraintType
  vtkPolyData* cycles = nullptr;      ///< the same, closed or not
  vtkPolyData* surface = nullptr;     ///< for its array ConnectId
  double strokeWeight = 1;            ///< in (0, 1]
  int valence = 3;                    ///< 2 to 8
};

enum class ConstraintKind
{
  Feature = 0,
  Stroke = 1,
  Valence = 2, ///< 3 in the output where it is not met; connections and cycles the same
  Connection = 4,
  Cycle = 6
};

/// What arrays and messages call it.
const char* nameOf(ConstraintKind kind);

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
  vtkIdType source = 0;      ///< line, or point, of its input
  std::vector<Vector3> path; ///< of one point for a valence, and for what is not followed
  double distance =
    0; ///< of the farthest given point to its place on the surface, in units of the input
  double weight = 0;                 ///< of strokes
  int valence = 0;                   ///< asked for
  std::vector<GuidedPolygon> guided; ///< of strokes: ascending by polygon
  std::size_t curve = 0; ///< of connections and cycles: its place in SurfaceInput::curves
  std::string whyNot;    ///< empty, or why it is not followed; its path is then a point
};

struct PlacedConstraints
{
  std::vector<PlacedConstraint> placed;
  std::vector<std::string> notices; ///< what the user should know
};

/// Features: every point of a curve goes to the nearest point of the surface's polygons, and between two of them runs
/// the path along edges that stays closest to the straight segment; its edges are marked in surface.curveMarks and
/// surface.input.featureEdges.
/// Strokes: every point goes to the nearest place on the surface, and the polygons under the straight segment between
/// two get its direction. Where the way there is torn, that of a feature is taken.
/// Valences: the nearest place on the surface, and of the corners of the polygon there the nearest one.
/// Connections and cycles: as they are, in surface.input.curves; also pairs of points of the surface that share a value
/// of its point array ConnectId.
/// Throws InvalidInput, with the place, for values that cannot be asked for and for a curve that cannot be followed.
PlacedConstraints applyConstraints(ConvertedSurface& surface, const ConstraintInputs& inputs);

/// What to do about valences that the quads do not have, with place and both numbers. mesh: what was made.
std::vector<std::string> missedValences(
  const std::vector<PlacedConstraint>& placed, const QuadMesh& mesh);

/// Lines and vertices where the constraints lie. Cells: Constraint (active: 0 feature, 1 stroke, 2 a valence that was
/// met, 3 one that was not), SourceId (line or point of its input), Distance, GuidingWeight (0 but on strokes),
/// TargetValence (0 on lines) and Valence (that of the quads there, on boundaries one more; 0 on lines). Points:
/// Direction (unit vectors along lines, else zero). Connections and cycles are 4 and 6, drawn as the chain of edges
/// that they became; 5 and 7 where there is none, as they were given.
/// outcomes: of connections and cycles. mesh: what was made.
vtkSmartPointer<vtkPolyData> writeConstraints(const std::vector<PlacedConstraint>& placed,
  const std::vector<CurveOutcome>& outcomes, const QuadMesh& mesh);

} // namespace quadrille
