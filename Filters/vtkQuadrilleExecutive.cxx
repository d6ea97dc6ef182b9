// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleExecutive.h"

#include "Ranks/Ranks.h"
#include "vtkQuadrilleAlgorithm.h"

#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"

namespace
{

/// All outputs are made at once, so they are for the piece that one of them is asked for. Where that is not the first
/// one, as in a view that shows another one before it, the others would be taken for those of a serial run.
void askAlike(vtkInformation* request, vtkInformationVector* outputs)
{
  using Executive = vtkStreamingDemandDrivenPipeline;
  const auto key = vtkExecutive::FROM_OUTPUT_PORT();
  vtkInformation* asked =
    request->Has(key) ? outputs->GetInformationObject(request->Get(key)) : nullptr;
  if (!asked || !asked->Has(Executive::UPDATE_PIECE_NUMBER()))
  {
    return;
  }
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkInformation* info = outputs->GetInformationObject(port);
    info->CopyEntry(asked, Executive::UPDATE_PIECE_NUMBER());
    info->CopyEntry(asked, Executive::UPDATE_NUMBER_OF_PIECES());
  }
}

} // namespace

vtkStandardNewMacro(vtkQuadrilleExecutive);

//------------------------------------------------------------------------------
vtkQuadrilleExecutive::vtkQuadrilleExecutive() = default;
vtkQuadrilleExecutive::~vtkQuadrilleExecutive() = default;

//------------------------------------------------------------------------------
vtkTypeBool vtkQuadrilleExecutive::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (request->Has(REQUEST_UPDATE_EXTENT()))
  {
    askAlike(request, outputs);
  }
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
