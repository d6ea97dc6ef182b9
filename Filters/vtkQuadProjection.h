// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadProjection
 * @brief   quads of a wrap, put onto the surface that was wrapped
 *
 * Input port 0 takes quads, port 1 the surface, a soup of triangles as well. Each point goes to the nearest place of
 * the surface, where that is near enough and has about the same direction. Where the quads have two sides at one place,
 * round a sheet, they stay. No quad becomes inverted: its points stay instead. Edges and corners that a wrap has
 * rounded stay without a line of edges along them.
 *
 * Output: the quads with the point array `OnSurface` (1: put onto the surface); field data `PointsOnSurface`. Of the
 * quads' arrays those are left out that name cells and points of the wrap: `SourceCellId`, `SourcePointIds`,
 * `SourceBarycentric`, and `QuadNormals`.
 *
 * There where vtkSurfaceWrap is.
 */
#ifndef vtkQuadProjection_h
#define vtkQuadProjection_h

#include "vtkQuadrilleAlgorithm.h"

class QUADRILLEFILTERS_EXPORT vtkQuadProjection : public vtkQuadrilleAlgorithm
{
public:
  static vtkQuadProjection* New();
  vtkTypeMacro(vtkQuadProjection, vtkQuadrilleAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// The surface.
  void SetSurfaceConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(1, output); }
  void SetSurfaceData(vtkDataObject* surface) { this->SetInputDataObject(1, surface); }
  ///@}

  ///@{
  /**
   * Points farther from the surface stay; in units of the input, 0 or more. 0, the default: twice the offset of the
   * wrap, as its field data tells it, or else a 300th of the diagonal of the surface.
   */
  vtkSetClampMacro(MaximumDistance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(MaximumDistance, double);
  ///@}

  ///@{
  /**
   * Points stay where quads and surface differ in direction by more than this; degrees from 0 to 90. Default: 60.
   */
  vtkSetClampMacro(MaximumAngle, double, 0.0, 90.0);
  vtkGetMacro(MaximumAngle, double);
  ///@}

protected:
  vtkQuadProjection();
  ~vtkQuadProjection() override;

  PortRole GetPortRole(int port) const override;
  void AddSettings(std::ostream& os) const override;
  void Execute(quadrille::Block& block) override;

private:
  vtkQuadProjection(const vtkQuadProjection&) = delete;
  void operator=(const vtkQuadProjection&) = delete;

  double MaximumDistance = 0;
  double MaximumAngle = 60;
};

#endif
