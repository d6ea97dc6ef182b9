// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What is left of a handle after it was cut and closed: two pits, or two stubs, with a cap at the end of each.
#pragma once

#include "Mesh/Surface.h"

namespace quadrille
{

/// Takes out a pit or stub up to its mouth and closes the surface there with a fan (see fillWithFan). `h` leaves the
/// middle of the cap at its end; `girth` is the length of the cap's edge, > 0, in units of the mesh. Of the discs round
/// the middle whose edge is not longer than 1.5 girths the one is taken out that has, within a twentieth, most area
/// beyond that of its fan. Left as it is where discs do not open into a surface, as on a ring or on a limb that ends;
/// where one would take away what was asked for (features, valences, sectors) or meet the boundary; where the fan would
/// fold; or where there is no pit to speak of. Returns whether something was taken out: then slots of faces are empty
/// until orderSurface.
/// A disc whose edge is longer than `opening`, in units of the mesh, has opened whatever the girth is: what is that
/// thick is no stub but a limb that quads show.
bool removeStub(PreparedSurface& surface, Index h, double girth, double opening = kInfinity);

} // namespace quadrille
