// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Faces of volumes that are inside, between two pieces.
#pragma once

#include "Ranks/Spread.h"

#include <string>
#include <vector>

namespace quadrille
{

/// Faces of volume cells that two pieces have are inside of the volume and go. Only faces whose box meets that of
/// another piece are looked at. Collective.
void dropInnerFaces(const Ranks& ranks, std::vector<SpreadPiece>& pieces, bool byIds, double unit,
  std::vector<std::string>& notices);

} // namespace quadrille
