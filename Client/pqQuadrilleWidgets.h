// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqQuadrilleWidgets_h
#define pqQuadrilleWidgets_h

#include "pqPropertyWidgetInterface.h"

#include <QObject>

/// The fields of panels that are Quadrille's own: it gives them to ParaView, which asks for each property. Without this
/// library a property has the field that ParaView has for its type.
class pqQuadrilleWidgets
  : public QObject
  , public pqPropertyWidgetInterface
{
  Q_OBJECT
  Q_INTERFACES(pqPropertyWidgetInterface)

public:
  using QObject::QObject;

  pqPropertyWidget* createWidgetForProperty(
    vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent) override;
};

#endif
