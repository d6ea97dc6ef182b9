// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Shortest strips (see IntegerMap.h) by Dijkstra's algorithm over (half-edge entered, vector carried).
#pragma once

#include "Integers/IntegerMap.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace quadrille
{

/// One shift of a strip.
struct StripStep
{
  Index halfEdge;
  FixedVec2 e;
};

struct Strip
{
  std::vector<StripStep> steps;
  double cost = kInfinity;
  bool found() const { return !steps.empty(); }
};

/// A strip on its way, as a number: the half-edge that it enters a face over, and the direction of its vector.
inline Index stateOf(Index h, FixedVec2 e)
{
  const Index direction = e.u > 0 ? 0 : e.v > 0 ? 1 : e.u < 0 ? 2 : 3;
  return 4 * h + direction;
}
inline FixedVec2 vectorOfState(Index state, std::int64_t length)
{
  return stepVector(static_cast<int>(state & 3), length);
}

/// What crossing a triangle costs.
enum class StripCost
{
  KeepSound, ///< never breaks a triangle; cost is the energy that edges gain
  Repair     ///< breaking costs first, energy second
};

class StripSearch
{
public:
  /// faceWeight: #F, multiplies the price of breaking a face; must outlive the search. None: all 1.
  StripSearch(
    const IntegerMap& map, StripCost cost, const std::vector<double>* faceWeight = nullptr);

  /// The cheapest strip that contains shift(h, e): a closed one, or one from boundary to boundary. The
  /// price of that first shift is left out; strips that cost `bound` or more are not found. With KeepSound the search
  /// also ends after a bounded number of steps, and what it has found till then counts; and it looks both ways from h
  /// in turn, as there is no strip where either has no way on.
  Strip through(Index h, FixedVec2 e, double bound);

  /// The cheapest strip that carries the vector e of the residual of face f to a face whose residual it
  /// lowers, or out through the boundary. residuals: #F.
  Strip discharge(Index f, FixedVec2 e, const std::vector<FixedVec2>& residuals);

  /// The faces that the last call of through() looked at, each once: as long as none of them changes, the same call
  /// finds the same.
  const std::vector<Index>& visitedFaces() const { return visited_; }
  /// Half-edges with their step that all searches so far have settled.
  std::size_t work() const { return work_; }

  static constexpr double kBroken = 1e4; ///< price of one unit of IntegerMap::brokenness

private:
  struct End
  {
    double cost = kInfinity;
    Index state = kInvalidIndex; ///< last state of the path; kInvalidIndex: the path has none
    Index exit = kInvalidIndex;  ///< boundary half-edge that it leaves through
    FixedVec2 exitVector;
  };

  /// A state as a search has left it.
  struct Reached
  {
    double distance = 0;
    Index parent = kInvalidIndex;
    std::uint32_t stamp =
      0; ///< twice the round that reached it, and one more where that has settled it
  };
  struct Entry
  {
    double cost;
    Index state;

    bool isBefore(const Entry& other) const
    {
      return cost < other.cost || (cost == other.cost && state < other.state);
    }
  };

  /// The states that one search has reached, and those from which it goes on.
  struct Front
  {
    std::vector<Reached> reached; ///< by state
    std::uint32_t round = 0;
    std::vector<Entry>
      heap; ///< a heap of four children each: half as deep, and those lie side by side

    void restart()
    {
      ++round;
      heap.clear();
    }
    void push(Entry entry);
    Entry popFirst();
    void relax(Index state, double cost, Index parent);
  };

  /// Shortest ways on from shift(h, e): to where it closes, and to a boundary.
  struct Exploration
  {
    Front& front;
    Index h;
    FixedVec2 e;
    double bound;
    Index last = kInvalidIndex; ///< over which it closes
    FixedVec2 closing = {};
    Index start = kInvalidIndex; ///< state
    std::size_t settled = 0;
    bool isOver = false; ///< nothing cheaper is left to be found
    bool isCut = false;  ///< as it has taken too many steps
    End closed = {}, border = {};

    bool hasFound() const { return closed.cost < bound || border.cost < bound; }
  };

  void visit(Index f);
  FixedVec2 vectorOf(Index state) const { return vectorOfState(state, length_); }
  bool pop(Front& front, Index& state, double& cost);
  double crossingCost(Index in, FixedVec2 e, Index out, bool isFirst) const;
  double edgeCost(Index out, FixedVec2 e) const;
  Exploration begin(Front& front, Index h, FixedVec2 e, double bound) const;
  void step(Exploration& way);
  /// Goes a way to its end, or until the other one, step by step beside it, has come to nothing; whether it has found
  /// anything. other: may be null.
  bool explore(Exploration& way, Exploration* other);
  void appendPath(const Front& front, const End& end, std::vector<StripStep>& steps) const;

  const IntegerMap& map_;
  const UvMesh& mesh_;
  StripCost cost_;
  const std::vector<double>* faceWeight_;
  std::int64_t length_ = 1; ///< of the vectors of the current search
  Front onward_, back_;     ///< on both sides of the half-edge that a strip is to contain
  std::vector<Index> visited_;
  std::vector<std::size_t> visitStamp_; ///< #F: the search that visited the face last
  std::size_t searches_ = 0;
  std::size_t work_ = 0;
};

} // namespace quadrille
