// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads of a surface by one click, for the first button of the tool bar and for the examples of the Help menu.
#pragma once

#include "RemeshConstraints.h"
#include "pqQuadrilleRun.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

class pqPipelineSource;
class vtkSMProxy;
class vtkSMSourceProxy;
class vtkSMViewProxy;

namespace quadrille
{

/// What a Quad Remesh is asked for beside what it does by itself.
struct NewQuads
{
  std::vector<std::pair<std::string, int>> numbers; ///< names and values of properties
  std::vector<NewConstraint> constraints;
};

/// Sets properties, also for the trace.
void setNumbers(vtkSMProxy* proxy, const std::vector<std::pair<std::string, int>>& numbers);

/// ParaView paints the quads as the surface is painted. By an array of one value, such as the solid of a text STL file
/// that has one, they would be as blue as their edges: they get no colours by it. view: may be null.
void leaveColoursOfOneValue(vtkSMSourceProxy* filter, vtkSMViewProxy* view);

/// What is done when quads are shown, or will not be. The filter is null where it is gone.
using Made = std::function<void(pqQuadrilleRun::End how, vtkSMSourceProxy* filter)>;

/// A Quad Remesh of the surface, whose quads are made beside the window and shown in the active view in the place of
/// the surface. What it makes belongs to the undo set of the caller, if there is one, who closes it in `then`. False,
/// and `then` is not called, where there can be no such filter.
bool makeQuads(pqPipelineSource* surface, const NewQuads& wanted, const Made& then);

} // namespace quadrille
