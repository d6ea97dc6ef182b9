// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "pqQuadrilleToolBar.h"

#include "pqQuadrilleDrawing.h"

#include <QAction>
#include <QIcon>
#include <QSpinBox>

namespace
{

struct Button
{
  pqQuadrilleDrawing::Tool tool;
  const char* name;
  const char* help;
};

const Button kButtons[] = {
  { pqQuadrilleDrawing::Tool::Stroke, "Stroke",
    "Stroke: drag over the surface; the quads follow the line" },
  { pqQuadrilleDrawing::Tool::Valence, "Valence",
    "Valence: click on the surface; so many quads meet there as the number in this bar says (also: "
    "digits, wheel)" },
  { pqQuadrilleDrawing::Tool::Move, "Move",
    "Move: drag an irregular vertex (a ball) over the surface; onto another one it joins with it" },
  { pqQuadrilleDrawing::Tool::Connect, "Connect",
    "Connect: click on two irregular vertices (balls), or drag from one to the other; a straight "
    "chain of edges joins "
    "them" },
  { pqQuadrilleDrawing::Tool::Loop, "Loop",
    "Loop: drag across a body for a chain of edges that closes round it, or back to where the drag "
    "began" },
  { pqQuadrilleDrawing::Tool::Feature, "Feature",
    "Feature: drag over the surface; the line becomes edges of the quads" },
};

} // namespace

pqQuadrilleToolBar::pqQuadrilleToolBar(QWidget* parent) : Superclass(parent)
{
  this->setWindowTitle("Quadrille");
  this->setObjectName("QuadrilleToolBar");
  auto* drawing = new pqQuadrilleDrawing(this);
  drawing->setObjectName("QuadrilleDrawing");
  for (const Button& button : kButtons)
  {
    const QString name = button.name;
    QAction* action = this->addAction(QIcon(":/Quadrille/Icons/" + name.toLower() + ".svg"), name);
    action->setObjectName("Quadrille" + name);
    action->setToolTip(button.help);
    action->setCheckable(true);
    const pqQuadrilleDrawing::Tool tool = button.tool;
    QObject::connect(action, &QAction::triggered, drawing,
      [drawing, tool](bool isDown)
      { drawing->setTool(isDown ? tool : pqQuadrilleDrawing::Tool::None); });
    QObject::connect(drawing, &pqQuadrilleDrawing::toolChanged, action,
      [action, tool](pqQuadrilleDrawing::Tool now) { action->setChecked(now == tool); });
  }
  this->addSeparator();
  auto* valence = new QSpinBox(this);
  valence->setObjectName("QuadrilleValenceNumber");
  valence->setPrefix("Valence ");
  valence->setRange(2, 8);
  valence->setValue(drawing->valence());
  valence->setToolTip("How many quads meet where Valence is clicked");
  this->addWidget(valence);
  QObject::connect(
    valence, QOverload<int>::of(&QSpinBox::valueChanged), drawing, &pqQuadrilleDrawing::setValence);
  QObject::connect(drawing, &pqQuadrilleDrawing::valenceChanged, valence, &QSpinBox::setValue);
  QAction* remove = this->addAction(QIcon(":/Quadrille/Icons/remove.svg"), "Remove Last");
  remove->setObjectName("QuadrilleRemoveLast");
  remove->setToolTip("Takes away the constraint that was made last");
  QObject::connect(remove, &QAction::triggered, drawing, &pqQuadrilleDrawing::removeLast);
}
