// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "PipelineRows.h"

#include "RemeshConstraints.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqDataRepresentation.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqRepresentation.h"
#include "pqServerManagerModel.h"
#include "pqView.h"
#include "vtkPVXMLElement.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxyLocator.h"
#include "vtkSMProxySelectionModel.h"
#include "vtkSMSessionProxyManager.h"

#include <QObject>
#include <QPointer>
#include <QTimer>

#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

/// The browser takes the row of a filter away and puts it in elsewhere, where the selection is lost: mostly in the
/// browser alone, but from some undo on for all, though the filter stays the active source.
void selectAgain()
{
  pqActiveObjects& active = pqActiveObjects::instance();
  if (!active.selection().isEmpty() || !active.activeSource())
  {
    Q_EMIT active.selectionChanged(active.selection());
    return;
  }
  vtkSMProxySelectionModel* selection =
    active.activeSource()->proxyManager()->GetSelectionModel("ActiveSources");
  selection->Select(selection->GetCurrentProxy(), vtkSMProxySelectionModel::CLEAR_AND_SELECT);
}

/// ParaView selects nothing when it has loaded a state.
void selectQuadRemesh()
{
  pqActiveObjects& active = pqActiveObjects::instance();
  for (pqPipelineSource* source :
    pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>())
  {
    if (!active.activeSource() && isQuadRemesh(source->getProxy()))
    {
      active.setActiveSource(source);
    }
  }
}

/// ParaView hides the first output of a filter that is deleted, and shows any input instead that has a representation;
/// a constraint has none. So where any other output was shown the surface is.
/// Representations go from their views before the filter goes, so what is remembered of them is used within the event.
class Surfaces : public QObject
{
public:
  explicit Surfaces(QObject* parent) : QObject(parent)
  {
    auto* model = pqApplicationCore::instance()->getServerManagerModel();
    for (pqView* view : model->findItems<pqView*>())
    {
      this->watch(view);
    }
    QObject::connect(model, &pqServerManagerModel::viewAdded, this, &Surfaces::watch);
    QObject::connect(model, &pqServerManagerModel::preSourceRemoved, this, &Surfaces::show);
  }

private:
  void watch(pqView* view)
  {
    QObject::connect(view, &pqView::representationRemoved, this,
      [this, view](pqRepresentation* representation) { this->remember(representation, view); });
  }

  void remember(pqRepresentation* representation, pqView* view)
  {
    auto* shown = qobject_cast<pqDataRepresentation*>(representation);
    const pqOutputPort* port = shown ? shown->getOutputPortFromInput() : nullptr;
    if (port && shown->isVisible() && isQuadRemesh(port->getSource()->getProxy()))
    {
      this->Seen.emplace_back(port->getSource()->getProxy(), view);
      QTimer::singleShot(0, this, [this] { this->Seen.clear(); });
    }
  }

  void show(pqPipelineSource* source)
  {
    for (const auto& [filter, view] : this->Seen)
    {
      if (filter != source->getProxy() || !view)
      {
        continue;
      }
      const vtkSMPropertyHelper input(filter, "Input", true);
      const auto port = static_cast<int>(input.GetOutputPort());
      auto* model = pqApplicationCore::instance()->getServerManagerModel();
      auto* surface = model->findItem<pqPipelineSource*>(input.GetAsProxy());
      // It has none where the whole pipeline goes.
      if (pqDataRepresentation* shown = surface ? surface->getRepresentation(port, view) : nullptr)
      {
        shown->setVisible(true);
      }
    }
  }

  std::vector<std::pair<vtkSMProxy*, QPointer<pqView>>> Seen;
};

} // namespace

void keepRows(QObject* parent)
{
  const auto look = [parent](pqPipelineSource*, pqPipelineSource* consumer, int)
  {
    if (isQuadRemesh(consumer->getProxy()))
    {
      QTimer::singleShot(0, parent, &selectAgain);
    }
  };
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  using Changed = void (pqServerManagerModel::*)(pqPipelineSource*, pqPipelineSource*, int);
  for (const Changed changed : { Changed(&pqServerManagerModel::connectionAdded),
         Changed(&pqServerManagerModel::connectionRemoved) })
  {
    QObject::connect(model, changed, parent, look);
  }
  new Surfaces(parent);
  QObject::connect(pqApplicationCore::instance(), &pqApplicationCore::stateLoaded, parent,
    [parent] { QTimer::singleShot(0, parent, &selectQuadRemesh); });
}

} // namespace quadrille
