// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// CAD files, with the module for Open CASCADE beside this one.
#pragma once

#include <pybind11/pybind11.h>

namespace quadrille::native
{

void bindCad(pybind11::module_& module);

} // namespace quadrille::native
