// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// NumPy's arrays and Core's vectors. Python has checked shapes and types before (Filters/Python/_inputs.py); what
/// comes otherwise is a mistake in that, and refused.
#pragma once

#include "Base/Types.h"
#include "Mesh/Surface.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <cstddef>
#include <vector>

namespace quadrille::native
{

namespace py = pybind11;

template <class Value>
using ArrayOf = py::array_t<Value, py::array::c_style | py::array::forcecast>;

/// n by 3.
std::vector<Vector3> vectorsFrom(const ArrayOf<double>& array);
py::array arrayFrom(const std::vector<Vector3>& vectors);

template <class Value>
std::vector<Value> valuesFrom(const ArrayOf<Value>& array)
{
  return { array.data(), array.data() + array.size() };
}

/// Of one dimension, or rows of `components`.
template <class Value>
py::array arrayFrom(const std::vector<Value>& values, std::size_t components = 1)
{
  std::vector<py::ssize_t> shape{ static_cast<py::ssize_t>(values.size() / components) };
  if (components > 1)
  {
    shape.push_back(static_cast<py::ssize_t>(components));
  }
  return py::array_t<Value>(shape, values.data());
}

template <class To, class From>
py::array castArrayFrom(const From& values, std::size_t components = 1)
{
  return arrayFrom(std::vector<To>(values.begin(), values.end()), components);
}

template <class To, class From, std::size_t kSize>
py::array rowsFrom(const std::vector<std::array<From, kSize>>& rows)
{
  std::vector<To> values;
  values.reserve(kSize * rows.size());
  for (const std::array<From, kSize>& row : rows)
  {
    values.insert(values.end(), row.begin(), row.end());
  }
  return arrayFrom(values, kSize);
}

/// surface: "points" (n by 3), "offsets", "corners", and of what is asked for any of "feature_edges", "patch_ids",
/// "guiding_direction", "guiding_weight", "target_valence", "sizing", "known_curvature" (6 a polygon), "designed" (its
/// features yield), see SurfaceInput.
SurfaceInput surfaceFrom(const py::dict& surface);

} // namespace quadrille::native
