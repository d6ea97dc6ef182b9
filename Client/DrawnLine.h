// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What the mouse draws: a path of pixels that becomes a line of few points on the surface.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace quadrille
{

/// In pixels of the view, from the left and from the bottom.
using Pixel = std::array<double, 2>;
using Place = std::array<double, 3>;

double lengthOf(const std::vector<Pixel>& path);

/// A path whose pixels are the same distance apart, at most `step` and above 0; the ends stay. Paths without length
/// become one pixel.
std::vector<Pixel> evenPath(const std::vector<Pixel>& path, double step);

/// Each pixel becomes the mean of those up to `reach` before and after it, so that a hand that trembles draws a smooth
/// line. Near the ends of an open path fewer count, as many on both sides, so that the ends stay where they are.
std::vector<Pixel> smoothPath(const std::vector<Pixel>& path, std::size_t reach, bool isClosed);

/// Whether a drag comes back to where it began: its ends are nearer to each other than `near`, or than a sixth of its
/// length.
bool isClosedPath(const std::vector<Pixel>& path, double near);

/// Of the places that pixels side by side see, none where they see no surface, the longest row on one sheet; of several
/// the first. Pixels a step apart see places about as far apart as others do; beyond `far`, and beyond six times the
/// median step, the mouse has passed an outline and sees another sheet. So it has where more than mostUnseen side by
/// side see none; a ray can slip through between two cells.
std::vector<Place> longestOnOneSheet(
  const std::vector<std::optional<Place>>& places, double far, std::size_t mostUnseen);

/// The ids of those places that keep the polyline through them within the tolerance of all [Douglas and Peucker 1973];
/// the first and the last are among them.
std::vector<std::size_t> keptPlaces(const std::vector<Place>& places, double tolerance);

} // namespace quadrille
