// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Strips of quads by which sheets get the edges that others have along their common joint (see
/// Assembly/SheetJoints.h).
#pragma once

#include "Assembly/JointChains.h"
#include "Assembly/JointSheets.h"
#include "Assembly/SheetBorders.h"
#include "Assembly/SheetJoints.h"
#include "Pipeline/Pipeline.h"
#include "Quads/StripInsertion.h"

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace quadrille
{

class JointStrips
{
public:
  /// All of these stay for as long as it does; `met` hears of failures and of the number of strips.
  JointStrips(RemeshResult& result, const JointSheets& sheets, SheetBorders& borders,
    JointChains& chains, int threads, MetSheets& met)
    : mesh_(result.surface.mesh), quads_(result.quads), sheets_(sheets), borders_(borders),
      chains_(chains), segments_(chains.segments()), loops_(chains.loops()), threads_(threads),
      met_(met)
  {
  }

  /// A strip may end where nothing is lacking, if it must: then all sheets there lack an edge more.
  void fillSheets();
  const std::set<Index>& withStrips() const { return withStrips_; }

private:
  struct ChainPlace
  {
    std::size_t loop = 0, chain = 0;
  };

  /// Where no path leads to a chain that lacks edges too.
  bool fillOtherwise(const ChainPlace& from);
  std::optional<ChainPlace> mostLacking() const;
  /// Whether a strip from a chain may end at another one, or at the same: it lacks an edge, or has no others to fit.
  bool takesEnd(const ChainPlace& from, const ChainPlace& to) const;
  /// Before a strip goes there.
  void raise(const ChainPlace& from, const ChainPlace& to);
  bool insertFrom(const ChainPlace& from, bool mayRaise);
  /// The same by a chord of quads that is split: where no path can begin, as at a single quad between two corners.
  bool splitFrom(const ChainPlace& from, bool mayRaise);
  /// The edge of the boundary at the end of a chord, in the direction of the boundary.
  std::pair<Index, Index> endOf(const QuadPath& chord) const;
  std::optional<ChainPlace> chainOf(Index sheet, Index x, Index y) const;
  void insertBehind(const ChainPlace& place, Index point, Index added);
  /// A point of a chain that is on no joint goes away from its copy, or between its neighbours.
  void spreadOnBoundary(const ChainPlace& place, Index point);
  /// Over the surface, or along the feature that the point is on.
  void goTowards(Index p, const Vector3& displacement);
  double crowdedCost(Index p) const;
  /// The next strips keep away from this one, such that the points of the chain need not move far.
  void crowd(const ChainPlace& place, Index point);
  /// The copy comes behind the point in its chain, or before it.
  void splitAt(const ChainPlace& place, Index point, Index copy, bool behind);
  /// Points inside a strip go apart, by a third of the way to their neighbours across.
  void spread(const InsertedStrip& strip);

  const Mesh& mesh_;
  QuadMesh& quads_;
  const JointSheets& sheets_;
  SheetBorders& borders_;
  JointChains& chains_;
  std::vector<JointSegment>& segments_;
  std::vector<SheetLoop>& loops_;
  int threads_;
  MetSheets& met_;
  std::map<Index, double> crowded_; ///< by point of the quads, what it costs to begin a strip there
  std::set<Index> withStrips_;      ///< sheets
};

} // namespace quadrille
