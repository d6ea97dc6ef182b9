// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Cad/CadFormat.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace quadrille
{

std::optional<CadFormat> cadFormatOf(const std::string& path)
{
  std::string e = std::filesystem::path(path).extension().string();
  std::transform(e.begin(), e.end(), e.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return e == ".stp" || e == ".step" ? std::optional(CadFormat::Step)
    : e == ".igs" || e == ".iges"    ? std::optional(CadFormat::Iges)
    : e == ".brep" || e == ".brp"    ? std::optional(CadFormat::Brep)
                                     : std::nullopt;
}

} // namespace quadrille
