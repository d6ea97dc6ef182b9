// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadSurfacePlaces
 * @brief   the places of a surface that rays of the mouse hit, among cells that are selected or are held
 *
 * The drawing tools of ParaView's window select what a view shows in a rectangle, and ask here for the places under the
 * pixels of a line in it, all at once: one selection and one search, however many pixels. A selection draws the view;
 * so while something is dragged, and quads come and go, they ask for places of the surface as it was held when the drag
 * began. With more than one rank all have to call Hold() and Compute(), and all have the same places then.
 *
 * @sa vtkQuadSurfacePick
 */
#ifndef vtkQuadSurfacePlaces_h
#define vtkQuadSurfacePlaces_h

#include "vtkDoubleArray.h" // for the places
#include "vtkQuadSurfaceQuery.h"
#include "vtkStaticCellLocator.h" // for what is held

#include <array> // for the rays

class QUADRILLEFILTERS_EXPORT vtkQuadSurfacePlaces : public vtkQuadSurfaceQuery
{
public:
  static vtkQuadSurfacePlaces* New();
  vtkTypeMacro(vtkQuadSurfacePlaces, vtkQuadSurfaceQuery);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Takes the whole first output of the input as it is now, in place of what is selected.
  void Hold();

  ///@{
  /// The rays, from their near end a to their far end b. At first there is none.
  void SetNumberOfRays(vtkIdType number);
  void SetRay(vtkIdType index, double ax, double ay, double az, double bx, double by, double bz);
  ///@}

  void Compute();

  /// Three values, its coordinates, for each ray, of the first place that it hits; not numbers where it hits none.
  vtkDoubleArray* GetPlaces() { return this->Places; }

protected:
  vtkQuadSurfacePlaces();
  ~vtkQuadSurfacePlaces() override;

private:
  vtkQuadSurfacePlaces(const vtkQuadSurfacePlaces&) = delete;
  void operator=(const vtkQuadSurfacePlaces&) = delete;

  using Ray = std::array<double, 6>;
  std::vector<double> HitsOfThisRank();

  std::vector<vtkSmartPointer<vtkStaticCellLocator>> Held;
  bool IsHeld = false;
  std::vector<Ray> Rays;
  vtkSmartPointer<vtkDoubleArray> Places;
};

#endif
