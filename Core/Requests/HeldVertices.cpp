// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/HeldVertices.h"

#include "Base/Lists.h"
#include "Base/Progress.h"
#include "Mesh/AskedVertices.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace quadrille
{
namespace
{

struct MeshSector
{
  Index first = kInvalidIndex; ///< half-edge
  Index corners = 0;
  Vector3 middle = Vector3::Zero();
};

double angleAt(const Mesh& mesh, Index h)
{
  const Vector3 a = mesh.edgeVector(h);
  const Vector3 b = -mesh.edgeVector(Mesh::previous(h));
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// first: constrained.
MeshSector sectorFrom(const Mesh& mesh, Index first)
{
  MeshSector sector{ first, 0, {} };
  double whole = 0;
  Index h = first;
  do
  {
    whole += angleAt(mesh, h);
    ++sector.corners;
    h = mesh.rotateCounterclockwise(h);
  } while (h != kInvalidIndex && !mesh.isConstrained(h));
  double before = 0;
  h = first;
  for (Index i = 0; i < sector.corners; ++i, h = mesh.rotateCounterclockwise(h))
  {
    const double angle = angleAt(mesh, h);
    if (before + angle >= whole / 2 || i + 1 == sector.corners)
    {
      const double share = angle > 0 ? std::min(1.0, (whole / 2 - before) / angle) : 0;
      const Vector3 a = mesh.edgeVector(h).stableNormalized();
      const Vector3 b = -mesh.edgeVector(Mesh::previous(h)).stableNormalized();
      sector.middle = ((1 - share) * a + share * b).stableNormalized();
      break;
    }
    before += angle;
  }
  return sector;
}

/// By vertex: its first constrained half-edge, that of the boundary where there is one; else none.
std::vector<Index> firstConstrained(const Mesh& mesh)
{
  std::vector<Index> first(mesh.vertexCount(), kInvalidIndex);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    Index& at = first[mesh.origin[h]];
    if (mesh.isConstrained(h) && (at == kInvalidIndex || mesh.isBoundary(h)))
    {
      at = h;
    }
  }
  return first;
}

std::vector<MeshSector> sectorsFrom(const Mesh& mesh, Index first)
{
  std::vector<MeshSector> sectors;
  Index h = first;
  do
  {
    sectors.push_back(sectorFrom(mesh, h));
    for (Index i = 0; i < sectors.back().corners && h != kInvalidIndex; ++i)
    {
      h = mesh.rotateCounterclockwise(h);
    }
  } while (h != kInvalidIndex && h != first);
  return sectors;
}

/// By how many places the sectors of the request are turned against those of the mesh.
std::size_t bestRotation(
  const std::vector<MeshSector>& there, const std::vector<HeldSector>& asked, bool onBoundary)
{
  std::size_t best = 0;
  double most = -1e300;
  for (std::size_t by = 0; by < (onBoundary ? 1 : asked.size()); ++by)
  {
    double sum = 0;
    for (std::size_t i = 0; i < there.size(); ++i)
    {
      sum += there[i].middle.dot(asked[(i + by) % asked.size()].middle);
    }
    if (sum > most)
    {
      most = sum;
      best = by;
    }
  }
  return best;
}

struct HeldCandidate
{
  std::size_t held = 0;
  double squared = 0;
  Index vertex = kInvalidIndex;

  bool operator<(const HeldCandidate& other) const
  {
    return std::tie(held, squared, vertex) < std::tie(other.held, other.squared, other.vertex);
  }
};

/// Vertices of curves at the points of the held ones.
std::vector<HeldCandidate> candidatesOf(const SurfaceInput& input, const PreparedSurface& surface)
{
  const Mesh& mesh = surface.mesh;
  std::vector<std::pair<Index, std::size_t>> byPoint;
  for (std::size_t i = 0; i < input.held.size(); ++i)
  {
    byPoint.emplace_back(input.held[i].point, i);
  }
  std::sort(byPoint.begin(), byPoint.end());
  std::vector<std::uint8_t> isHeld(byPoint.back().first + std::size_t{ 1 }, 0);
  for (const auto& [point, held] : byPoint)
  {
    isHeld[point] = 1;
  }
  const std::vector<Index> curves = firstConstrained(mesh);
  std::vector<HeldCandidate> candidates;
  const auto add = [&](Index point, Index v)
  {
    auto at =
      std::lower_bound(byPoint.begin(), byPoint.end(), std::make_pair(point, std::size_t{ 0 }));
    for (; at != byPoint.end() && at->first == point; ++at)
    {
      const HeldVertex& held = input.held[at->second];
      candidates.push_back({ at->second, (mesh.position[v] - held.place).squaredNorm(), v });
    }
  };
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    if (curves[mesh.origin[h]] == kInvalidIndex)
    {
      continue;
    }
    const Index f = Mesh::face(h);
    const bool isRefined =
      !surface.refinedEntry.empty() && surface.refinedEntry[f] != kInvalidIndex;
    // What a flipped face comes from is not what its corners come from.
    const std::array<Index, 3> points =
      surface.isFlipped(f) ? surface.locate(f, cornerWeight(h)).points : surface.sourcePoints[f];
    for (int i = 0; i < 3; ++i)
    {
      if (points[i] < isHeld.size() && isHeld[points[i]] != 0 &&
        (isRefined || static_cast<Index>(i) == h % 3))
      {
        add(points[i], mesh.origin[h]);
      }
    }
  }
  std::sort(candidates.begin(), candidates.end());
  return candidates;
}

} // namespace

std::vector<SectorRequest> placeHeldVertices(
  const SurfaceInput& input, const PreparedSurface& surface)
{
  std::vector<SectorRequest> sectors;
  if (input.held.empty())
  {
    return sectors;
  }
  std::vector<std::uint8_t> taken(surface.mesh.vertexCount(), 0);
  for (const ValenceRequest& request : surface.valenceRequests)
  {
    taken[request.vertex] = 1;
  }
  std::vector<std::uint8_t> placed(input.held.size(), 0);
  std::size_t lastPlaced = 0;
  const auto hasFanOf = [&](const HeldVertex& held, Index v)
  {
    return !surface.withoutMap.empty() && !sectors.empty() && sectors.back().vertex == v &&
      input.held[lastPlaced].place == held.place;
  };
  for (const HeldCandidate& candidate : candidatesOf(input, surface))
  {
    const HeldVertex& held = input.held[candidate.held];
    if (placed[candidate.held] == 0 && taken[candidate.vertex] == 0)
    {
      placed[candidate.held] = taken[candidate.vertex] = 1;
      sectors.push_back({ candidate.vertex, held.sectors });
      lastPlaced = candidate.held;
    }
    else if (placed[candidate.held] == 0 && hasFanOf(held, candidate.vertex))
    {
      placed[candidate.held] = 1;
      append(sectors.back().sectors, held.sectors);
    }
  }
  sortByVertex(sectors);
  return sectors;
}

std::vector<SectorRequest> sectorsOf(const Mesh& level, const std::vector<std::int8_t>& sectorTurns,
  const std::vector<std::uint8_t>& flags, const std::vector<Index>& fineVertex)
{
  std::vector<SectorRequest> result;
  const std::vector<Index> first = firstConstrained(level);
  for (Index v = 0; v < level.vertexCount(); ++v)
  {
    if (flags[v] == 0 || first[v] == kInvalidIndex)
    {
      continue;
    }
    result.push_back({ fineVertex[v], {} });
    for (const MeshSector& sector : sectorsFrom(level, first[v]))
    {
      result.back().sectors.push_back({ sector.middle, sectorTurns[sector.first] });
    }
  }
  sortByVertex(result);
  return result;
}

std::vector<int> levelSectors(
  const PreparedSurface& surface, const Mesh& level, const std::vector<Index>& fineVertex)
{
  if (!surface.regularOnFeatures)
  {
    return {};
  }
  std::vector<int> turns(level.halfEdgeCount(), 0);
  const std::vector<Index> first = firstConstrained(level);
  for (Index v = 0; v < level.vertexCount(); ++v)
  {
    if (first[v] == kInvalidIndex)
    {
      continue;
    }
    const std::vector<MeshSector> there = sectorsFrom(level, first[v]);
    const bool onBoundary = level.isBoundary(first[v]);
    const SectorRequest* asked = requestAt(surface.sectorRequests, fineVertex[v]);
    const bool isAsked = asked != nullptr && asked->sectors.size() == there.size();
    const std::size_t by = isAsked ? bestRotation(there, asked->sectors, onBoundary) : 0;
    const bool passes = there.size() == (onBoundary ? 1 : 2);
    for (std::size_t i = 0; i < there.size() && (isAsked || passes); ++i)
    {
      const MeshSector& sector = there[i];
      if (sector.corners > 1)
      {
        turns[sector.first] =
          isAsked ? asked->sectors[(i + by) % there.size()].turns : kStraightTurns;
      }
    }
  }
  return turns;
}

std::vector<HeldSector> sectorsLike(const std::vector<HeldSector>& held, const Mesh& mesh, Index h)
{
  Index first = kInvalidIndex;
  forEachInFan(mesh, h,
    [&](Index g) {
      first = mesh.isConstrained(g) && (first == kInvalidIndex || mesh.isBoundary(g)) ? g : first;
    });
  std::vector<HeldSector> sectors;
  for (const MeshSector& sector : sectorsFrom(mesh, first))
  {
    const auto like = std::max_element(held.begin(), held.end(),
      [&](const HeldSector& a, const HeldSector& b)
      { return a.middle.dot(sector.middle) < b.middle.dot(sector.middle); });
    sectors.push_back({ sector.middle, like->turns });
  }
  return sectors;
}

} // namespace quadrille
