// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceWrap
 * @brief   a closed surface round a soup of triangles, or round points
 *
 * CGAL's 3D alpha wrapping: what comes is closed, orientable, manifold and free of self-intersections, whatever the
 * input is, and has the input inside, at the distance Offset. Gaps that a ball with the radius Alpha does not fit
 * through are closed. An open surface gets two sides. Edges and corners are rounded.
 *
 * Input port 0 takes a surface, or points (vertices, or no cells at all). Output: the triangles, with all arrays of a
 * surface from the nearest place; field data `WrapAlpha` and `WrapOffset`, the lengths that were used.
 *
 * There only where Quadrille was built with CGAL, see QUADRILLE_USE_CGAL; with it the program is under the GPL.
 */
#ifndef vtkSurfaceWrap_h
#define vtkSurfaceWrap_h

#include "vtkQuadrilleAlgorithm.h"

class QUADRILLEFILTERS_EXPORT vtkSurfaceWrap : public vtkQuadrilleAlgorithm
{
public:
  static vtkSurfaceWrap* New();
  vtkTypeMacro(vtkSurfaceWrap, vtkQuadrilleAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Radius of the ball that carves, in units of the input, 0 or more. 0, the default: a hundredth of the diagonal of
   * the bounding box. Smaller ones follow the input more closely, and cost more triangles, with the inverse square.
   */
  vtkSetClampMacro(Alpha, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Alpha, double);
  ///@}

  ///@{
  /**
   * Distance of the wrap from the input, in units of the input, 0 or more. 0, the default: a 600th of the diagonal, at
   * most a sixth of Alpha.
   */
  vtkSetClampMacro(Offset, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Offset, double);
  ///@}

protected:
  vtkSurfaceWrap();
  ~vtkSurfaceWrap() override;

  void AddSettings(std::ostream& os) const override;
  void Execute(quadrille::Block& block) override;

private:
  vtkSurfaceWrap(const vtkSurfaceWrap&) = delete;
  void operator=(const vtkSurfaceWrap&) = delete;

  double Alpha = 0;
  double Offset = 0;
};

#endif
