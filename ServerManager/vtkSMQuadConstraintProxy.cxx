// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMQuadConstraintProxy.h"

#include "InvokeOnObject.h"

#include "vtkBoundingBox.h"
#include "vtkClientServerStream.h"
#include "vtkCommand.h"
#include "vtkObjectFactory.h"
#include "vtkPVDataInformation.h"
#include "vtkPVSession.h"
#include "vtkPVXMLElement.h"
#include "vtkSMInputProperty.h"
#include "vtkSMOutputPort.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxyIterator.h"
#include "vtkSMProxySelectionModel.h"
#include "vtkSMQuadPickProxy.h"
#include "vtkSMSession.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMTrace.h"
#include "vtkSMUncheckedPropertyHelper.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <set>
#include <utility>

vtkStandardNewMacro(vtkSMQuadConstraintProxy);

namespace
{

using quadrille::invoke;

constexpr std::size_t kCoordinates = 3;

bool isQuadRemesh(vtkSMProxy* proxy)
{
  const char* name = proxy ? proxy->GetXMLName() : nullptr;
  return name && std::strcmp(name, "QuadRemesh") == 0 && proxy->GetProperty("Constraints");
}

/// The first one of the proxy and all that it is an input of.
vtkSMProxy* quadRemeshBehind(vtkSMProxy* proxy, std::set<vtkSMProxy*>& visited)
{
  if (!proxy || isQuadRemesh(proxy) || !visited.insert(proxy).second)
  {
    return isQuadRemesh(proxy) ? proxy : nullptr;
  }
  for (unsigned int i = 0; i < proxy->GetNumberOfConsumers(); ++i)
  {
    auto* consumer = vtkSMSourceProxy::SafeDownCast(proxy->GetConsumerProxy(i));
    if (vtkSMProxy* found = quadRemeshBehind(consumer, visited))
    {
      return found;
    }
  }
  return nullptr;
}

/// What the user has selected in the pipeline; null where it is nothing.
vtkSMProxy* selectedSource(vtkSMSessionProxyManager* manager)
{
  vtkSMProxySelectionModel* selection = manager->GetSelectionModel("ActiveSources");
  vtkSMProxy* current = selection ? selection->GetCurrentProxy() : nullptr;
  auto* port = vtkSMOutputPort::SafeDownCast(current);
  return port ? port->GetSourceProxy() : current;
}

/// Consumers of a source are also filters in whose panel it can be chosen.
bool hasConstraint(vtkSMProxy* filter, vtkSMProxy* source)
{
  auto* constraints = vtkSMInputProperty::SafeDownCast(filter->GetProperty("Constraints"));
  return constraints && constraints->IsProxyAdded(source);
}

/// The last one that was made; with a source given, of those that have it as a constraint.
vtkSMProxy* lastQuadRemesh(vtkSMSessionProxyManager* manager, vtkSMProxy* constraint = nullptr)
{
  vtkSMProxy* last = nullptr;
  auto iterator = vtk::TakeSmartPointer(vtkSMProxyIterator::New());
  iterator->SetSessionProxyManager(manager);
  for (iterator->Begin("sources"); !iterator->IsAtEnd(); iterator->Next())
  {
    vtkSMProxy* proxy = iterator->GetProxy();
    if (isQuadRemesh(proxy) && (!constraint || hasConstraint(proxy, constraint)) &&
      (!last || last->GetGlobalID() < proxy->GetGlobalID()))
    {
      last = proxy;
    }
  }
  return last;
}

vtkSMProxy* quadRemeshToUse(vtkSMSessionProxyManager* manager)
{
  std::set<vtkSMProxy*> visited;
  vtkSMProxy* found = quadRemeshBehind(selectedSource(manager), visited);
  return found ? found : lastQuadRemesh(manager);
}

/// Round what is drawn on: the input of the filter, or what is selected. Not valid where nothing was made yet.
vtkBoundingBox boxOf(vtkSMProxy* filter, vtkSMSessionProxyManager* manager)
{
  vtkSMProxy* proxy =
    filter ? vtkSMPropertyHelper(filter, "Input").GetAsProxy() : selectedSource(manager);
  vtkBoundingBox box;
  auto* source = vtkSMSourceProxy::SafeDownCast(proxy);
  if (source && source->GetOutputPortsCreated())
  {
    double bounds[6];
    source->GetDataInformation(0)->GetBounds(bounds);
    box.SetBounds(bounds);
  }
  return box;
}

/// Points on the box as the shape says.
std::vector<double> pointsOn(const vtkBoundingBox& box, const std::string& shape)
{
  const auto at = [&box](double x, double y, double z)
  {
    const double share[] = { x, y, z };
    std::vector<double> point(kCoordinates);
    for (int c = 0; c < 3; ++c)
    {
      point[c] = box.GetBound(2 * c) + share[c] * box.GetLength(c);
    }
    return point;
  };
  std::vector<double> points;
  const auto append = [&points](const std::vector<double>& point)
  { points.insert(points.end(), point.begin(), point.end()); };
  constexpr double quarter = 0.25;
  constexpr double middle = 0.5;
  if (shape == "point")
  {
    append(at(middle, middle, 1));
  }
  if (shape == "line" || shape == "begin")
  {
    append(at(quarter, middle, 1));
  }
  if (shape == "line" || shape == "end")
  {
    append(at(1 - quarter, middle, 1));
  }
  return points;
}

std::vector<double> valuesOf(vtkSMPropertyHelper& helper)
{
  std::vector<double> values(helper.GetNumberOfElements());
  if (!values.empty())
  {
    helper.Get(values.data(), static_cast<unsigned int>(values.size()));
  }
  return values;
}

/// The coordinates of the last point; empty where there is none.
std::vector<double> lastOf(const std::vector<double>& values)
{
  return values.size() < kCoordinates
    ? std::vector<double>{}
    : std::vector<double>(values.end() - static_cast<std::ptrdiff_t>(kCoordinates), values.end());
}

bool isAutoApplyOn(vtkSMSessionProxyManager* manager)
{
  vtkSMProxy* settings = manager->GetProxy("settings", "GeneralSettings");
  if (!settings || !settings->GetObjectsCreated())
  {
    return false;
  }
  vtkClientServerStream stream;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(settings) << "GetAutoApply"
         << vtkClientServerStream::End;
  settings->GetSession()->ExecuteStream(vtkPVSession::CLIENT, stream);
  bool isOn = false;
  return settings->GetSession()->GetLastResult(vtkPVSession::CLIENT).GetArgument(0, 0, &isOn) &&
    isOn;
}

/// Symmetric quads, and the method Seamless, have none.
bool hasPreview(vtkSMProxy* filter)
{
  constexpr int seamless = 3; // vtkQuadRemesh::METHOD_SEAMLESS
  return vtkSMPropertyHelper(filter, "Symmetry").GetAsInt() == 0 &&
    vtkSMPropertyHelper(filter, "Method").GetAsInt() != seamless;
}

void updateViews(vtkSMSessionProxyManager* manager)
{
  auto iterator = vtk::TakeSmartPointer(vtkSMProxyIterator::New());
  iterator->SetSessionProxyManager(manager);
  for (iterator->Begin("views"); !iterator->IsAtEnd(); iterator->Next())
  {
    vtkSMProxy* view = iterator->GetProxy();
    if (view && view->GetObjectsCreated())
    {
      invoke(view, "Update");
    }
  }
}

} // namespace

vtkSMQuadConstraintProxy::vtkSMQuadConstraintProxy() = default;

vtkSMQuadConstraintProxy::~vtkSMQuadConstraintProxy()
{
  this->StopWaiting();
}

//------------------------------------------------------------------------------
int vtkSMQuadConstraintProxy::ReadXMLAttributes(
  vtkSMSessionProxyManager* manager, vtkPVXMLElement* element)
{
  const int isRead = this->Superclass::ReadXMLAttributes(manager, element);
  vtkPVXMLElement* hints = this->GetHints();
  for (unsigned int i = 0; hints && i < hints->GetNumberOfNestedElements(); ++i)
  {
    vtkPVXMLElement* hint = hints->GetNestedElement(i);
    const char* name = hint->GetAttribute("property");
    vtkSMProperty* property = name ? this->GetProperty(name) : nullptr;
    if (std::strcmp(hint->GetName(), "Points") == 0 && property)
    {
      this->PointsProperties.push_back({ name, hint->GetAttributeOrEmpty("shape"), {}, {}, {} });
      property->AddObserver(
        vtkCommand::UncheckedPropertyModifiedEvent, this, &vtkSMQuadConstraintProxy::Follow);
    }
  }
  return isRead;
}

//------------------------------------------------------------------------------
int vtkSMQuadConstraintProxy::LoadXMLState(vtkPVXMLElement* element, vtkSMProxyLocator* locator)
{
  this->IsAttached = true;
  return this->Superclass::LoadXMLState(element, locator);
}

//------------------------------------------------------------------------------
void vtkSMQuadConstraintProxy::PlaceOnSurface(vtkMTimeType made)
{
  vtkSMSessionProxyManager* manager = this->GetSessionProxyManager();
  this->Filter = quadRemeshToUse(manager);
  const vtkBoundingBox box = boxOf(this->Filter, manager);
  for (const PointsProperty& points : this->PointsProperties)
  {
    vtkSMProperty* property = this->GetProperty(points.Name.c_str());
    if (box.IsValid() && property->GetMTime() <= made)
    {
      const std::vector<double> values = pointsOn(box, points.Shape);
      vtkSMPropertyHelper(property).Set(values.data(), static_cast<unsigned int>(values.size()));
    }
  }
  this->ReadFirstValues();
}

//------------------------------------------------------------------------------
void vtkSMQuadConstraintProxy::ReadFirstValues()
{
  for (PointsProperty& points : this->PointsProperties)
  {
    vtkSMPropertyHelper helper(this, points.Name.c_str());
    points.First = valuesOf(helper);
    points.Shown = points.First;
  }
}

//------------------------------------------------------------------------------
void vtkSMQuadConstraintProxy::NoteShown()
{
  for (PointsProperty& points : this->PointsProperties)
  {
    vtkSMUncheckedPropertyHelper helper(this, points.Name.c_str());
    const std::vector<double> before = std::exchange(points.Shown, valuesOf(helper));
    if (points.Shape == "line" && before.size() == points.Shown.size() &&
      vtkSMQuadPickProxy::TakeLastPlace(lastOf(points.Shown)) &&
      lastOf(before) != lastOf(points.First) &&
      std::equal(before.begin(), before.end() - static_cast<std::ptrdiff_t>(kCoordinates),
        points.Shown.begin()))
    {
      points.Picked = before;
      const std::vector<double> place = lastOf(points.Shown);
      points.Picked.insert(points.Picked.end(), place.begin(), place.end());
      this->WaitForRender();
    }
  }
}

//------------------------------------------------------------------------------
void vtkSMQuadConstraintProxy::WaitForRender()
{
  // The panel does not hear of changes while it makes one itself.
  auto iterator = vtk::TakeSmartPointer(vtkSMProxyIterator::New());
  iterator->SetSessionProxyManager(this->GetSessionProxyManager());
  for (iterator->Begin("views"); !iterator->IsAtEnd(); iterator->Next())
  {
    vtkSMProxy* view = iterator->GetProxy();
    const auto isIt = [view](const RenderWait& wait) { return wait.View == view; };
    if (std::none_of(this->Waits.begin(), this->Waits.end(), isIt))
    {
      this->Waits.push_back({ view,
        view->AddObserver(vtkCommand::EndEvent, this, &vtkSMQuadConstraintProxy::ShowPicked) });
    }
  }
}

//------------------------------------------------------------------------------
void vtkSMQuadConstraintProxy::StopWaiting()
{
  for (const RenderWait& wait : this->Waits)
  {
    if (wait.View)
    {
      wait.View->RemoveObserver(wait.Observer);
    }
  }
  this->Waits.clear();
}

//------------------------------------------------------------------------------
void vtkSMQuadConstraintProxy::ShowPicked()
{
  this->StopWaiting();
  for (PointsProperty& points : this->PointsProperties)
  {
    const std::vector<double> values = std::exchange(points.Picked, {});
    if (!values.empty())
    {
      vtkSMUncheckedPropertyHelper(this, points.Name.c_str())
        .Set(values.data(), static_cast<unsigned int>(values.size()));
    }
  }
}

//------------------------------------------------------------------------------
bool vtkSMQuadConstraintProxy::IsShown()
{
  // A panel's widget listens to it, to be shown and hidden by scripts.
  return this->HasObserver(vtkCommand::UserEvent) != 0;
}

//------------------------------------------------------------------------------
bool vtkSMQuadConstraintProxy::IsPlaced()
{
  for (const PointsProperty& points : this->PointsProperties)
  {
    vtkSMPropertyHelper helper(this, points.Name.c_str());
    const std::vector<double> now = valuesOf(helper);
    if (now.size() == points.First.size())
    {
      for (std::size_t i = 0; i < now.size(); i += kCoordinates)
      {
        if (std::equal(now.begin() + static_cast<std::ptrdiff_t>(i),
              now.begin() + static_cast<std::ptrdiff_t>(i + kCoordinates),
              points.First.begin() + static_cast<std::ptrdiff_t>(i)))
        {
          return false;
        }
      }
    }
  }
  return true;
}

//------------------------------------------------------------------------------
void vtkSMQuadConstraintProxy::UpdateVTKObjects()
{
  this->EndFollowing();
  this->Superclass::UpdateVTKObjects();
  if (!this->GetObjectsCreated() || !this->IsShown())
  {
    return;
  }
  // An undo puts the points back to where they were at first.
  const bool isPlaced = this->IsPlaced();
  this->IsAttached = this->IsAttached && isPlaced;
  if (!this->IsAttached && isPlaced)
  {
    this->Attach();
  }
}

//------------------------------------------------------------------------------
void vtkSMQuadConstraintProxy::Attach()
{
  vtkSMProxy* filter =
    this->Filter ? this->Filter.Get() : quadRemeshToUse(this->GetSessionProxyManager());
  if (!filter)
  {
    return; // one may come
  }
  this->IsAttached = true;
  if (!this->ConnectedFilter())
  {
    // A trace has what panels change; this is changed by no panel.
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", filter);
    vtkSMPropertyHelper(filter, "Constraints").Add(this, 0);
    filter->UpdateVTKObjects();
  }
}

//------------------------------------------------------------------------------
vtkSMProxy* vtkSMQuadConstraintProxy::ConnectedFilter()
{
  return lastQuadRemesh(this->GetSessionProxyManager(), this);
}

//------------------------------------------------------------------------------
bool vtkSMQuadConstraintProxy::IsChanging()
{
  return std::any_of(this->PointsProperties.begin(), this->PointsProperties.end(),
    [this](const PointsProperty& points)
    {
      vtkSMPropertyHelper applied(this, points.Name.c_str());
      vtkSMUncheckedPropertyHelper shown(this, points.Name.c_str());
      return valuesOf(applied) != valuesOf(shown);
    });
}

//------------------------------------------------------------------------------
void vtkSMQuadConstraintProxy::Follow()
{
  vtkSMSessionProxyManager* manager = this->GetSessionProxyManager();
  if (this->IsBusy || this->IsPrototype() || !this->GetObjectsCreated() || !this->IsShown())
  {
    return;
  }
  this->NoteShown();
  vtkSMProxy* filter = this->ConnectedFilter();
  if (!filter || !hasPreview(filter) || !this->IsChanging() || !isAutoApplyOn(manager))
  {
    return;
  }
  this->IsBusy = true;
  for (const PointsProperty& points : this->PointsProperties)
  {
    vtkSMUncheckedPropertyHelper helper(this, points.Name.c_str());
    this->SendPoints(points, valuesOf(helper));
  }
  this->BeginPreview(filter);
  filter->MarkModified(filter);
  updateViews(manager);
  this->IsBusy = false;
}

//------------------------------------------------------------------------------
void vtkSMQuadConstraintProxy::SendPoints(
  const PointsProperty& points, const std::vector<double>& coordinates)
{
  if (points.Shape == "begin" || points.Shape == "end" || points.Shape == "point")
  {
    invoke(this, points.Shape == "end" ? "SetPoint2" : "SetPoint1", coordinates[0], coordinates[1],
      coordinates[2]);
    return;
  }
  invoke(this, "SetNumberOfPoints", static_cast<vtkIdType>(coordinates.size() / kCoordinates));
  for (std::size_t i = 0; i + 2 < coordinates.size(); i += kCoordinates)
  {
    invoke(this, "SetPoint", static_cast<vtkIdType>(i / kCoordinates), coordinates[i],
      coordinates[i + 1], coordinates[i + 2]);
  }
}

//------------------------------------------------------------------------------
void vtkSMQuadConstraintProxy::BeginPreview(vtkSMProxy* filter)
{
  this->IsFollowing = true;
  this->Filter = filter;
  invoke(filter, "SetPreview", 1);
  this->MarkModified(this);
}

//------------------------------------------------------------------------------
void vtkSMQuadConstraintProxy::Join(vtkSMProxy* filter, const char* method)
{
  constexpr int constraints = 6; // input of vtkQuadRemesh
  vtkClientServerStream stream;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(this) << "GetOutputPort" << 0
         << vtkClientServerStream::End;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(filter) << method << constraints
         << vtkClientServerStream::LastResult << vtkClientServerStream::End;
  filter->GetSession()->ExecuteStream(filter->GetLocation(), stream);
}

//------------------------------------------------------------------------------
bool vtkSMQuadConstraintProxy::SendPreview(
  vtkSMProxy* filter, const std::vector<double>& coordinates)
{
  if (this->IsBusy || !hasPreview(filter))
  {
    return false;
  }
  this->IsBusy = true;
  if (this->ConnectedFilter() != filter && this->Joined != filter)
  {
    this->Joined = filter;
    this->Join(filter, "AddInputConnection");
  }
  auto next = coordinates.begin();
  for (const PointsProperty& points : this->PointsProperties)
  {
    const auto end =
      next + vtkSMUncheckedPropertyHelper(this, points.Name.c_str()).GetNumberOfElements();
    this->SendPoints(points, std::vector<double>(next, end));
    next = end;
  }
  this->BeginPreview(filter);
  this->IsBusy = false;
  return true;
}

//------------------------------------------------------------------------------
std::vector<double> vtkSMQuadConstraintProxy::GetShownPoints()
{
  std::vector<double> coordinates;
  for (const PointsProperty& points : this->PointsProperties)
  {
    vtkSMUncheckedPropertyHelper helper(this, points.Name.c_str());
    const std::vector<double> values = valuesOf(helper);
    coordinates.insert(coordinates.end(), values.begin(), values.end());
  }
  return coordinates;
}

//------------------------------------------------------------------------------
void vtkSMQuadConstraintProxy::SetPoints(const std::vector<double>& coordinates)
{
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", this);
  const double* next = coordinates.data();
  for (const PointsProperty& points : this->PointsProperties)
  {
    vtkSMUncheckedPropertyHelper shown(this, points.Name.c_str());
    const unsigned int count = shown.GetNumberOfElements();
    vtkSMPropertyHelper(this, points.Name.c_str()).Set(next, count);
    next += count;
  }
  this->UpdateVTKObjects();
}

//------------------------------------------------------------------------------
void vtkSMQuadConstraintProxy::EndFollowing()
{
  if (!this->IsFollowing)
  {
    return;
  }
  this->IsFollowing = false;
  if (this->Filter)
  {
    invoke(this->Filter, "SetPreview", vtkSMPropertyHelper(this->Filter, "Preview").GetAsInt());
    this->Filter->MarkModified(this->Filter);
  }
  if (this->Joined)
  {
    this->Join(this->Joined, "RemoveInputConnection");
    this->Joined = nullptr;
  }
  // What the object has been given does not show in the properties, so they are sent whether they have changed or not.
  for (const PointsProperty& points : this->PointsProperties)
  {
    this->SetPropertyModifiedFlag(points.Name.c_str(), 1);
  }
  this->MarkModified(this);
}

//------------------------------------------------------------------------------
void vtkSMQuadConstraintProxy::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "IsAttached: " << this->IsAttached << "\n";
  os << indent << "IsFollowing: " << this->IsFollowing << "\n";
}
