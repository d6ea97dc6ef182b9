// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Shape functions of quads of second order, and the determinant of their Jacobian.
///
///   3----6----2     node 0 at (-1, -1), 2 at (1, 1); 8, the centre, has the Lagrange element
///   |         |     alone; the order of VTK, Exodus II, Abaqus and Gmsh
///   7    8    5
///   |         |     eta
///   0----4----1      ^-> xi
#pragma once

#include "Base/Types.h"

#include <array>
#include <cstddef>
#include <vector>

namespace quadrille
{

/// Nodes of one element in the order of the drawing; of 8 nodes the last one counts for nothing.
using QuadraticNodes = std::array<Vector3, 9>;

/// Where determinants are looked at: the nodes of the element, and the points of the 3 by 3 Gauss rule.
/// nodes: 8 or 9.
std::vector<Vector2> jacobianPlaces(int nodes);

/// d/dxi and d/deta of the shape functions at a place: of the serendipity element for 8 nodes, of the Lagrange element
/// for 9.
std::array<std::array<double, 9>, 2> shapeDerivatives(int nodes, const Vector2& place);

/// Determinants of an element with so many nodes against the normal of the straight quad of its corners.
class QuadraticShape
{
public:
  /// nodes: 8 or 9.
  explicit QuadraticShape(int nodes);

  /// The least over jacobianPlaces of normal . (x_xi cross x_eta), with the unit normal at the centre of the quad of
  /// the corners; units of an area. -infinity where that quad has none.
  double leastDeterminant(const QuadraticNodes& x) const;

private:
  std::vector<std::array<std::array<double, 9>, 2>> derivatives_; ///< per place
};

} // namespace quadrille
