// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/HandlesOfPiece.h"

#include "Base/Progress.h"
#include "Mesh/CloseHandles.h"
#include "Mesh/Handles.h"
#include "Mesh/NearLoops.h"
#include "Pipeline/SmallHandles.h"

#include <algorithm>
#include <utility>

namespace quadrille
{
bool HandlesOfPiece::isNear(
  const Mesh& mesh, const std::vector<Index>& place, const std::vector<Vector3>& kept) const
{
  return std::any_of(place.begin(), place.end(),
    [&](Index v)
    {
      return std::any_of(kept.begin(), kept.end(),
        [&](const Vector3& p) { return (mesh.position[v] - p).norm() < closedLoop_; });
    });
}

std::vector<std::vector<Index>> HandlesOfPiece::placesOnSurface(
  const Mesh& mesh, const Level& level, const std::vector<Vector3>& kept) const
{
  std::vector<std::vector<Index>> places;
  for (const HandleLoop& loop : findShortHandles(level.mesh, kLongerAlongEdges * closedLoop_))
  {
    std::vector<Index> place(loop.vertices.size());
    std::transform(loop.vertices.begin(), loop.vertices.end(), place.begin(),
      [&](Index v) { return level.fineVertex[v]; });
    if (!isNear(mesh, place, kept))
    {
      places.push_back(std::move(place));
    }
  }
  return places;
}

bool HandlesOfPiece::close(
  PreparedSurface& surface, const Level& level, const std::vector<Vector3>& kept, int threads)
{
  if (!(closedLoop_ > 0))
  {
    return false;
  }
  const std::vector<std::vector<Index>> places = placesOnSurface(surface.mesh, level, kept);
  const auto lengths = lengthsNear(surface.mesh, places, closedLoop_, threads);
  std::vector<std::vector<Index>> shortOnes;
  std::vector<SmallDetail> found;
  for (std::size_t i = 0; lengths && i < places.size(); ++i)
  {
    if ((*lengths)[i] > 0)
    {
      found.push_back({ DetailKind::Handle, DetailDecision::Simplify, (*lengths)[i] / quadEdge_,
        surface.mesh.position[places[i].front()], kCutAndClosed });
      shortOnes.push_back(places[i]);
    }
  }
  if (shortOnes.empty())
  {
    return false;
  }
  surface.namesBefore = NamesBefore::of(surface.mesh.vertexCount(), surface.mesh.faceCount());
  for (const std::size_t i : closeHandles(
         surface, shortOnes, kLongerAlongEdges * closedLoop_, kGirthOfLimb * quadEdge_, threads))
  {
    closed_.push_back(found[i]);
  }
  surface.repair.closedHandles -= closed_.size(); // told as details
  if (!closed_.empty())
  {
    findNewVertices(surface);
  }
  if (closed_.empty() || closed_.size() > kMostFollowed ||
    surface.mesh.faceCount() < kLeastFollowed)
  {
    surface.namesBefore.reset();
  }
  return !closed_.empty();
}

void HandlesOfPiece::findNewVertices(const PreparedSurface& surface)
{
  const Mesh& mesh = surface.mesh;
  isNew_.assign(mesh.vertexCount(), 0);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    isNew_[v] = surface.namesBefore->vertex[v] == kInvalidIndex ? 1 : 0;
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

std::optional<Vector3> HandlesOfPiece::offInput(const FacePlace& place) const
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
