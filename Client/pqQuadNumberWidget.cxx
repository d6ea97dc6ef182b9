// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "pqQuadNumberWidget.h"

#include "vtkSMProperty.h"

#include <QHBoxLayout>
#include <QIntValidator>
#include <QLineEdit>

#include <limits>

namespace
{

constexpr const char* kByShape = "0";

} // namespace

pqQuadNumberWidget::pqQuadNumberWidget(vtkSMProxy* filter, vtkSMProperty* number, QWidget* parent)
  : Superclass(filter, parent), Field(new QLineEdit(this))
{
  this->Field->setObjectName("QuadNumber");
  this->Field->setPlaceholderText("automatic");
  this->Field->setValidator(new QIntValidator(0, std::numeric_limits<int>::max(), this->Field));
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->addWidget(this->Field);
  // Apply is live while a number is typed; Auto Apply waits until it is there.
  this->setChangeAvailableAsChangeFinished(false);
  QObject::connect(this->Field, &QLineEdit::textEdited, this, &pqQuadNumberWidget::numberChanged);
  QObject::connect(
    this->Field, &QLineEdit::editingFinished, this, &pqQuadNumberWidget::changeFinished);
  this->addPropertyLink(this, "number", SIGNAL(numberChanged()), number);
}

//-----------------------------------------------------------------------------
QString pqQuadNumberWidget::number() const
{
  const QString text = this->Field->text();
  return text.isEmpty() ? kByShape : text;
}

//-----------------------------------------------------------------------------
void pqQuadNumberWidget::setNumber(const QString& number)
{
  if (number != this->number())
  {
    this->Field->setText(number == kByShape ? QString() : number);
  }
}
