// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The integer-grid map of the coarse mesh: seamless map (SeamlessMap.h) -> quantization (Quantize.h) -> re-embedding
/// (Embed.h), and the certificate that travels with every map (Certificate.h).
///
/// A map is one fixed-point uv per corner (half-edge id of Mesh, see there): uv[h] is the image of
/// origin[h] in the chart of face(h). Transitions are not stored: they follow exactly from uv and matching.
#pragma once

#include "Base/FixedPoint.h"
#include "Base/Progress.h"
#include "CrossField/CrossField.h"
#include "GridMap/Certificate.h"
#include "GridMap/MapCheck.h"
#include "GridMap/PreviousMap.h"
#include "Mesh/Mesh.h"
#include "Requests/Guides.h"

#include <cstddef>
#include <string>
#include <vector>

namespace quadrille
{

/// How the map is made [Ebke et al. 2016, Figure 8].
enum class MapMethod
{
  /// Seamless map without inverted triangles, integers from it, re-embedding: never inverted, whole everywhere. After
  /// [Ebke et al. 2014] by its aim; see Documentation/Design/Map.md for the means.
  ScaleAware,
  MixedInteger, ///< integers are rounded one at a time [Bommes et al. 2009]; triangles may be inverted
  QuadCover, ///< integers are rounded all at once [Kalberer et al. 2007]; triangles may be inverted
  Seamless   ///< no integers at all, so no quads; never inverted
};
/// "scale aware", "mixed integer", "QuadCover", "seamless".
const char* nameOf(MapMethod method);
/// Whether a map is what its method promises: valid, whole or, for the seamless one, seamless.
bool hasPromised(const Certificate& certificate, MapMethod method);

struct GridMapOptions
{
  MapMethod method = MapMethod::ScaleAware;
  double edgeLength = 0;  ///< s, on the surface; > 0
  double targetQuads = 0; ///< 0: follow edgeLength; else scale so that the uv area comes near this
  /// See QuantizeOptions. Below 1 the number of quads is what comes of it, targetQuads only scales the seamless map.
  double pull = 1;
  /// The ratio of the two stretches of a triangle, over the sizes that the mesh wants, from which on it is to come down
  /// as far as integers and irregular vertices let it, at the price of more distortion elsewhere; >= 1, or 0: no limit.
  /// Not by the methods that round.
  double anisotropyLimit = 0;
  Index maximumVertices = 100000;  ///< of the mesh; the solvers are made for coarse levels
  std::vector<Guide> guides;       ///< empty or #F, see CrossFieldOptions
  std::vector<int> targetValences; ///< empty or #V, the same
  std::vector<int> sectorTurns;    ///< empty or #H, the same
  SizeWish sizes = SizeWish::None; ///< the same
  /// Lines, which are features of the mesh (see DrawnLines.h); where no map is straight along all of them irregular
  /// vertices may lie on them, which GridMapResult::curves tells. Those that are not drawn stay out.
  std::vector<CurveRequest> curves;
  /// Parts of the boundary that get the same number of edges. Both of a pair must be of one component.
  std::vector<SeamRequest> seams;
  std::vector<StraightRequest> straight; ///< parts of the boundary
  /// Irregular vertices give way to each other where they can. Where a mesh with seams has no map, this is tried: a
  /// lone pair of valences 3 and 5 makes the two parts of a seam differ.
  bool fewIrregular = false;
  /// Empty or #F: how the surface that a face stands for is stretched against it, see CrossField::stretch.
  std::vector<Eigen::Matrix2d> stretch;
  /// An earlier map to start from (see PreviousMap.h), or null. The result is as valid as without, but may differ; it
  /// is the same for the same earlier map. Where it leads to no map, all is done again without it. Only the scale aware
  /// method starts from it.
  const PreviousMap* previous = nullptr;
  std::vector<Index> vertexIds; ///< #V where there is an earlier map: see PreviousMap::vertexIds
  ProgressCallback progress;
};
/// What a map has taken over from an earlier one.
struct MapReuse
{
  std::size_t faces = 0;    ///< that were the same before
  std::size_t seamless = 0; ///< components whose seamless map started from the earlier one
  std::size_t integers = 0; ///< components whose integers started from the earlier ones

  bool any() const { return seamless + integers > 0; }
};
/// What making maps has taken.
struct MapWork
{
  std::size_t work = 0; ///< as counted by countWork()
  double secondsField = 0, secondsSeamless = 0, secondsQuantize = 0, secondsEmbed = 0;
  /// The same in processor time of the whole process, which other programs on the machine do not disturb.
  double processorField = 0, processorSeamless = 0, processorQuantize = 0, processorEmbed = 0;
  int seamlessSteps = 0, embedSteps = 0; ///< Newton steps of all solves

  /// Adds what another, failed try has taken.
  void addWork(const MapWork& other);
};
struct GridMapResult : MapWork
{
  std::vector<FixedVec2> uv;         ///< #H; zero on connected components that have no map at all
  std::vector<FixedVec2> seamlessUv; ///< #H; of the components that have a map
  CrossField field;
  Certificate certificate;
  MapReuse reuse;
  Status status;               ///< not ok: why and where; uv then holds the best that was reached
  std::vector<Index> failedAt; ///< coarse vertices around which the triangulation lacks freedom
  FailedFaces failedFaces;     ///< coarse faces where that was; empty where it was not in faces
  std::vector<Index>
    failedIn; ///< a coarse vertex of each component that has no map, however it is tried
  std::vector<CurveOutcome> curves; ///< what became of GridMapOptions::curves
  double refinement = 1;            ///< of the component whose sizes had to shrink most
  /// The share of the area whose ratio of stretches is above the limit after all; 0 without limit, or where the status
  /// is not ok.
  double beyondAnisotropyLimit = 0;
  std::size_t components = 0, failedComponents = 0;
};
/// The whole chain on one coarse mesh. Its connected components are solved one by one; each gets quads by its area, and
/// all are tried, so that failedAt tells about every one that fails.
GridMapResult computeGridMap(const Mesh& mesh, const GridMapOptions& options);

/// What the next map can start from; the status of `map` must be ok. vertexIds: #V of its mesh.
PreviousMap previousMap(
  const Mesh& mesh, const GridMapResult& map, const std::vector<Index>& vertexIds);

} // namespace quadrille
