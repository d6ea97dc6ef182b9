// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadExtraction
 * @brief   the quads of a surface with an integer-grid map
 *
 * Input: a triangle surface with the cell array `IGM` (vtkIntegerGridMapUpmap, output 1 of vtkQuadRemesh, or the coarse
 * level of vtkIntegerGridMap; or by another program: 6 real numbers a cell, u and v of its corners, one unit a quad). Without that array the
 * active texture coordinates of the points are the map, as vtkOBJReader delivers them: points at the same place are then joined over the edges of the
 * triangles. Features are in the cell array `FeatureEdges`; the quarter turns across edges are taken from the cell array `Matching` where there is one, else
 * from the two images of each edge, as the translations always are. A map that is not exact is rounded, and the field arrays `MapLargestMove` (in
 * quads), `MapFixedPoints` and `MapInconsistentVertices` and a notice tell how much; an exact one, as our own, is taken as it is.
 *
 * Outputs: 0 the quads, 1 the feature and boundary lines, both as from vtkQuadRemesh.
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
   * What texture coordinates are multiplied by to make one unit one quad, above 0; the array IGM is not scaled. Default: 1.
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

  /// Output 1.
  vtkPolyData* GetLines();

protected:
  vtkQuadExtraction();
  ~vtkQuadExtraction() override;

  void Execute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkQuadExtraction(const vtkQuadExtraction&) = delete;
  void operator=(const vtkQuadExtraction&) = delete;

  vtkIdType MaximumNumberOfQuads = 10000000;
  double TextureScale = 1;
  std::string PatchArrayName = "PatchId";
};

#endif
