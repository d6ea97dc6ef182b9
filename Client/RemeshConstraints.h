// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The constraints of a Quad Remesh, as the drawing tools of the window make, change and remove them.
#pragma once

#include "DrawnLine.h"

#include "vtkSmartPointer.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

class vtkSMProxy;
class vtkSMQuadConstraintProxy;
class vtkSMSessionProxyManager;
class vtkSMSourceProxy;

namespace quadrille
{

bool isQuadRemesh(vtkSMProxy* proxy);

/// Whether a Quad Remesh takes what the source gives.
bool isSurface(vtkSMSourceProxy* source);

/// The Quad Remesh that what is drawn on a surface is for: the surface is its output or its input, with filters between
/// or without; of several the active one, else the one made last. Null where there is none.
vtkSMSourceProxy* remeshOf(vtkSMSourceProxy* surface, vtkSMProxy* active);

struct NewConstraint
{
  std::string source; ///< its name in the XML of the server manager, as "QuadStroke"
  /// Names and values of properties.
  std::vector<std::pair<std::string, std::vector<double>>> values;
};

/// A source that is registered. What is selected in the pipeline stays. Null where the server does not know such a
/// source.
vtkSMSourceProxy* registerConstraint(
  vtkSMSessionProxyManager* manager, const NewConstraint& constraint);

/// Makes registered sources constraints of the filter, which is not updated.
void connectConstraints(
  vtkSMSourceProxy* filter, const std::vector<vtkSMSourceProxy*>& constraints);

/// Both.
vtkSMSourceProxy* addConstraint(vtkSMSourceProxy* filter, const NewConstraint& constraint);

/// A move of an irregular vertex that belongs to no filter and is not in the pipeline: for previews. Null where the
/// server does not know such a source.
vtkSmartPointer<vtkSMQuadConstraintProxy> newMove(vtkSMSourceProxy* filter);

/// The constraint of the filter that was made last, by these tools or otherwise; null where it has none.
vtkSMSourceProxy* lastConstraint(vtkSMSourceProxy* filter);

/// Which one of the filter a user who takes one away means: what is selected where it is one, else the last one; null
/// where it has none.
vtkSMSourceProxy* constraintMeant(vtkSMSourceProxy* filter, vtkSMSourceProxy* selected);

/// Takes a constraint out of the filter and out of the pipeline.
void removeConstraint(vtkSMSourceProxy* filter, vtkSMSourceProxy* constraint);

/// Sets a number of a constraint, also for the trace; whether it is another one than before.
bool setNumber(vtkSMSourceProxy* constraint, const char* property, int value);

/// The places of the irregular vertices of the quads that are there.
std::vector<Place> irregularVertices(vtkSMSourceProxy* filter);

/// Whether a move takes this irregular vertex.
bool isMovable(vtkSMSourceProxy* filter, const Place& vertex);

/// Places on the feature curves of the quads that are there, four to an edge; not on boundaries.
std::vector<Place> placesOnFeatures(vtkSMSourceProxy* filter);

/// The constraint of the filter that draws a feature curve through a place, up to a distance; null: none does.
vtkSMSourceProxy* featureCurveAt(vtkSMSourceProxy* filter, const Place& place, double within);

/// Mean edge length of the quads that are there; none where there are no quads.
std::optional<double> edgeLength(vtkSMSourceProxy* filter);

/// Where a plane through a place cuts what a source gives: the curve nearest to that place, without its first point
/// again at its end. Empty where that one does not close.
std::vector<Place> closedCut(vtkSMSourceProxy* source, const Place& origin, const Place& normal);

/// What the filter says of a constraint after it was executed.
struct ConstraintWord
{
  bool isMet = false;
  std::string reason; ///< why it is not met
  std::string remark; ///< what else is to be known
};

/// Whether there is one that is not met.
bool hasUnmetConstraints(vtkSMSourceProxy* filter);
/// How many are not met, by the Constraint Table.
int countUnmet(vtkSMSourceProxy* filter);

/// The word on the last constraint of a kind (of the column Kind of the Constraint Table); none where it tells of none.
std::optional<ConstraintWord> wordOnLast(vtkSMSourceProxy* filter, const std::string& kind);

} // namespace quadrille
