// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "pqQuadrilleRun.h"

#include "StatusBar.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqServerManagerModel.h"
#include "pqView.h"
#include "vtkClientServerStream.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSession.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMViewProxy.h"

#include <QApplication>
#include <QKeyEvent>

#include <utility>

namespace
{

constexpr int kLookAgain = 20; // milliseconds

/// Calls a method on the object of the filter, wherever that is; what it gives back.
template <class... Values>
int call(vtkSMSourceProxy* filter, const char* method, Values... values)
{
  vtkClientServerStream stream;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(filter) << method;
  static_cast<void>((stream << ... << values));
  stream << vtkClientServerStream::End;
  filter->GetSession()->ExecuteStream(filter->GetLocation(), stream);
  int result = 0;
  filter->GetSession()->GetLastResult(filter->GetLocation()).GetArgument(0, 0, &result);
  return result;
}

/// The time that the active view shows.
double shownTime()
{
  pqView* view = pqActiveObjects::instance().activeView();
  vtkSMViewProxy* proxy = view ? view->getViewProxy() : nullptr;
  return proxy ? vtkSMPropertyHelper(proxy, "ViewTime").GetAsDouble() : 0;
}

void update(vtkSMSourceProxy* filter)
{
  filter->MarkModified(filter);
  filter->UpdatePipeline(shownTime());
}

/// Also before anything is selected: where a filter has been executed, and the view not been drawn since, a selection
/// of ParaView 5.11 finds nothing, and neither do those after it.
void renderActive()
{
  if (pqView* view = pqActiveObjects::instance().activeView())
  {
    view->forceRender();
  }
}

} // namespace

pqQuadrilleRun::pqQuadrilleRun(QObject* parent) : Superclass(parent)
{
  this->Timer.setInterval(kLookAgain);
  QObject::connect(&this->Timer, &QTimer::timeout, this, &pqQuadrilleRun::look);
}

//-----------------------------------------------------------------------------
pqQuadrilleRun* pqQuadrilleRun::instance()
{
  static auto* run = new pqQuadrilleRun(qApp);
  return run;
}

//-----------------------------------------------------------------------------
void pqQuadrilleRun::start(vtkSMSourceProxy* filter, Then then)
{
  this->IsTold = true;
  this->execute(filter, std::move(then));
}

//-----------------------------------------------------------------------------
void pqQuadrilleRun::startPreview(vtkSMSourceProxy* filter, Then then)
{
  this->IsTold = false;
  this->execute(filter, std::move(then));
}

//-----------------------------------------------------------------------------
void pqQuadrilleRun::dropPreview(vtkSMSourceProxy* filter)
{
  if (this->Filter == filter)
  {
    this->Waiting.clear();
    this->end(End::Stopped);
  }
  call(filter, "StopUnderway");
  call(filter, "TakeUnderway");
  update(filter); // a look-up
  renderActive();
}

//-----------------------------------------------------------------------------
void pqQuadrilleRun::execute(vtkSMSourceProxy* filter, Then then)
{
  if (this->Filter && this->Filter != filter)
  {
    this->show(); // it waits for the run
  }
  this->Filter = filter;
  this->Waiting.push_back(std::move(then));
  call(filter, "SetInBackground", 1);
  update(filter);
  if (call(filter, "GetIsUnderway") == 0)
  {
    this->show();
    return;
  }
  if (this->IsTold) // something can be drawn meanwhile
  {
    renderActive();
  }
  if (!this->Timer.isActive())
  {
    qApp->installEventFilter(this);
    this->Timer.start();
  }
}

//-----------------------------------------------------------------------------
void pqQuadrilleRun::look()
{
  if (!this->Filter)
  {
    this->end(End::Stopped); // it was deleted
  }
  else if (call(this->Filter, "GetIsUnderway") == 0)
  {
    this->show();
  }
  else if (this->IsTold)
  {
    quadrille::say(QString("Making quads: %1 %. Escape stops it.")
                     .arg(call(this->Filter, "GetUnderwayProgress")));
  }
}

//-----------------------------------------------------------------------------
void pqQuadrilleRun::show()
{
  vtkSMSourceProxy* filter = this->Filter;
  call(filter, "TakeUnderway");
  update(filter);
  this->end(End::Shown);
  renderActive();
  pqView* active = pqActiveObjects::instance().activeView();
  for (pqView* view : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqView*>())
  {
    if (view != active)
    {
      view->render();
    }
  }
}

//-----------------------------------------------------------------------------
void pqQuadrilleRun::stop()
{
  if (this->Filter)
  {
    call(this->Filter, "StopUnderway");
    call(this->Filter, "TakeUnderway");
    this->end(End::Stopped);
  }
}

//-----------------------------------------------------------------------------
void pqQuadrilleRun::end(End how)
{
  this->Timer.stop();
  qApp->removeEventFilter(this);
  this->Filter = nullptr;
  if (this->IsTold)
  {
    quadrille::say({}); // the progress; what follows may tell the outcome
  }
  for (const Then& then : std::exchange(this->Waiting, {}))
  {
    then(how);
  }
}

//-----------------------------------------------------------------------------
bool pqQuadrilleRun::eventFilter(QObject* watched, QEvent* event)
{
  if (!this->IsTold ||
    (event->type() != QEvent::KeyPress && event->type() != QEvent::ShortcutOverride))
  {
    return this->Superclass::eventFilter(watched, event);
  }
  auto* key = static_cast<QKeyEvent*>(event);
  if (key->key() != Qt::Key_Escape || QApplication::activeModalWidget() ||
    QApplication::activePopupWidget())
  {
    return this->Superclass::eventFilter(watched, event);
  }
  if (event->type() == QEvent::ShortcutOverride)
  {
    event->accept();
    return true;
  }
  this->stop();
  return true;
}
