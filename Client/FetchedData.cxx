// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "FetchedData.h"

#include "pqUndoStack.h"
#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkPVDataInformation.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"

namespace quadrille
{

vtkSmartPointer<vtkDataObject> fetched(vtkSMSourceProxy* source, int port)
{
  const pqScopedUndoExclude noStepOfTheUser;
  vtkPVDataInformation* there = source->GetDataInformation(static_cast<unsigned int>(port));
  if (!there || there->IsNull())
  {
    return nullptr;
  }
  vtkSMSessionProxyManager* manager = source->GetSessionProxyManager();
  const auto made = [manager](const char* name)
  {
    return vtkSmartPointer<vtkSMSourceProxy>::Take(
      vtkSMSourceProxy::SafeDownCast(manager->NewProxy("filters", name)));
  };
  const vtkSmartPointer<vtkSMSourceProxy> gathered = made("ReductionFilter");
  const vtkSmartPointer<vtkSMSourceProxy> moved = made("ClientServerMoveData");
  if (!gathered || !moved)
  {
    return nullptr;
  }
  vtkSMPropertyHelper(gathered, "Input").Set(source, static_cast<unsigned int>(port));
  if (there->IsCompositeDataSet())
  {
    vtkSMPropertyHelper(gathered, "PostGatherHelperName").Set("vtkMultiBlockDataGroupFilter");
  }
  else if (there->DataSetTypeIsA("vtkPolyData"))
  {
    vtkSMPropertyHelper(gathered, "PostGatherHelperName").Set("vtkAppendPolyData");
  }
  else
  {
    vtkSMPropertyHelper(gathered, "PassThrough").Set(0); // a table, which the first rank has
  }
  gathered->UpdateVTKObjects();
  gathered->UpdatePipeline();
  vtkPVDataInformation* whole = gathered->GetDataInformation(0);
  vtkSMPropertyHelper(moved, "Input").Set(gathered);
  vtkSMPropertyHelper(moved, "OutputDataType")
    .Set(whole->IsCompositeDataSet() ? whole->GetCompositeDataSetType() : whole->GetDataSetType());
  moved->UpdateVTKObjects();
  moved->UpdatePipeline();
  auto* algorithm = vtkAlgorithm::SafeDownCast(moved->GetClientSideObject());
  return algorithm ? algorithm->GetOutputDataObject(0) : nullptr;
}

} // namespace quadrille
