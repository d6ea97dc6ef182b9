// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMQuadPickProxy.h"

#include "vtkObjectFactory.h"
#include "vtkSMPropertyHelper.h"

vtkStandardNewMacro(vtkSMQuadPickProxy);

namespace
{

/// The proxy itself lives for one pick only; the window has one mouse.
std::vector<double>& lastPlace()
{
  static std::vector<double> place;
  return place;
}

} // namespace

vtkSMQuadPickProxy::vtkSMQuadPickProxy() = default;
vtkSMQuadPickProxy::~vtkSMQuadPickProxy() = default;

//------------------------------------------------------------------------------
void vtkSMQuadPickProxy::UpdatePropertyInformation(vtkSMProperty* property)
{
  this->Superclass::UpdatePropertyInformation(property);
  if (property && property == this->GetProperty("Intersection"))
  {
    lastPlace().resize(3);
    vtkSMPropertyHelper(property).Get(lastPlace().data(), 3);
  }
}

//------------------------------------------------------------------------------
bool vtkSMQuadPickProxy::TakeLastPlace(const std::vector<double>& place)
{
  const bool isIt = !place.empty() && place == lastPlace();
  if (isIt)
  {
    lastPlace().clear();
  }
  return isIt;
}

//------------------------------------------------------------------------------
void vtkSMQuadPickProxy::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
