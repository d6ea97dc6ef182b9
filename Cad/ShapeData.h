// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What is behind a CadShape. Only the sources of Cad include this, and with it Open CASCADE.
#pragma once

#include "Cad/Shape.h"

#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Shape.hxx>

namespace quadrille
{

struct CadShape::Data
{
  explicit Data(const TopoDS_Shape& all);

  TopoDS_Shape shape;
  // Open CASCADE counts from 1: id i is number i + 1.
  TopTools_IndexedMapOfShape faces;
  TopTools_IndexedMapOfShape edges;
  TopTools_IndexedMapOfShape vertices;
  std::size_t solids = 0;
  double diagonal = 0;
};

} // namespace quadrille
