// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleExecutive.h"

#include "Ranks/Ranks.h"
#include "vtkQuadrilleAlgorithm.h"

#include "vtkInformation.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkQuadrilleExecutive);

//------------------------------------------------------------------------------
vtkQuadrilleExecutive::vtkQuadrilleExecutive() = default;
vtkQuadrilleExecutive::~vtkQuadrilleExecutive() = default;

//------------------------------------------------------------------------------
vtkTypeBool vtkQuadrilleExecutive::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const vtkTypeBool done = this->Superclass::ProcessRequest(request, inputs, outputs);
  auto* filter = vtkQuadrilleAlgorithm::SafeDownCast(this->GetAlgorithm());
  if (request->Has(REQUEST_DATA()) && filter &&
    filter->GetOutcome() == vtkQuadrilleAlgorithm::Aborted)
  {
    this->DataTime = vtkTimeStamp();
  }
  return done;
}

//------------------------------------------------------------------------------
int vtkQuadrilleExecutive::ForwardUpstream(vtkInformation* request)
{
  const int result = this->Superclass::ForwardUpstream(request);
  if (!request->Has(REQUEST_DATA()))
  {
    return result;
  }
  this->UpstreamFailed = result == 0;
  const bool hasOthers = quadrille::controllerOf(this->GetOutputInformation()) != nullptr;
  return hasOthers ? 1 : result;
}

//------------------------------------------------------------------------------
void vtkQuadrilleExecutive::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "UpstreamFailed: " << this->UpstreamFailed << "\n";
}
