// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadExtraction
 * @brief   the quads of a surface with an integer-grid map
 *
 * Input: a triangle surface with the cell array `IGM` (vtkIntegerGridMapUpmap, output 1 of vtkQuadRemesh, or the coarse
 * level of vtkIntegerGridMap; or by another program: 6 real numbers a cell, u and v of its corners, one unit a quad).
 * Without that array the active texture coordinates of the points are the map, as vtkOBJReader delivers them: points at
 * the same place are then joined over the edges of the triangles. Features are in the cell array `FeatureEdges`; the
 * quarter turns across edges are taken from the cell array `Matching` where there is one, else from the two images of
 * each edge, as the translations always are. A map that is not exact is rounded, and the field arrays `MapLargestMove`
 * (in quads), `MapFixedPoints` and `MapInconsistentVertices` and a notice tell how much; an exact one, as our own, is
 * taken as it is.
 *
 * Outputs: 0 the quads, 1 the feature and boundary lines, 2 the separatrices, as outputs 0, 2 and 3 of vtkQuadRemesh.
 *
 * Triangles may be inverted or without area, and coordinates mirrored. Field data of output 0: what the input has,
 * `ActualQuads`, and `ExtractionNames`, `ExtractionCounts`, which tell what folds made necessary: sides of cells of
 * length zero, merged vertices, zipped sides, cancelled quads, dropped outlines, filled holes, open ports; all zero for
 * a valid map.
 */
#ifndef vtkQuadExtraction_h
#define vtkQuadExtraction_h

#include "vtkQuadrilleAlgorithm.h"

class QUADRILLEFILTERS_EXPORT vtkQuadExtraction : public vtkQuadrilleAlgorithm
{
public:
  static vtkQuadExtraction* New();
  vtkTypeMacro(vtkQuadExtraction, vtkQuadrilleAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The filter refuses, before memory is spent, to make more quads than this; at least 1. Default: ten million.
   */
  vtkSetMacro(MaximumNumberOfQuads, vtkIdType);
  vtkGetMacro(MaximumNumberOfQuads, vtkIdType);
  ///@}

  ///@{
  /**
   * Sweeps in which the points of the quads move over the surface, those of features and boundaries along their curves,
   * towards the average of their neighbours; a move that would lower the worst scaled Jacobian round a point is not
   * made. Then points near quads that are turned over at a corner move to mend them. At least 0: the points stay where
   * the map has them. Default: 5.
   */
  vtkSetMacro(SmoothingSteps, int);
  vtkGetMacro(SmoothingSteps, int);
  ///@}

  /// The values of BoundaryMode, see there.
  enum BoundaryModes
  {
    BOUNDARY_ALIGNED = 0,
    BOUNDARY_TRIMMED = 1,
    BOUNDARY_POLYGONS = 2
  };

  ///@{
  /**
   * What becomes of cells of the map that the boundary cuts, a BoundaryModes. Aligned: there must be none; the boundary
   * of a map of ours lies on isolines, and one that does not is an error. Trimmed: they are left out; quads that then
   * touch in a corner only get a point each. Polygons: they are kept behind the quads, as cells of three corners or
   * more (1 in the cell array `Partial`, which is there where such cells are): grid points, the crossings of isolines
   * with the boundary, and corners of the boundary of more than 30 degrees; they are in no layout patch (-1). Points at
   * a free boundary are not smoothed. Ends of features that are no grid points are told as a notice and in the field
   * arrays `NonIntegerFeatureEnds` and `NonIntegerFeatureEndPlaces`, holes smaller than a quad in `LoopsInCells`.
   * Default: BOUNDARY_ALIGNED.
   */
  vtkSetClampMacro(BoundaryMode, int, BOUNDARY_ALIGNED, BOUNDARY_POLYGONS);
  vtkGetMacro(BoundaryMode, int);
  void SetBoundaryModeToAligned() { this->SetBoundaryMode(BOUNDARY_ALIGNED); }
  void SetBoundaryModeToTrimmed() { this->SetBoundaryMode(BOUNDARY_TRIMMED); }
  void SetBoundaryModeToPolygons() { this->SetBoundaryMode(BOUNDARY_POLYGONS); }
  ///@}

  ///@{
  /**
   * What texture coordinates are multiplied by to make one unit one quad, above 0; the array IGM is not scaled.
   * Default: 1.
   */
  vtkSetMacro(TextureScale, double);
  vtkGetMacro(TextureScale, double);
  ///@}

  ///@{
  /**
   * Name of the cell array with patch ids, for the pairs that feature lines separate; may be missing.
   * Default: "PatchId".
   */
  void SetPatchArrayName(const char* name);
  const char* GetPatchArrayName() { return this->PatchArrayName.c_str(); }
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

  /// Outputs 1 and 2.
  vtkPolyData* GetLines();
  vtkPolyData* GetSeparatrices();

protected:
  vtkQuadExtraction();
  ~vtkQuadExtraction() override;

  PortRole GetPortRole(int) const override { return PortRole::Mesh; }
  void Execute(quadrille::Block& block) override;

private:
  vtkQuadExtraction(const vtkQuadExtraction&) = delete;
  void operator=(const vtkQuadExtraction&) = delete;

  vtkIdType MaximumNumberOfQuads = 10000000;
  int SmoothingSteps = 5;
  int BoundaryMode = BOUNDARY_ALIGNED;
  double TextureScale = 1;
  std::string PatchArrayName = "PatchId";
  int CellDataFrom = CELL_DATA_FROM_CENTRE;
};

#endif
