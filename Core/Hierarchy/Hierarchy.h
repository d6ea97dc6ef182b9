// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Decimation to the intermediate and the coarse level, and its log [Ebke et al. 2016, Section 5].
#pragma once

#include "Base/Progress.h"
#include "Hierarchy/DecimationLog.h"
#include "Mesh/Mesh.h"
#include "Requests/Guides.h"

#include <memory>
#include <string>
#include <vector>

namespace quadrille
{

enum class DecimationCost
{
  Gaussian,       ///< E_G: change of Gaussian curvature against the current mesh
  GaussianMemory, ///< E_G,mem: against the input mesh
  Quadric,        ///< E_QEM, to compare with (ComparedCosts.h)
  Uniform         ///< E_uni: shortest incident edge; the same
};

/// A budget of the coarse level that follows the surface [after the same, Section 10]. Each removal moves curvature,
/// half of E_G, about an edge far. Singularities of the field are where the curvature is, and a quad mesh can place
/// them by s only; so phase 2 ends when the curvature of the intermediate level would have moved by more than
/// kCurvatureShift s on average.
/// Performance.md has what that does to the singularities.
constexpr double kCurvatureShift = 0.5;
/// The limits of such a budget: with less the map lacks room, with more it takes seconds.
constexpr Index kLeastCoarseVertices = 300;
constexpr Index kMostCoarseVertices = 4000;

struct HierarchyOptions
{
  double targetEdgeLength =
    0; ///< s, in units of the mesh; > 0. Phase 1 ends when edges exceed s/2.
  /// Budget of the coarse level; raised where features, handles or components need more (told in Hierarchy::notice).
  /// 0: as many as the curvature needs, see kCurvatureShift; for the costs Gaussian and GaussianMemory only.
  Index coarseVertices = 1000;
  DecimationCost cost = DecimationCost::Gaussian; ///< of phase 2
  /// Phase 2 begins with more rounds like those of phase 1 where the intermediate level has more vertices than this. An
  /// ordered removal costs fifteen times as much as one of these, and a level of so many vertices resolves ten times
  /// what the coarse level can; with an eighth of them the irregular vertices of bunny_ct increase by a third.
  Index mostOrdered = 30000;
  /// Vertices of the finest mesh that no phase may remove (index constraints; places where a map needs
  /// more freedom, see TransferResult::defectVertices).
  std::vector<Index> keepVertices;
  /// Guides of faces of the finest mesh, ascending by face (see surfaceGuides), which are brought to the intermediate
  /// level. No triangle of any level depends on them.
  std::vector<FaceGuide> guides;
  /// Phase 1 may leave some edges shorter than s/2, where that costs more time than it saves later: for a
  /// level that is thinned out again.
  bool isRough = false;
  /// The finest mesh has no noise, so that no fold of it has to be flattened: phase 1 leaves those that it has.
  bool isExact = false;
  /// The finest mesh is known to have one component, which saves looking for small ones; the result is the same.
  bool isConnected = false;
  int threads = 0; ///< 0: all; the result does not depend on it
  ProgressCallback progress;
};

/// A coarser mesh whose corners are slots of the finest mesh: corner i of face f is corner i of the
/// finest level's face fineFace[f].
struct Level
{
  Mesh mesh;
  std::vector<Index> fineVertex; ///< #V; id on the finest mesh (levels are subsamplings)
  std::vector<Index> fineFace;   ///< #F
  std::vector<Guide> guides;     ///< #F, or empty where no face has one
};
/// Vertices of the level on the finest mesh.
std::vector<Index> onFinest(const std::vector<Index>& vertices, const Level& level);

/// How much of phase 2's evaluations of removals the cache of Section 5.3 saved.
struct CacheReport
{
  std::size_t lookups = 0; ///< triangulations of stars that were asked for
  std::size_t hits = 0;    ///< those that the cache knew
  std::size_t bytes = 0;   ///< afterwards
};

struct Hierarchy
{
  Level intermediate;
  Level coarse;
  DecimationLog log;
  std::string notice; ///< empty, or why the coarse level is larger than asked
  CacheReport cache;
  /// By how much phase 2 has moved the curvature of the intermediate level on average, in s, at most; for the costs
  /// Gaussian and GaussianMemory. See kCurvatureShift.
  double curvatureShift = 0;
  double secondsPhase1 = 0;
  double secondsPhase2 = 0;
};

/// A hierarchy whose coarse level can be made again, from the intermediate one, when other vertices are to be kept,
/// or the budget changes [Section 5.3]. What a removal costs is remembered from one time to the next by the
/// star of the vertex; the result is the same as without.
class Redecimation
{
public:
  /// Phase 1 with the vertices to keep of the options. Throws InvalidInput when s is not positive and finite, or the
  /// budget is 0 for a cost that knows no curvature. Progress and cancel through the options.
  Redecimation(const Mesh& fine, std::uint64_t fineHash, const HierarchyOptions& options);
  ~Redecimation();
  Redecimation(Redecimation&&) noexcept;
  Redecimation& operator=(Redecimation&&) noexcept;

  /// The intermediate level as phase 1 left it, without vertices that were brought back. Valid until update().
  const Level& intermediateOfPhase1() const;
  /// Other sizes of the finest mesh, for the next update().
  void setSizes(SharedArray<float> sizing);
  /// Phase 2: makes the coarse level and the end of the log anew. Vertices to keep that phase 1 has removed come back
  /// first, and as many as are needed where the mesh has smaller sizes now, see VertexRestoration.h. The result depends
  /// on what phase 1 was given, and on what is asked for now, but not on what came between. Throws InvalidInput unless
  /// the target edge length is that of phase 1; all else may change. Cancelled leaves the hierarchy without a coarse
  /// level.
  const Hierarchy& update(const HierarchyOptions& options);
  /// The hierarchy after the last update().
  const Hierarchy& hierarchy() const;
  /// The guides of the options, which alone have changed since update(), on the intermediate level: no triangle of any
  /// level depends on them. Those of the coarse level are for the caller to gather, see Transfer/SurfaceStretch.h.
  void setGuides(const HierarchyOptions& options);
  /// Guides of the coarse level (#F), until the next update().
  void setCoarseGuides(std::vector<Guide> guides);
  /// Gives the hierarchy away; this object must not be used any more.
  Hierarchy take();
  /// Of what is held to go back to the level that phase 1 left; hierarchy() is not among it.
  std::size_t bytesAside() const;

private:
  class Implementation;

  std::unique_ptr<Implementation> implementation_;
};

/// Whether bringing so many vertices back, and making quads smaller where the mesh has smaller sizes than these, is
/// less work than another phase 1 that knows them.
bool isLocalChange(const Mesh& fine, const std::vector<float>& sizesBefore, std::size_t kept);

} // namespace quadrille
