// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "MakeQuads.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqObjectBuilder.h"
#include "pqPipelineSource.h"
#include "pqView.h"
#include "vtkNew.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkSMParaViewPipelineControllerWithRendering.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRepresentationProxy.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"
#include "vtkSMTransferFunctionManager.h"
#include "vtkSMViewProxy.h"
#include "vtkWeakPointer.h"

namespace quadrille
{
namespace
{

/// The outputs of the filter that are shown at first, in place of the surface.
void showInstead(vtkSMSourceProxy* filter, vtkSMSourceProxy* surface, vtkSMViewProxy* view)
{
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  for (unsigned int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
  {
    controller->ShowInPreferredView(filter, static_cast<int>(port), view);
  }
  if (view && surface)
  {
    controller->SetVisibility(surface, 0, view, false);
  }
  leaveColoursOfOneValue(filter, view);
}

} // namespace

void leaveColoursOfOneValue(vtkSMSourceProxy* filter, vtkSMViewProxy* view)
{
  vtkSMProxy* quads = view ? view->FindRepresentation(filter, 0) : nullptr;
  if (!quads || !quads->GetProperty("ColorArrayName"))
  {
    return;
  }
  vtkSMPropertyHelper colours(quads, "ColorArrayName");
  const int association = colours.GetInputArrayAssociation();
  const char* name = colours.GetInputArrayNameToProcess();
  vtkPVArrayInformation* array =
    name ? filter->GetDataInformation(0)->GetArrayInformation(name, association) : nullptr;
  if (!array || array->GetNumberOfComponents() != 1 ||
    array->GetComponentRange(0)[0] < array->GetComponentRange(0)[1])
  {
    return;
  }
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", quads);
  colours.SetInputArrayToProcess(association, "");
  quads->UpdateVTKObjects();
  vtkNew<vtkSMTransferFunctionManager> legends;
  legends->UpdateScalarBars(view, vtkSMTransferFunctionManager::HIDE_UNUSED_SCALAR_BARS);
}

void setNumbers(vtkSMProxy* proxy, const std::vector<std::pair<std::string, int>>& numbers)
{
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", proxy);
  for (const auto& [name, value] : numbers)
  {
    vtkSMPropertyHelper(proxy, name.c_str()).Set(value);
  }
  proxy->UpdateVTKObjects();
}

bool makeQuads(pqPipelineSource* surface, const NewQuads& wanted, const Made& then)
{
  // Before the filter: a redo makes it with all its inputs.
  std::vector<vtkSMSourceProxy*> constraints;
  for (const NewConstraint& constraint : wanted.constraints)
  {
    constraints.push_back(registerConstraint(surface->proxyManager(), constraint));
  }
  pqPipelineSource* filter = pqApplicationCore::instance()->getObjectBuilder()->createFilter(
    "filters", "QuadRemesh", surface);
  if (!filter)
  {
    return false;
  }
  filter->setModifiedState(pqProxy::UNMODIFIED);
  const vtkWeakPointer<vtkSMSourceProxy> made = filter->getSourceProxy();
  if (!wanted.numbers.empty())
  {
    setNumbers(made, wanted.numbers);
  }
  if (!constraints.empty())
  {
    connectConstraints(made, constraints);
  }
  pqView* view = pqActiveObjects::instance().activeView();
  const vtkWeakPointer<vtkSMSourceProxy> shown = surface->getSourceProxy();
  const vtkWeakPointer<vtkSMViewProxy> shownIn = view ? view->getViewProxy() : nullptr;
  pqQuadrilleRun::instance()->start(made,
    [made, shown, shownIn, then](pqQuadrilleRun::End how)
    {
      if (how == pqQuadrilleRun::End::Shown && made)
      {
        showInstead(made, shown, shownIn);
      }
      then(how, made);
    });
  return true;
}

} // namespace quadrille
