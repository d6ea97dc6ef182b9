// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Half-edges of quads: half-edge 4q + i runs from corner i of quad q to corner i + 1.
#pragma once

#include "Base/Types.h"

namespace quadrille
{

inline Index nextInQuad(Index h)
{
  return h % 4 == 3 ? h - 3 : h + 1;
}

inline Index previousInQuad(Index h)
{
  return h % 4 == 0 ? h + 3 : h - 1;
}

inline Index oppositeInQuad(Index h)
{
  return h % 4 < 2 ? h + 2 : h - 2;
}

} // namespace quadrille
