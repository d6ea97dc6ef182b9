// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Displacements on the half-edges of a decimated seamless map that make it an integer-grid map, changed by
/// strips: adding a vector along a closed chain of triangles, or one that ends at the boundary, leaves
/// every triangle closed.
///
///      \    / \    /        each crossed edge grows by e, which turns with the transitions;
///   --- \--/---\--/ ---     whatever lies on one side of the strip moves by e against the other side.
///        \/  e  \/
///
/// Displacements count in sixteenths of a quad: integer vertices lie whole quads apart, other vertices that the
/// decimation kept may lie between.
#pragma once

#include "Base/FixedPoint.h"
#include "Integers/UvMesh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace quadrille
{

/// Steps of a quad.
constexpr std::int64_t kGrain = 16;

/// What is wanted for an edge, in its lengths in the seamless map.
struct CurveShare
{
  double bent = 0; ///< for where its curve bends, whatever the size of quads
  double rest = 1; ///< follows the size of quads
  double all() const { return bent + rest; }
};

/// A displacement per half-edge of a UvMesh; q[twin h] = -R90^rotation q[h]. Edges may be flipped, which the
/// editor records.
class IntegerMap
{
public:
  /// integerVertex: #V; the vertices that have to lie at whole points. shares: #H or empty.
  IntegerMap(UvMesh& mesh, UvEditor& editor, const std::vector<std::uint8_t>& integerVertex,
    std::vector<CurveShare> shares = {});

  const UvMesh& mesh() const { return mesh_; }
  /// The faces that are alive, ascending.
  const std::vector<Index>& faces() const { return faces_; }
  /// Vertices that need not lie at whole points.
  const std::vector<Index>& freeVertices() const { return freeVertices_; }
  FixedVec2 operator[](Index h) const { return q_[h]; }
  /// In quads: what the energy is measured from, see setPull.
  Vector2 target(Index h) const { return target_[h]; }

  /// Rounds `scale` times what is wanted; no half-edge becomes zero. Triangles need not close.
  void round(double scale);
  /// The displacements of another map along the same half-edges, to the nearest sixteenth; uv: #H. Triangles close
  /// where its transitions are whole. False, with nothing to use, when an edge of a curve runs the wrong way there.
  bool adopt(const std::vector<FixedVec2>& uv);
  /// q[h] += e, and its twin follows.
  void shift(Index h, FixedVec2 e);
  /// Whether e keeps the half-edge on its isoline, and along it the way that is wanted.
  bool mayShift(Index h, FixedVec2 e) const;
  /// Moves a vertex by e in the chart of the half-edge that mesh().outgoing names.
  void moveVertex(Index v, FixedVec2 e);
  /// Whether moving by e keeps the vertex on its curve, between its neighbours there.
  bool mayMove(Index v, FixedVec2 e) const;
  /// From now on the energy is that of the difference to so many times what is wanted, but for curves that bend, which
  /// keep their numbers; >= 0; 1 at first. 0: displacements become as short as triangles stay sound.
  void setPull(double pull);
  /// The change of energy by moveVertex.
  double moveEnergy(Index v, FixedVec2 e) const;

  bool mayFlip(Index h) const;
  std::array<std::int64_t, 2> flippedDeterminants(Index h) const;
  void flip(Index h);
  /// Flips to the Delaunay triangulation of the displacements, as far as triangles stay sound.
  void makeDelaunay();

  /// What the edges of face f fail to close by; 0 where its corners are points.
  FixedVec2 residual(Index f) const { return q_[3 * f] + q_[3 * f + 1] + q_[3 * f + 2]; }
  /// Twice the area of face f in units of kGrain^-2 quads.
  std::int64_t determinant(Index f) const { return cross(q_[3 * f], q_[3 * f + 1]); }
  /// The determinant that a face has once e comes in over its half-edge `in` and leaves over `out`.
  std::int64_t crossedDeterminant(Index in, FixedVec2 e, Index out) const
  {
    const FixedVec2 a = q_[in] + e, b = q_[out] - e;
    return out == Mesh::next(in) ? cross(a, b) : cross(b, a);
  }
  /// 0 for a sound triangle, else by how much it misses that; in units of a determinant.
  static std::int64_t brokenness(std::int64_t determinant)
  {
    return determinant >= kLeastDeterminant ? 0 : kGrain * kGrain + kLeastDeterminant - determinant;
  }
  bool isSound(Index f) const { return determinant(f) >= kLeastDeterminant; }

  /// Steps that boundary loops lack to have three quads each: the two quads at a loop of two edges, or the two sides of
  /// one at a loop of one edge, would be joined along it, and the hole be lost.
  std::int64_t shortageOfLoops() const { return shortage_; }
  /// The half-edges of loops that lack some, ascending.
  std::vector<Index> shortLoops() const;
  /// Along the curve that h lies on, the way that lengthens it.
  FixedVec2 along(Index h) const;

  /// The change of the energy sum weight |q - target|^2 by shift(h, e).
  double energyChange(Index h, FixedVec2 e) const;
  double energy() const;
  /// In quads.
  double area() const;
  /// Every triangle closed and sound, and the winding at every vertex that of the seamless map.
  bool isValid() const;
  /// The vertices that wind otherwise than in the seamless map, ascending; of triangles that are closed and sound.
  std::vector<Index> wrongWindings() const;

  /// Along an axis.
  static std::int64_t lengthOf(FixedVec2 q) { return std::abs(q.u) + std::abs(q.v); }
  static std::int64_t cross(FixedVec2 a, FixedVec2 b) { return a.u * b.v - a.v * b.u; }

private:
  enum Axis : std::uint8_t
  {
    kFree,
    kOnlyU, ///< the half-edge runs along u: its v component stays zero
    kOnlyV
  };
  /// A triangle of a sixty-fourth of a quad is what re-embedding can still work with.
  static constexpr std::int64_t kLeastDeterminant = 8;

  static constexpr std::int64_t kLeastLoop = 3 * kGrain;

  static Vector2 inQuads(FixedVec2 q)
  {
    return Vector2(static_cast<double>(q.u), static_cast<double>(q.v)) / double(kGrain);
  }
  /// Whether an edge of a curve still runs the way that it should. No determinant tells: on a staircase of corners that
  /// turn by one and three quarters in turn, a step backwards makes three of one, and all triangles stay positive.
  static bool isAlong(std::int64_t step, double wanted) { return wanted > 0 ? step > 0 : step < 0; }
  void findLoops();
  void measureLoops();
  std::int64_t shortageOf(Index loop) const
  {
    return std::max<std::int64_t>(0, kLeastLoop - loopLength_[loop]);
  }
  void measure(Index h);
  void weigh(Index h);
  Vector2 seamless(Index h) const { return toDouble(mesh_.vector(h)); }
  double cotangentOpposite(Index h) const;
  bool wantsFlip(Index h) const;
  bool hasCornerToSpare(Index h) const;
  std::vector<FixedVec2> residues() const;
  FixedVec2 residueOf(Index v) const;
  FixedVec2 nearestAllowed(Index h, double scale, FixedVec2 residue) const;
  template <typename Visit>
  void visitStar(Index v, FixedVec2 e, Visit visit) const;
  template <typename VectorOf>
  std::vector<int> windings(VectorOf vectorOf) const;

  UvMesh& mesh_;
  UvEditor& editor_;
  double pull_ = 1;
  std::vector<std::uint8_t> integerVertex_;
  std::vector<Index> faces_;
  std::vector<Index> freeVertices_;
  std::vector<FixedVec2> q_;             ///< #H
  std::vector<Axis> axis_;               ///< #H
  std::vector<CurveShare> shares_;       ///< #H
  std::vector<Vector2> wanted_, target_; ///< #H, in quads: without and with the pull
  std::vector<double> weight_;           ///< #H; the same on both sides
  std::vector<int> turns_;               ///< #V; quarter turns in the seamless map
  std::vector<Index> loop_;              ///< #H; of boundary half-edges
  std::vector<std::int64_t> loopLength_;
  std::int64_t shortage_ = 0; ///< of all loops
};

/// The vectors of one step, counterclockwise from +u.
inline FixedVec2 stepVector(int direction, std::int64_t length)
{
  return rotate(FixedVec2{ length, 0 }, direction);
}

// The two that searches for strips spend most of their time in.

inline bool IntegerMap::mayShift(Index h, FixedVec2 e) const
{
  switch (axis_[h])
  {
    case kOnlyU:
      return e.v == 0 && isAlong(q_[h].u + e.u, wanted_[h].x());
    case kOnlyV:
      return e.u == 0 && isAlong(q_[h].v + e.v, wanted_[h].y());
    default:
      return true;
  }
}

inline double IntegerMap::energyChange(Index h, FixedVec2 e) const
{
  const Vector2 d = inQuads(e);
  return weight_[h] * d.dot(2 * (inQuads(q_[h]) - target_[h]) + d);
}

} // namespace quadrille
