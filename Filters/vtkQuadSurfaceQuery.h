// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadSurfaceQuery
 * @brief   what the questions about places under the mouse share: the surface, and what a view has selected of it
 *
 * With more than one rank each has its own part of both.
 */
#ifndef vtkQuadSurfaceQuery_h
#define vtkQuadSurfaceQuery_h

#include "QuadrilleFiltersModule.h" // for the export macro
#include "vtkObject.h"
#include "vtkSmartPointer.h" // for the inputs

#include <vector> // for the parts

class vtkAlgorithm;
class vtkDataObject;
class vtkDataSet;

class QUADRILLEFILTERS_EXPORT vtkQuadSurfaceQuery : public vtkObject
{
public:
  vtkTypeMacro(vtkQuadSurfaceQuery, vtkObject);

  ///@{
  /// What the selection is of, and what gives the selection: of the first output of the input.
  void SetInput(vtkAlgorithm* input);
  void SetSelection(vtkAlgorithm* selection);
  ///@}

protected:
  vtkQuadSurfaceQuery();
  ~vtkQuadSurfaceQuery() override;

  bool IsComplete() const { return this->Input != nullptr && this->Selection != nullptr; }
  /// What is selected, and all of the first output as it is now; on this rank, those that have cells.
  std::vector<vtkSmartPointer<vtkDataSet>> GetSelected();
  std::vector<vtkSmartPointer<vtkDataSet>> GetAll();

private:
  vtkQuadSurfaceQuery(const vtkQuadSurfaceQuery&) = delete;
  void operator=(const vtkQuadSurfaceQuery&) = delete;

  void Set(vtkSmartPointer<vtkAlgorithm>& member, vtkAlgorithm* value);

  vtkSmartPointer<vtkAlgorithm> Input;
  vtkSmartPointer<vtkAlgorithm> Selection;
};

#endif
