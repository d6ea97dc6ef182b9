// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// remesh() of Python: arrays in, arrays out, with what vtkQuadRemesh does between its properties and Core.
#pragma once

#include "Evaluation/ConstraintWords.h"
#include "Ways/Ways.h"

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace quadrille::native
{

namespace py = pybind11;

/// What was made, and of what.
struct Remeshed
{
  QuadsMade made;
  AskedConstraints asked;
  std::vector<float> sizing; ///< of the input, to be judged
  std::vector<std::string> notices;
  RemeshOptions options;
  bool everything = false;
};

/// surface: see surfaceFrom. settings: JSON, see SessionJson.h. how: "preview", "everything", "time_limit", and where
/// they are asked for "symmetry" ("found", or "origin" and "normal" beside it as "symmetry_plane"), "plane_curve",
/// "rotation_order", "rotation_axis". lines: tuples of a kind (0 feature, 1 stroke, 2 connection, 3 cycle, 6 cleared
/// feature, 7 size), its points, its radius and its factor. progress: None, or a function, see ProgressCall. Returns a
/// dict of arrays, see resultDict. Raises InvalidInput, else RemeshError.
py::dict remeshCall(const py::dict& surface, const std::string& settings, const py::dict& how,
  const py::list& lines, const py::object& progress);

} // namespace quadrille::native
