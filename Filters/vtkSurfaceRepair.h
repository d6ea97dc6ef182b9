// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceRepair
 * @brief   an oriented manifold from a soup of triangles, with what is wrong with it
 *
 * CGAL's Polygon Mesh Processing: points at one place become one, faces without three different corners and double ones
 * go, the others are turned to agree with their neighbours, and edges and points that no manifold has are parted by
 * copies of points. Holes with a boundary shorter than FillHolesBelow are filled with a smooth patch.
 * Self-intersections are found and told, not removed: vtkSurfaceWrap does that.
 *
 * Output: the triangles, with all arrays of the input from the nearest place, and the cell arrays `Filling` (1: made to
 * fill a hole) and, where it was looked for, `SelfIntersecting` (1: crosses another face); field data
 * `SelfIntersections` (pairs of faces; -1 where it was not looked for), `FilledHoles`, `OpenBoundaries`, `Components`,
 * and `NeedsWrap` (1: most faces cross others, or most stand alone, so that quads of a wrap have more sense).
 * GetNoticesText() tells counts and places.
 *
 * There only where Quadrille was built with CGAL, see QUADRILLE_USE_CGAL; with it the program is under the GPL.
 */
#ifndef vtkSurfaceRepair_h
#define vtkSurfaceRepair_h

#include "vtkQuadrilleAlgorithm.h"

class QUADRILLEFILTERS_EXPORT vtkSurfaceRepair : public vtkQuadrilleAlgorithm
{
public:
  static vtkSurfaceRepair* New();
  vtkTypeMacro(vtkSurfaceRepair, vtkQuadrilleAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Holes whose boundary is shorter than this are filled; a length in units of the input, 0 or more. 0, the default:
   * none.
   */
  vtkSetClampMacro(FillHolesBelow, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(FillHolesBelow, double);
  ///@}

  ///@{
  /**
   * Whether faces that cross each other are looked for, which takes about as long as all else. Default: on.
   */
  vtkSetMacro(FindSelfIntersections, vtkTypeBool);
  vtkGetMacro(FindSelfIntersections, vtkTypeBool);
  vtkBooleanMacro(FindSelfIntersections, vtkTypeBool);
  ///@}

protected:
  vtkSurfaceRepair();
  ~vtkSurfaceRepair() override;

  void AddSettings(std::ostream& os) const override;
  void Execute(quadrille::Block& block) override;

private:
  vtkSurfaceRepair(const vtkSurfaceRepair&) = delete;
  void operator=(const vtkSurfaceRepair&) = delete;

  double FillHolesBelow = 0;
  vtkTypeBool FindSelfIntersections = 1;
};

#endif
