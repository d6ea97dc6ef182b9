// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// CAD files as input of a run, and its quads put onto their exact shape.
#pragma once

#include "Options.h"
#include "RemeshRun.h"

#include <vtkSmartPointer.h>

#include <string>

class vtkDataSet;
class vtkPolyData;

namespace quadrille
{

/// What the command line asks of CAD files.
class CadRun
{
public:
  /// Adds --cad-chord-error, --cad-follow and --cad-nodes.
  void addOptions(CommandOptions& options);
  /// What no option can check for itself. Throws UsageError.
  void check(const CommandOptions& options, const std::string& input) const;

  /// Whether the file is a CAD file, by its extension.
  static bool isCad(const std::string& path);
  /// All its parts as one surface. Throws FileError, also where this build has no Open CASCADE.
  vtkSmartPointer<vtkPolyData> read(RemeshRun& run, const std::string& path) const;
  /// The nodes of the mesh on the exact shape, or the mesh itself where that is not asked for. Notices go to the run.
  /// Null where it fails, and the run has the reason.
  vtkSmartPointer<vtkDataSet> project(
    RemeshRun& run, const vtkSmartPointer<vtkDataSet>& mesh) const;

private:
  double chordError_ = 0.0005;
  int follow_ = 0;
  bool keepsNodes_ = false;
};

} // namespace quadrille
