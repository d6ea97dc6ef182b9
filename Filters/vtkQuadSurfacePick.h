// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadSurfacePick
 * @brief   the place of the surface under the mouse
 *
 * The keys P, 1 and 2 of ParaView's widgets for points and lines ask the card which cell is drawn at the pixel, and a
 * proxy "PickingHelper" where the ray through the pixel meets that cell. ParaView 5.11 and 5.13 send the ray through
 * the corner of the pixel while the card looks at its centre, so that near an edge of the cell it passes beside it: of
 * 1,500 places on 1,433 quads 87 were missed, of the places of their irregular vertices eight of 13. 5.11 then gives
 * (0, 0, 0) for the place, 5.13 nothing but an error. This class stands in for ParaView's own in that proxy: where the
 * ray passes beside the cell it gives the place of the cell nearest to the ray.
 *
 * Input has the cell, or the point, that is selected in its first output; ParaView does not tell of which output the
 * cell was drawn.
 */
#ifndef vtkQuadSurfacePick_h
#define vtkQuadSurfacePick_h

#include "vtkQuadSurfaceQuery.h"

class vtkCell;
class vtkDataSet;

class QUADRILLEFILTERS_EXPORT vtkQuadSurfacePick : public vtkQuadSurfaceQuery
{
public:
  static vtkQuadSurfacePick* New();
  vtkTypeMacro(vtkQuadSurfacePick, vtkQuadSurfaceQuery);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// The ray, from the near end to the far one. At first (0, 0, 0) and (0, 0, 1).
  vtkSetVector3Macro(PointA, double);
  vtkGetVector3Macro(PointA, double);
  vtkSetVector3Macro(PointB, double);
  vtkGetVector3Macro(PointB, double);
  ///@}

  ///@{
  /// Whether the selected point itself is the place. Off at first.
  vtkSetMacro(SnapOnMeshPoint, bool);
  vtkGetMacro(SnapOnMeshPoint, bool);
  ///@}

  /// With more than one rank all call it; the first one has the result.
  void ComputeIntersection();

  ///@{
  /// Not numbers where nothing is selected, and where there is no normal.
  vtkGetVector3Macro(Intersection, double);
  vtkGetVector3Macro(IntersectionNormal, double);
  ///@}

protected:
  vtkQuadSurfacePick();
  ~vtkQuadSurfacePick() override;

private:
  vtkQuadSurfacePick(const vtkQuadSurfacePick&) = delete;
  void operator=(const vtkQuadSurfacePick&) = delete;

  void PickFrom(vtkDataSet* selected);
  void PickCell(vtkDataSet* selected);
  void Share(bool isFound);

  double PointA[3] = { 0, 0, 0 };
  double PointB[3] = { 0, 0, 1 };
  bool SnapOnMeshPoint = false;
  double Intersection[3];
  double IntersectionNormal[3];
};

#endif
