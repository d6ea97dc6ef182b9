// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "pqQuadrilleToolBar.h"

#include "MakeQuads.h"
#include "RemeshConstraints.h"
#include "Word.h"
#include "pqQuadrilleDrawing.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "vtkSMSourceProxy.h"

#include <QAction>
#include <QDoubleSpinBox>
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
    "chain of edges joins them" },
  { pqQuadrilleDrawing::Tool::Loop, "Loop",
    "Loop: drag across a body for a chain of edges that closes round it, or back to where the drag "
    "began" },
  { pqQuadrilleDrawing::Tool::Feature, "Feature",
    "Feature: drag over the surface; the line becomes edges of the quads. Click on a feature curve "
    "to clear it" },
  { pqQuadrilleDrawing::Tool::Size, "Size",
    "Size: drag from a place to as far as quads are to have the size that this bar says, times "
    "that of "
    "others" },
};

constexpr const char* kHelp = "QuadrilleHelp"; // property of an action: what it does

/// Grey with the reason, or not where there is none.
void allow(QAction* action, const QString& reasonNot)
{
  const QString help = action->property(kHelp).toString();
  action->setEnabled(reasonNot.isEmpty());
  action->setToolTip(reasonNot.isEmpty() ? help : help + ".\n\nNot now: " + reasonNot);
}

/// Whether the pipeline is empty.
bool isNothingThere()
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  return model->findItems<pqPipelineSource*>().empty();
}

/// Why no quads can be made of what is selected; empty where they can.
QString whyNoQuads(pqPipelineSource* selected)
{
  if (!selected)
  {
    return isNothingThere() ? "there is no surface: open one with File > Open, and Apply."
                            : "nothing is selected: select a surface in the pipeline.";
  }
  if (selected->modifiedState() == pqProxy::UNINITIALIZED)
  {
    return selected->getSMName() + " is not applied yet: press Apply in the panel.";
  }
  if (!quadrille::isSurface(selected->getSourceProxy()))
  {
    return selected->getSMName() + " gives no surface: select one in the pipeline.";
  }
  return {};
}

/// The Quad Remesh that what is selected in the pipeline belongs to.
vtkSMSourceProxy* filterOf(pqPipelineSource* selected)
{
  vtkSMSourceProxy* proxy = selected ? selected->getSourceProxy() : nullptr;
  return quadrille::remeshOf(proxy, proxy);
}

/// Why nothing can be drawn; empty where it can.
QString whyNoDrawing(pqPipelineSource* selected)
{
  if (vtkSMSourceProxy* filter = filterOf(selected))
  {
    auto* model = pqApplicationCore::instance()->getServerManagerModel();
    auto* source = model->findItem<pqPipelineSource*>(filter);
    // What a redo has brought back is uninitialized for ParaView, though it is shown.
    return source && source->modifiedState() == pqProxy::UNINITIALIZED && source->getViews().empty()
      ? source->getSMName() + " is not applied yet: press Apply in the panel."
      : QString();
  }
  return selected ? selected->getSMName() +
      " has no Quad Remesh: select one in the pipeline, or make one with the first button."
    : isNothingThere() ? QString("there is no Quad Remesh: the first button makes one.")
                       : QString("nothing is selected: select a Quad Remesh in the pipeline.");
}

} // namespace

pqQuadrilleToolBar::pqQuadrilleToolBar(QWidget* parent)
  : Superclass(parent), Drawing(new pqQuadrilleDrawing(this))
{
  this->setWindowTitle("Quadrille");
  this->setObjectName("QuadrilleToolBar");
  this->Drawing->setObjectName("QuadrilleDrawing");
  this->Remesh = this->add("Remesh",
    "Quad Remesh: makes quads of what is selected in the pipeline, as many as its shape needs; its "
    "panel sets "
    "another number");
  QObject::connect(this->Remesh, &QAction::triggered, this, &pqQuadrilleToolBar::makeQuads);
  this->addSeparator();
  this->addTools();
  this->addSeparator();
  this->addValence();
  this->addSize();
  this->Remove = this->add("Remove",
    "Remove: takes away the constraint that is selected in the pipeline, else the one that was "
    "made last");
  QObject::connect(
    this->Remove, &QAction::triggered, this->Drawing, &pqQuadrilleDrawing::removeMeant);
  quadrille::addRoomForWords(this);
  // What was said of what is undone now is not true any more.
  pqUndoStack* undo = pqApplicationCore::instance()->getUndoStack();
  QObject::connect(undo, &pqUndoStack::undone, this, [] { quadrille::say({}); });
  QObject::connect(undo, &pqUndoStack::redone, this, [] { quadrille::say({}); });
  this->watchPipeline();
  this->refresh();
}

//-----------------------------------------------------------------------------
QAction* pqQuadrilleToolBar::add(const QString& name, const QString& help)
{
  QAction* action = this->addAction(QIcon(":/Quadrille/Icons/" + name.toLower() + ".svg"), name);
  action->setObjectName("Quadrille" + name);
  action->setProperty(kHelp, help);
  return action;
}

//-----------------------------------------------------------------------------
void pqQuadrilleToolBar::addTools()
{
  for (const Button& button : kButtons)
  {
    QAction* action = this->add(button.name, button.help);
    action->setCheckable(true);
    const pqQuadrilleDrawing::Tool tool = button.tool;
    QObject::connect(action, &QAction::triggered, this->Drawing,
      [this, tool](bool isDown)
      { this->Drawing->setTool(isDown ? tool : pqQuadrilleDrawing::Tool::None); });
    QObject::connect(this->Drawing, &pqQuadrilleDrawing::toolChanged, action,
      [action, tool](pqQuadrilleDrawing::Tool now) { action->setChecked(now == tool); });
    this->Tools << action;
  }
}

//-----------------------------------------------------------------------------
void pqQuadrilleToolBar::addValence()
{
  this->Valence = new QSpinBox(this);
  this->Valence->setObjectName("QuadrilleValenceNumber");
  this->Valence->setPrefix("Valence ");
  this->Valence->setRange(2, 8);
  this->Valence->setValue(this->Drawing->valence());
  this->Valence->setToolTip("How many quads meet where Valence is clicked");
  this->addWidget(this->Valence);
  QObject::connect(this->Valence, QOverload<int>::of(&QSpinBox::valueChanged), this->Drawing,
    &pqQuadrilleDrawing::setValence);
  QObject::connect(
    this->Drawing, &pqQuadrilleDrawing::valenceChanged, this->Valence, &QSpinBox::setValue);
}

//-----------------------------------------------------------------------------
void pqQuadrilleToolBar::addSize()
{
  this->Size = new QDoubleSpinBox(this);
  this->Size->setObjectName("QuadrilleSizeNumber");
  this->Size->setPrefix("Size ");
  this->Size->setDecimals(2);
  this->Size->setRange(0.1, 5);
  this->Size->setSingleStep(0.1);
  this->Size->setValue(this->Drawing->sizeFactor());
  this->Size->setToolTip("Edge lengths where Size is dragged, over those of other quads");
  this->addWidget(this->Size);
  QObject::connect(this->Size, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this->Drawing,
    &pqQuadrilleDrawing::setSizeFactor);
}

//-----------------------------------------------------------------------------
void pqQuadrilleToolBar::watchPipeline()
{
  this->Refresh.setSingleShot(true);
  this->Refresh.setInterval(0);
  QObject::connect(&this->Refresh, &QTimer::timeout, this, &pqQuadrilleToolBar::refresh);
  const auto later = [this] { this->Refresh.start(); };
  QObject::connect(&pqActiveObjects::instance(), &pqActiveObjects::sourceChanged, this, later);
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  QObject::connect(model, &pqServerManagerModel::sourceAdded, this, later);
  QObject::connect(model, &pqServerManagerModel::sourceRemoved, this, later);
  QObject::connect(model,
    QOverload<pqPipelineSource*, pqPipelineSource*, int>::of(
      &pqServerManagerModel::connectionAdded),
    this, later);
  QObject::connect(model,
    QOverload<pqPipelineSource*, pqPipelineSource*, int>::of(
      &pqServerManagerModel::connectionRemoved),
    this, later);
  QObject::connect(model, &pqServerManagerModel::dataUpdated, this, later);
  QObject::connect(model, &pqServerManagerModel::modifiedStateChanged, this, later);
}

//-----------------------------------------------------------------------------
void pqQuadrilleToolBar::refresh()
{
  pqPipelineSource* selected = pqActiveObjects::instance().activeSource();
  allow(this->Remesh, whyNoQuads(selected));
  const QString reasonNot = whyNoDrawing(selected);
  for (QAction* action : this->Tools)
  {
    allow(action, reasonNot);
  }
  allow(this->Remove,
    reasonNot.isEmpty() && !quadrille::lastConstraint(filterOf(selected))
      ? QString("this Quad Remesh has no constraint.")
      : reasonNot);
  this->Valence->setEnabled(reasonNot.isEmpty());
  this->Size->setEnabled(reasonNot.isEmpty());
  if (!reasonNot.isEmpty() && this->Drawing->tool() != pqQuadrilleDrawing::Tool::None)
  {
    this->Drawing->setTool(pqQuadrilleDrawing::Tool::None);
  }
}

//-----------------------------------------------------------------------------
void pqQuadrilleToolBar::makeQuads()
{
  pqPipelineSource* surface = pqActiveObjects::instance().activeSource();
  if (!surface)
  {
    return;
  }
  BEGIN_UNDO_SET("Quad Remesh");
  const auto then = [](pqQuadrilleRun::End how, vtkSMSourceProxy*)
  {
    END_UNDO_SET(); // with what was shown
    pqQuadrilleRun::undoIfStopped(how);
  };
  if (!quadrille::makeQuads(surface, {}, then))
  {
    END_UNDO_SET();
  }
}
