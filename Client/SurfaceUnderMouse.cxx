// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceUnderMouse.h"

#include "pqUndoStack.h"
#include "vtkCollection.h"
#include "vtkNew.h"
#include "vtkRenderer.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMRepresentationProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille
{
namespace
{

constexpr double kCentre = 0.5; // of a pixel, from its corner

std::array<int, 2> rounded(const Pixel& pixel)
{
  return { static_cast<int>(std::lround(pixel[0])), static_cast<int>(std::lround(pixel[1])) };
}

vtkSMSourceProxy* sourceOf(vtkObject* representation)
{
  auto* proxy = vtkSMProxy::SafeDownCast(representation);
  return proxy ? vtkSMSourceProxy::SafeDownCast(vtkSMPropertyHelper(proxy, "Input").GetAsProxy())
               : nullptr;
}

/// From the near plane of the camera to the far one, through the centre of the pixel.
std::array<double, 6> rayThrough(vtkRenderer* renderer, const Pixel& pixel)
{
  std::array<double, 6> ray;
  for (int end = 0; end < 2; ++end)
  {
    renderer->SetDisplayPoint(pixel[0] + kCentre, pixel[1] + kCentre, end);
    renderer->DisplayToWorld();
    const double* world = renderer->GetWorldPoint();
    for (int c = 0; c < 3; ++c)
    {
      ray[static_cast<std::size_t>(3 * end + c)] = world[c] / world[3];
    }
  }
  return ray;
}

/// What is selected of a source in a rectangle, and whether it is all that is seen there.
struct Seen
{
  vtkSmartPointer<vtkSMProxy> selection; ///< null where it is nothing
  bool isAlone = true;
};

Seen seenIn(
  vtkSMRenderViewProxy* view, const std::array<int, 4>& rectangle, vtkSMSourceProxy* source)
{
  vtkNew<vtkCollection> drawn;
  vtkNew<vtkCollection> selections;
  drawIfOld(view);
  view->SelectSurfaceCells(rectangle.data(), drawn, selections, true);
  Seen seen;
  for (int i = 0; i < drawn->GetNumberOfItems() && i < selections->GetNumberOfItems(); ++i)
  {
    if (sourceOf(drawn->GetItemAsObject(i)) == source)
    {
      seen.selection = vtkSMProxy::SafeDownCast(selections->GetItemAsObject(i));
    }
    else
    {
      seen.isAlone = false;
    }
  }
  return seen;
}

/// Round all pixels and those beside them: left, bottom, right, top.
std::array<int, 4> rectangleRound(vtkSMRenderViewProxy* view, const std::vector<Pixel>& pixels)
{
  const int* size = view->GetRenderer()->GetSize();
  std::array<int, 4> rectangle{ size[0] - 1, size[1] - 1, 0, 0 };
  for (const Pixel& pixel : pixels)
  {
    const std::array<int, 2> at = rounded(pixel);
    for (std::size_t c = 0; c < 2; ++c)
    {
      rectangle[c] = std::max(std::min(rectangle[c], at[c] - 1), 0);
      rectangle[2 + c] = std::min(std::max(rectangle[2 + c], at[c] + 1), size[c] - 1);
    }
  }
  return rectangle;
}

/// What answers questions about the source; null where the server has no plugin.
vtkSmartPointer<vtkSMProxy> newPlaces(vtkSMSourceProxy* source)
{
  auto places = vtkSmartPointer<vtkSMProxy>::Take(
    source->GetSessionProxyManager()->NewProxy("misc", "QuadSurfacePlaces"));
  if (places)
  {
    vtkSMPropertyHelper(places, "Input").Set(source);
  }
  return places;
}

/// Where the rays first hit what is selected or held: three coordinates each, not numbers where they do not.
std::vector<double> hitsOf(const std::vector<double>& rays, vtkSMProxy* places)
{
  vtkSMPropertyHelper(places, "Rays").Set(rays.data(), static_cast<unsigned int>(rays.size()));
  places->UpdateVTKObjects();
  places->InvokeCommand("Compute");
  places->UpdatePropertyInformation();
  return vtkSMPropertyHelper(places, "Places").GetDoubleArray();
}

} // namespace

void drawIfOld(vtkSMViewProxy* view)
{
  if (view->GetNeedsUpdate())
  {
    view->StillRender();
  }
}

vtkSMSourceProxy* sourceUnder(vtkSMRenderViewProxy* view, const Pixel& pixel)
{
  const pqScopedUndoExclude noStepOfTheUser;
  const auto [x, y] = rounded(pixel);
  drawIfOld(view);
  return sourceOf(view->Pick(x, y));
}

std::vector<std::optional<Place>> placesUnder(
  vtkSMRenderViewProxy* view, const std::vector<Pixel>& pixels, vtkSMSourceProxy* source)
{
  const pqScopedUndoExclude noStepOfTheUser;
  std::vector<std::optional<Place>> places(pixels.size());
  const Seen seen =
    source && !pixels.empty() ? seenIn(view, rectangleRound(view, pixels), source) : Seen{};
  if (!seen.selection)
  {
    return places;
  }
  std::vector<double> rays;
  for (const Pixel& pixel : pixels)
  {
    const std::array<double, 6> ray = rayThrough(view->GetRenderer(), pixel);
    rays.insert(rays.end(), ray.begin(), ray.end());
  }
  const vtkSmartPointer<vtkSMProxy> asked = newPlaces(source);
  if (!asked)
  {
    return places;
  }
  vtkSMPropertyHelper(asked, "Selection").Set(seen.selection);
  const std::vector<double> hits = hitsOf(rays, asked);
  for (std::size_t i = 0; i < pixels.size() && 3 * i + 2 < hits.size(); ++i)
  {
    if (std::isfinite(hits[3 * i]) && (seen.isAlone || sourceUnder(view, pixels[i]) == source))
    {
      places[i] = { hits[3 * i], hits[3 * i + 1], hits[3 * i + 2] };
    }
  }
  return places;
}

HeldSurface::HeldSurface(vtkSMSourceProxy* source) : places_(newPlaces(source))
{
  const pqScopedUndoExclude noStepOfTheUser;
  if (places_)
  {
    places_->UpdateVTKObjects();
    places_->InvokeCommand("Hold");
  }
}

std::optional<Place> HeldSurface::placeUnder(vtkSMRenderViewProxy* view, const Pixel& pixel) const
{
  if (!places_)
  {
    return std::nullopt;
  }
  const pqScopedUndoExclude noStepOfTheUser;
  const std::array<double, 6> ray = rayThrough(view->GetRenderer(), pixel);
  const std::vector<double> hit = hitsOf({ ray.begin(), ray.end() }, places_);
  return hit.size() == 3 && std::isfinite(hit[0]) ? std::optional<Place>({ hit[0], hit[1], hit[2] })
                                                  : std::nullopt;
}

Place directionThrough(vtkSMRenderViewProxy* view, const Pixel& pixel)
{
  const std::array<double, 6> ray = rayThrough(view->GetRenderer(), pixel);
  return { ray[3] - ray[0], ray[4] - ray[1], ray[5] - ray[2] };
}

Pixel pixelOf(vtkSMRenderViewProxy* view, const Place& place)
{
  vtkRenderer* renderer = view->GetRenderer();
  renderer->SetWorldPoint(place[0], place[1], place[2], 1);
  renderer->WorldToDisplay();
  const double* display = renderer->GetDisplayPoint();
  return { display[0] - kCentre, display[1] - kCentre };
}

std::optional<std::size_t> nearestSeen(vtkSMRenderViewProxy* view, vtkSMSourceProxy* source,
  const std::vector<Place>& places, const Pixel& pixel, double reach, double near)
{
  std::vector<std::pair<double, std::size_t>> candidates;
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    const Pixel at = pixelOf(view, places[i]);
    const double away = std::hypot(at[0] - pixel[0], at[1] - pixel[1]);
    if (away <= reach)
    {
      candidates.emplace_back(away, i);
    }
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<Pixel> pixels;
  for (const auto& candidate : candidates)
  {
    pixels.push_back(pixelOf(view, places[candidate.second]));
  }
  const std::vector<std::optional<Place>> seen = placesUnder(view, pixels, source);
  for (std::size_t i = 0; i < candidates.size(); ++i)
  {
    const Place& place = places[candidates[i].second];
    if (seen[i] &&
      std::hypot((*seen[i])[0] - place[0], (*seen[i])[1] - place[1], (*seen[i])[2] - place[2]) <=
        near)
    {
      return candidates[i].second;
    }
  }
  return std::nullopt;
}

} // namespace quadrille
