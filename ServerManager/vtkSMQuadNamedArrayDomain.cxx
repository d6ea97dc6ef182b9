// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMQuadNamedArrayDomain.h"

#include "vtkObjectFactory.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMStringVectorProperty.h"

vtkStandardNewMacro(vtkSMQuadNamedArrayDomain);

vtkSMQuadNamedArrayDomain::vtkSMQuadNamedArrayDomain() = default;
vtkSMQuadNamedArrayDomain::~vtkSMQuadNamedArrayDomain() = default;

//------------------------------------------------------------------------------
int vtkSMQuadNamedArrayDomain::SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues)
{
  auto* names = vtkSMStringVectorProperty::SafeDownCast(property);
  if (!names)
  {
    return 0;
  }
  unsigned int place = 0;
  const char* name = names->GetDefaultValue(0);
  vtkSMPropertyHelper helper(property);
  helper.SetUseUnchecked(useUncheckedValues);
  helper.Set(0, this->IsInDomain(name, place) ? name : this->GetNoneString());
  return 1;
}

//------------------------------------------------------------------------------
void vtkSMQuadNamedArrayDomain::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
