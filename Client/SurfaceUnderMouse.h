// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Which surface the user sees at a pixel of a view, and where. All by ParaView's selection of what the card has drawn,
/// so that it works with a server, and that what is hidden or not pickable is looked through.
#pragma once

#include "DrawnLine.h"

#include "vtkSmartPointer.h"

#include <optional>
#include <vector>

class vtkSMProxy;
class vtkSMRenderViewProxy;
class vtkSMSourceProxy;
class vtkSMViewProxy;

namespace quadrille
{

/// Draws the view before something is selected in it, unless it is drawn: where a filter has been executed, and the
/// view not been drawn since, a selection of ParaView 5.11 finds nothing, and neither do those after it. The selections
/// below do so themselves.
void drawIfOld(vtkSMViewProxy* view);

/// What is drawn at the pixel: the source whose output it is; null where it is nothing.
vtkSMSourceProxy* sourceUnder(vtkSMRenderViewProxy* view, const Pixel& pixel);

/// The places of the surface of this source that are seen at the pixels; none where something else, or nothing, is
/// seen. All by one selection in the rectangle round the pixels.
std::vector<std::optional<Place>> placesUnder(
  vtkSMRenderViewProxy* view, const std::vector<Pixel>& pixels, vtkSMSourceProxy* source);

/// The surface of a source as it is now, to be asked for places while the source changes, without a selection, which
/// draws the view. What lies before it in the view hides nothing of it.
class HeldSurface
{
public:
  explicit HeldSurface(vtkSMSourceProxy* source);

  /// Where the surface is under the centre of the pixel.
  std::optional<Place> placeUnder(vtkSMRenderViewProxy* view, const Pixel& pixel) const;

private:
  vtkSmartPointer<vtkSMProxy> places_; ///< null where the server knows no such proxy
};

/// The direction in which the eye looks through a pixel, of any length.
Place directionThrough(vtkSMRenderViewProxy* view, const Pixel& pixel);

/// Where a place lies in the view, hidden or not.
Pixel pixelOf(vtkSMRenderViewProxy* view, const Place& place);

/// Of places of a surface the one that is seen nearest to the pixel, within a reach in pixels: its number. Places that
/// lie farther than `near` from what is seen at their own pixel are behind it.
std::optional<std::size_t> nearestSeen(vtkSMRenderViewProxy* view, vtkSMSourceProxy* source,
  const std::vector<Place>& places, const Pixel& pixel, double reach, double near);

} // namespace quadrille
