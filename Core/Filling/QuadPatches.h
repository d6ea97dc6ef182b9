// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Patches of a quad mesh that are changed by themselves: rings of quads round one, between the lines of the mesh.
#pragma once

#include "Base/Lists.h"
#include "Filling/FaceGround.h"
#include "Filling/QuadRelaxation.h"
#include "Quads/QuadMesh.h"
#include "Quads/QuadShape.h"
#include "Quads/QuadTopology.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace quadrille
{

/// Gaps, quads without points, do not count.
QuadScore scoreOf(const FaceQuads& mesh);

struct QuadPatch
{
  std::vector<Index> quads;   ///< the nearest ones first
  std::size_t changeable = 0; ///< so many of them, the first ones, may change
  std::vector<Index>
    points;      ///< pins first: those on lines, that stay, or have quads outside of the patch
  FaceQuads own; ///< with these points
  std::vector<Index> triangles; ///< below the patch and round it, without crossing features
  std::shared_ptr<const Mesh> below;
  std::shared_ptr<const FaceGround> ground;
};

/// While changes are made, quads that have gone are gaps, and new ones come last.
class QuadPatches
{
public:
  /// fixedVertices: of the mesh, ascending; points on them stay, with their quads. The quads must be a manifold.
  QuadPatches(const Mesh& mesh, QuadMesh& quads, const std::vector<Index>& fixedVertices);

  /// By their points: patches do not cross these chains, and their points stay.
  void keep(const std::vector<std::vector<Index>>& chains);
  bool stays(Index p) const { return stays_[p] != 0; }
  /// By an edge, before.
  bool areJoined(Index a, Index b) const;

  /// Rings round a quad of before. None where one of the quads was changed already, or no triangle is found below.
  std::optional<QuadPatch> around(Index q) const;
  /// Puts changed quads and points in place of those of the patch. made: with gaps, points first as in the patch.
  void write(const QuadPatch& patch, const FaceQuads& made);
  /// Drops gaps and points without quads; then no more can be asked.
  void finish();

private:
  bool isOnLine(Index a, Index b) const { return lines_.count(std::minmax(a, b)) != 0; }
  bool collect(Index first, QuadPatch& patch) const;
  std::vector<Index> trianglesBelow(const QuadPatch& patch) const;
  void number(QuadPatch& patch) const;

  const Mesh& mesh_;
  QuadMesh& quads_;
  QuadTopology topology_;
  Grouped<> quadsAt_; ///< per point
  std::vector<std::uint8_t> stays_, onLine_;
  std::vector<std::uint8_t> isTouched_; ///< per quad: by a change
  std::set<std::pair<Index, Index>> lines_;
};

} // namespace quadrille
