// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a run has made, as dicts of NumPy's arrays.
#pragma once

#include "Native/RemeshCall.h"
#include "Pipeline/RunFields.h"

namespace quadrille::native
{

/// "points", "quads"; "point_data" and "cell_data": dicts of arrays by the names that VTK's output has; where the quads
/// come from, to carry arrays: "point_source" (polygon, three points and their weights a point) and "quad_source" (a
/// polygon a quad); "fields": a dict of lists; "constraints" and "details": lists of dicts; with everything also
/// "surface", "lines" and "separatrices".
py::dict resultDict(const Remeshed& remeshed);

/// Points, and quads as the same.
py::tuple quadArrays(const QuadMesh& quads);

} // namespace quadrille::native
