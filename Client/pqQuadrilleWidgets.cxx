// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "pqQuadrilleWidgets.h"

#include "pqQuadNumberWidget.h"
#include "pqQuadVerdictWidget.h"

#include "vtkSMProperty.h"
#include "vtkSMProxy.h"

#include <string>

pqPropertyWidget* pqQuadrilleWidgets::createWidgetForProperty(
  vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
{
  const std::string name = proxy->GetXMLName() ? proxy->GetXMLName() : "";
  const bool hasVerdict = name == "QuadRemesh" || name == "QuadCADProjection";
  if (hasVerdict && property == proxy->GetProperty("Verdict"))
  {
    return new pqQuadVerdictWidget(proxy, property, parent);
  }
  const bool hasNumber = name == "QuadRemesh" || name == "DecimationHierarchy";
  return hasNumber && property == proxy->GetProperty("NumberOfQuads")
    ? new pqQuadNumberWidget(proxy, property, parent)
    : nullptr;
}
