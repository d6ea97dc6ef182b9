// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Local changes of the connectivity of the quads of a face: a quad collapses, an edge comes to join two other points,
/// or two quads become four. Whether one is made is for the caller to say.
#pragma once

#include "Base/Lists.h"
#include "Filling/QuadRelaxation.h"
#include "Quads/QuadTopology.h"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace quadrille
{

class QuadChanges
{
public:
  using Quad = std::array<Index, 4>;
  struct Count
  {
    Index point, before, after; ///< quads at it
  };
  struct Change
  {
    std::vector<Index> old; ///< ids of quads that go
    /// Those that come, with the same boundary. They may have new points, which are the last ones of the mesh then.
    std::vector<Quad> made;
    std::vector<Count> counts; ///< of the points that get more or fewer quads, ascending
    void make(std::vector<Quad>& quads) const;
  };
  using Judge = std::function<bool(const Change& change)>;

  /// The quads must be a manifold, and remain one. A change is made where the judge says so; each new quad has four
  /// different points then, no two points are joined by two edges, pins have at least one quad, and other points have
  /// none or at least three.
  QuadChanges(FaceQuads& mesh, Judge judge);

  /// A point with two quads: they become one, whatever the judge says.
  bool tryDoublet(Index v);
  /// The changes for which half-edge h stands: of its quad, its beginning, its edge. True after the first one made.
  bool tryAt(Index h);
  /// Takes out the quads that have gone; then no more can be tried.
  void finish();

  Index pointCount() const { return static_cast<Index>(topology_.valence.size()); } ///< of before
  Index quadCount() const { return static_cast<Index>(isChanged_.size()); }         ///< the same

private:
  bool isPin(Index v) const { return v < mesh_.pinCount; }
  Index corner(Index h) const { return mesh_.quads[h / 4][h % 4]; }
  bool isFresh(Index v) const;
  bool areNeighbours(Index a, Index b) const;
  std::vector<Count> counts(const Change& change) const;
  bool mayBe(const Change& change) const;
  bool tryChange(std::vector<Index> old, std::vector<Quad> made);
  void make(const Change& change);
  bool tryCollapse(Index h);
  std::optional<std::array<Index, 6>> hexagonAt(Index h) const;
  bool tryRotateEdge(Index h);
  bool tryInsert(Index h);
  void addPoint(const std::array<Index, 6>& hexagon, Index a, Index b);
  void resize(std::size_t count);

  FaceQuads& mesh_;
  Judge judge_;
  QuadTopology topology_;
  std::vector<std::uint8_t> isChanged_; ///< per quad of before
  Grouped<> quadsAt_;                   ///< per point the half-edges that leave it
};

} // namespace quadrille
