// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Examples.h"

#include "MakeQuads.h"
#include "Word.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqObjectBuilder.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqRenderView.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "vtkNew.h"
#include "vtkPVPluginsInformation.h"
#include "vtkSMParaViewPipelineControllerWithRendering.h"
#include "vtkSMPluginManager.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMViewLayoutProxy.h"
#include "vtkSMViewProxy.h"
#include "vtkSmartPointer.h"

#include <QDir>
#include <QFileInfo>
#include <QPointer>

#include <algorithm>

namespace quadrille
{
namespace
{

constexpr int kFound = 2; // of Symmetry
constexpr int kSecondOrder = 2;
constexpr int kIrregularVertices = 4; // outputs of Quad Remesh
constexpr int kConstraints = 5;

struct Example
{
  QString name;
  QString file;
  Place direction; ///< in which it is looked at; z is up
  NewQuads wanted;
  std::vector<int> shown; ///< outputs, beside what is shown at first
  bool hasElements = false;
};

const Place kFromItsSide = { -0.3, 0.9, -0.3 };

std::vector<Example> examples()
{
  const NewConstraint shoulder = { "QuadStroke",
    { { "Points",
      { -0.75, -0.205, 0.42, -0.45, -0.346, 0.33, -0.15, -0.43, 0.18, 0.15, -0.439, 0.03, 0.45,
        -0.478, -0.1 } } } };
  const NewConstraint belly = { "QuadStroke",
    { { "Points", { -0.7, -0.527, 0, -0.4, -0.398, -0.1, -0.1, -0.362, -0.15 } } } };
  const NewConstraint place = { "QuadValence",
    { { "Point", { 0.45, -0.414, 0.35 } }, { "Valence", { 5 } } } };
  return {
    { "Scan With Strokes", "beast.ply", kFromItsSide,
      { { { "NumberOfQuads", 2500 } }, { shoulder, belly, place } },
      { kIrregularVertices, kConstraints } },
    { "Part For Simulation", "part.ply", { 0.3, 0.7, -0.65 }, { { { "NumberOfQuads", 3000 } }, {} },
      {}, true },
    { "Symmetry", "beast.ply", { 0.9, 0.35, -0.4 },
      { { { "NumberOfQuads", 2500 }, { "Symmetry", kFound } }, {} }, { kIrregularVertices } },
  };
}

/// The folder that lies beside the plugin where the data are: a server has a plugin, and files, of its own.
QString folderOf(pqServer* server)
{
  vtkSMPluginManager* manager = vtkSMProxyManager::GetProxyManager()->GetPluginManager();
  vtkPVPluginsInformation* plugins = server->isRemote()
    ? manager->GetRemoteInformation(server->session())
    : manager->GetLocalInformation();
  for (unsigned int i = 0; i < plugins->GetNumberOfPlugins(); ++i)
  {
    if (plugins->GetPluginLoaded(i) && QString(plugins->GetPluginName(i)) == "Quadrille")
    {
      return QFileInfo(plugins->GetPluginFileName(i)).path() + "/Examples";
    }
  }
  return {};
}

/// The active view, if it shows nothing; else a new one with a tab of its own.
pqRenderView* emptyView(pqServer* server)
{
  auto* active = qobject_cast<pqRenderView*>(pqActiveObjects::instance().activeView());
  if (active && active->getNumberOfVisibleDataRepresentations() == 0)
  {
    return active;
  }
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  auto layout =
    vtkSmartPointer<vtkSMProxy>::Take(server->proxyManager()->NewProxy("misc", "ViewLayout"));
  controller->InitializeProxy(layout);
  controller->RegisterLayoutProxy(layout);
  pqView* view =
    pqApplicationCore::instance()->getObjectBuilder()->createView("RenderView", server);
  controller->AssignViewToLayout(
    view->getViewProxy(), vtkSMViewLayoutProxy::SafeDownCast(layout), 0);
  pqActiveObjects::instance().setActiveView(view);
  return qobject_cast<pqRenderView*>(view);
}

/// Opens a surface and shows it in an empty view, which is the active one then. As with a state that is loaded there is
/// nothing to undo afterwards: what a redo of ParaView makes of all this is not what it was.
pqPipelineSource* openSurface(const QString& name, const Place& direction)
{
  pqServer* server = pqActiveObjects::instance().activeServer();
  const QString folder = folderOf(server);
  if (folder.isEmpty())
  {
    say("The server has no plugin Quadrille: load it there, too (Tools > Manage Plugins).");
    return nullptr;
  }
  const QString file = folder + '/' + name;
  if (!server->isRemote() && !QFileInfo::exists(file))
  {
    say(file + " is not there: install the plugin again, with its folder Examples.");
    return nullptr;
  }
  pqRenderView* view = emptyView(server);
  pqPipelineSource* surface = pqApplicationCore::instance()->getObjectBuilder()->createReader(
    "sources", "QuadrillePLYReader", { file }, server);
  surface->setModifiedState(pqProxy::UNMODIFIED);
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  controller->Show(surface->getSourceProxy(), 0, view->getViewProxy());
  view->resetViewDirection(direction[0], direction[1], direction[2], 0, 0, 1);
  view->render();
  CLEAR_UNDO_STACK();
  return surface;
}

pqPipelineSource* itemOf(vtkSMSourceProxy* filter)
{
  return pqApplicationCore::instance()->getServerManagerModel()->findItem<pqPipelineSource*>(
    filter);
}

/// Elements of second order with measures of their quality, in place of the quads.
void addElements(pqPipelineSource* surface, pqPipelineSource* quads, pqView* view)
{
  pqPipelineSource* elements =
    pqApplicationCore::instance()->getObjectBuilder()->createFilter("filters", "QuadElements",
      { { "Input", { quads->getOutputPort(0) } }, { "Surface", { surface->getOutputPort(0) } } },
      surface->getServer());
  setNumbers(elements->getProxy(), { { "Order", kSecondOrder }, { "Quality", 1 } });
  elements->setModifiedState(pqProxy::UNMODIFIED);
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  controller->Show(elements->getSourceProxy(), 0, view->getViewProxy());
  controller->SetVisibility(quads->getSourceProxy(), 0, view->getViewProxy(), false);
}

/// What follows the quads; where they were stopped the button Apply makes them.
void finish(const Example& example, pqPipelineSource* surface, vtkSMSourceProxy* filter,
  pqQuadrilleRun::End how)
{
  const pqScopedUndoExclude isAsAState;
  pqPipelineSource* quads = itemOf(filter);
  if (how == pqQuadrilleRun::End::Stopped)
  {
    quads->setModifiedState(pqProxy::UNINITIALIZED);
    return;
  }
  pqView* view = pqActiveObjects::instance().activeView();
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  for (const int port : example.shown)
  {
    controller->Show(filter, port, view->getViewProxy());
  }
  if (example.hasElements)
  {
    addElements(surface, quads, view);
  }
  view->render();
}

} // namespace

std::vector<QString> exampleNames()
{
  std::vector<QString> names;
  for (const Example& example : examples())
  {
    names.push_back(example.name);
  }
  return names;
}

void openExample(std::size_t number)
{
  const Example example = examples().at(number);
  const pqScopedUndoExclude isAsAState;
  const QPointer<pqPipelineSource> surface = openSurface(example.file, example.direction);
  if (surface)
  {
    makeQuads(surface, example.wanted,
      [example, surface](pqQuadrilleRun::End how, vtkSMSourceProxy* filter)
      {
        if (how != pqQuadrilleRun::End::Gone && filter && surface)
        {
          finish(example, surface, filter, how);
        }
      });
  }
}

pqPipelineSource* openScan()
{
  const pqScopedUndoExclude isAsAState;
  return openSurface("beast.ply", kFromItsSide);
}

} // namespace quadrille
