// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "pqQuadrilleTutorial.h"

#include "Examples.h"
#include "RemeshConstraints.h"
#include "pqQuadrilleDrawing.h"
#include "pqQuadrilleRun.h"

#include "pqApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"

#include <QLabel>
#include <QMainWindow>

#include <array>

namespace
{

constexpr int kLookAgain = 200; // milliseconds
constexpr int kMargin = 6;      // pixels
constexpr int kLines = 2;       // of a text, in a window as narrow as 800 pixels
constexpr const char* kName = "QuadrilleTutorial";

enum class Goal
{
  Quads,
  StrokeTool,
  Constraint,
  MoveTool,
  Undo,
  NoTool,
  None
};

struct Step
{
  Goal goal;
  const char* icon; ///< of the button that is spoken of
  const char* text;
};

const std::array<Step, 8> kSteps = { {
  { Goal::Quads, "remesh",
    "This is a scan of 20,000 triangles. Press the button <b>Remesh</b> in the tool bar above: it "
    "makes quads." },
  { Goal::StrokeTool, "stroke", "The quads run as the shape does. Press <b>Stroke</b>." },
  { Goal::Constraint, "stroke",
    "With the left mouse button drag a line over the body: when you release it the quads follow "
    "that line." },
  { Goal::MoveTool, "move",
    "Press <b>Move</b>: balls show where 3 quads meet (blue), or 5 (red), in place of 4." },
  { Goal::Constraint, "move", "Drag one of the balls to another place. The quads follow it." },
  { Goal::Undo, "",
    "Press <b>Ctrl+Z</b>: it takes back what was done last, one action each time." },
  { Goal::NoTool, "",
    "Press <b>Escape</b>: no tool is on any more, and the left mouse button turns the view." },
  { Goal::None, "",
    "That was it. With the quads selected in the pipeline the panel sets their number; the other "
    "tools work alike. <b>File &gt; Save Data</b> writes the quads. <b>Help &gt; Quadrille</b> has "
    "examples. Close this strip by its cross." },
} };

} // namespace

void pqQuadrilleTutorial::start(QMainWindow* window, pqQuadrilleDrawing* drawing)
{
  delete window->findChild<pqQuadrilleTutorial*>(kName);
  if (pqPipelineSource* surface = quadrille::openScan())
  {
    window->addDockWidget(Qt::TopDockWidgetArea, new pqQuadrilleTutorial(window, drawing, surface));
  }
}

//-----------------------------------------------------------------------------
pqQuadrilleTutorial::pqQuadrilleTutorial(
  QMainWindow* window, pqQuadrilleDrawing* drawing, pqPipelineSource* surface)
  : Superclass("Quadrille: a minute with the drawing tools", window), Drawing(drawing),
    Surface(surface), Text(new QLabel(this))
{
  this->setObjectName(kName);
  this->setAttribute(Qt::WA_DeleteOnClose);
  this->Text->setWordWrap(true);
  this->Text->setMargin(kMargin);
  this->Text->setFixedHeight(kLines * this->fontMetrics().lineSpacing() + 2 * kMargin);
  this->setWidget(this->Text);
  this->say();
  QObject::connect(&this->Timer, &QTimer::timeout, this, &pqQuadrilleTutorial::look);
  QObject::connect(surface, &QObject::destroyed, this, &QWidget::close);
  this->Timer.start(kLookAgain);
}

//-----------------------------------------------------------------------------
void pqQuadrilleTutorial::say()
{
  const Step& step = kSteps[this->Current];
  QString text;
  if (step.goal != Goal::None)
  {
    text = QString("<b>%1 of %2</b>&nbsp;&nbsp;").arg(this->Current + 1).arg(kSteps.size() - 1);
  }
  if (*step.icon != '\0')
  {
    text += QString("<img src=':/Quadrille/Icons/%1.svg' width='20' height='20' "
                    "style='vertical-align: middle'>&nbsp;&nbsp;")
              .arg(step.icon);
  }
  this->Text->setText(text + step.text);
}

//-----------------------------------------------------------------------------
void pqQuadrilleTutorial::look()
{
  if (this->Drawing && this->Surface && this->isDone())
  {
    ++this->Current;
    this->Before = this->constraints();
    this->say();
  }
}

//-----------------------------------------------------------------------------
bool pqQuadrilleTutorial::isDone() const
{
  if (pqQuadrilleRun::instance()->isUnderway())
  {
    return false;
  }
  switch (kSteps[this->Current].goal)
  {
    case Goal::Quads:
    {
      auto* model = pqApplicationCore::instance()->getServerManagerModel();
      auto* shown = model->findItem<pqPipelineSource*>(this->filter());
      return shown && !shown->getViews().empty();
    }
    case Goal::StrokeTool:
      return this->Drawing->tool() == pqQuadrilleDrawing::Tool::Stroke;
    case Goal::MoveTool:
      return this->Drawing->tool() == pqQuadrilleDrawing::Tool::Move;
    case Goal::NoTool:
      return this->Drawing->tool() == pqQuadrilleDrawing::Tool::None;
    case Goal::Constraint:
      return this->constraints() > this->Before;
    case Goal::Undo:
      return this->constraints() < this->Before;
    case Goal::None:
      break;
  }
  return false;
}

//-----------------------------------------------------------------------------
vtkSMSourceProxy* pqQuadrilleTutorial::filter() const
{
  return quadrille::remeshOf(this->Surface->getSourceProxy(), nullptr);
}

//-----------------------------------------------------------------------------
unsigned int pqQuadrilleTutorial::constraints() const
{
  vtkSMSourceProxy* filter = this->filter();
  if (!filter)
  {
    return 0;
  }
  const vtkSMPropertyHelper list(filter, "Constraints");
  unsigned int count = 0;
  for (unsigned int i = 0; i < list.GetNumberOfElements(); ++i)
  {
    count += list.GetAsProxy(i) ? 1 : 0;
  }
  return count;
}
