// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "pqQuadrilleWidgets.h"

#include "RemeshConstraints.h"
#include "pqQuadVerdictWidget.h"

#include "vtkSMProperty.h"
#include "vtkSMProxy.h"

pqPropertyWidget* pqQuadrilleWidgets::createWidgetForProperty(
  vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent)
{
  return quadrille::isQuadRemesh(proxy) && property == proxy->GetProperty("Verdict")
    ? new pqQuadVerdictWidget(proxy, property, parent)
    : nullptr;
}
