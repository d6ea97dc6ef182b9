// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkIntegerGridMapComparison
 * @brief   how far two maps of one surface are apart: irregular vertices, sizing, anisotropy, shear
 *
 * Input 0: a surface with a map, as vtkIntegerGridMapQuality takes it. Input 1: the same points and triangles with
 * another map, the reference. Outputs:
 *
 * 0. lines, one for each move of the optimal transport that takes the irregular vertices of the reference to those of
 *    the map; cell arrays `Turns` (how many quarter turns) and `Length` (of the way along the surface);
 * 1. a table of measures: `Measure`, `Map`, `Reference`, `Distance`, `MapMedian`, `ReferenceMedian`. For sizing,
 *    anisotropy and shear means and medians by area and the first Wasserstein distance of the two distributions over
 *    the area; for the irregular vertices their numbers and the earth mover's distance in quarter turns times edge
 *    lengths; those of other valences than 3 and 5; inverted triangles;
 * 2. a table of histograms: for each measure the middle of the bin, and the shares of both maps in percent;
 * 3. a table of valences: `Valence`, `Map`, `Reference`.
 *
 * The earth mover's distance [Ebke et al. 2016, Section 8; Rubner et al. 1998] is exact as a transport problem, with
 * ways along the surface that are about 1 % longer than geodesics, component by component. Quarter turns that have no
 * partner, because the sums on a component differ, are counted in the field data of output 1, `UnmatchedTurns`, with a
 * notice; vertices on the boundary do not take part.
 */
#ifndef vtkIntegerGridMapComparison_h
#define vtkIntegerGridMapComparison_h

#include "vtkQuadrilleAlgorithm.h"

class vtkTable;

class QUADRILLEFILTERS_EXPORT vtkIntegerGridMapComparison : public vtkQuadrilleAlgorithm
{
public:
  static vtkIntegerGridMapComparison* New();
  vtkTypeMacro(vtkIntegerGridMapComparison, vtkQuadrilleAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// The surface with the map to compare with.
  void SetReferenceConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(1, output); }
  void SetReferenceData(vtkDataObject* surface) { this->SetInputDataObject(1, surface); }
  ///@}

  ///@{
  /**
   * The edge length s of the quads asked for, in units of the input, for both maps. 0, the default: as in
   * vtkIntegerGridMapQuality, by the reference.
   */
  vtkSetClampMacro(EdgeLength, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(EdgeLength, double);
  ///@}

  ///@{
  /**
   * Quads per unit of the texture coordinates, where the maps are read from these. Default: 1.
   */
  vtkSetMacro(TextureScale, double);
  vtkGetMacro(TextureScale, double);
  ///@}

  ///@{
  /// Outputs 1 to 3; null for composite data.
  vtkTable* GetMeasures();
  vtkTable* GetHistograms();
  vtkTable* GetValences();
  ///@}

protected:
  vtkIntegerGridMapComparison();
  ~vtkIntegerGridMapComparison() override;

  PortRole GetPortRole(int) const override { return PortRole::Mesh; }
  const char* GetBlockType(int outputPort) const override;
  void AddSettings(std::ostream& os) const override;
  void Execute(quadrille::Block& block) override;

private:
  vtkIntegerGridMapComparison(const vtkIntegerGridMapComparison&) = delete;
  void operator=(const vtkIntegerGridMapComparison&) = delete;

  double EdgeLength = 0;
  double TextureScale = 1;
};

#endif
