// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "UndoInTrace.h"

#include "pqApplicationCore.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"
#include "pqUndoStack.h"
#include "vtkCommand.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMPropertyIterator.h"
#include "vtkSMProxyIterator.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"
#include "vtkSMUndoStack.h"
#include "vtkSMUndoStackBuilder.h"
#include "vtkSMViewProxy.h"
#include "vtkSmartPointer.h"
#include "vtkTimeStamp.h"
#include "vtkWeakPointer.h"

#include <QObject>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <vector>

namespace quadrille
{
namespace
{

/// What a representation shows.
struct Shown
{
  vtkSmartPointer<vtkSMProxy> producer;
  unsigned int port = 0;
  vtkSmartPointer<vtkSMProxy> view;
};

using Proxies = std::vector<vtkSmartPointer<vtkSMProxy>>;
using Pictures = std::map<vtkSmartPointer<vtkSMProxy>, Shown>;

/// All of a group in all sessions of the window, in the order in which they were made.
Proxies proxiesOf(const char* group)
{
  Proxies proxies;
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqServer* server : model->findItems<pqServer*>())
  {
    auto iterator = vtk::TakeSmartPointer(vtkSMProxyIterator::New());
    iterator->SetSessionProxyManager(server->proxyManager());
    for (iterator->Begin(group); !iterator->IsAtEnd(); iterator->Next())
    {
      proxies.emplace_back(iterator->GetProxy());
    }
  }
  std::sort(proxies.begin(), proxies.end(),
    [](vtkSMProxy* a, vtkSMProxy* b) { return a->GetGlobalID() < b->GetGlobalID(); });
  return proxies;
}

bool has(const Proxies& proxies, vtkSMProxy* proxy)
{
  return std::find(proxies.begin(), proxies.end(), proxy) != proxies.end();
}

/// What is visible, by representation.
Pictures pictures()
{
  Pictures visible;
  for (vtkSMProxy* representation : proxiesOf("representations"))
  {
    if (!representation->GetProperty("Input") || !representation->GetProperty("Visibility") ||
      vtkSMPropertyHelper(representation, "Visibility").GetAsInt() == 0)
    {
      continue;
    }
    const vtkSMPropertyHelper input(representation, "Input");
    const Shown shown{ input.GetAsProxy(), input.GetOutputPort(),
      vtkSMViewProxy::FindView(representation) };
    if (shown.producer && shown.view)
    {
      visible[representation] = shown;
    }
  }
  return visible;
}

/// A property counts as traced where it is modified while an item for its proxy is open.
void traceChanges(vtkSMProxy* proxy, vtkMTimeType since)
{
  std::vector<vtkSMProperty*> changed;
  auto iterator = vtk::TakeSmartPointer(proxy->NewPropertyIterator());
  for (iterator->Begin(); !iterator->IsAtEnd(); iterator->Next())
  {
    vtkSMProperty* property = iterator->GetProperty();
    if (property && property->GetMTime() > since && !property->GetInformationOnly())
    {
      changed.push_back(property);
    }
  }
  if (changed.empty())
  {
    return;
  }
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", proxy);
  for (vtkSMProperty* property : changed)
  {
    property->Modified();
  }
}

/// Compares the pipeline after a step with that before.
class UndoInTrace : public QObject
{
public:
  UndoInTrace(vtkSMUndoStack* stack, QObject* parent) : QObject(parent), stack_(stack)
  {
    observers_ = { stack->AddObserver(vtkCommand::StartEvent, this, &UndoInTrace::begin),
      stack->AddObserver(vtkCommand::EndEvent, this, &UndoInTrace::end) };
  }

  ~UndoInTrace() override
  {
    for (const unsigned long observer : observers_)
    {
      if (stack_)
      {
        stack_->RemoveObserver(observer);
      }
    }
  }

private:
  void begin()
  {
    if (vtkSMTrace::GetActiveTracer())
    {
      sources_ = proxiesOf("sources");
      visible_ = pictures();
      since_.Modified();
      // The window selects what comes again before the trace has it.
      blocked_ = std::make_unique<vtkSMTrace::TraceItem>("BlockTraceItems");
      *blocked_ = vtkSMTrace::TraceItemArgs();
    }
  }

  void end()
  {
    blocked_.reset();
    if (vtkSMTrace::GetActiveTracer())
    {
      const pqScopedUndoExclude noStepOfTheUser;
      tracePipeline(proxiesOf("sources"));
    }
    sources_.clear();
    visible_.clear();
  }

  void tracePipeline(const Proxies& now)
  {
    for (vtkSMProxy* proxy : now)
    {
      if (!has(sources_, proxy))
      {
        SM_SCOPED_TRACE(RegisterPipelineProxy).arg("proxy", proxy);
      }
    }
    for (vtkSMProxy* proxy : now)
    {
      if (has(sources_, proxy))
      {
        traceChanges(proxy, since_.GetMTime());
      }
    }
    tracePictures(now, pictures());
    for (auto proxy = sources_.rbegin(); proxy != sources_.rend(); ++proxy)
    {
      if (!has(now, *proxy))
      {
        SM_SCOPED_TRACE(Delete).arg("proxy", proxy->Get());
      }
    }
  }

  void tracePictures(const Proxies& sources, const Pictures& now)
  {
    for (const auto& [representation, shown] : visible_)
    {
      if (now.count(representation) == 0 && has(sources, shown.producer))
      {
        SM_SCOPED_TRACE(Hide)
          .arg(shown.producer.Get())
          .arg(static_cast<int>(shown.port))
          .arg(shown.view.Get());
      }
    }
    for (const auto& [representation, shown] : now)
    {
      if (visible_.count(representation) == 0)
      {
        SM_SCOPED_TRACE(Show)
          .arg("producer", shown.producer.Get())
          .arg("port", static_cast<int>(shown.port))
          .arg("view", shown.view.Get())
          .arg("display", representation.Get());
      }
    }
  }

  vtkWeakPointer<vtkSMUndoStack> stack_;
  std::array<unsigned long, 2> observers_{};
  vtkTimeStamp since_;
  std::unique_ptr<vtkSMTrace::TraceItem> blocked_; ///< during a step nothing else is traced
  Proxies sources_;                                ///< before the step
  Pictures visible_;
};

} // namespace

void traceUndo(QObject* parent)
{
  if (pqUndoStack* stack = pqApplicationCore::instance()->getUndoStack())
  {
    new UndoInTrace(stack->GetUndoStackBuilder()->GetUndoStack(), parent);
  }
}

} // namespace quadrille
