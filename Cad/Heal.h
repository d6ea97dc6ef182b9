// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Shapes made valid by Open CASCADE's fixers. Only the sources of Cad include this.
#pragma once

#include <TopoDS_Shape.hxx>

#include <functional>
#include <string>
#include <vector>

namespace quadrille
{

struct HealedShape
{
  TopoDS_Shape shape;
  /// What has become of a face, edge or vertex of the shape before.
  std::function<TopoDS_Shape(const TopoDS_Shape&)> healed;
  std::vector<std::string> repairs; ///< "3 faces with self-intersecting wires were repaired"
};

/// The free edges of faces of no solid are sewn where they meet, and what BRepCheck finds invalid goes through
/// ShapeFix_Shape. A shape that is valid stays as it is. What is invalid after that is told, too.
HealedShape healShape(const TopoDS_Shape& shape);

} // namespace quadrille
