// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Which files are CAD files. Needs no Open CASCADE.
#pragma once

#include <optional>
#include <string>

namespace quadrille
{

enum class CadFormat
{
  Step,
  Iges,
  Brep
};

/// By the extension, in either case: stp and step, igs and iges, brep and brp; none for others.
std::optional<CadFormat> cadFormatOf(const std::string& path);

} // namespace quadrille
