// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Joints cut into segments, what the quads of each sheet have along them, and how many edges each segment gets (see
/// Assembly/SheetJoints.h).
#pragma once

#include "Assembly/JointSheets.h"
#include "Assembly/SheetBorders.h"
#include "Assembly/SheetJoints.h"
#include "Pipeline/Pipeline.h"

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace quadrille
{

/// A joint between two nodes, by points of the joint surface.
struct JointSegment
{
  std::vector<Index> points;
  std::vector<double> arc;   ///< from the begin, one a point
  std::size_t edges = 0;     ///< of the quads
  std::vector<double> stops; ///< arc of each point of the quads, edges + 1
};

/// What a sheet's quads have along a segment, or along its own boundary between two nodes.
struct SheetChain
{
  Index segment = kInvalidIndex;
  bool isForward = true;
  std::vector<Index> points; ///< of the quads, at least one
  std::size_t edges() const { return points.size() - 1; }
};

/// A boundary loop of a sheet, in the order of its boundary; each chain ends where the next one begins.
struct SheetLoop
{
  Index sheet = 0;
  std::vector<SheetChain> chains;
};

class JointChains
{
public:
  /// All of these stay for as long as it does; `met` hears of failures and of the number of segments.
  JointChains(const RemeshResult& result, const JointSheets& sheets,
    const std::vector<Vector3>& jointPoints, const SheetBorders& borders, int threads,
    MetSheets& met)
    : result_(result), mesh_(result.surface.mesh), quads_(result.quads), sheets_(sheets),
      jointPoints_(jointPoints), borders_(borders), fineLoops_(borders.loops()), threads_(threads),
      met_(met)
  {
  }

  void find()
  {
    findNodes();
    findSegments();
    findChains();
  }

  /// Of the edges of each segment: those of the sheet that has the most, and one more where sheets need that.
  void chooseNumbers();
  std::size_t lackOf(const SheetChain& chain) const;
  std::size_t lackOf(Index sheet) const;
  void fail(const std::string& what, Index jointPoint);

  std::vector<JointSegment>& segments() { return segments_; }
  std::vector<SheetLoop>& loops() { return loops_; }

private:
  /// Ends and branches of joints, where sheets change, and what the quads of a sheet have there.
  void findNodes();
  void findSegments();
  /// The chains of all sheets, cut at the points of the quads nearest to nodes.
  void findChains();
  void addLoop(const FineLoop& fine, const std::vector<std::pair<double, Index>>& points);
  /// A sheet without a boundary of its own can lack an even number only: some segments get an edge more for that.
  void makeSheetsEven();
  bool hasFree(Index sheet) const;

  const RemeshResult& result_;
  const Mesh& mesh_;
  const QuadMesh& quads_;
  const JointSheets& sheets_;
  const std::vector<Vector3>& jointPoints_;
  const SheetBorders& borders_;
  const std::vector<FineLoop>& fineLoops_;
  int threads_;
  MetSheets& met_;
  std::map<Index, std::vector<Index>> neighbours_; ///< along joints, by points of the joint surface
  std::set<Index> nodes_;
  std::vector<JointSegment> segments_;
  /// Of an edge from the first point to the second: its segment, and whether it runs along it.
  std::map<std::pair<Index, Index>, std::pair<Index, bool>> segmentOf_;
  std::vector<SheetLoop> loops_;
};

} // namespace quadrille
