// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#ifndef pqQuadNumberWidget_h
#define pqQuadNumberWidget_h

#include "pqPropertyWidget.h"

#include <QString>

class QLineEdit;
class vtkSMProperty;

/// The field of Number Of Quads: empty, with the word "automatic" in it, while the shape of the surface says how many,
/// which is 0 for the filter.
class pqQuadNumberWidget : public pqPropertyWidget
{
  Q_OBJECT
  Q_PROPERTY(QString number READ number WRITE setNumber NOTIFY numberChanged)
  typedef pqPropertyWidget Superclass;

public:
  pqQuadNumberWidget(vtkSMProxy* filter, vtkSMProperty* number, QWidget* parent = nullptr);

  /// As the property has it.
  QString number() const;
  void setNumber(const QString& number);

Q_SIGNALS:
  void numberChanged();

private:
  Q_DISABLE_COPY(pqQuadNumberWidget)

  QLineEdit* Field;
};

#endif
