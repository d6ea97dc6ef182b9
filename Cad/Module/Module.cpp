// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The module itself: everything that needs Open CASCADE behind one name, see Calls.h.
#include "Cad/Calls.h"

extern "C" __attribute__((visibility("default"))) const quadrille::CadCalls* quadrilleCadCalls()
{
  using namespace quadrille;
  static const CadCalls calls{ &readCadFile, &CadShape::ofBytes,
    [](const CadShape& shape) { return shape.bytes(); }, &tessellate, &placeOnShape, &takeVertices,
    &keepQuads };
  return &calls;
}
