// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Sessions of Python, with the methods of vtkQuadrilleSession; what is wrong is raised.
#pragma once

#include <pybind11/pybind11.h>

namespace quadrille::native
{

void bindSession(pybind11::module_& module);

} // namespace quadrille::native
