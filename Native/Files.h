// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Files of Python's read() and write(), by Core's readers and writers.
#pragma once

#include <pybind11/pybind11.h>

namespace quadrille::native
{

void bindFiles(pybind11::module_& module);

} // namespace quadrille::native
