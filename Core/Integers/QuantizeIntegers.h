// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Choosing the integers on the decimated mesh [Coudert-Osmont et al. 2023, from its description]: a first valid
/// assignment, then strips, moves of free vertices and flips that bring it nearer to what is wanted.
#pragma once

#include "Base/Progress.h"
#include "Integers/IntegerMap.h"

#include <cstddef>
#include <vector>

namespace quadrille
{

struct IntegerStart
{
  bool valid = false;
  double scale = 1;      ///< of the wanted displacements, at which the map became valid
  std::size_t steps = 0; ///< StripSearch::work of closing and repairs
};

/// Real models became valid at scales up to about 12; where 12 is not enough the failures seen came back at every scale
/// up to 256, so this leaves some room and ends there.
constexpr double kMaximumScale = 32;

/// Rounds, closes and repairs at scales that grow from 1 by sqrt 2 up to kMaximumScale until valid.
IntegerStart findValidIntegers(IntegerMap& map, const ProgressCallback& progress);

/// Closes and repairs displacements that were rounded, or were valid before the wanted ones or the kept vertices
/// changed; not valid where that does not succeed.
IntegerStart repairIntegers(IntegerMap& map);

/// Where the map is not valid: the triangles that are not closed, or not sound; where all are, those round vertices
/// that wind otherwise than in the seamless map.
std::vector<Index> brokenFaces(const IntegerMap& map);

/// Lowers the energy of a valid map until nothing helps, or half of the work that is left is done; it stays valid.
void improveIntegers(IntegerMap& map, const ProgressCallback& progress);

} // namespace quadrille
