// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What is wrong with the quads, where it is seen, and what mends it.
#pragma once

#include "DrawnLine.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

class vtkSMRenderViewProxy;
class vtkSMSourceProxy;

namespace quadrille
{

/// A property and its new value.
struct Remedy
{
  std::string property;
  std::string label; ///< as the panel names the property
  double value = 0;
};

/// What the filter's Remedy says; none where it is empty.
std::optional<Remedy> remedyOf(vtkSMSourceProxy* filter);

/// Sets the property, also for the trace.
void apply(vtkSMSourceProxy* filter, const Remedy& remedy);

/// Whether the last execution left something in the output Problems of Quad Remesh or Quad Nodes On CAD Geometry.
bool hasProblems(vtkSMSourceProxy* filter);

/// A place of which the output Problems tells, and the direction out of the surface there.
struct ProblemPlace
{
  Place place;
  Place outward;
  double edge = 0; ///< mean edge length of the surface beside
};

/// Those that fail, and inverted quads; where there is none, the middle of what has no quads.
std::vector<ProblemPlace> problemPlaces(vtkSMSourceProxy* filter);

/// Looks at the place from outside, near enough to see the edges beside it.
void lookAt(vtkSMRenderViewProxy* view, const ProblemPlace& problem);

} // namespace quadrille
