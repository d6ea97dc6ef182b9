// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces/HandlesOfPiece.h"

#include "Base/Progress.h"
#include "Details/CloseHandles.h"
#include "Details/Handles.h"
#include "Details/NearLoops.h"
#include "Pipeline/Attempt.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace quadrille
{

std::vector<ShortHandle> findShortHandles(const Mesh& mesh, const Level& level, double closedLoop,
  double quadEdge, const std::vector<Vector3>& kept, int threads)
{
  std::vector<ShortHandle> handles;
  if (!(closedLoop > 0))
  {
    return handles;
  }
  std::vector<std::vector<Index>> onLevel, places;
  for (HandleLoop& loop : findShortHandles(level.mesh, kLongerAlongEdges * closedLoop))
  {
    std::vector<Index> place = onFinest(loop.vertices, level);
    if (std::none_of(place.begin(), place.end(),
          [&](Index v) { return isNear(mesh.position[v], kept, closedLoop); }))
    {
      places.push_back(std::move(place));
      onLevel.push_back(std::move(loop.vertices));
    }
  }
  const auto lengths = lengthsNear(mesh, places, closedLoop, threads);
  for (std::size_t i = 0; lengths && i < places.size(); ++i)
  {
    if ((*lengths)[i] > 0)
    {
      handles.push_back({ std::move(onLevel[i]),
        { DetailKind::Handle, DetailDecision::Simplify, (*lengths)[i] / quadEdge,
          mesh.position[places[i].front()], kCutAndClosed } });
    }
  }
  return handles;
}

std::vector<SmallDetail> cutShortHandles(PreparedSurface& surface,
  const std::vector<ShortHandle>& handles, const std::vector<std::vector<Index>>& places,
  double closedLoop, double quadEdge, int threads)
{
  std::vector<SmallDetail> closed;
  for (const std::size_t i :
    closeHandles(surface, places, kLongerAlongEdges * closedLoop, kGirthOfLimb * quadEdge, threads))
  {
    closed.push_back(handles[i].detail);
  }
  surface.repair.closedHandles -= closed.size(); // told as details
  return closed;
}

bool HandlesOfPiece::close(
  PreparedSurface& surface, const Level& level, const std::vector<Vector3>& kept, int threads)
{
  const std::vector<ShortHandle> handles =
    findShortHandles(surface.mesh, level, closedLoop_, quadEdge_, kept, threads);
  if (handles.empty())
  {
    return false;
  }
  std::vector<std::vector<Index>> places(handles.size());
  std::transform(handles.begin(), handles.end(), places.begin(),
    [&](const ShortHandle& handle) { return onFinest(handle.onLevel, level); });
  surface.vertexBefore.resize(surface.mesh.vertexCount());
  std::iota(surface.vertexBefore.begin(), surface.vertexBefore.end(), Index{ 0 });
  closed_ = cutShortHandles(surface, handles, places, closedLoop_, quadEdge_, threads);
  if (!closed_.empty())
  {
    findNewVertices(surface);
  }
  surface.vertexBefore.clear();
  return !closed_.empty();
}

void HandlesOfPiece::findNewVertices(const PreparedSurface& surface)
{
  const Mesh& mesh = surface.mesh;
  isNew_.assign(mesh.vertexCount(), 0);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    isNew_[v] = surface.vertexBefore[v] == kInvalidIndex ? 1 : 0;
  }
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    const std::array<Index, 3> v{ mesh.origin[3 * f], mesh.origin[3 * f + 1],
      mesh.origin[3 * f + 2] };
    if (std::any_of(v.begin(), v.end(), [&](Index corner) { return isNew(corner); }))
    {
      offFaces_.push_back({ f, { mesh.position[v[0]], mesh.position[v[1]], mesh.position[v[2]] } });
    }
  }
}

std::optional<Vector3> HandlesOfPiece::offInput(const SurfacePoint& place) const
{
  const auto found = std::lower_bound(offFaces_.begin(), offFaces_.end(), place.face,
    [](const OffFace& off, Index face) { return off.face < face; });
  if (found == offFaces_.end() || found->face != place.face)
  {
    return std::nullopt;
  }
  return Vector3(place.weights[0] * found->corners[0] + place.weights[1] * found->corners[1] +
    place.weights[2] * found->corners[2]);
}

} // namespace quadrille
