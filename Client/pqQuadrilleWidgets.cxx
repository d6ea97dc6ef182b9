// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "pqQuadrilleWidgets.h"

#include "pqQuadVerdictWidget.h"

#include "vtkSMProperty.h"
#include "vtkSMProxy.h"

#include <string>

pqPropertyWidget* pqQuadrilleWidgets::createWidgetForProperty(
  vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
{
  const std::string name = proxy->GetXMLName() ? proxy->GetXMLName() : "";
  const bool hasVerdict = name == "QuadRemesh" || name == "QuadCADProjection";
  return hasVerdict && property == proxy->GetProperty("Verdict")
    ? new pqQuadVerdictWidget(proxy, property, parent)
    : nullptr;
}
