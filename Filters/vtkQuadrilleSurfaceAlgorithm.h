// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadrilleSurfaceAlgorithm
 * @brief   what the filters that start from a triangle surface share: the target size, features, curves
 *
 * Input port 0 takes the surface: polygons and triangle strips; vertices and lines are not used. Cell arrays
 * `FeatureEdges` (unsigned char, bit i set: the edge from corner i to corner i+1 is a feature) and the patch array
 * (see PatchArrayName) mark features beside the feature angle. The cell array `GuidingDirection` (3 real numbers; zero:
 * free) asks for edges of the quads along a direction in the cell, and `GuidingWeight` (a real number in (0, 1], 1
 * where there is no such array) says how strongly. The point array `TargetValence` (a whole number) asks for a valence:
 * 0 is free, 4 regular, 2, 3, 5 to 8 a vertex of that valence at exactly that point; on a boundary as if the quads went
 * on beyond, so 3 is a corner. What cannot be completed is an error that names the place and what is missing. The point
 * array `Sizing` (a real number above 0; 1 where there is no such array) multiplies the target edge length; the larger
 * sizes give way where it grows by more than a quarter per edge length, which is told in a notice. The number of quads
 * asked for is met as a whole.
 *
 * Three optional inputs hold what is drawn beside the surface, see Filters/Constraints/Constraints.h for how it is put
 * there; their points go to the nearest places on the surface, wherever that has its own:
 * - port 1, feature curves: polylines that become features, straight over the faces of the surface. The line cell
 *   array `ConstraintType` may say 1: a guiding stroke instead; 2: a connection; 3: a cycle; 4: a move of an irregular
 *   vertex (see vtkQuadRemesh, which has inputs for them, too); other values than 0 to 4 are an error. Vertices of
 *   which it says 6 clear the feature curves there, those of 7 ask for edges that are `SizeFactor` times as long within
 *   `GuidingRadius`, both of them cell arrays;
 * - port 2, guiding strokes: polylines whose direction the surface below takes with StrokeWeight, or with the line cell
 *   array `GuidingWeight`, as far as StrokeRadius, or the line cell array `GuidingRadius`, says;
 * - port 3, valence points: points, with cells or without. At the nearest place on the surface comes a vertex of
 *   PointValence, or of what the point array `TargetValence` says.
 * Two points of the surface, or of port 3, with the same value of a point array `ConnectId` other than 0 are joined by
 * a connection.
 * Whole numbers may come as real numbers, as a Calculator makes them. Arrays on the wrong kind of element or with a
 * name that is nearly one of these are told in a notice and a warning.
 */
#ifndef vtkQuadrilleSurfaceAlgorithm_h
#define vtkQuadrilleSurfaceAlgorithm_h

#include "vtkQuadrilleAlgorithm.h"

namespace quadrille
{
struct AskedConstraints;
struct ConvertedSurface;
struct GivenInputs;
struct RemeshOptions;
struct ToldOfInputs;
}

class QUADRILLEFILTERS_EXPORT vtkQuadrilleSurfaceAlgorithm : public vtkQuadrilleAlgorithm
{
public:
  vtkTypeMacro(vtkQuadrilleSurfaceAlgorithm, vtkQuadrilleAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum TargetTypes
  {
    TARGET_NUMBER_OF_QUADS = 0,
    TARGET_EDGE_LENGTH = 1,
    TARGET_RELATIVE_EDGE_LENGTH = 2
  };

  /// The value of NumberOfQuads that leaves the number to the shape.
  enum NumberOfQuadsTypes
  {
    BY_SHAPE = 0
  };

  ///@{
  /// The optional inputs.
  void SetCurvesConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(1, output); }
  void SetCurvesData(vtkDataObject* curves) { this->SetInputDataObject(1, curves); }
  void SetStrokesConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(2, output); }
  void SetStrokesData(vtkDataObject* strokes) { this->SetInputDataObject(2, strokes); }
  void SetValencePointsConnection(vtkAlgorithmOutput* output)
  {
    this->SetInputConnection(3, output);
  }
  void SetValencePointsData(vtkDataObject* points) { this->SetInputDataObject(3, points); }
  ///@}

  ///@{
  /**
   * How strongly quads follow the strokes of port 2 that have no `GuidingWeight`, above 0 and at most 1. Default: 1.
   */
  vtkSetMacro(StrokeWeight, double);
  vtkGetMacro(StrokeWeight, double);
  ///@}

  ///@{
  /**
   * The distance from a guiding stroke, in units of the input, up to which the surface takes its direction, that of its
   * nearest piece, reached over the surface. 0: only what it runs over. Default: 0.
   */
  vtkSetClampMacro(StrokeRadius, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(StrokeRadius, double);
  ///@}

  ///@{
  /**
   * Name of an array of three numbers on cells, or else on points, that guides the quads where `GuidingDirection` and
   * strokes do not: stress, the direction of fibres. Signs and lengths do not count; a zero vector leaves a cell free,
   * as do points that are all zero. Of the points of a cell their main direction is taken. An error where it is
   * missing. Empty or "(none)": not used. Default: empty.
   */
  void SetGuideArrayName(const char* name);
  const char* GetGuideArrayName() { return this->GuideArrayName.c_str(); }
  ///@}

  ///@{
  /**
   * The valence that is asked for at the points of port 3 without `TargetValence`, 2 to 8. Default: 3.
   */
  vtkSetMacro(PointValence, int);
  vtkGetMacro(PointValence, int);
  ///@}

  ///@{
  /**
   * Which of the three properties below sets the size of the quads, a TargetTypes. Default:
   * TARGET_NUMBER_OF_QUADS.
   */
  vtkSetClampMacro(TargetType, int, TARGET_NUMBER_OF_QUADS, TARGET_RELATIVE_EDGE_LENGTH);
  vtkGetMacro(TargetType, int);
  void SetTargetTypeToNumberOfQuads() { this->SetTargetType(TARGET_NUMBER_OF_QUADS); }
  void SetTargetTypeToEdgeLength() { this->SetTargetType(TARGET_EDGE_LENGTH); }
  void SetTargetTypeToRelativeEdgeLength() { this->SetTargetType(TARGET_RELATIVE_EDGE_LENGTH); }
  ///@}

  ///@{
  /**
   * Target number of quads, at least 1; or 0, BY_SHAPE: as many as the shape needs, 5000 or up to 20000, so that the
   * surface turns by more than 45 degrees over an edge on at most 5 % of its area; a notice tells the number where it
   * is more than 5000. Blocks that share 5000 by area each get up to four times their share. Default: 0.
   */
  vtkSetMacro(NumberOfQuads, vtkIdType);
  vtkGetMacro(NumberOfQuads, vtkIdType);
  void SetNumberOfQuadsToByShape() { this->SetNumberOfQuads(BY_SHAPE); }
  ///@}

  /// The values of QuadsAre, see there.
  enum QuadsAreTypes
  {
    QUADS_ARE_SHARED_BY_AREA = 0,
    QUADS_ARE_PER_BLOCK = 1
  };

  ///@{
  /**
   * What the target size means for composite data of several blocks, a QuadsAreTypes: shared by area, NumberOfQuads is
   * for all blocks together, each gets the part that its area has, but small ones at least 50, where there are 100 for
   * each, else half of the mean; and RelativeEdgeLength is over the diagonal of the box round all blocks; per block,
   * both are meant for each block by itself. Default: QUADS_ARE_SHARED_BY_AREA.
   */
  vtkSetClampMacro(QuadsAre, int, QUADS_ARE_SHARED_BY_AREA, QUADS_ARE_PER_BLOCK);
  vtkGetMacro(QuadsAre, int);
  void SetQuadsAreToSharedByArea() { this->SetQuadsAre(QUADS_ARE_SHARED_BY_AREA); }
  void SetQuadsAreToPerBlock() { this->SetQuadsAre(QUADS_ARE_PER_BLOCK); }
  ///@}

  ///@{
  /**
   * Numbers of quads that blocks of composite data have of their own: pairs "name = number", one a line or with ';'
   * between them. The name is that of the block, or all of its path as in messages ("Car/Wheel"); whole numbers of at
   * least 1. A field data array `NumberOfQuads` of a block, or of its partitioned data set, with one such number says
   * the same where the text does not name the block. They count where the target is a number of quads; the other
   * blocks share what is left of NumberOfQuads, or get NumberOfQuads each, see QuadsAre. An error where a name is that
   * of no block, or nothing is left. Default: empty.
   */
  void SetQuadsOfBlocks(const char* pairs);
  const char* GetQuadsOfBlocks() { return this->QuadsOfBlocks.c_str(); }
  ///@}

  ///@{
  /**
   * Target edge length in units of the input, positive. Default: 1.
   */
  vtkSetMacro(EdgeLength, double);
  vtkGetMacro(EdgeLength, double);
  ///@}

  ///@{
  /**
   * Target edge length over the diagonal of the input's bounding box, positive. Default: 0.02.
   */
  vtkSetMacro(RelativeEdgeLength, double);
  vtkGetMacro(RelativeEdgeLength, double);
  ///@}

  ///@{
  /**
   * Whether edges are features by their dihedral angle. Default: on.
   */
  vtkSetMacro(DetectFeatures, vtkTypeBool);
  vtkGetMacro(DetectFeatures, vtkTypeBool);
  vtkBooleanMacro(DetectFeatures, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Edges where the normals of the two faces differ by more than this are features; degrees in (0, 180].
   * Default: 40.
   */
  vtkSetMacro(FeatureAngle, double);
  vtkGetMacro(FeatureAngle, double);
  ///@}

  /// The values of FeatureCriterion, see there.
  enum FeatureCriterionTypes
  {
    FEATURES_ARE_CREASES = 0,
    FEATURES_BY_ANGLE = 1
  };

  ///@{
  /**
   * Which edges above the feature angle are features, a FeatureCriterionTypes. Creases: those of curves that are
   * creases as a whole, long against the quads, smooth along their course and sharp over a distance, too; noise of
   * scans makes none. By angle: all that stand out from their surroundings and that quads of this size can follow.
   * On a surface with large planes, as designed bodies have, creases are all that quads of this size can follow.
   * Default: creases.
   */
  vtkSetClampMacro(FeatureCriterion, int, FEATURES_ARE_CREASES, FEATURES_BY_ANGLE);
  vtkGetMacro(FeatureCriterion, int);
  void SetFeatureCriterionToCreases() { this->SetFeatureCriterion(FEATURES_ARE_CREASES); }
  void SetFeatureCriterionToAngle() { this->SetFeatureCriterion(FEATURES_BY_ANGLE); }
  ///@}

  ///@{
  /**
   * Name of an integer cell array; edges between two of its values are features. The default "PatchId" may be
   * missing on the input, any other name is an error when it is. Empty or "(none)": not used.
   */
  void SetPatchArrayName(const char* name);
  const char* GetPatchArrayName() { return this->PatchArrayName.c_str(); }
  ///@}

  ///@{
  /**
   * Budget of vertices on the coarse level, where the layout is computed; raised by the filter where features,
   * handles or components need more. 0: as many as the surface's curvature needs, from 300 to 4000; else at least 4.
   * Default: 1000.
   */
  void SetCoarseVertices(int number);
  vtkGetMacro(CoarseVertices, int);
  void SetCoarseVerticesToAutomatic() { this->SetCoarseVertices(0); }
  ///@}

protected:
  vtkQuadrilleSurfaceAlgorithm();
  ~vtkQuadrilleSurfaceAlgorithm() override;

  bool HasCommonTarget() const override { return this->QuadsAre == QUADS_ARE_SHARED_BY_AREA; }

  /// NumberOfQuads, or the least number where the shape says how many.
  double GetQuadsOfAll() const;
  double GetSharedTarget() const override;
  double LeastAreaShare(std::size_t blocks, double target) const override;
  double ReadOwnTarget(const std::string& block, vtkFieldData* fieldData) const override;
  void CheckBlockNames(const std::vector<std::string>& names) const override;
  void AddSettings(std::ostream& os) const override;

  /// The block's inputs with what the properties ask for, to be read by any thread.
  quadrille::GivenInputs GetGivenInputs(const quadrille::Block& block) const;
  /// Notices and warnings of those who have read them.
  void TellOfInputs(const std::vector<quadrille::ToldOfInputs>& told);
  /// Reads them here; asked gets the constraints of all ports.
  quadrille::ConvertedSurface ConvertInputs(
    const quadrille::Block& block, quadrille::AskedConstraints& asked);
  /// The properties in Core's units, with the block's part of the number of quads.
  quadrille::RemeshOptions MakeOptions(const quadrille::Block& block) const;
  /// GuideArrayName, or empty where none is to be used.
  std::string GetGuideArrayInUse() const;

  int TargetType = TARGET_NUMBER_OF_QUADS;
  vtkIdType NumberOfQuads = BY_SHAPE;
  int QuadsAre = QUADS_ARE_SHARED_BY_AREA;
  std::string QuadsOfBlocks;
  double EdgeLength = 1;
  double RelativeEdgeLength = 0.02;
  vtkTypeBool DetectFeatures = 1;
  double FeatureAngle = 40;
  int FeatureCriterion = FEATURES_ARE_CREASES;
  std::string PatchArrayName = "PatchId";
  int CoarseVertices = 1000;
  double StrokeWeight = 1;
  double StrokeRadius = 0;
  std::string GuideArrayName;
  int PointValence = 3;

private:
  vtkQuadrilleSurfaceAlgorithm(const vtkQuadrilleSurfaceAlgorithm&) = delete;
  void operator=(const vtkQuadrilleSurfaceAlgorithm&) = delete;
};

#endif
