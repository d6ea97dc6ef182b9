// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What is drawn at points and along paths, put on the surface of a run.
#pragma once

#include "Mesh/Surface.h"
#include "Pipeline/ResultStore.h"

#include <functional>
#include <string>
#include <vector>

namespace quadrille
{

/// Of a prepared surface with sizes that were drawn on it for quads of this edge length.
ResultKey drawnKey(ResultKey prepared, const SurfaceInput& input, double edgeLength);

/// Sizes become those of the surface, which is one from before refinement. Adds what the user should know to notices.
void drawSizes(PreparedSurface& surface, const SurfaceInput& input, double edgeLength, int threads,
  std::vector<std::string>& notices);

/// Features at these places are none any more, see clearFeatures; before others are drawn. The hash of the surface
/// stays what it was.
void clearDrawn(PreparedSurface& surface, const std::vector<Vector3>& places, double edgeLength,
  std::vector<std::string>& notices);

/// Edge lengths from the end of a connection to the feature or boundary that it joins, at most.
constexpr double kReachOfCurve = 1.5;

/// Features become those of the surface, and so do its lines, which get their course on it.
void drawFeatures(PreparedSurface& surface, const std::vector<FeatureRequest>& drawn,
  double edgeLength, int threads, std::vector<std::string>& notices);

/// Valences that are asked for on the surface, and those at the ends of its connections; of the same valence at one
/// place, on the same side of a thin wall, one.
std::vector<ValencePlace> withEnds(const PreparedSurface& surface,
  std::vector<ValencePlace> valences, double edgeLength, int threads);

/// Of the places with this valence the nearest one to p, at most so far away; null: none. counts: which of them do;
/// empty: all.
const ValencePlace* nearestOf(const std::vector<ValencePlace>& valences, int valence,
  const Vector3& p, double within, const std::function<bool(const ValencePlace&)>& counts = {});

/// Valences at places, on the triangles as they are to stay. Whether vertices were added to these.
bool drawValences(PreparedSurface& surface, const std::vector<ValencePlace>& valences,
  double edgeLength, int threads, std::vector<std::string>& notices);

} // namespace quadrille
