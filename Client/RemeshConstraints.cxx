// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "RemeshConstraints.h"

#include "FetchedData.h"

#include "pqActiveObjects.h"
#include "pqUndoStack.h"
#include "vtkCellData.h"
#include "vtkCleanPolyData.h"
#include "vtkDataArray.h"
#include "vtkLine.h"
#include "vtkNew.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSMInputProperty.h"
#include "vtkSMIntVectorProperty.h"
#include "vtkSMParaViewPipelineController.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxyIterator.h"
#include "vtkSMProxySelectionModel.h"
#include "vtkSMQuadConstraintProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"
#include "vtkSmartPointer.h"
#include "vtkStripper.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <QSignalBlocker>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

namespace quadrille
{
namespace
{

constexpr int kQuads = 0; // outputs of Quad Remesh
constexpr int kFeatureLines = 2;
constexpr int kIrregularVertices = 4;
constexpr int kConstraintTable = 6;

/// Whether what the proxy gives depends on the source.
bool dependsOn(vtkSMProxy* proxy, vtkSMProxy* source, std::set<vtkSMProxy*>& visited)
{
  if (proxy == source || !proxy || !visited.insert(proxy).second)
  {
    return proxy != nullptr && proxy == source;
  }
  for (unsigned int i = 0; i < proxy->GetNumberOfProducers(); ++i)
  {
    auto* producer = vtkSMSourceProxy::SafeDownCast(proxy->GetProducerProxy(i));
    if (dependsOn(producer, source, visited))
    {
      return true;
    }
  }
  return false;
}

bool dependsOn(vtkSMProxy* proxy, vtkSMProxy* source)
{
  std::set<vtkSMProxy*> visited;
  return dependsOn(proxy, source, visited);
}

bool isConstraint(vtkSMProxy* proxy)
{
  const char* type = proxy ? proxy->GetVTKClassName() : nullptr;
  return type && std::strcmp(type, "vtkQuadConstraintSource") == 0;
}

struct Curve
{
  std::vector<Place> places; ///< of a closed one without the first again at its end
  bool isClosed = false;
};

/// The lines of a cut put together.
std::vector<Curve> curvesOf(vtkPolyData& cut)
{
  vtkNew<vtkCleanPolyData> merged; // pieces of several ranks and blocks
  merged->SetInputData(&cut);
  vtkNew<vtkStripper> joined;
  joined->SetInputConnection(merged->GetOutputPort());
  joined->JoinContiguousSegmentsOn();
  joined->SetMaximumLength(std::numeric_limits<int>::max());
  joined->Update();
  vtkPolyData* lines = joined->GetOutput();
  std::vector<Curve> curves;
  for (vtkIdType i = 0; i < lines->GetNumberOfCells(); ++i)
  {
    const vtkIdType* ids = nullptr;
    vtkIdType size = 0;
    lines->GetCellPoints(i, size, ids);
    Curve curve;
    curve.isClosed = size > 3 && ids[0] == ids[size - 1];
    for (vtkIdType k = 0; k < (curve.isClosed ? size - 1 : size); ++k)
    {
      curve.places.emplace_back();
      lines->GetPoint(ids[k], curve.places.back().data());
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

vtkSMProxySelectionModel* selectionOf(vtkSMSessionProxyManager* manager)
{
  return manager->GetSelectionModel("ActiveSources");
}

} // namespace

bool isQuadRemesh(vtkSMProxy* proxy)
{
  const char* name = proxy ? proxy->GetXMLName() : nullptr;
  return name && std::strcmp(name, "QuadRemesh") == 0;
}

bool isSurface(vtkSMSourceProxy* source)
{
  vtkSMProxy* filter = source->GetSessionProxyManager()->GetPrototypeProxy("filters", "QuadRemesh");
  auto* input = vtkSMInputProperty::SafeDownCast(filter ? filter->GetProperty("Input") : nullptr);
  if (!input)
  {
    return false;
  }
  input->RemoveAllUncheckedProxies();
  input->AddUncheckedInputConnection(source, 0);
  const bool isTaken = input->IsInDomains() != 0;
  input->RemoveAllUncheckedProxies();
  return isTaken;
}

vtkSMSourceProxy* remeshOf(vtkSMSourceProxy* surface, vtkSMProxy* active)
{
  const auto isFor = [surface](vtkSMProxy* proxy)
  {
    return isQuadRemesh(proxy) && proxy->GetObjectsCreated() &&
      (dependsOn(surface, proxy) || dependsOn(proxy, surface));
  };
  if (!surface || isFor(active))
  {
    return surface ? vtkSMSourceProxy::SafeDownCast(active) : nullptr;
  }
  vtkSMProxy* last = nullptr;
  auto iterator = vtk::TakeSmartPointer(vtkSMProxyIterator::New());
  iterator->SetSessionProxyManager(surface->GetSessionProxyManager());
  for (iterator->Begin("sources"); !iterator->IsAtEnd(); iterator->Next())
  {
    vtkSMProxy* proxy = iterator->GetProxy();
    if (isFor(proxy) && (!last || last->GetGlobalID() < proxy->GetGlobalID()))
    {
      last = proxy;
    }
  }
  return vtkSMSourceProxy::SafeDownCast(last);
}

vtkSMSourceProxy* registerConstraint(
  vtkSMSessionProxyManager* manager, const NewConstraint& constraint)
{
  auto made = vtkSmartPointer<vtkSMSourceProxy>::Take(
    vtkSMSourceProxy::SafeDownCast(manager->NewProxy("sources", constraint.source.c_str())));
  if (!made)
  {
    return nullptr;
  }
  vtkNew<vtkSMParaViewPipelineController> controller;
  controller->PreInitializeProxy(made);
  for (const auto& [name, values] : constraint.values)
  {
    const auto count = static_cast<unsigned int>(values.size());
    vtkSMPropertyHelper property(made, name.c_str());
    if (vtkSMIntVectorProperty::SafeDownCast(made->GetProperty(name.c_str())))
    {
      const std::vector<int> numbers(values.begin(), values.end());
      property.Set(numbers.data(), count);
      continue;
    }
    property.Set(values.data(), count);
  }
  controller->PostInitializeProxy(made);
  {
    // The controller selects what it registers. What was selected stays so, and ParaView need not build a panel.
    const QSignalBlocker unseen(pqActiveObjects::instance());
    const vtkSmartPointer<vtkSMProxy> selected = selectionOf(manager)->GetCurrentProxy();
    controller->RegisterPipelineProxy(made);
    selectionOf(manager)->SetCurrentProxy(selected, vtkSMProxySelectionModel::CLEAR_AND_SELECT);
  }
  return made;
}

vtkSMSourceProxy* addConstraint(vtkSMSourceProxy* filter, const NewConstraint& constraint)
{
  vtkSMSourceProxy* made = registerConstraint(filter->GetSessionProxyManager(), constraint);
  if (made)
  {
    connectConstraints(filter, { made });
  }
  return made;
}

void connectConstraints(vtkSMSourceProxy* filter, const std::vector<vtkSMSourceProxy*>& constraints)
{
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", filter);
  for (vtkSMSourceProxy* constraint : constraints)
  {
    vtkSMPropertyHelper(filter, "Constraints").Add(constraint);
  }
  filter->UpdateVTKObjects();
}

vtkSmartPointer<vtkSMQuadConstraintProxy> newMove(vtkSMSourceProxy* filter)
{
  const pqScopedUndoExclude noStepOfTheUser;
  auto made = vtkSmartPointer<vtkSMProxy>::Take(
    filter->GetSessionProxyManager()->NewProxy("sources", "QuadMove"));
  vtkSmartPointer<vtkSMQuadConstraintProxy> move = vtkSMQuadConstraintProxy::SafeDownCast(made);
  if (move)
  {
    vtkNew<vtkSMParaViewPipelineController> controller;
    controller->InitializeProxy(move);
    move->UpdateVTKObjects();
  }
  return move;
}

vtkSMSourceProxy* lastConstraint(vtkSMSourceProxy* filter)
{
  const vtkSMPropertyHelper constraints(filter, "Constraints");
  vtkSMSourceProxy* last = nullptr;
  for (unsigned int i = 0; i < constraints.GetNumberOfElements(); ++i)
  {
    auto* proxy = vtkSMSourceProxy::SafeDownCast(constraints.GetAsProxy(i));
    if (isConstraint(proxy) && (!last || last->GetGlobalID() < proxy->GetGlobalID()))
    {
      last = proxy;
    }
  }
  return last;
}

vtkSMSourceProxy* constraintMeant(vtkSMSourceProxy* filter, vtkSMSourceProxy* selected)
{
  const vtkSMPropertyHelper constraints(filter, "Constraints");
  for (unsigned int i = 0; i < constraints.GetNumberOfElements(); ++i)
  {
    if (isConstraint(selected) && constraints.GetAsProxy(i) == selected)
    {
      return selected;
    }
  }
  return lastConstraint(filter);
}

void removeConstraint(vtkSMSourceProxy* filter, vtkSMSourceProxy* constraint)
{
  {
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", filter);
    vtkSMPropertyHelper(filter, "Constraints").Remove(constraint);
    filter->UpdateVTKObjects();
  }
  vtkSMProxySelectionModel* selection = selectionOf(filter->GetSessionProxyManager());
  if (selection->GetCurrentProxy() == constraint)
  {
    selection->SetCurrentProxy(filter, vtkSMProxySelectionModel::CLEAR_AND_SELECT);
  }
  vtkNew<vtkSMParaViewPipelineController> controller;
  controller->UnRegisterProxy(constraint);
}

bool setNumber(vtkSMSourceProxy* constraint, const char* property, int value)
{
  if (vtkSMPropertyHelper(constraint, property).GetAsInt() == value)
  {
    return false;
  }
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", constraint);
  vtkSMPropertyHelper(constraint, property).Set(value);
  constraint->UpdateVTKObjects();
  return true;
}

std::vector<Place> irregularVertices(vtkSMSourceProxy* filter)
{
  std::vector<Place> places;
  forEach<vtkPolyData>(fetched(filter, kIrregularVertices),
    [&places](vtkPolyData& data)
    {
      for (vtkIdType i = 0; i < data.GetNumberOfPoints(); ++i)
      {
        places.emplace_back();
        data.GetPoint(i, places.back().data());
      }
    });
  return places;
}

bool isMovable(vtkSMSourceProxy* filter, const Place& vertex)
{
  bool isIt = true;
  forEach<vtkPolyData>(fetched(filter, kIrregularVertices),
    [&](vtkPolyData& data)
    {
      vtkDataArray* movable = data.GetPointData()->GetArray("MovableValence");
      for (vtkIdType i = 0; movable && i < data.GetNumberOfPoints(); ++i)
      {
        Place place;
        data.GetPoint(i, place.data());
        isIt = isIt && (place != vertex || movable->GetComponent(i, 0) != 0);
      }
    });
  return isIt;
}

std::vector<Place> placesOnFeatures(vtkSMSourceProxy* filter)
{
  constexpr int kPlacesAnEdge = 4;
  std::vector<Place> places;
  forEach<vtkPolyData>(fetched(filter, kFeatureLines),
    [&places](vtkPolyData& data)
    {
      vtkDataArray* boundary = data.GetCellData()->GetArray("Boundary");
      for (vtkIdType i = 0; boundary && i < data.GetNumberOfCells(); ++i)
      {
        const vtkIdType* ids = nullptr;
        vtkIdType size = 0;
        data.GetCellPoints(i, size, ids);
        for (vtkIdType k = 0; boundary->GetComponent(i, 0) == 0 && k + 1 < size; ++k)
        {
          Place from;
          Place to;
          data.GetPoint(ids[k], from.data());
          data.GetPoint(ids[k + 1], to.data());
          for (int step = 0; step < kPlacesAnEdge; ++step)
          {
            const double t = (step + 0.5) / kPlacesAnEdge;
            places.push_back({ (1 - t) * from[0] + t * to[0], (1 - t) * from[1] + t * to[1],
              (1 - t) * from[2] + t * to[2] });
          }
        }
      }
    });
  return places;
}

vtkSMSourceProxy* featureCurveAt(vtkSMSourceProxy* filter, const Place& place, double within)
{
  constexpr unsigned int kNumbersOfPoint = 3;
  const vtkSMPropertyHelper constraints(filter, "Constraints");
  for (unsigned int i = 0; i < constraints.GetNumberOfElements(); ++i)
  {
    auto* proxy = vtkSMSourceProxy::SafeDownCast(constraints.GetAsProxy(i));
    if (!proxy || std::strcmp(proxy->GetXMLName(), "QuadFeatureCurve") != 0)
    {
      continue;
    }
    const std::vector<double> points = vtkSMPropertyHelper(proxy, "Points").GetArray<double>();
    for (std::size_t k = 0; k + 2 * kNumbersOfPoint <= points.size(); k += kNumbersOfPoint)
    {
      double along = 0;
      Place nearest;
      const double squared = vtkLine::DistanceToLine(
        place.data(), &points[k], &points[k + kNumbersOfPoint], along, nearest.data());
      if (squared <= within * within)
      {
        return proxy;
      }
    }
  }
  return nullptr;
}

std::optional<double> edgeLength(vtkSMSourceProxy* filter)
{
  double sum = 0;
  double count = 0;
  forEach<vtkPolyData>(fetched(filter, kQuads),
    [&sum, &count](vtkPolyData& data)
    {
      for (vtkIdType i = 0; i < data.GetNumberOfCells(); ++i)
      {
        const vtkIdType* corners = nullptr;
        vtkIdType size = 0;
        data.GetCellPoints(i, size, corners);
        for (vtkIdType c = 0; c < size; ++c)
        {
          Place from;
          Place to;
          data.GetPoint(corners[c], from.data());
          data.GetPoint(corners[(c + 1) % size], to.data());
          sum += std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
          ++count;
        }
      }
    });
  return count > 0 ? std::optional<double>(sum / count) : std::nullopt;
}

std::vector<Place> closedCut(vtkSMSourceProxy* source, const Place& origin, const Place& normal)
{
  const pqScopedUndoExclude noStepOfTheUser;
  vtkSMSessionProxyManager* manager = source->GetSessionProxyManager();
  auto plane = vtkSmartPointer<vtkSMProxy>::Take(manager->NewProxy("implicit_functions", "Plane"));
  auto cut = vtkSmartPointer<vtkSMSourceProxy>::Take(
    vtkSMSourceProxy::SafeDownCast(manager->NewProxy("filters", "Cut")));
  if (!plane || !cut)
  {
    return {};
  }
  vtkSMPropertyHelper(plane, "Origin").Set(origin.data(), 3);
  vtkSMPropertyHelper(plane, "Normal").Set(normal.data(), 3);
  plane->UpdateVTKObjects();
  vtkSMPropertyHelper(cut, "Input").Set(source);
  vtkSMPropertyHelper(cut, "CutFunction").Set(plane);
  vtkSMPropertyHelper(cut, "ContourValues").Set(0, 0.0);
  cut->UpdateVTKObjects();
  cut->UpdatePipeline();
  Curve nearest;
  double least = std::numeric_limits<double>::infinity();
  forEach<vtkPolyData>(fetched(cut, 0),
    [&](vtkPolyData& data)
    {
      for (const Curve& curve : curvesOf(data))
      {
        double away = std::numeric_limits<double>::infinity();
        for (const Place& place : curve.places)
        {
          away = std::min(
            away, std::hypot(place[0] - origin[0], place[1] - origin[1], place[2] - origin[2]));
        }
        if (away < least)
        {
          least = away;
          nearest = curve;
        }
      }
    });
  return nearest.isClosed ? nearest.places : std::vector<Place>{};
}

bool hasUnmetConstraints(vtkSMSourceProxy* filter)
{
  vtkPVArrayInformation* met = filter->GetOutputPortsCreated()
    ? filter->GetDataInformation(kConstraintTable)->GetArrayInformation("Met", vtkDataObject::ROW)
    : nullptr;
  return met && met->GetComponentRange(0)[0] == 0;
}

int countUnmet(vtkSMSourceProxy* filter)
{
  int unmet = 0;
  forEach<vtkTable>(fetched(filter, kConstraintTable),
    [&unmet](vtkTable& table)
    {
      for (vtkIdType row = 0; row < table.GetNumberOfRows(); ++row)
      {
        unmet += table.GetValueByName(row, "Met").ToInt() == 0 ? 1 : 0;
      }
    });
  return unmet;
}

std::optional<ConstraintWord> wordOnLast(vtkSMSourceProxy* filter, const std::string& kind)
{
  std::optional<ConstraintWord> word;
  forEach<vtkTable>(fetched(filter, kConstraintTable),
    [&word, &kind](vtkTable& table)
    {
      for (vtkIdType row = 0; row < table.GetNumberOfRows(); ++row)
      {
        if (table.GetValueByName(row, "Kind").ToString() == kind)
        {
          word = { table.GetValueByName(row, "Met").ToInt() != 0,
            table.GetValueByName(row, "Reason").ToString(),
            table.GetValueByName(row, "Remark").ToString() };
        }
      }
    });
  return word;
}

} // namespace quadrille
