// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The steps of settleDetails, see SettledSurface.h.
#pragma once

#include "Details/Handles.h"
#include "Mesh/Surface.h"
#include "Pipeline/Attempt.h"

#include <cstddef>
#include <vector>

namespace quadrille
{

/// So many handles are a crowd: resolved as a whole, or cut.
constexpr std::size_t kManyHandles = 24;

/// Below which lengths loops are simplified, in units of the mesh.
struct DetailLimits
{
  double boundaryLoops = 0;
  double handles = 0;
};
/// smallest: RemeshOptions::smallestDetail. takesAll: what is shorter than kQuadsOfLoop edge lengths, whatever smaller
/// quads could do. isRest: nothing else has led to quads.
DetailLimits detailLimits(double edgeLength, double smallest, bool takesAll, bool isRest);

/// Whether the handles at least as long as the limit are so many, and smaller quads round them would be so many more,
/// that all short ones are cut; never on a designed body. The short loops of the run were found.
bool isCrowdToCut(const DetailLimits& limits, const RunContext& run);

/// Below the limit. Those of components with less area than a closed block of quads are left to them.
std::vector<HandleLoop> shortBoundaryLoops(
  const PreparedSurface& surface, double edgeLength, double limit, int threads);

/// With vertices of the surface. The run, whose short loops were found, knows those of up to kQuadsOfLoop edge lengths.
std::vector<HandleLoop> handlesBelow(RunContext& run, double limit);

/// A surface with more handles and holes than quads of the size that was asked for can go round ends in minutes of
/// attempts that fail: Infeasible, with the place. isCut: whether what can be simplified was. What is ok is kept in the
/// store, if any.
Status judgeHandles(const SizedSurface& sized, bool isCut, int threads, ResultStore* store);

/// What is asked of a surface, with the places of the vertices, to ask it of one that was made of it.
struct AskedPlaces
{
  SurfaceRequests requests;
  std::vector<Vector3> valencePlaces, sectorPlaces;
};
AskedPlaces askedPlaces(const PreparedSurface& surface);
/// Of the vertices at the same places of another surface; what has none there is dropped.
void ask(const AskedPlaces& asked, PreparedSurface& surface, double edgeLength, int threads);

} // namespace quadrille
