// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A run on a wrap of the input, whose quads are put back onto the input.
#pragma once

#include "RemeshRun.h"

namespace quadrille
{

/// Whether this build has CGAL.
bool canWrap();

struct WrapRequest
{
  bool isAsked = false;
  bool onlyAfterFailure = false; ///< the input itself comes first
  double alpha = 0;              ///< 0: the default of vtkSurfaceWrap
  /// Sharp edges are looked for on the wrap, too, with the settings of the run: else not, as it rounds them.
  bool detectsFeatures = false;
};

/// run.execute(), on the input or a wrap of it. The output of the filter then holds quads whose points lie on the input
/// where they belong to it, and the notices of the run tell so.
ExitCode executeWrapped(RemeshRun& run, vtkPolyData* input, const WrapRequest& request);

} // namespace quadrille
