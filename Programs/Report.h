// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The report of the command quadrille, as JSON.
#pragma once

#include "ElementRun.h"
#include "RemeshRun.h"

#include <string>

class vtkPolyData;

namespace quadrille
{

/// Files of a run.
struct RunFiles
{
  std::string input;
  std::string output; ///< empty for a method without quads
  std::string map;    ///< empty: not asked for
  std::string report; ///< empty: not asked for
};

/// In seconds.
struct RunTimes
{
  double read = 0;
  double total = 0;
};

/// What the run made, or why it made nothing. To be called after RemeshRun::execute().
/// elements: of the run; code: of the quads.
std::string makeReport(const RunFiles& files, RemeshRun& run, const ElementRun& elements,
  ExitCode code, const RunTimes& times);

/// The report of a run that ended before there was a mesh.
std::string makeFailureReport(const RunFiles& files, ExitCode code, const std::string& error);

/// The first value of a field array; 0 where there is none.
double fieldNumber(vtkPolyData* data, const char* name);

} // namespace quadrille
