// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads of a run as elements for simulation, by vtkQuadElements.
#pragma once

#include "Options.h"
#include "RemeshRun.h"

#include <vtkNew.h>
#include <vtkQuadElements.h>
#include <vtkSmartPointer.h>

#include <string>

class vtkDataSet;
class vtkPolyData;

namespace quadrille
{

/// What the command line asks of elements.
class ElementRun
{
public:
  /// Adds --order and --nodes.
  void addOptions(CommandOptions& options);
  /// What no option can check for itself, before the run. output: path of the mesh. Throws UsageError.
  void check(const CommandOptions& options, const std::string& output) const;
  /// Switches on what the run must make for the elements. isWrapped: of a wrap may be quads, too.
  void prepare(RemeshRun& run, bool isWrapped);

  /// Whether there is anything to be made of the quads.
  bool isAsked() const;
  /// The elements of the quads of the run, which succeeded; input: what was remeshed. Notices go to the run. Null where
  /// it fails, and the run has the reason.
  vtkSmartPointer<vtkDataSet> execute(RemeshRun& run, vtkPolyData* input);

  vtkQuadElements* filter() { return filter_; }

private:
  vtkNew<vtkQuadElements> filter_;
  bool usesMappedSurface_ = false;
};

} // namespace quadrille
