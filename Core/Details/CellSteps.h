// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Steps between the cells that a surface is made of, which are no sharp edges of the shape.
#pragma once

#include "Mesh/Mesh.h"

#include <vector>

namespace quadrille
{

/// The features that nobody asked for (without kRequestedFeature) that are steps lower than `height` (> 0, units of the
/// mesh): the middle of another one that is about parallel, and bends the other way, is nearer. One half-edge of each,
/// ascending. A surface that is as smooth as its cells let it be has hardly any others, so there are none where they
/// are not most of the features.
std::vector<Index> stepsBelow(const Mesh& mesh, double height);

} // namespace quadrille
