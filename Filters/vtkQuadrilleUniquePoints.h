// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadrilleUniquePoints
 * @brief   finds equal points by hashing, wherever they lie
 *
 * A locator for readers that join equal points (vtkSTLReader::SetLocator). vtkMergePoints sorts points into buckets of
 * even size over the bounds: with one point far off all others are in one bucket, and a file takes minutes to hours.
 * Ids are the same. Points are inserted, nothing else is asked.
 */
#ifndef vtkQuadrilleUniquePoints_h
#define vtkQuadrilleUniquePoints_h

#include "QuadrilleFiltersModule.h" // for the export macro
#include "vtkMergePoints.h"

#include <memory> // for std::unique_ptr

class QUADRILLEFILTERS_EXPORT vtkQuadrilleUniquePoints : public vtkMergePoints
{
public:
  static vtkQuadrilleUniquePoints* New();
  vtkTypeMacro(vtkQuadrilleUniquePoints, vtkMergePoints);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  int InitPointInsertion(vtkPoints* points, const double bounds[6]) override;
  int InitPointInsertion(vtkPoints* points, const double bounds[6], vtkIdType size) override;
  /// Coordinates are compared as they are stored, in single precision.
  int InsertUniquePoint(const double x[3], vtkIdType& id) override;
  vtkIdType IsInsertedPoint(const double x[3]) override;
  vtkIdType IsInsertedPoint(double x, double y, double z) override;

protected:
  vtkQuadrilleUniquePoints();
  ~vtkQuadrilleUniquePoints() override;

private:
  vtkQuadrilleUniquePoints(const vtkQuadrilleUniquePoints&) = delete;
  void operator=(const vtkQuadrilleUniquePoints&) = delete;

  struct Internals;
  std::unique_ptr<Internals> Ids;
};

#endif
