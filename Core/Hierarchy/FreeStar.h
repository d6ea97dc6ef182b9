// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Removal of a vertex far from all constrained curves, with a small ring: nearly all of phase 1.
///
/// It does what VertexRemoval does, with the same guards, and writes the same records, but in single precision relative
/// to the vertex and with the triangles of a ring evaluated side by side: those that are rotations of each other
/// by the ring form one loop without branches. What single precision cannot judge (slivers) or the tables do not
/// hold (large rings) is left to VertexRemoval. No transcendental function of the system's
/// library is called, so the result does not depend on its version.
#pragma once

#include "Hierarchy/DecimationMesh.h"
#include "Hierarchy/FanFlips.h"
#include "Hierarchy/VertexRemoval.h"

#include <array>
#include <cstdint>

namespace quadrille
{

class FreeStar
{
public:
  enum class Outcome
  {
    Planned,  ///< apply() may follow
    Refused,  ///< by the shape of the star: again, as long as the star is the same
    Blocked,  ///< by valences round it, which other removals may change
    Unsuited, ///< ask VertexRemoval
  };
  /// Smallest and largest ring.
  static constexpr int kLeast = 3;
  static constexpr int kMost = 10;

  FreeStar(DecimationMesh& mesh, const RemovalGuards& guards) : mesh_(mesh), guards_(guards) {}

  /// Collects the star of an inner vertex of suitable valence.
  void gather(Index v);
  int ringSize() const { return size_; }
  Index ringVertex(int i) const { return ring_[static_cast<std::size_t>(i)]; }
  /// After gather(): the shortest edge at the vertex. This and what follows is in multiples of `unit`.
  float shortestEdge(double unit);

  /// After shortestEdge(): finds the new triangulation. No ring vertex may lie on a curve.
  Outcome plan();

  /// Carries out the plan and logs it.
  void apply(RecordWriter& log);

private:
  /// Ring arrays go round once and a half, so that the neighbours of a vertex follow it in memory.
  static constexpr std::size_t kLanes = 24;
  using Lanes = std::array<float, kLanes>;
  struct Triangle
  {
    std::uint8_t a = 0, b = 0, c = 0;
  };

  template <int N>
  Outcome planRing();
  template <int N>
  bool measure();
  template <int N>
  bool mapToPlane();
  template <int N>
  void evaluateTriangles();
  template <int N>
  bool triangulate();
  template <int N>
  Outcome checkRing();
  bool locate();
  bool hasDoubleVertex() const;
  bool hasOuterEdge(std::size_t a, std::size_t b, int valence) const;
  bool closesTetrahedron() const;
  int bestTarget() const;
  CollapseRecord makeRecord(int target) const;

  DecimationMesh& mesh_;
  RemovalGuards guards_;
  Index vertex_ = kInvalidIndex;
  int size_ = 0;
  std::array<Index, kMost> ring_{};
  std::array<Index, kMost>
    slot_{}; ///< corner of the vertex in face i, between ring vertices i and i + 1

  // Ring vertices minus vertex, their lengths and their images in the plane.
  alignas(64) Lanes x_{}, y_{}, z_{}, squared_{}, length_{}, u_{}, v_{};
  // Unit normals of the faces, angles at the vertex, shapes (1 for an equilateral triangle).
  alignas(64) Lanes nx_{}, ny_{}, nz_{}, angle_{}, shape_{};
  std::array<float, 3> mean_{}; ///< unit normal of the whole star
  float leastDot_ = 0;          ///< of normals of new triangles with those they replace
  float leastPlanar_ = 0;       ///< see VertexRemoval
  float mostHarmonic_ = 0;
  alignas(64)
    std::array<float, 144> cost_{}; ///< of the triangles; infinite for those that are not allowed

  std::array<Triangle, kMost> triangles_{};
  std::array<std::uint8_t, kMost> diagonals_{}; ///< new diagonals at each ring vertex
  std::array<std::uint8_t, 3> weightRing_{};
  std::array<float, 2> weight_{};

  FanFlips<kMost> flips_; ///< work of apply()
};

} // namespace quadrille
