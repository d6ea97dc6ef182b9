// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadrilleExecutive
 * @brief   executes a filter of Quadrille in a parallel run also where a filter upstream failed
 *
 * An executive does not execute its filter where something upstream fails. If that happens on one rank only, the filter
 * waits on the others for a rank that never comes. This executive goes on, and the filter tells all ranks. All outputs
 * are made for the piece that one of them is asked for, whichever that is.
 */
#ifndef vtkQuadrilleExecutive_h
#define vtkQuadrilleExecutive_h

#include "QuadrilleFiltersModule.h" // for the export macro
#include "vtkCompositeDataPipeline.h"

class QUADRILLEFILTERS_EXPORT vtkQuadrilleExecutive : public vtkCompositeDataPipeline
{
public:
  static vtkQuadrilleExecutive* New();
  vtkTypeMacro(vtkQuadrilleExecutive, vtkCompositeDataPipeline);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Whether something upstream failed in the last request for data.
  vtkGetMacro(UpstreamFailed, bool);

  /// After a stop on request the filter is out of date, so that the next update makes what is missing; VTK's own
  /// executive takes any execution for one that has brought the outputs up to date.
  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

protected:
  vtkQuadrilleExecutive();
  ~vtkQuadrilleExecutive() override;

  using Superclass::ForwardUpstream;
  int ForwardUpstream(vtkInformation* request) override;

private:
  vtkQuadrilleExecutive(const vtkQuadrilleExecutive&) = delete;
  void operator=(const vtkQuadrilleExecutive&) = delete;

  bool UpstreamFailed = false;
};

#endif
