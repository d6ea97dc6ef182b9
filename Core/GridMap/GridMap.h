// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The integer-grid map of the coarse mesh: seamless map -> quantization -> re-embedding, and the
/// certificate that travels with every map.
///
/// A map is one fixed-point uv per corner (half-edge id of Mesh, see there): uv[h] is the image of
/// origin[h] in the chart of face(h). Transitions are not stored: they follow exactly from uv and matching.
#pragma once

#include "Base/FixedPoint.h"
#include "Base/Progress.h"
#include "CrossField/CrossField.h"
#include "GridMap/PreviousMap.h"
#include "Mesh/Mesh.h"

#include <string>
#include <vector>

namespace quadrille
{

/// Why a map is, or is not, an integer-grid map. All counts are zero for a valid one.
struct Certificate
{
  std::size_t triangles = 0;
  std::size_t notPositive = 0;   ///< triangles with !(det > 0)
  std::size_t wrongTurns = 0;    ///< vertices whose winding is not the expected one
  std::size_t seamResiduals = 0; ///< edges whose two images differ by more than a transition
  std::size_t offAxes = 0;       ///< constrained edges that are not parallel to an axis
  std::size_t offIsolines = 0;   ///< constrained edges that do not lie on an integer isoline
  std::size_t offIntegers = 0;   ///< integer vertices (singular, corner, end) not at integer points
  std::size_t fractionalTransitions = 0; ///< transitions whose translation is not whole
  double minimumDeterminant = 0; ///< smallest det(u, v edges), in quads^2 (twice the uv area)
  double area = 0;               ///< total uv area in quads: the number of quads to expect
  std::vector<Index> worstFaces; ///< up to 16 faces, smallest determinant first

  bool seamless() const
  {
    return notPositive == 0 && wrongTurns == 0 && seamResiduals == 0 && offAxes == 0;
  }
  bool valid() const
  {
    return seamless() && offIsolines == 0 && offIntegers == 0 && fractionalTransitions == 0;
  }
  /// Everything that has to be whole is so, whatever the triangles do.
  bool whole() const
  {
    return seamResiduals == 0 && offAxes == 0 && offIsolines == 0 && offIntegers == 0 &&
      fractionalTransitions == 0;
  }
  std::string text() const; ///< one line for people
};

/// The transition of half-edge h (chart of face(h) -> chart of the twin's face), exact. For a zero-length
/// image of the edge `fallbackRotation` is taken. residual, when given, is set to whether the far end disagrees.
Transition transitionOf(const Mesh& mesh, const std::vector<FixedVec2>& uv, Index h,
  int fallbackRotation = 0, bool* residual = nullptr);

/// #H: rotation of each half-edge's transition; 0 on boundaries. threads: 0 means all.
std::vector<std::int8_t> matchingOf(
  const Mesh& mesh, const std::vector<FixedVec2>& uv, int threads);

/// Exact check of a map. expectedTurns: #V (see CrossField::turns). integerVertex: #V flags. threads: 0: all; the
/// result does not depend on it.
Certificate certify(const Mesh& mesh, const std::vector<FixedVec2>& uv,
  const std::vector<int>& expectedTurns, const std::vector<std::uint8_t>& integerVertex,
  int threads = 0);

struct SeamlessOptions
{
  double edgeLength = 0; ///< length on the surface that one uv unit stands for; > 0
  /// 0, or the area that the map is scaled to in the end; scaling changes nothing else of it.
  double targetQuads = 0;
  /// SeamlessResult::solution for the same mesh and field: it is scaled to targetQuads instead of solving again.
  const Eigen::VectorXd* solution = nullptr;
  /// An earlier map in the charts of the field, or null: where a start near it has nothing inverted, it takes the place of the
  /// Poisson equation's solution.
  const CarriedMap* previous = nullptr;
  double anisotropyLimit = 0; ///< as in GridMapOptions
  ProgressCallback progress;
};
struct SeamlessResult
{
  std::vector<FixedVec2> uv; ///< #H; best effort when the status is not ok
  Eigen::VectorXd solution;  ///< the free unknowns of the map, before scaling
  Status status;
  std::vector<Index> inverted; ///< faces left with !(det > 0)
  std::vector<Index>
    offenders; ///< vertices round which the triangulation, or the field, leaves no map
  int newtonSteps = 0;
  std::size_t work = 0; ///< as UntangleResult::work
  bool startedFromPrevious = false;
};
/// A seamless map without inverted triangles that follows the field: transitions are quarter turns plus any
/// translation, constrained edges lie on isolines (of any value). Exact on the fixed-point grid.
SeamlessResult computeSeamlessMap(
  const Mesh& mesh, const CrossField& field, const SeamlessOptions& options);

struct QuantizeOptions
{
  double maximumRefinement = 8; ///< the integers may grow by this factor when nothing else is valid
  /// In [0, 1]: the integers come near to so many times the seamless map. 0: as near to nothing as a valid map can.
  double pull = 1;
  /// Vertices, as EmbedResult::offenders, whose triangles the integers must leave positive as they are.
  std::vector<Index> watched;
  /// #H: an integer-grid map along the same field, or null. Its integers are the start where they are valid, and are only
  /// improved then.
  const std::vector<FixedVec2>* previousUv = nullptr;
  ProgressCallback progress;
};
struct QuantizeResult
{
  /// #H: integer translations, integer vertices and isolines locked; triangles may be inverted
  /// (embedMap mends that).
  std::vector<FixedVec2> uv;
  Status status;
  double refinement = 1; ///< factor by which sizes had to grow to be valid
  std::size_t work = 0;  ///< steps from triangle to triangle that all searches have made
  bool startedFromPrevious = false;
};
/// Integers for a seamless map without a T-mesh [Coudert-Osmont et al. 2023].
QuantizeResult quantizeMap(const Mesh& mesh, const CrossField& field,
  const std::vector<FixedVec2>& seamlessUv, const QuantizeOptions& options);

struct EmbedOptions
{
  double edgeLength = 0; ///< as in SeamlessOptions
  /// The valid seamless map that the integers were made for; when given, embedding falls back on
  /// following a continuous way from there.
  const std::vector<FixedVec2>* seamlessUv = nullptr;
  /// An earlier map in the charts of the field, or null: a start near it is tried first.
  const CarriedMap* previous = nullptr;
  double anisotropyLimit = 0; ///< as in GridMapOptions
  /// Where embedding other integers failed, ascending: if it fails at just these again, it is told at once, as the way from the seamless map
  /// was gone in vain then.
  std::vector<Index> failedBefore;
  ProgressCallback progress;
};
struct EmbedResult
{
  std::vector<FixedVec2> uv;
  Status status;
  std::vector<Index> inverted; ///< faces left with !(det > 0)
  std::vector<Index>
    offenders; ///< vertices round which the triangulation leaves no map with these integers
  int newtonSteps = 0;
  std::size_t work = 0; ///< as UntangleResult::work
  bool startedFromPrevious = false;
};
/// Moves everything but integers (integer vertices, isoline values, translations) so that every det > 0.
/// Throws InvalidInput, naming the element, when integerUv is fractional or contradicts the field.
EmbedResult embedMap(const Mesh& mesh, const CrossField& field,
  const std::vector<FixedVec2>& integerUv, const EmbedOptions& options);

/// How the map is made [Ebke et al. 2016, Figure 8].
enum class MapMethod
{
  /// Seamless map without inverted triangles, integers from it, re-embedding: never inverted, whole everywhere. After
  /// [Ebke et al. 2014] by its aim; see Documentation/Design.md for the means.
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
  /// The ratio of the two stretches of a triangle, over the sizes that the mesh wants, from which on it is to come down as far as
  /// integers and irregular vertices let it, at the price of more distortion elsewhere; >= 1, or 0: no limit. Not by the methods that round.
  double anisotropyLimit = 0;
  Index maximumVertices = 100000;  ///< of the mesh; the solvers are made for coarse levels
  std::vector<Guide> guides;       ///< empty or #F, see CrossFieldOptions
  std::vector<int> targetValences; ///< empty or #V, the same
  /// Empty or #F: how the surface that a face stands for is stretched against it, see CrossField::stretch.
  std::vector<Eigen::Matrix2d> stretch;
  /// An earlier map to start from (see PreviousMap.h), or null. The result is as valid as without, but may differ; it is the same
  /// for the same earlier map. Where it leads to no map, all is done again without it. Only the scale aware
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
  std::size_t embedded = 0; ///< components that were embedded starting from the earlier map

  bool any() const { return seamless + integers + embedded > 0; }
};
struct GridMapResult
{
  std::vector<FixedVec2> uv;         ///< #H; zero on connected components that have no map at all
  std::vector<FixedVec2> seamlessUv; ///< #H; of the components that have a map
  CrossField field;
  Certificate certificate;
  MapReuse reuse;
  Status status;                ///< not ok: why and where; uv then holds the best that was reached
  std::vector<Index> offenders; ///< coarse vertices around which the triangulation lacks freedom
  double refinement = 1;        ///< of the component whose sizes had to shrink most
  /// The share of the area whose ratio of stretches is above the limit after all; 0 without limit, or where the status is not ok.
  double beyondAnisotropyLimit = 0;
  std::size_t components = 0, failedComponents = 0;
  /// Of all solves, as UntangleResult::work, and what quantization took in the same unit.
  std::size_t work = 0;
  double secondsField = 0, secondsSeamless = 0, secondsQuantize = 0, secondsEmbed = 0;
  /// The same in processor time of the whole process, which other programs on the machine do not disturb.
  double processorField = 0, processorSeamless = 0, processorQuantize = 0, processorEmbed = 0;
  int seamlessSteps = 0, embedSteps = 0; ///< Newton steps of all solves

  /// Adds what another, failed try has taken.
  void addWork(const GridMapResult& other);
};
/// The whole chain on one coarse mesh. Its connected components are solved one by one; each gets quads by its area, and all
/// are tried, so that offenders tells about every one that fails.
GridMapResult computeGridMap(const Mesh& mesh, const GridMapOptions& options);

/// What the next map can start from; the status of `map` must be ok. vertexIds: #V of its mesh.
PreviousMap previousMap(
  const Mesh& mesh, const GridMapResult& map, const std::vector<Index>& vertexIds);

} // namespace quadrille
