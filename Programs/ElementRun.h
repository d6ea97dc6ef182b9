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
  /// Adds --order, --nodes, --quality, --require, --worst, --thickness, --axis, --axis-fallback and --local-vectors.
  void addOptions(CommandOptions& options);
  /// What no option can check for itself, before the run. output: path of the mesh. Throws UsageError.
  void check(const CommandOptions& options, const std::string& output) const;
  /// Switches on what the run must make for the elements. isWrapped: the quads may be of a wrap. hasCellData: whether
  /// the user says what cell arrays come from.
  void prepare(RemeshRun& run, bool isWrapped, bool hasCellData);

  /// Whether there is anything to be made of the quads.
  bool isAsked() const;
  /// The elements of the quads of the run, which succeeded; input: what was remeshed. Notices go to the run. Null where
  /// it fails, and the run has the reason.
  vtkSmartPointer<vtkDataSet> execute(RemeshRun& run, vtkPolyData* input);

  /// Whether all elements keep what --require asks for; true before execute().
  bool isGood() const { return isGood_; }
  /// How many elements do not, and where the worst are; empty where all do.
  std::string failure() const;
  /// What execute() has made; null before it.
  vtkQuadElements* filter() const { return isDone_ ? filter_.Get() : nullptr; }

private:
  void tellWorst(RemeshRun& run);

  vtkNew<vtkQuadElements> filter_;
  bool isWanted_ = false; ///< an option other than the order asks for elements
  bool tellsWorst_ = false;
  bool usesMappedSurface_ = false;
  bool isDone_ = false;
  bool isGood_ = true;
};

} // namespace quadrille
