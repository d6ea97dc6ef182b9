// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMQuadConstraintPlacement.h"

#include "vtkObjectFactory.h"
#include "vtkSMQuadConstraintProxy.h"

vtkStandardNewMacro(vtkSMQuadConstraintPlacement);

vtkSMQuadConstraintPlacement::vtkSMQuadConstraintPlacement() = default;
vtkSMQuadConstraintPlacement::~vtkSMQuadConstraintPlacement() = default;

//------------------------------------------------------------------------------
void vtkSMQuadConstraintPlacement::PostInitializeProxy(
  vtkSMProxy* proxy, vtkPVXMLElement*, vtkMTimeType made)
{
  if (auto* constraint = vtkSMQuadConstraintProxy::SafeDownCast(proxy))
  {
    constraint->PlaceOnSurface(made);
  }
}

//------------------------------------------------------------------------------
void vtkSMQuadConstraintPlacement::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
