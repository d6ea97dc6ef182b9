// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Short loops round the handles of a surface, or through them.
///
/// Such a loop does not cut the surface in two, where all boundary loops are thought to be closed. That is told by its
/// homology class with coefficients in Z/2, the sum of labels of its edges, which a tree and a cotree give [Eppstein
/// 2003; Busaryev et al.
/// 2012]. The shortest loops are made of two shortest paths from one vertex and an arc between their ends [Erickson and
/// Whittlesey 2005]. Here the paths end at half of the length that is looked for, so that a search stays near its
/// vertex.
#pragma once

#include "Mesh/Mesh.h"

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

namespace quadrille
{

class LoopSearch
{
public:
  enum Moves
  {
    kStraightened, ///< along edges, and straight across pairs of triangles
    kInnerEdges    ///< along edges only, and by no vertex of the boundary
  };
  /// A step of a path: along a half-edge, or from the corner before it across its edge to the corner beyond.
  struct Arc
  {
    Index halfEdge = kInvalidIndex;
    bool across = false;
  };
  /// Simple and closed: arc i joins vertex i and the next one.
  struct Loop
  {
    std::vector<Index> vertices;
    std::vector<Arc> arcs; ///< in either direction
    double length = 0;
  };
  /// Bit i, in words of 64: the coefficient of generator i.
  using Class = std::vector<std::uint64_t>;
  /// By the sum of the labels, the shortest loop that has it. With up to 32 handles that is the class itself; with
  /// more, 64 bits of it, which two classes share with a chance of 2^-64.
  using LoopsByLabel = std::unordered_map<std::uint64_t, Loop>;

  /// Linear. The mesh passes validate().
  LoopSearch(const Mesh& mesh, Moves moves);

  /// The genus, the sum over all components.
  std::size_t handles() const { return generators_.size() / 2; }
  /// Vertices of which every loop that is looked for meets one; ascending.
  std::vector<Index> roots() const;
  /// For each of the 2 `handles()` generators a vertex that is on a loop of its class.
  std::vector<Index> generatorRoots() const;

  /// Collects loops round handles that two shortest paths from the root and an arc make in less than `bound`.
  void search(Index root, double bound, LoopsByLabel& loops);
  /// The shortest of these; none below the bound.
  std::optional<Loop> shortest(Index root, double bound);

  Class classOf(const Loop& loop) const;
  /// The intersection with each generator: bit i says whether a loop of the class and generator i cross an odd number
  /// of times.
  Class crossings(const Class& loop) const;
  /// Vertices that searches have visited so far, all together.
  std::size_t work() const { return work_; }

private:
  struct Generator
  {
    Index halfEdge; ///< the lower one of its edge
    std::uint64_t code;
    std::size_t firstEnd = 0; ///< where the contour of the tree meets its two ends
    std::size_t lastEnd = 0;
  };
  struct Visit
  {
    std::uint32_t search = 0; ///< what follows belongs to this search
    bool settled = false;
    Index from = kInvalidIndex;
    Arc arc;
    double distance = 0;
    std::uint64_t label = 0;
  };

  void closeBoundary();
  void growTree();
  void growCotree();
  void collectGenerators();
  void labelEdges();
  void walkContour();
  void addEdge(Index h, Class& sum) const;
  template <typename Visitor>
  void forEachArc(Index v, Visitor&& visit) const;
  template <typename Meeting>
  void spread(Index root, const double& bound, Meeting&& meet);
  Loop trace(Index a, Index b, const Arc& arc, double length) const;

  Mesh mesh_; ///< without flags, and closed: each boundary loop has a fan round a vertex of its own
  Index vertices_; ///< of the surface itself
  Index faces_;    ///< of the surface itself
  Moves moves_;
  std::vector<Index> outgoing_;      ///< #V
  std::vector<std::uint8_t> barred_; ///< #V; no path comes here
  std::vector<std::uint8_t> inTree_; ///< #H
  std::vector<Index> parent_; ///< #F; half-edge of the face to the one before it on the cotree
  std::vector<Index> order_;  ///< #F; faces from the roots of the cotree on
  std::vector<Index> rank_,
    lastRank_; ///< #F; the subtree of a face has the ranks in between, both included
  std::vector<Generator> generators_; ///< ascending by half-edge
  std::vector<std::uint64_t> label_;  ///< #H; sum of the codes of the generators that have the edge
  std::vector<Visit> visits_;         ///< #V
  std::uint32_t search_ = 0;
  std::size_t work_ = 0;
};

} // namespace quadrille
