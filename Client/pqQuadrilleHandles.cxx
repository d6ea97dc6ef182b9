// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "pqQuadrilleHandles.h"

#include "RemeshConstraints.h"
#include "pqQuadrilleOverlay.h"
#include "pqQuadrilleRun.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqRenderView.h"
#include "pqUndoStack.h"
#include "vtkCommand.h"
#include "vtkMath.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMQuadConstraintProxy.h"
#include "vtkSMRenderViewProxy.h"

#include <QApplication>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace
{

using quadrille::Pixel;
using quadrille::Place;

constexpr double kRingReach = 10;    // pixels from the centre of a ring
constexpr float kBeforeParaView = 9; // priority of observers; the drawing tools come first
constexpr double kBehind = 0.5;      // edge lengths

std::vector<Place> placesOf(const std::vector<double>& coordinates)
{
  std::vector<Place> places;
  for (std::size_t i = 0; i + 2 < coordinates.size(); i += 3)
  {
    places.push_back({ coordinates[i], coordinates[i + 1], coordinates[i + 2] });
  }
  return places;
}

std::vector<double> coordinatesOf(const std::vector<Place>& places)
{
  std::vector<double> coordinates;
  for (const Place& place : places)
  {
    coordinates.insert(coordinates.end(), place.begin(), place.end());
  }
  return coordinates;
}

} // namespace

pqQuadrilleHandles::pqQuadrilleHandles(QObject* parent) : Superclass(parent)
{
  this->Glide.setSingleShot(true);
  this->Glide.setInterval(0);
  QObject::connect(&this->Glide, &QTimer::timeout, this, &pqQuadrilleHandles::glide);
  auto& active = pqActiveObjects::instance();
  QObject::connect(&active, &pqActiveObjects::sourceChanged, this, &pqQuadrilleHandles::watch);
  QObject::connect(&active, &pqActiveObjects::viewChanged, this, &pqQuadrilleHandles::watchView);
}

pqQuadrilleHandles::~pqQuadrilleHandles()
{
  this->stopWatching();
}

//-----------------------------------------------------------------------------
void pqQuadrilleHandles::watch(pqPipelineSource* source)
{
  this->Constraint = vtkSMQuadConstraintProxy::SafeDownCast(source ? source->getProxy() : nullptr);
  this->watchView(pqActiveObjects::instance().activeView());
}

//-----------------------------------------------------------------------------
void pqQuadrilleHandles::watchView(pqView* view)
{
  this->stopWatching();
  auto* renderView = qobject_cast<pqRenderView*>(view);
  if (!this->Constraint || !renderView || !renderView->widget()) // it is being closed
  {
    return;
  }
  this->View = renderView;
  this->Overlay = new pqQuadrilleOverlay(renderView->widget());
  QObject::connect(renderView, &pqView::endRender, this->Overlay, [this] { this->showRings(); });
  this->Interactor = this->viewProxy()->GetInteractor();
  const auto observe = [this](unsigned long event,
                         bool (pqQuadrilleHandles::*answer)(vtkObject*, unsigned long, void*)) {
    this->Observers.push_back(this->Interactor->AddObserver(event, this, answer, kBeforeParaView));
  };
  observe(vtkCommand::LeftButtonPressEvent, &pqQuadrilleHandles::onPress);
  observe(vtkCommand::MouseMoveEvent, &pqQuadrilleHandles::onMove);
  observe(vtkCommand::LeftButtonReleaseEvent, &pqQuadrilleHandles::onRelease);
  this->showRings();
}

//-----------------------------------------------------------------------------
void pqQuadrilleHandles::stopWatching()
{
  for (const unsigned long observer : this->Observers)
  {
    if (this->Interactor)
    {
      this->Interactor->RemoveObserver(observer);
    }
  }
  this->Glide.stop();
  this->Observers.clear();
  this->Dragged.reset();
  this->View = nullptr;
  delete this->Overlay;
}

//-----------------------------------------------------------------------------
vtkSMRenderViewProxy* pqQuadrilleHandles::viewProxy() const
{
  return this->View->getRenderViewProxy();
}

//-----------------------------------------------------------------------------
Pixel pqQuadrilleHandles::mouse() const
{
  const int* at = this->viewProxy()->GetInteractor()->GetEventPosition();
  return { static_cast<double>(at[0]), static_cast<double>(at[1]) };
}

//-----------------------------------------------------------------------------
double pqQuadrilleHandles::pixelRatio() const
{
  return this->View->widget()->devicePixelRatioF();
}

//-----------------------------------------------------------------------------
void pqQuadrilleHandles::showRings()
{
  if (!this->Overlay || !this->Constraint)
  {
    return;
  }
  if (!this->Dragged)
  {
    this->Points = placesOf(this->Constraint->GetShownPoints());
  }
  QPolygonF rings;
  for (const Place& point : this->Points)
  {
    const Pixel pixel = quadrille::pixelOf(this->viewProxy(), point);
    rings << QPointF((pixel[0] + 0.5) / this->pixelRatio(),
      this->Overlay->height() - (pixel[1] + 0.5) / this->pixelRatio());
  }
  this->Overlay->setRings(rings);
}

//-----------------------------------------------------------------------------
std::optional<std::size_t> pqQuadrilleHandles::grasp(vtkSMSourceProxy* filter)
{
  const Pixel pixel = this->mouse();
  std::optional<std::size_t> nearest;
  double least = kRingReach * this->pixelRatio();
  for (std::size_t i = 0; i < this->Points.size(); ++i)
  {
    const Pixel at = quadrille::pixelOf(this->viewProxy(), this->Points[i]);
    const double away = std::hypot(at[0] - pixel[0], at[1] - pixel[1]);
    if (away <= least)
    {
      least = away;
      nearest = i;
    }
  }
  if (!nearest)
  {
    return std::nullopt;
  }
  const Place& point = this->Points[*nearest];
  const Pixel at = quadrille::pixelOf(this->viewProxy(), point);
  vtkSMSourceProxy* surface = quadrille::sourceUnder(this->viewProxy(), at);
  this->Surface.emplace(surface ? surface : filter);
  const std::optional<Place> seen = this->Surface->placeUnder(this->viewProxy(), at);
  if (!surface || !seen)
  {
    return nearest;
  }
  const Place into = quadrille::directionThrough(this->viewProxy(), at);
  double depth = 0;
  for (std::size_t c = 0; c < point.size(); ++c)
  {
    depth += (point[c] - (*seen)[c]) * into[c] / vtkMath::Norm(into.data());
  }
  return depth <= kBehind * quadrille::edgeLength(filter).value_or(0) ? nearest : std::nullopt;
}

//-----------------------------------------------------------------------------
bool pqQuadrilleHandles::onPress(vtkObject*, unsigned long, void*)
{
  vtkRenderWindowInteractor* interactor = this->viewProxy()->GetInteractor();
  vtkSMSourceProxy* filter =
    this->Constraint ? vtkSMSourceProxy::SafeDownCast(this->Constraint->GetFilter()) : nullptr;
  if (this->IsBusy || !filter || interactor->GetShiftKey() || interactor->GetControlKey() ||
    interactor->GetAltKey())
  {
    return this->IsBusy;
  }
  this->Dragged = this->grasp(filter);
  this->HasMoved = false;
  this->IsReleased = false;
  return this->Dragged.has_value();
}

//-----------------------------------------------------------------------------
bool pqQuadrilleHandles::onMove(vtkObject*, unsigned long, void*)
{
  if (this->Dragged)
  {
    this->Glide.start();
  }
  return this->Dragged.has_value() || this->IsBusy;
}

//-----------------------------------------------------------------------------
bool pqQuadrilleHandles::onRelease(vtkObject*, unsigned long, void*)
{
  if (!this->Dragged)
  {
    return this->IsBusy;
  }
  this->IsReleased = true;
  this->glide();
  this->Glide.stop();
  this->IsBusy = true;
  QTimer::singleShot(0, this, &pqQuadrilleHandles::finish);
  return true;
}

//-----------------------------------------------------------------------------
void pqQuadrilleHandles::glide()
{
  // While a preview is being made the mouse moves on; the next one is of where it is then.
  if (!this->Dragged || !this->Constraint || !this->View || !this->Surface ||
    (!this->IsReleased && pqQuadrilleRun::instance()->isUnderway()))
  {
    return;
  }
  const std::optional<Place> place = this->Surface->placeUnder(this->viewProxy(), this->mouse());
  if (!place || *place == this->Points[*this->Dragged])
  {
    return; // beside the surface it stays where it was last
  }
  this->HasMoved = true;
  this->Points[*this->Dragged] = *place;
  this->showRings();
  auto* filter = vtkSMSourceProxy::SafeDownCast(this->Constraint->GetFilter());
  if (filter && !this->IsReleased &&
    this->Constraint->SendPreview(filter, coordinatesOf(this->Points)))
  {
    pqQuadrilleRun::instance()->startPreview(filter,
      [this](pqQuadrilleRun::End how)
      {
        if (how == pqQuadrilleRun::End::Shown)
        {
          this->glide();
        }
      });
  }
}

//-----------------------------------------------------------------------------
void pqQuadrilleHandles::finish()
{
  const std::vector<double> coordinates = coordinatesOf(this->Points);
  this->Dragged.reset();
  this->Surface.reset();
  if (this->HasMoved && this->Constraint && this->View)
  {
    auto* filter = vtkSMSourceProxy::SafeDownCast(this->Constraint->GetFilter());
    if (filter)
    {
      pqQuadrilleRun::prepare(filter);
    }
    BEGIN_UNDO_SET("Drag a Point");
    this->Constraint->SetPoints(coordinates); // which ends the preview
    END_UNDO_SET();
    if (pqPipelineSource* source = pqActiveObjects::instance().activeSource())
    {
      source->setModifiedState(pqProxy::UNMODIFIED);
    }
    if (filter)
    {
      pqQuadrilleRun::instance()->start(filter, pqQuadrilleRun::undoIfStopped);
    }
  }
  this->IsBusy = false;
  this->showRings();
}
