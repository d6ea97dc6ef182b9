// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/SmallHandles.h"

#include "Base/PlaceText.h"
#include "Details/CloseHandles.h"
#include "Details/Handles.h"
#include "Hierarchy/Hierarchy.h"
#include "Prepare/Refine.h"
#include "Requests/Guides.h"

#include <algorithm>
#include <optional>
#include <sstream>

namespace quadrille
{
namespace
{

/// How often handles are looked for and closed: those whose loops meet others' have to wait.
constexpr int kMaximumClosings = 10;

std::vector<std::vector<Index>> placesOf(const HandleReport& found, const Level& level)
{
  std::vector<std::vector<Index>> places(found.loops.size());
  std::transform(found.loops.begin(), found.loops.end(), places.begin(),
    [&](const HandleLoop& loop) { return onFinest(loop.vertices, level); });
  return places;
}

std::string closedText(
  double length, std::size_t closed, std::size_t left, const std::optional<Vector3>& place)
{
  std::ostringstream text;
  text << closed << " handles shorter round than " << length << " edge lengths were cut and closed";
  if (place)
  {
    text << ", the shortest near " << placeText(*place);
  }
  if (left > 0)
  {
    text << "; " << left
         << " are left: every short loop round them meets the boundary or another one";
  }
  return text.str();
}

} // namespace

std::vector<Index> onFinest(const std::vector<Index>& vertices, const Level& level)
{
  std::vector<Index> finest(vertices.size());
  std::transform(
    vertices.begin(), vertices.end(), finest.begin(), [&](Index v) { return level.fineVertex[v]; });
  return finest;
}

ClosedHandles closeSmallHandles(
  PreparedSurface& surface, double edgeLength, const RemeshOptions& options)
{
  ClosedHandles result;
  const double limit = options.closeHandles * edgeLength;
  std::size_t closed = 0, left = 0;
  std::optional<Vector3> place;
  for (int closing = 0; closing < kMaximumClosings; ++closing)
  {
    HierarchyOptions levels;
    levels.targetEdgeLength = edgeLength;
    levels.coarseVertices = options.coarseVertices;
    levels.guides = surfaceGuides(surface, options.threads).faces;
    levels.keepVertices = keptVertices(surface);
    levels.threads = options.threads;
    levels.progress = subProgress(options.progress, 0.15, 0.45, "Decimating: ");
    const Redecimation redecimation(surface.mesh, surface.hash, levels);
    ++result.decimations;
    const Level& level = redecimation.hierarchy().intermediate;
    const HandleReport found = findHandles(level.mesh, limit);
    left = found.loops.size();
    if (left == 0)
    {
      break;
    }
    const std::vector<std::vector<Index>> places = placesOf(found, level);
    place = place.value_or(surface.mesh.position[places.front().front()]);
    std::vector<Vector3> at;
    at.reserve(places.size());
    for (const std::vector<Index>& loop : places)
    {
      at.push_back(surface.mesh.position[loop.front()]);
    }
    const std::vector<std::size_t> closedHere = closeHandles(
      surface, places, kLongerAlongEdges * limit, kGirthOfLimb * edgeLength, options.threads);
    if (closedHere.empty())
    {
      break;
    }
    closed += closedHere.size();
    for (const std::size_t i : closedHere)
    {
      result.details.push_back({ DetailKind::Handle, DetailDecision::Simplify,
        found.loops[i].length / edgeLength, at[i], "cut and closed, as was asked for" });
    }
    refineSurface(surface, edgeLength, {}, options.threads);
  }
  result.notice = closedText(options.closeHandles, closed, left, place);
  return result;
}

} // namespace quadrille
