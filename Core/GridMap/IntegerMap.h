// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Whole displacements on the half-edges of a triangulated flat cone surface, changed by strips: adding a vector
/// along a closed chain of triangles, or one that ends at the boundary, leaves every triangle closed.
///
///      \    / \    /        each crossed edge grows by e, which turns with the transitions;
///   --- \--/---\--/ ---     whatever lies on one side of the strip moves by e against the other side.
///        \/  e  \/
#pragma once

#include "Base/FixedPoint.h"
#include "GridMap/UvMesh.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// The decimated mesh without dead slots, and what its half-edges should be.
struct IntegerDomain
{
  enum Axis : std::uint8_t
  {
    kFree,
    kOnlyU, ///< the half-edge runs along u: its v component stays zero
    kOnlyV
  };
  std::vector<Index> slot;           ///< #H; slot of the UvMesh
  std::vector<Index> origin;         ///< #H
  std::vector<Index> twin;           ///< #H
  std::vector<std::int8_t> rotation; ///< #H
  std::vector<Axis> axis;            ///< #H
  std::vector<Vector2> wanted;       ///< #H; displacement in quads
  std::vector<double> weight;        ///< #H; of |q - wanted|^2, the same on both sides
  std::vector<int> turns;            ///< #V; quarter turns round the vertex in the wanted map
  bool hasBoundary = false;

  static IntegerDomain from(const UvMesh& mesh);
  Index halfEdgeCount() const { return static_cast<Index>(twin.size()); }
  Index faceCount() const { return halfEdgeCount() / 3; }
};

/// A displacement in whole quads per half-edge; q[twin h] = -R90^rotation q[h].
class IntegerMap
{
public:
  explicit IntegerMap(const IntegerDomain& domain) : domain_(&domain), q_(domain.halfEdgeCount()) {}

  const IntegerDomain& domain() const { return *domain_; }
  FixedVec2 operator[](Index h) const { return q_[h]; }

  /// Rounds `scale` times what is wanted; no half-edge becomes zero. Triangles need not close.
  void round(double scale);
  /// q[h] += e, and its twin follows.
  void shift(Index h, FixedVec2 e);
  /// Whether e keeps the half-edge on its isoline.
  bool mayShift(Index h, FixedVec2 e) const;

  FixedVec2 defect(Index f) const { return q_[3 * f] + q_[3 * f + 1] + q_[3 * f + 2]; }
  /// Twice the area of face f in quads.
  std::int64_t determinant(Index f) const { return cross(q_[3 * f], q_[3 * f + 1]); }
  /// The change of the energy sum weight |q - wanted|^2 by shift(h, e).
  double energyChange(Index h, FixedVec2 e) const;
  double energy() const;
  double area() const;
  /// Every triangle closed and positive, and the winding at every vertex as wanted.
  bool isValid() const;

  static std::int64_t cross(FixedVec2 a, FixedVec2 b) { return a.u * b.v - a.v * b.u; }

private:
  const IntegerDomain* domain_;
  std::vector<FixedVec2> q_;
};

/// The unit vectors, counterclockwise from +u.
inline FixedVec2 unitVector(int direction)
{
  return rotate(FixedVec2{ 1, 0 }, direction);
}

} // namespace quadrille
