// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadSurfacePlaces
 * @brief   the places of a surface that rays of the mouse hit, among cells that are selected
 *
 * The drawing tools of ParaView's window select what a view shows in a rectangle, and ask here for the places under the
 * pixels of a line in it, all at once: one selection and one search, however many pixels. With more than one rank all
 * have to call Compute(), and all have the same places then.
 *
 * @sa vtkQuadSurfacePick
 */
#ifndef vtkQuadSurfacePlaces_h
#define vtkQuadSurfacePlaces_h

#include "QuadrilleFiltersModule.h" // for the export macro
#include "vtkDoubleArray.h"         // for the places
#include "vtkObject.h"
#include "vtkSmartPointer.h" // for the inputs

#include <array>  // for the rays
#include <vector> // for the rays

class vtkAlgorithm;

class QUADRILLEFILTERS_EXPORT vtkQuadSurfacePlaces : public vtkObject
{
public:
  static vtkQuadSurfacePlaces* New();
  vtkTypeMacro(vtkQuadSurfacePlaces, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// What the selection is of, and what gives the selection: cells of the first output of the input.
  void SetInput(vtkAlgorithm* input);
  void SetSelection(vtkAlgorithm* selection);
  ///@}

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

  vtkSmartPointer<vtkAlgorithm> Input;
  vtkSmartPointer<vtkAlgorithm> Selection;
  std::vector<Ray> Rays;
  vtkSmartPointer<vtkDoubleArray> Places;
};

#endif
