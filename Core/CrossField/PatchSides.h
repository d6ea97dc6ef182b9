// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Patches, into which features and boundaries cut a surface, their sides from corner to corner, and which quarter
/// turns can move between corners of a patch.
#pragma once

#include "CrossField/FieldTopology.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace quadrille
{

/// A field, and what the choice of other turns goes by.
struct PatchSidesInput
{
  const Mesh& mesh;
  const FieldTopology& topology;
  const std::vector<int>& turns;             ///< per fan
  const std::vector<std::int8_t>& matching;  ///< #H, see CrossField
  const std::vector<std::int8_t>& alignment; ///< #H, see CrossField
  const std::vector<double>& natural;        ///< per fan, see naturalTurns
  double length = 0;                         ///< s
  /// Empty or #H: those that are not 0 stay, see CrossFieldOptions.
  const std::vector<int>& sectorTurns;
  const std::vector<int>& targetValences; ///< empty or #V, the same
};

/// One loop of the boundary of a patch.
struct PatchLoop
{
  Index patch = 0;
  std::vector<Index> halfEdges; ///< each ends where the next one begins
  std::vector<Index> corners;   ///< which of these begin at a corner
  std::vector<double> before;   ///< the length of those before each
  double length = 0;
  Index firstSide = 0; ///< one side for each corner; one where there is none
};

/// A side of a patch: a curve as seen from there.
struct PatchSide
{
  Index first = 0; ///< its first half-edge
  Index curve = 0;
};

/// A quarter turn goes from one corner of a loop to another: all sides between them turn by a quarter.
struct TurnMove
{
  /// What turns become more unnatural by: squared differences to their angles, in quarter turns.
  double cost = 0;
  Index loop = 0;
  Index from = 0, to = 0; ///< of its corners
  int by = 1;             ///< -1: the other way, and the sides between them turn the other way

  TurnMove back() const { return { -cost, loop, from, to, -by }; }
};

/// Lengths of the sides of a patch that run along u, along v, against u and against v.
using SidesByDirection = std::array<double, 4>;

class PatchSides
{
public:
  explicit PatchSides(const PatchSidesInput& input);

  const PatchSidesInput& input() const { return input_; }
  Index patchCount() const { return static_cast<Index>(isFree_.size()); }
  const std::vector<PatchLoop>& loops() const { return loops_; }
  const std::vector<PatchSide>& sides() const { return sides_; }
  /// Per patch: of sides().
  const std::vector<Index>& sidesOf(Index patch) const { return sidesOfPatch_[patch]; }
  Index patchOf(Index h) const { return patch_[Mesh::face(h)]; }
  /// Which way a side runs in the chart of its patch, as in SidesByDirection.
  int direction(Index firstHalfEdge) const { return direction_[firstHalfEdge]; }
  /// Whether sides along u may differ in sum from those against u: where the patch has irregular vertices, a handle, or
  /// a loop that turns by other than whole turns.
  bool isFree(Index patch) const { return isFree_[patch] != 0; }

  /// Between corners of one loop, as far as turns stay close to their angles and within the valences that fields have.
  std::vector<TurnMove> movesOf(Index loop) const;
  /// None where it may not be, as after another one.
  std::optional<double> costOf(const TurnMove& move) const;
  void apply(const TurnMove& move);
  /// The patch has no irregular vertices, and turns as they are now.
  void markChanged(Index patch) { isChanged_[patch] = 1; }
  bool isAnyChanged() const;
  /// All patches of the connected components of these are free and not changed, whatever was applied there.
  void leaveOut(const std::vector<Index>& patches);
  /// #H and #V, as in CrossFieldOptions: all of the patches that are marked.
  std::vector<int> sectorTurns() const;
  std::vector<int> targetValences() const;

private:
  int turnsOf(Index h) const { return turns_[input_.topology.fanOfCorner[h]]; }
  Index nextOnLoop(Index h) const;
  void numberPatches();
  void findCorners();
  void findLoops();
  void findSides();
  void findFreePatches();
  void findDirections();
  std::optional<double> costOf(Index h, int change, bool isShort) const;

  PatchSidesInput input_;
  const Mesh& mesh_;
  std::vector<int> turns_;               ///< per fan
  std::vector<Index> patch_;             ///< #F
  std::vector<std::uint8_t> isFree_;     ///< per patch
  std::vector<std::uint8_t> isChanged_;  ///< per patch
  std::vector<int> loopsOfPatch_;        ///< their number
  std::vector<std::uint8_t> isCorner_;   ///< #V
  std::vector<int> turnsAt_;             ///< #V
  std::vector<std::uint8_t> isBoundary_; ///< #V
  std::vector<std::uint8_t> direction_;  ///< #H, of constrained ones
  std::vector<PatchLoop> loops_;
  std::vector<PatchSide> sides_;
  std::vector<std::vector<Index>> sidesOfPatch_;
};

} // namespace quadrille
