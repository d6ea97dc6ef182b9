// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A grid map in one try: its field, the maps of its components, and these as one.
#pragma once

#include "GridMap/FieldOfMap.h"
#include "GridMap/GridMap.h"

namespace quadrille
{

/// A map of one try, and whether its field holds all irregular vertices.
struct TriedMap
{
  GridMapResult map;
  bool holdsIrregular = false; ///< of the field that was led along the curves
};

TriedMap mapInOneTry(const Mesh& mesh, const GridMapOptions& options, const CurveTry& howto);

} // namespace quadrille
