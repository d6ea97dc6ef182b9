// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Pairs all triangles of a connected triangulation to quads: the best pairs first, and those that are left over, two
/// by two, along a path of quads between them. A triangle crosses a quad of the path so that the two become another
/// quad and another triangle, which has the edge to the next one; so it gets to the other triangle.
#pragma once

#include "Filling/FaceTriangulation.h"

#include <array>
#include <vector>

namespace quadrille
{

/// The quads of vertices of the triangulation, counterclockwise. Some edges of the triangulation are flipped, and
/// seldom one is split. The number of its triangles must be even.
std::vector<std::array<Index, 4>> pairTriangles(FaceTriangles& triangles);

} // namespace quadrille
