// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "HelpMenu.h"
#include "PipelineRows.h"
#include "UndoInTrace.h"
#include "WindowPauses.h"
#include "pqQuadrilleHandles.h"
#include "pqQuadrilleToolBar.h"
#include "pqQuadrilleWidgets.h"

#include "pqApplicationCore.h"
#include "pqCoreUtilities.h"
#include "pqInterfaceTracker.h"

#include <QApplication>
#include <QMainWindow>
#include <QTimer>

namespace
{

constexpr int kPause = 200; // milliseconds

/// ParaView loads plug-ins before it has a window.
void placeToolBar()
{
  auto* window = qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget());
  if (!window || !window->isVisible())
  {
    QTimer::singleShot(kPause, qApp, &placeToolBar);
  }
  else if (!window->findChild<pqQuadrilleToolBar*>())
  {
    auto* bar = new pqQuadrilleToolBar(window);
    // At the end of ParaView's own row it would be behind the arrow of what has no room.
    window->addToolBarBreak(Qt::TopToolBarArea);
    window->addToolBar(Qt::TopToolBarArea, bar);
    new pqQuadrilleHandles(bar);
    quadrille::addToHelpMenu(window, bar->drawing());
    quadrille::traceUndo(bar);
    quadrille::writePauses(bar);
    quadrille::keepRows(bar);
  }
}

/// The core of the application is still being made when plug-ins are loaded.
void offerWidgets()
{
  auto* core = pqApplicationCore::instance();
  core->interfaceTracker()->addInterface(new pqQuadrilleWidgets(core));
}

} // namespace

/// Called by the plugin, see QuadrilleClientLoader.h.
extern "C" Q_DECL_EXPORT void quadrilleStartClient()
{
  if (qobject_cast<QApplication*>(QCoreApplication::instance()))
  {
    QTimer::singleShot(0, qApp, &offerWidgets);
    QTimer::singleShot(0, qApp, &placeToolBar);
  }
}
