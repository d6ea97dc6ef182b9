// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Choosing the integers on the decimated mesh [Coudert-Osmont et al. 2023, from its description]: a first valid
/// assignment, then strips that bring it nearer to what is wanted.
#pragma once

#include "Base/Progress.h"
#include "GridMap/IntegerMap.h"

namespace quadrille
{

struct IntegerStart
{
  bool valid = false;
  double scale = 1; ///< of the wanted displacements, at which the map became valid
};

/// Rounds, closes and repairs at growing scales (factor sqrt 2, up to maximumScale) until valid.
IntegerStart findValidIntegers(
  IntegerMap& map, double maximumScale, const ProgressCallback& progress);

/// Lowers the energy of a valid map by strips until none helps; it stays valid.
void improveIntegers(IntegerMap& map, const ProgressCallback& progress);

} // namespace quadrille
