// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "pqQuadrilleRun.h"

#include "InvokeOnObject.h"
#include "SurfaceUnderMouse.h"
#include "Word.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "pqView.h"
#include "vtkClientServerStream.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSession.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMViewProxy.h"

#include <QAction>
#include <QApplication>
#include <QKeyEvent>

#include <utility>

namespace
{

using quadrille::invoke;

constexpr int kLookAgain = 20; // milliseconds

/// A number that a method of the filter's object gives.
int ask(vtkSMSourceProxy* filter, const char* method)
{
  invoke(filter, method);
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

/// The same at the time that was shown last, past ParaView: what it looks at after each execution, such as what all
/// outputs hold, it looks at when the view is drawn.
void updateObject(vtkSMSourceProxy* filter)
{
  invoke(filter, "Update");
}

/// Without the smoothing of edges, which takes two thirds of the time of a picture where no card draws it.
void renderActiveQuickly()
{
  pqView* active = pqActiveObjects::instance().activeView();
  if (!active)
  {
    return;
  }
  vtkSMViewProxy* view = active->getViewProxy();
  const bool hasSmoothing = view->GetProperty("UseFXAA") != nullptr;
  if (hasSmoothing)
  {
    invoke(view, "SetUseFXAA", 0);
  }
  active->forceRender();
  if (hasSmoothing)
  {
    invoke(view, "SetUseFXAA", vtkSMPropertyHelper(view, "UseFXAA").GetAsInt());
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
void pqQuadrilleRun::undoIfStopped(End how)
{
  if (how == End::Stopped)
  {
    pqApplicationCore::instance()->getUndoStack()->undo();
  }
}

//-----------------------------------------------------------------------------
void pqQuadrilleRun::prepare(vtkSMSourceProxy* filter)
{
  invoke(filter, "SetInBackground", 1);
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
void pqQuadrilleRun::follow(vtkSMSourceProxy* filter)
{
  prepare(filter);
  this->holdSaving();
  QTimer::singleShot(0, this,
    [this, executed = vtkWeakPointer<vtkSMSourceProxy>(filter)]
    {
      if (executed && this->Filter != executed)
      {
        ask(executed, "GetIsToBeTaken") != 0 ? this->start(executed, undoIfStopped)
                                             : invoke(executed, "SetInBackground", 0);
      }
      if (!this->Filter)
      {
        this->releaseSaving();
      }
    });
}

//-----------------------------------------------------------------------------
void pqQuadrilleRun::execute(vtkSMSourceProxy* filter, Then then)
{
  if (this->Filter && this->Filter->GetSession() && this->Filter != filter)
  {
    this->show(); // it waits for the run
  }
  if (this->IsTold)
  {
    quadrille::say({}); // of what was done before
  }
  this->Filter = filter;
  this->Waiting.push_back(std::move(then));
  prepare(filter);
  if (this->IsTold)
  {
    update(filter);
  }
  else
  {
    updateObject(filter);
    filter->MarkModified(filter); // its representations
  }
  if (ask(filter, "GetIsUnderway") == 0)
  {
    this->show();
    return;
  }
  if (this->IsTold)
  {
    this
      ->holdSaving(); // the picture stays as it is, and is not drawn until somebody asks what is in it
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
  if (!this->Filter || !this->Filter->GetSession()) // a panel may hold it when its server was left
  {
    this->end(End::Gone);
  }
  else if (ask(this->Filter, "GetIsUnderway") == 0)
  {
    this->show();
  }
  else if (this->IsTold)
  {
    quadrille::sayProgress(QString("Making quads: %1 %. Escape stops it.")
                             .arg(ask(this->Filter, "GetUnderwayProgress")));
  }
}

//-----------------------------------------------------------------------------
void pqQuadrilleRun::show()
{
  vtkSMSourceProxy* filter = this->Filter;
  const bool isWhole = this->IsTold;
  invoke(filter, "TakeUnderway");
  if (isWhole)
  {
    update(filter);
    this->end(End::Shown);
  }
  else
  {
    updateObject(filter);
    filter->MarkModified(filter); // its representations
    this->end(End::Shown); // which may begin the next preview, that is made while this one is drawn
    renderActiveQuickly();
  }
  pqView* active = pqActiveObjects::instance().activeView();
  for (pqView* view : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqView*>())
  {
    if (isWhole || view != active)
    {
      view->render(); // events that came meanwhile are taken up before
    }
  }
}

//-----------------------------------------------------------------------------
void pqQuadrilleRun::stop()
{
  if (this->Filter && this->Filter->GetSession())
  {
    invoke(this->Filter, "StopUnderway");
    invoke(this->Filter, "TakeUnderway");
    this->end(End::Stopped);
  }
}

//-----------------------------------------------------------------------------
void pqQuadrilleRun::holdSaving()
{
  if (!this->Saving.empty())
  {
    return; // by the run whose place this one takes
  }
  for (QAction* action : pqCoreUtilities::mainWidget()->findChildren<QAction*>())
  {
    for (QObject* reaction : action->children())
    {
      if (reaction->inherits("pqSaveDataReaction"))
      {
        // ParaView makes it live again whenever something is selected.
        const auto makeGrey = [action] { action->setEnabled(false); };
        this->Saving.push_back(
          { reaction, QObject::connect(action, &QAction::changed, this, makeGrey) });
        makeGrey();
      }
    }
  }
}

//-----------------------------------------------------------------------------
void pqQuadrilleRun::releaseSaving()
{
  for (const HeldAction& held : std::exchange(this->Saving, {}))
  {
    QObject::disconnect(held.Hold);
    if (held.Reaction)
    {
      QMetaObject::invokeMethod(held.Reaction, "updateEnableState");
    }
  }
}

//-----------------------------------------------------------------------------
void pqQuadrilleRun::end(End how)
{
  this->Timer.stop();
  this->releaseSaving();
  qApp->removeEventFilter(this);
  this->Filter = nullptr;
  quadrille::sayProgress({});
  for (const Then& then : std::exchange(this->Waiting, {}))
  {
    then(how);
  }
}

//-----------------------------------------------------------------------------
bool pqQuadrilleRun::eventFilter(QObject* watched, QEvent* event)
{
  pqView* view = pqActiveObjects::instance().activeView();
  if (event->type() == QEvent::MouseButtonPress && view)
  {
    quadrille::drawIfOld(view->getViewProxy()); // ParaView's own tools select, too
  }
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
