// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadRemesh
 * @brief   a triangle surface becomes a pure quad mesh: all stages of Quadrille in one filter
 *
 * Follows Ebke, Schmidt, Campen, Kobbelt, "Interactively Controlled Quad Remeshing of High Resolution 3D
 * Models" (2016). Inputs: see vtkQuadrilleSurfaceAlgorithm. Outputs:
 *
 * 0. the quads. Points: `Valence`, `QuadNormals` (surfaces without features), `OnBoundary`, `SourceCellId`,
 *    `SourcePointIds` and `SourceBarycentric` (where the point lies on the input); with a Symmetry `MirrorPoint` (the
 *    id of the point that is its mirror image, its own in the plane: an involution that maps quads to quads), or, of a
 *    rotation, `RotatedPoint` (the id of the point that it becomes when it is turned by one step). Cells:
 *    `SourceCellId`, `FeatureEdges`, `LayoutPatch` (the patch of the base complex). Every array of the input: on points
 *    real numbers and colours interpolated, whole numbers and strings from the nearest point; on cells see
 *    CellDataFrom.
 * 1. the input surface, repaired, with the integer-grid map: `IGM`, `Matching`, `Determinant` on cells, `Turns`,
 *    `Index` on points, and texture coordinates; `Charts` and `SeamEdges` in field data: one chart a component, with
 *    seams between irregular vertices. Empty unless ComputeMappedSurface is on.
 * 2. feature and boundary lines of the quads, with `Boundary`; where there is a patch array `PatchIds`, the pair that a
 *    line separates; `LayoutPatchIds`, the same for layout patches; `Separatrix` (1: a border of layout patches without
 *    features, too); `QuadPointId` on points.
 * 3. the lines between layout patches inside, as polylines. A straight line of edges leaves regular vertices opposite
 *    to where it came in; those with an irregular end or a feature edge are the borders of patches, which are grids of
 *    quads with four sides, or rings or tori where there is no irregular vertex. Cells: `StartKind` and `EndKind` (0
 *    irregular vertex, 1 boundary, 2 the feature ends or begins here, 3 closed), `Feature` (1: all of it on features,
 *    0: none), `Separatrix` (1: the straight line has an irregular end); `QuadPointId` on points.
 * 4. the irregular vertices of the quads as vertices: `Valence` (number of edges), `MovableValence` (the same; 0: no
 *    move takes it, as it is on a feature or boundary, or in a face that was filled), `Index` (edges missing to a
 *    regular vertex), `OnBoundary` and `QuadPointId`.
 * 5. what the constraints of the inputs 1 to 6 became on the surface, see Filters/Constraints/Constraints.h.
 * 6. a vtkTable with a row for each constraint, in the order of the input: those of the surface's arrays (guides,
 *    feature edges, valences, sizes), then those of the inputs 1 to 6. `Id` (0, 1, ...), `Kind` ("guide array": a
 *    connected region, "guide stroke", "feature curve": of `FeatureEdges` a connected set, "valence", "size": the
 *    array), `SourceId` (line or point of its input; of arrays the first cell or point; -1 for sizes), `X`, `Y`, `Z`
 *    (where it deviates most; the vertex of a valence), `Met` (0 or 1), `Deviation` in `Unit`, `Deviation95`, `Reason`
 *    (why not met, else empty), `Remark` (what else is to be known, met or not). What could not be measured is NaN.
 *    - "degrees", guides: the angle between the asked direction at the centre of a face and the nearer of the two
 *      families of edges of the quad there, in the plane of the face; the mean by area, and in `Deviation95` the 95th
 *      percentile. Met: a mean of at most 5.
 *    - "edge lengths", curves: the largest distance of their course over the faces from the quads' edges. Met: at most
 *      0.3. Of connections and cycles that of the straight chain of edges from the course, or back; met: at most 0.5.
 *    - "edge lengths", valences, and moves (kind "move") at their ends: the distance to the nearest point of the quads
 *      with that valence, on boundaries one more than its edges; of 4 it is 0 where the nearest point has it. Met: at
 *      most 0.3, and where the vertex of a move was it is regular.
 *    - "relative to the diagonal", the symmetry (kind "symmetry" or "rotation", the last row, with a Symmetry): how far
 *      the mirror image of the surface, or the surface turned by one step, is from it, over the diagonal of its box, as
 *      the root of the mean square; in `Deviation95` the largest distance. Met: the quads have the topology of the
 *      surface, and none is turned over where points were put onto the surface.
 *    - "factor", sizes: by which the square root of a quad's area differs, over the median of all, from `Sizing` there;
 *      mean by area and 95th percentile. Met: a mean of at most 1.25.
 * 7. what of the surface is smaller than the quads, a vertex for each, those that SmallDetails, SmallestDetail and
 *    SmallComponents took out first. Points: `Kind` ("handle", "boundary loop", "component", "thin part"), `Size`
 *    (the length of the loop, of a component the square root of its area, over the target edge length and the
 *    sizes there), `Decision` ("resolved": quads are smaller there, "simplified", "kept"), `Result` (what became
 *    of it), `DecisionId` (0 resolved, 1 simplified, 2 kept).
 * 8. what is wrong, to be seen beside the quads: the polygons that have none, those of components that were left out
 *    (see FailedComponents) or, after a failure without quads from before, all of the input; and a vertex for each
 *    place where the map or the quads have failed, and for each inverted quad. Cells: `Problem` (0 without quads, 1
 *    fails here, 2 inverted). Field data: `Words`, what is told of it. Empty where all is well.
 *
 * Field data of output 0, beside that of the input: `LayoutPatchShape` (a patch: 0 four corners, 1 ring, 2 torus) and
 * `LayoutPatchSize` (2: quads along and across), `StageNames`, `StageSeconds`, `StageElementsIn`, `StageElementsOut`,
 * `ReusedStages`, `Certificate`, `CertificateValid`, `CertificateNames`, `CertificateValues`, `Method`, `RepairNames`,
 * `RepairCounts`, `ExtractionNames`, `ExtractionCounts`, `Notices`, `EstimatedSeconds`, `EstimatedMegabytes`,
 * `TargetEdgeLength`, `TargetQuads`, `ActualQuads`, `ComponentsWithoutQuads` where there are any, `CoarseVertices`,
 * `Decimations`, `Replays`, `SurfaceFaces`, `Attempts` (maps that were tried), `RecoveryNames` and `RecoveryCounts`
 * (the strategies that made all but the first one), `TryNames`, `TriesTaken` and `TriesLed` (what was tried otherwise
 * in any stage, how often, and how often that is used), `Handles`, `UnresolvedHandles`, `ShortestLoopOverEdgeLength`,
 * `ShortestBoundaryOverEdgeLength` (see the getters of the same names), `ShortestLoopPlace`, `ShortestBoundaryPlace`;
 * with a FinalQuality other than Coarse `DistortionNames`, `DistortionBefore`, `DistortionAfter`, `OptimizationSteps`;
 * with a Symmetry what vtkQuadrilleSymmetryAlgorithm tells.
 */
#ifndef vtkQuadRemesh_h
#define vtkQuadRemesh_h

#include "vtkQuadrilleSymmetryAlgorithm.h"

#include <cstdint>  // for std::uint8_t
#include <memory>   // for std::unique_ptr
#include <optional> // for std::optional

class vtkTable;

namespace quadrille
{
class BackgroundRun;
struct JoinedParts;
struct JointSheets;
struct MetSheets;
struct PartContacts;
struct PreparedRun;
struct QuadProblem;
struct RemeshResult;
struct RunOfBlock;
struct SurfaceInput;
enum class TouchingSheets : std::uint8_t;
}

class QUADRILLEFILTERS_EXPORT vtkQuadRemesh : public vtkQuadrilleSymmetryAlgorithm
{
public:
  static vtkQuadRemesh* New();
  vtkTypeMacro(vtkQuadRemesh, vtkQuadrilleSymmetryAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The values of Method, see there.
  enum Methods
  {
    METHOD_SCALE_AWARE = 0,
    METHOD_MIXED_INTEGER = 1,
    METHOD_QUADCOVER = 2,
    METHOD_SEAMLESS = 3
  };

  ///@{
  /**
   * How the map of the coarse level is made, a Methods. Scale aware never inverts a triangle. Mixed integer
   * [Bommes et al. 2009] rounds integers one at a time, QuadCover [Kalberer et al. 2007] all at once: both
   * may leave inverted triangles, which a notice counts, and then there may be no quads. Seamless has no
   * integers and makes no quads: the mapped surface, output 1, is the result. Default: METHOD_SCALE_AWARE.
   */
  vtkSetClampMacro(Method, int, METHOD_SCALE_AWARE, METHOD_SEAMLESS);
  vtkGetMacro(Method, int);
  void SetMethodToScaleAware() { this->SetMethod(METHOD_SCALE_AWARE); }
  void SetMethodToMixedInteger() { this->SetMethod(METHOD_MIXED_INTEGER); }
  void SetMethodToQuadCover() { this->SetMethod(METHOD_QUADCOVER); }
  void SetMethodToSeamless() { this->SetMethod(METHOD_SEAMLESS); }
  ///@}

  /// The values of Integers, see there.
  enum IntegersTypes
  {
    INTEGERS_KEEP_SIZES = 0,
    INTEGERS_COARSEST = 1
  };

  ///@{
  /**
   * What the whole numbers of the map aim at, an IntegersTypes: quads of the size asked for, or the coarsest layout,
   * with integers as small as a map can have whose quads are the surface. The size then sets only what the coarse level
   * keeps. Needs METHOD_SCALE_AWARE. Default: INTEGERS_KEEP_SIZES.
   */
  vtkSetClampMacro(Integers, int, INTEGERS_KEEP_SIZES, INTEGERS_COARSEST);
  vtkGetMacro(Integers, int);
  void SetIntegersToKeepSizes() { this->SetIntegers(INTEGERS_KEEP_SIZES); }
  void SetIntegersToCoarsest() { this->SetIntegers(INTEGERS_COARSEST); }
  ///@}

  ///@{
  /**
   * The ratio of the two stretches of a triangle of the coarse level, against the sizes asked for, from which on the
   * map gives way to bring it down, at the price of quads that differ more in size. At least 1; 0 means no limit. Whole
   * numbers, features and irregular vertices may keep it from being met: the share of the area beyond it is told in the
   * field data. Not with METHOD_MIXED_INTEGER and METHOD_QUADCOVER. Default: 0.
   */
  vtkSetMacro(AnisotropyLimit, double);
  vtkGetMacro(AnisotropyLimit, double);
  ///@}

  ///@{
  /**
   * The filter refuses, before memory is spent, to make more quads than this; at least 1. Default: ten million.
   */
  vtkSetMacro(MaximumNumberOfQuads, vtkIdType);
  vtkGetMacro(MaximumNumberOfQuads, vtkIdType);
  ///@}

  ///@{
  /**
   * Sweeps in which the points of the quads move over the surface, those of features and boundaries along their
   * curves, towards the average of their neighbours; a move that would lower the worst scaled Jacobian round a point
   * is not made. Points of curves slide to the bends of their curve, too, as long as scaled Jacobians stay above 0.3,
   * so that the edges of the quads lie close to it. Then points near quads that are turned over at a corner move to
   * mend them. At least 0: the points stay where the map has them. Default: 5.
   */
  vtkSetMacro(SmoothingSteps, int);
  vtkGetMacro(SmoothingSteps, int);
  ///@}

  ///@{
  /**
   * The filter refuses, before it starts, to work on a surface that needs more memory than this by its estimate; in
   * millions of bytes. 0, the default, means what the machine has free.
   */
  vtkSetClampMacro(MemoryLimit, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(MemoryLimit, double);
  ///@}

  ///@{
  /**
   * By how much an edge of the quads may lie off the surface, in units of the input: on a normal curvature k edges are
   * at most sqrt(8 ChordError / k) long, within SmallestSize and LargestSize. The curvature is that of the cell array
   * KnownCurvature, as surfaces of vtkQuadrilleCADReader have it; else it is taken over about a target edge length.
   * With NumberOfQuads the quads are distributed so that there are as many. The array Sizing may ask for less. 0: edges
   * do not depend on the curvature so. Default: 0.
   */
  vtkSetClampMacro(ChordError, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(ChordError, double);
  ///@}

  ///@{
  /**
   * By how many degrees the surface may turn along an edge of the quads: edges are at most AngleAQuad / k long, with
   * all else as for ChordError. 0: edges do not depend on the curvature so. Default: 0.
   */
  vtkSetClampMacro(AngleAQuad, double, 0.0, 180.0);
  vtkGetMacro(AngleAQuad, double);
  ///@}

  ///@{
  /**
   * So many edges at least go into the thickness of the solid, and into the gap to an opposite sheet outside, within
   * SmallestSize and LargestSize. The smallest of this, ChordError, AngleAQuad and the array Sizing counts. 0: edges do
   * not depend on that. Default: 0.
   */
  vtkSetClampMacro(GapQuads, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(GapQuads, double);
  ///@}

  ///@{
  /**
   * The range of what ChordError, AngleAQuad and GapQuads ask for, over the target edge length: SmallestSize above 0
   * and at most 1, LargestSize at least 1. Defaults: 0.2 and 1.
   */
  vtkSetMacro(SmallestSize, double);
  vtkGetMacro(SmallestSize, double);
  vtkSetMacro(LargestSize, double);
  vtkGetMacro(LargestSize, double);
  ///@}

  ///@{
  /**
   * Whether quads follow the principal curvature of the surface where no other guide is, wherever its anisotropy
   * |k1 - k2| / (|k1| + |k2|) over about an edge length is above LeastAnisotropy, the more the larger it is. Defaults:
   * off, 0.3.
   */
  vtkSetMacro(CurvatureGuides, vtkTypeBool);
  vtkGetMacro(CurvatureGuides, vtkTypeBool);
  vtkBooleanMacro(CurvatureGuides, vtkTypeBool);
  vtkSetMacro(LeastAnisotropy, double);
  vtkGetMacro(LeastAnisotropy, double);
  ///@}

  ///@{
  /**
   * What is smaller than this, in target edge lengths, is taken out before the first map: of the surface handles and
   * boundary loops by their lengths (where SmallDetails is automatic) and, above 1, connected components by the square
   * roots of their areas; of the features that nobody asked for those that quads cannot show, by the diagonal of the
   * box round those that hang together, a quarter of the length of those that end on the surface, and a hundred times
   * the width between two of them. A larger one never brings a detail back; 0: nothing. Default: 1.
   */
  vtkSetClampMacro(SmallestDetail, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(SmallestDetail, double);
  ///@}

  /// The values of SmallDetails, see there.
  enum SmallDetailsTypes
  {
    SMALL_DETAILS_AUTOMATIC = 0,
    SMALL_DETAILS_RESOLVE = 1,
    SMALL_DETAILS_SIMPLIFY = 2,
    SMALL_DETAILS_KEEP = 3
  };
  ///@{
  /**
   * What becomes of handles and boundary loops that are shorter round than three target edge lengths, which is found
   * before the first map. SMALL_DETAILS_RESOLVE makes quads smaller there, whatever number of them it takes up to
   * MaximumNumberOfQuads; SMALL_DETAILS_SIMPLIFY takes them out of the surface: handles are cut along their shortest
   * loop and closed on both sides, boundary loops filled; SMALL_DETAILS_KEEP leaves surface and sizes as they are,
   * and the run fails where that is impossible. SMALL_DETAILS_AUTOMATIC simplifies those below SmallestDetail and
   * crowds of handles on surfaces that are not known as designed, and resolves the others where that takes at most 1.6
   * times the quads; components with less area than a quad are left out where the smallest blocks for all small ones
   * (see SmallComponents) would be more quads than are asked for. With METHOD_MIXED_INTEGER and QUADCOVER,
   * INTEGERS_COARSEST and a Symmetry nothing is simplified by it, nor by SMALL_DETAILS_SIMPLIFY with a Symmetry.
   * Output 7 has them all. Default: SMALL_DETAILS_AUTOMATIC.
   */
  vtkSetClampMacro(SmallDetails, int, SMALL_DETAILS_AUTOMATIC, SMALL_DETAILS_KEEP);
  vtkGetMacro(SmallDetails, int);
  void SetSmallDetailsToAutomatic() { this->SetSmallDetails(SMALL_DETAILS_AUTOMATIC); }
  void SetSmallDetailsToResolve() { this->SetSmallDetails(SMALL_DETAILS_RESOLVE); }
  void SetSmallDetailsToSimplify() { this->SetSmallDetails(SMALL_DETAILS_SIMPLIFY); }
  void SetSmallDetailsToKeep() { this->SetSmallDetails(SMALL_DETAILS_KEEP); }
  ///@}

  /// The values of SmallComponents, see there.
  enum SmallComponentsTypes
  {
    KEEP_SMALL_COMPONENTS = 0,
    REMOVE_SMALL_COMPONENTS = 1
  };
  ///@{
  /**
   * What becomes of connected components with less area than the smallest block of quads of the target size has, such
   * as the islands of isosurfaces: KEEP_SMALL_COMPONENTS makes each of about that many quads (six for a closed one),
   * REMOVE_SMALL_COMPONENTS leaves them out, unless all are such. A notice counts them. Default: KEEP_SMALL_COMPONENTS.
   */
  vtkSetClampMacro(SmallComponents, int, KEEP_SMALL_COMPONENTS, REMOVE_SMALL_COMPONENTS);
  vtkGetMacro(SmallComponents, int);
  ///@}

  /// The values of FailedComponents, see there.
  enum FailedComponentsTypes
  {
    LEAVE_OUT_FAILED_COMPONENTS = 0,
    FAIL_WITH_FAILED_COMPONENTS = 1
  };
  ///@{
  /**
   * What becomes of connected components that have no map: LEAVE_OUT_FAILED_COMPONENTS makes quads of the others, and
   * tells it by a warning, in the certificate, by GetComponentsWithoutQuads() and in output 8;
   * FAIL_WITH_FAILED_COMPONENTS makes no quads at all, as it is also for conforming blocks, surfaces that are cut into
   * pieces, and with a Symmetry. Default: LEAVE_OUT_FAILED_COMPONENTS.
   */
  vtkSetClampMacro(FailedComponents, int, LEAVE_OUT_FAILED_COMPONENTS, FAIL_WITH_FAILED_COMPONENTS);
  vtkGetMacro(FailedComponents, int);
  ///@}

  ///@{
  /**
   * Whether the filter holds on to what each stage has made, so that a change begins where it enters: guides, and the
   * number of coarse vertices, at phase 2 of the decimation; target valences at phase 1; the size of the quads at the
   * refinement; smoothing steps at the extraction; the feature angle and the surface itself at the beginning. What was
   * set before is looked up. Contents are compared, not times. The quads are the same as without. Stages hold about 130
   * bytes a triangle after the first execution, more with each setting that was tried, at most a quarter of the
   * machine's memory for a block, see GetRememberedMegabytes(); where the machine has no room for that, nothing is held
   * and a notice says so. Off lets all go. Default: on.
   */
  void SetKeepLevels(vtkTypeBool on);
  vtkGetMacro(KeepLevels, vtkTypeBool);
  vtkBooleanMacro(KeepLevels, vtkTypeBool);
  ///@}

  ///@{
  /**
   * On which level the map is computed at last: the coarse one (the default), or, with the same whole numbers and
   * irregular vertices, again on the intermediate one or on the input itself. The quads are the same in number and
   * connectivity; the finer the level, the less are they distorted, and the longer it takes. Where that is not possible
   * or does not help, the map stays as it was, with a notice.
   */
  enum FinalQualityLevel
  {
    Coarse = 0,
    Intermediate = 1,
    Input = 2
  };
  vtkSetClampMacro(FinalQuality, int, Coarse, Input);
  vtkGetMacro(FinalQuality, int);
  void SetFinalQualityToCoarse() { this->SetFinalQuality(Coarse); }
  void SetFinalQualityToIntermediate() { this->SetFinalQuality(Intermediate); }
  void SetFinalQualityToInput() { this->SetFinalQuality(Input); }
  ///@}

  ///@{
  /**
   * Whether the map of the coarse level fits its quads to the surface that a coarse triangle stands for, as the
   * decimation has it, and not to the flat triangle: the sizes of the quads come out a little more even. Default: off.
   */
  vtkSetMacro(DistortionMetric, vtkTypeBool);
  vtkGetMacro(DistortionMetric, vtkTypeBool);
  vtkBooleanMacro(DistortionMetric, vtkTypeBool);
  ///@}

  /// The values of CellDataFrom, see there.
  enum CellDataFromTypes
  {
    CELL_DATA_FROM_CENTRE = 0,
    CELL_DATA_FROM_AREA = 1
  };

  ///@{
  /**
   * Where the cell arrays of the quads come from, a CellDataFromTypes: from the cell under the centre of the quad, or
   * from all cells under it by their area in the map: of real numbers and colours the average, of whole numbers and
   * strings that with the largest part. Cells beyond a feature never count. Centre and area are those before the points
   * are smoothed. Default: CELL_DATA_FROM_CENTRE.
   */
  vtkSetClampMacro(CellDataFrom, int, CELL_DATA_FROM_CENTRE, CELL_DATA_FROM_AREA);
  vtkGetMacro(CellDataFrom, int);
  void SetCellDataFromToCentre() { this->SetCellDataFrom(CELL_DATA_FROM_CENTRE); }
  void SetCellDataFromToArea() { this->SetCellDataFrom(CELL_DATA_FROM_AREA); }
  ///@}

  ///@{
  /**
   * With KeepLevels: whether the map starts from that of the last execution, which keeps whole numbers where irregular
   * vertices and features stay. The result then depends on what was made before, within the same certificate; off, on
   * the inputs and properties alone. Default: off.
   */
  vtkSetMacro(WarmStart, vtkTypeBool);
  vtkGetMacro(WarmStart, vtkTypeBool);
  vtkBooleanMacro(WarmStart, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Quads of the intermediate level in place of those of the surface: the same map with the same integers, made in a
   * time that follows the number of quads and not the size of the surface. Only the quads (points with `Valence` and
   * `OnBoundary`), the irregular vertices, the constraints and their table are made then. Default: off.
   */
  vtkSetMacro(Preview, vtkTypeBool);
  vtkGetMacro(Preview, vtkTypeBool);
  vtkBooleanMacro(Preview, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Whether quads of blocks of composite data fit together where blocks meet. Blocks with edges in common, that is
   * whose ends are at the same places up to a millionth of the box round all blocks, are made in one run: the common
   * curves become edges of the quads, with the same points, to the bit, in all blocks. Each block keeps its share of
   * the quads (see QuadsAre and QuadsOfBlocks, by sizes where they differ from the shares of areas), its arrays and its
   * orientation; what the run tells as a whole stands at the first block of those that hang together, and
   * `ConformingWith` in the field data names the others. Where more than two sheets meet, as at a rib, they are made
   * apart and get strips of quads until all have the same points there; faces that two solids share, with the same
   * triangles, become the same quads of both. An error names the place where a block meets itself at such a curve.
   * Where there is no map with all borders, as blocks or the gaps between their corners are far smaller than a quad,
   * some are not followed: the blocks have the same points on edges of quads beside them, a block narrower than a quad
   * may have none, and notices tell lengths and places. Not with a Symmetry, nor with moves of irregular vertices, nor,
   * where more than two sheets meet, with connections and cycles; Preview does not count for such blocks. Default: off.
   */
  vtkSetMacro(Conforming, vtkTypeBool);
  vtkGetMacro(Conforming, vtkTypeBool);
  vtkBooleanMacro(Conforming, vtkTypeBool);
  ///@}

  /// See SetSpreadSurfaces().
  enum SpreadSurfacesType
  {
    SPREAD_AUTOMATIC = 0,
    SPREAD_ALWAYS = 1,
    SPREAD_NEVER = 2
  };
  ///@{
  /**
   * Whether a surface that comes in pieces, one or more a rank, stays spread over the ranks, a SpreadSurfacesType. Then
   * no rank ever holds all of it: pieces are thinned out where they are, the quads are made on the joined thin pieces,
   * by one rank, and each rank has the quads with their centre on its pieces, with global ids of points and cells,
   * ghost points, and ghost cells where they are asked for. Output 1 is then the joined surface, and outputs 1 to 7 lie
   * on that rank. Automatic: with several ranks and more than 2,000,000 cells on all of them. What cannot be spread
   * (directions on cells, symmetry, previews, CellDataFrom by area, the method without quads) is
   * brought to one rank, with a notice; with Always it is an error. Never: the pieces are always brought to one rank
   * and put together there; the quads are then the same for any number of ranks. Default: Automatic.
   */
  vtkSetClampMacro(SpreadSurfaces, int, SPREAD_AUTOMATIC, SPREAD_NEVER);
  vtkGetMacro(SpreadSurfaces, int);
  ///@}

  /// See SetPieces().
  enum PiecesType
  {
    PIECES_AUTOMATIC = 0,
    PIECES_ALWAYS = 1,
    PIECES_NEVER = 2
  };
  ///@{
  /**
   * Whether a surface in one process is cut into compact pieces of about a million triangles, a PiecesType. Each is
   * prepared and thinned out by itself, to triangles that are small against the quads, one piece a thread; the quads
   * are made on the thinned pieces together, and their points go back to the surface. That takes about a third of the
   * memory and less time, and holds nothing of the surface for the next execution. Automatic: from 4,000,000 triangles
   * on, where a quad has at least 66 of them, and with KeepLevels from 10,000,000 on; without KeepLevels a surface of
   * 1,000,000 triangles or more is thinned out without being cut; so is a larger one with
   * constraints or polygons with more than three corners, which cannot be cut. What needs the whole surface keeps it
   * whole: guides, moves, symmetry, the mapped surface, CellDataFrom by area, FinalQuality on the input, the method
   * without quads. Always: also where it is smaller; what cannot be cut is an error. Never: the surface stays whole.
   * Default: Automatic.
   */
  vtkSetClampMacro(Pieces, int, PIECES_AUTOMATIC, PIECES_NEVER);
  vtkGetMacro(Pieces, int);
  ///@}

  /// Millions of bytes that are held for the next execution.
  double GetRememberedMegabytes() const;
  /// Stages that the last execution had, or began, from an earlier one, one a line; "all" where nothing had changed and
  /// the result before was returned.
  const char* GetReusedStagesText() const { return this->GetReusedStages(); }

  ///@{
  /// Whether output 1, the input surface with the map, is made; with METHOD_SEAMLESS it is in any case. Default: on. In
  /// proxies of ParaView it is off until something takes the output as its input.
  vtkSetMacro(ComputeMappedSurface, vtkTypeBool);
  vtkGetMacro(ComputeMappedSurface, vtkTypeBool);
  vtkBooleanMacro(ComputeMappedSurface, vtkTypeBool);
  ///@}

  ///@{
  /// Whether output 1 has texture coordinates; its points are then doubled where the map is cut. Default: on.
  vtkSetMacro(TextureCoordinates, vtkTypeBool);
  vtkGetMacro(TextureCoordinates, vtkTypeBool);
  vtkBooleanMacro(TextureCoordinates, vtkTypeBool);
  ///@}

  /// Number of quads that were made by the last execution.
  vtkIdType GetActualQuads() const { return this->CountOverBlocks("ActualQuads"); }
  /// Number of quads that the last execution aimed at.
  vtkIdType GetTargetQuads() const { return this->CountOverBlocks("TargetQuads"); }
  /// The property, and its value, with which another execution may mend what is wrong with the last one:
  /// "NumberOfQuads 20000". Quads that are half as long are four times as many; where a limit was in the way it is the
  /// limit. Empty where all is well, and where no property of its own can mend it.
  const char* GetRemedyText();
  /// Connected components that the last execution has left out, see FailedComponents.
  vtkIdType GetComponentsWithoutQuads() const
  {
    return this->CountOverBlocks("ComponentsWithoutQuads");
  }

  ///@{
  /**
   * Of the last execution, also of one that failed after its decimation: handles of the surface; those with a loop
   * round or through them that is shorter than three target edge lengths; the shortest such loop, and the shortest
   * boundary loop, over the target edge length (0: there is none).
   */
  vtkIdType GetHandles() const { return this->CountOverBlocks("Handles"); }
  vtkIdType GetUnresolvedHandles() const { return this->CountOverBlocks("UnresolvedHandles"); }
  double GetShortestLoopOverEdgeLength() const
  {
    return this->LeastOverBlocks("ShortestLoopOverEdgeLength");
  }
  double GetShortestBoundaryOverEdgeLength() const
  {
    return this->LeastOverBlocks("ShortestBoundaryOverEdgeLength");
  }
  ///@}

  /// Outputs 1 to 6.
  vtkPolyData* GetMappedSurface() { return this->GetPolyDataOutputAt(1); }
  vtkPolyData* GetLines() { return this->GetPolyDataOutputAt(2); }
  vtkPolyData* GetSeparatrices() { return this->GetPolyDataOutputAt(3); }
  vtkPolyData* GetIrregularVertices() { return this->GetPolyDataOutputAt(4); }
  vtkPolyData* GetConstraints() { return this->GetPolyDataOutputAt(5); }
  vtkTable* GetConstraintTable();
  /// Output 7.
  vtkPolyData* GetDetailPlaces() { return this->GetPolyDataOutputAt(7); }

  ///@{
  /// Optional inputs: polylines between irregular vertices, or from one to a feature or boundary, that a straight chain
  /// of edges is to join (port 4), and closed ones along which a chain of edges is to close (port 5). The chains lie
  /// where the lines are. What connections join is looked for in quads without them, which are made first.
  void SetConnectionsConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(4, output); }
  void SetConnectionsData(vtkDataObject* lines) { this->SetInputDataObject(4, lines); }
  void SetCyclesConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(5, output); }
  void SetCyclesData(vtkDataObject* lines) { this->SetInputDataObject(5, lines); }
  ///@}

  ///@{
  /// Optional input with any number of connections (port 6): constraints of all classes, as vtkQuadConstraintSource
  /// makes them. Lines by their cell array `ConstraintType` (0 or none: feature curve, 1 guiding stroke, 2 connection,
  /// 3 cycle, 4 move: the irregular vertex nearest to the begin of the line goes to its end), vertices by the same (6
  /// cleared feature, 7 size, with `SizeFactor` and `GuidingRadius`), points by their point array `TargetValence`;
  /// without all these all of them get PointValence.
  void AddConstraintsConnection(vtkAlgorithmOutput* output) { this->AddInputConnection(6, output); }
  void AddConstraintsData(vtkDataObject* data) { this->AddInputDataObject(6, data); }
  void RemoveAllConstraints() { this->SetInputConnection(6, nullptr); }
  ///@}

  /// With InBackground on an execution leaves the run to a thread of its own and ends at once, with the outcome
  /// Underway and the outputs as they were. The next execution with the same inputs and properties makes the outputs of
  /// that run, one with others stops it. Composite data, several ranks, and surfaces from kTrianglesWorthPieces on
  /// (Core/Ways) are executed as ever. The quads are the same. Default: off. It is no property of the result.
  void SetInBackground(vtkTypeBool on) { this->InBackground = on; }
  vtkTypeBool GetInBackground() const { return this->InBackground; }

  /// Whether a run in the background has not ended; how far it is, in hundredths; asks it to end, which it does soon.
  vtkTypeBool GetIsUnderway() const;
  /// Whether there is such a run, ended or not, whose outputs the next execution is to make.
  vtkTypeBool GetIsToBeTaken() const { return this->Background ? 1 : 0; }
  int GetUnderwayProgress() const;
  void StopUnderway();
  /// Switches InBackground off, and lets the next execution take what was made, waiting for it where it is not over.
  void TakeUnderway();

protected:
  vtkQuadRemesh();
  ~vtkQuadRemesh() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  const char* GetBlockType(int outputPort) const override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  void Execute(quadrille::Block& block) override;
  bool JoinsBlocks() const override { return this->Conforming != 0; }
  std::vector<Together> FindTogether(const std::vector<quadrille::Block*>& blocks) override;
  void ExecuteTogether(const std::vector<quadrille::Block*>& blocks) override;
  void WritePreview(quadrille::Block& block, const quadrille::AskedConstraints& asked,
    const quadrille::RemeshResult& result);
  int GetSpreadMode() const override { return this->SpreadSurfaces; }
  std::string ReasonNotToSpread(
    const std::vector<vtkSmartPointer<vtkPolyData>>& pieces) const override;
  void PlanSpread(const quadrille::Block& block, const quadrille::SpreadSize& size,
    quadrille::SpreadPlan& plan) const override;
  int GetProblemPort() const override { return 8; }
  vtkSmartPointer<vtkDataObject> MakeProblems(quadrille::Block& block) override;
  bool KeepsResult() override { return this->KeepLevels != 0; }
  void AddSettings(std::ostream& os) const override;
  bool AllowsEarlier(const quadrille::BlockReport& report) const override;

private:
  vtkQuadRemesh(const vtkQuadRemesh&) = delete;
  void operator=(const vtkQuadRemesh&) = delete;

  void CheckProperties() const;
  quadrille::RemeshOptions MakeRunOptions(const quadrille::Block& block);
  /// The block with what the properties ask for; the surface is converted when it is asked for as a whole. The block
  /// has to be there as long as the run.
  std::unique_ptr<quadrille::PreparedRun> PrepareRun(quadrille::Block& block);
  /// Has the quads of the block made, here or in the background; throws Underway.
  std::unique_ptr<quadrille::PreparedRun> MakeRun(quadrille::Block& block);
  std::unique_ptr<quadrille::PreparedRun> TakeFromBackground();
  /// Asks a run in the background to end, of which nobody wants the quads. It does so soon, but nobody waits for it
  /// here; only the next run does.
  void LeaveBackground();
  bool GoesToBackground(const quadrille::Block& block) const;
  /// Symmetry, and where cell data come from.
  void SetWishes(quadrille::QuadProblem& problem) const;
  void TellRun(quadrille::Block& block, const quadrille::RemeshResult& result);
  /// In the window a warning opens Output Messages over the view: not after a run that an edit has begun there.
  void WarnInForeground(const std::string& text);
  void WriteQuads(quadrille::Block& block, const quadrille::RunOfBlock& run);
  /// The options get the number of quads of all blocks; shares: of each, sum 1; sizes: of its quads for that share,
  /// over the mean.
  void ShareQuads(const std::vector<quadrille::Block*>& blocks, quadrille::RemeshOptions& options,
    std::vector<double>& shares, std::vector<double>& sizes);
  /// Refuses what is not possible where more than two sheets meet.
  void CheckSheets(const std::vector<quadrille::SurfaceInput>& parts,
    const quadrille::PartContacts& contacts, const std::vector<quadrille::Block*>& blocks) const;
  /// sheets: where there is a value, the run is one of sheets, which it becomes.
  quadrille::RemeshResult RunJoined(quadrille::Block& first, quadrille::JoinedParts& joined,
    const quadrille::RemeshOptions& options, const std::vector<double>& sizes,
    std::optional<quadrille::JointSheets>& sheets, quadrille::TouchingSheets touching);
  /// A run of sheets, which then meet: they are joints also where sheets only touch, unless that has no quads.
  quadrille::RemeshResult RunSheets(quadrille::Block& first, quadrille::JoinedParts& joined,
    const quadrille::RemeshOptions& options, const std::vector<double>& sizes,
    quadrille::JointSheets& sheets, quadrille::MetSheets& met);

  vtkPolyData* GetPolyDataOutputAt(int port);
  void SetSizes(quadrille::RemeshOptions& options) const;
  bool MakesMappedSurface() const
  {
    return this->ComputeMappedSurface != 0 || this->Method == METHOD_SEAMLESS;
  }
  /// What is asked of the surface that its triangles do not tell; empty: nothing.
  std::string WhyNotCut(const quadrille::Block& block) const;
  vtkIdType CountOverBlocks(const char* number) const
  {
    return static_cast<vtkIdType>(this->SumOverBlocks(number));
  }

  int Method = METHOD_SCALE_AWARE;
  int Integers = INTEGERS_KEEP_SIZES;
  double AnisotropyLimit = 0;
  vtkIdType MaximumNumberOfQuads = 10000000;
  int SmoothingSteps = 5;
  double MemoryLimit = 0;
  double SmallestDetail = 1;
  int SmallDetails = SMALL_DETAILS_AUTOMATIC;
  int SmallComponents = KEEP_SMALL_COMPONENTS;
  int FailedComponents = LEAVE_OUT_FAILED_COMPONENTS;
  double ChordError = 0;
  double AngleAQuad = 0;
  double GapQuads = 0;
  double SmallestSize = 0.2;
  double LargestSize = 1;
  vtkTypeBool CurvatureGuides = 0;
  double LeastAnisotropy = 0.3;
  int SpreadSurfaces = SPREAD_AUTOMATIC;
  int Pieces = PIECES_AUTOMATIC;
  vtkTypeBool KeepLevels = 1;
  vtkTypeBool Preview = 0;
  vtkTypeBool Conforming = 0;
  vtkTypeBool WarmStart = 0;
  int FinalQuality = Coarse;
  vtkTypeBool DistortionMetric = 0;
  int CellDataFrom = CELL_DATA_FROM_CENTRE;
  vtkTypeBool ComputeMappedSurface = 1;
  vtkTypeBool TextureCoordinates = 1;
  std::string RemedyText;
  vtkTypeBool InBackground = 0;
  /// The run whose outputs are made; who waited for it looks at what is not met.
  bool WasInBackground = false;
  double RememberedBefore = 0; ///< megabytes, when the run in the background began
  std::unique_ptr<quadrille::BackgroundRun> Background;
  std::unique_ptr<quadrille::BackgroundRun> Ending; ///< has been left
};

#endif
