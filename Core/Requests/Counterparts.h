// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What an irregular vertex needs beside it where features all round leave it nothing else.
///
///    3 --- 5      The indices of the four make up for each other, and so do the shifts of the two pairs: a curve round
///    |     |      them comes back to where it began, whatever the angle between their square and the quads. Round one
///    5 --- 3      pair alone opposite sides of a face between features have other numbers of quads.
#pragma once

#include "Mesh/Surface.h"

#include <vector>

namespace quadrille
{

/// Requests for three more vertices, at the corners of a square of this side whose fourth one has what was asked for.
/// They may drift. Of eight squares it is the one that is farthest from what bounds the face. Empty where asked is on a
/// feature or the boundary, or no square has vertices of the face near its corners.
std::vector<ValenceRequest> counterparts(
  const PreparedSurface& surface, const ValenceRequest& asked, double side);

} // namespace quadrille
