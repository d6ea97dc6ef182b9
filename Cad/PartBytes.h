// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What was read as bytes, from one process to the other. Only the sources of Cad include this.
#pragma once

#include "Cad/CadFile.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

std::vector<std::uint8_t> bytesOf(const CadFile& file);
CadFile fileOf(const std::vector<std::uint8_t>& bytes);

} // namespace quadrille
