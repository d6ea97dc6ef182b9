// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// nlohmann-json for sources that include VTK, too. After VTK 9.3.0 the headers of VTK's arrays declare types of its
/// own copy of that library, under the same guards and with a macro for the name of the namespace, so that both cannot
/// be in one translation unit: there VTK's copy is taken.
#pragma once

#include <vtkAbstractArray.h>

#ifdef VTK_NLOHMANN_JSON
#include VTK_NLOHMANN_JSON(json.hpp)
#else
#include <nlohmann/json.hpp>
#endif
