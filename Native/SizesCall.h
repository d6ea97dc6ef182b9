// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Sizes of quads by names.
#pragma once

#include <pybind11/pybind11.h>

namespace quadrille::native
{

void bindSizes(pybind11::module_& module);

} // namespace quadrille::native
