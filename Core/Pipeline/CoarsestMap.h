// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The coarsest quad layout of a field, as an integer-grid map.
#pragma once

#include "GridMap/GridMap.h"

namespace quadrille
{

/// Like computeGridMap by the scale aware method, but with integers as small as a map can have whose quads are the
/// surface: with the smallest ones quads often touch themselves, round a torus for example. Then the integers come near
/// to a share of the sizes, which grows from a sixteenth by a factor of two until quads are sound, up to all.
/// options.pull is not looked at. The work of all tries is added up. Not ok where there is no map, or where even the
/// sizes asked for leave quads that touch themselves, which the caller finds then.
GridMapResult computeCoarsestMap(const Mesh& mesh, GridMapOptions options);

} // namespace quadrille
