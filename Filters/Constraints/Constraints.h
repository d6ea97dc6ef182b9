// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a user draws beside the surface: feature curves, guiding strokes, connections, cycles, and points with
/// valences, with sizes, or whose features are to be none. They are put on the surface, and what became of them is
/// shown.
#pragma once

#include "Convert/PolyData.h"
#include "Extraction/Extraction.h"
#include "Requests/DrawnConstraints.h"

#include <vtkSmartPointer.h>

#include <memory>
#include <string>
#include <vector>

class vtkPolyData;

namespace quadrille
{

struct InputPlaces;

/// Null inputs ask for nothing.
struct ConstraintInputs
{
  /// Polylines that become features. A line cell array ConstraintType may say 1: this one is a guiding stroke; 2: a
  /// connection; 3: a cycle; 4: the irregular vertex nearest to its begin goes to its end. Vertices of which it says 6:
  /// the feature curves there are none; 7: edges there are SizeFactor times as long within GuidingRadius.
  vtkPolyData* curves = nullptr;
  /// Polylines whose direction the quads follow. A line cell array GuidingWeight goes before strokeWeight,
  /// GuidingRadius before strokeRadius.
  vtkPolyData* strokes = nullptr;
  /// Points for which a valence is asked. A point array TargetValence goes before valence; 0 there: nothing is asked.
  /// Two points with the same value of a point array ConnectId, other than 0, are joined; without TargetValence no
  /// valence is asked for at these.
  vtkPolyData* points = nullptr;
  vtkPolyData* connections = nullptr; ///< polylines, whatever their ConstraintType
  vtkPolyData* cycles = nullptr;      ///< the same, closed or not
  /// All classes: lines as in curves, points as in points; those of lines only where TargetValence asks for one.
  vtkPolyData* mixed = nullptr;
  vtkPolyData* surface = nullptr; ///< for its array ConnectId
  double strokeWeight = 1;        ///< in (0, 1]
  /// What lies within this distance of a stroke takes its direction, too; >= 0, in units of the surface.
  double strokeRadius = 0;
  int valence = 3;       ///< 2 to 8
  double sameWithin = 0; ///< places that are no farther apart are one, see kOnePlace
  /// Of the surface; null there: they are made where they are needed. Null: nobody else needs them.
  std::unique_ptr<InputPlaces>* places = nullptr;
  int threads = 1; ///< 0: all
};

/// All goes to surface.input.drawn, see ConstraintPlacement: every point goes to the nearest place on the surface,
/// wherever its vertices are. Connections and cycles stay as they are, in surface.input.curves; also pairs of points of
/// the surface that share a value of its point array ConnectId.
/// Moves: as they are, see Session/Moves.h.
/// Throws InvalidInput, with the place, for values that cannot be asked for and for a curve that cannot be followed.
PlacedConstraints applyConstraints(ConvertedSurface& surface, const ConstraintInputs& inputs);

/// Lines and vertices where the constraints lie. Cells: Met (active: 0 or 1), Constraint (0 feature, 1 stroke, 2 a
/// valence that was met, 3 one that was not), SourceId (line or point of its input), Distance, GuidingWeight (0 but on
/// strokes), TargetValence (0 on lines) and Valence (of the quads' point there, on boundaries one more; 0 on lines).
/// Points: Direction (unit vectors along lines, else zero). Connections and cycles are 4 and 6, drawn as the chain of
/// edges that is judged; 5 and 7 where they are not met, as they were given if there is no chain. Moves of irregular
/// vertices are 8, the vertex at its new place, and 9, where they begin; 10 is the mirror plane, see addMirrorLines.
/// Cleared features are 12, and 13 where they are not met; sizes 14 and 15.
/// Lines that could not be put on the surface are their first point.
/// mesh: what was made. isMet: of each, see judgeConstraints.
vtkSmartPointer<vtkPolyData> writeConstraints(const std::vector<PlacedConstraint>& placed,
  const QuadMesh& mesh, const std::vector<bool>& isMet);

} // namespace quadrille
