// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/RemeshMemory.h"

#include "Mesh/ContentHash.h"

#include <utility>

namespace quadrille
{
namespace
{

template <typename T>
std::size_t bytesOf(const std::vector<T>& values)
{
  return values.capacity() * sizeof(T);
}

std::size_t bytesOf(const Mesh& mesh)
{
  return bytesOf(mesh.position) + bytesOf(mesh.origin) + bytesOf(mesh.twin) + bytesOf(mesh.flags) +
    bytesOf(mesh.sizing);
}

std::size_t bytesOf(const PreparedSurface& surface)
{
  return bytesOf(surface.mesh) + bytesOf(surface.sourcePolygon) + bytesOf(surface.sourcePoints) +
    bytesOf(surface.refinedEntry) + bytesOf(surface.cornerWeights);
}

void forgetRequests(PreparedSurface& surface)
{
  surface.polygonGuides.clear();
  surface.valenceRequests.clear();
  surface.unusedValences = 0;
}

/// 64 bits over guides and valences; in any order of magnitude smaller than the surface.
std::uint64_t requestsHash(const SurfaceInput& input)
{
  SurfaceInput requests;
  requests.points = input.guideDirections;
  requests.patchIds.assign(input.targetValences.begin(), input.targetValences.end());
  for (const double weight : input.guideWeights)
  {
    requests.points.emplace_back(weight, 0, 0);
  }
  return contentHash(requests, 1);
}

} // namespace

bool RemeshMemory::Key::preparesAs(const Key& other) const
{
  return input == other.input && featureAngle == other.featureAngle;
}

bool RemeshMemory::Key::refinesAs(const Key& other) const
{
  return preparesAs(other) && closeHandles == other.closeHandles && requests == other.requests &&
    removeSmallComponents == other.removeSmallComponents && edgeLength == other.edgeLength;
}

RemeshMemory::Key memoryKey(
  const SurfaceInput& input, std::optional<double> featureAngle, double closeHandles, int threads)
{
  RemeshMemory::Key key;
  key.input = contentHash(input, threads);
  key.featureAngle = featureAngle;
  key.closeHandles = closeHandles;
  key.requests = closeHandles > 0 ? requestsHash(input) : 0;
  return key;
}

std::size_t RemeshMemory::bytes() const
{
  std::size_t sum = bytesOf(before_.flags) + bytesOf(levelsKept);
  sum += surface_ ? bytesOf(*surface_) : 0;
  sum += prepared_ ? bytesOf(*prepared_) : 0;
  sum += map ? map->bytes() : 0;
  if (levels)
  {
    const Hierarchy& hierarchy = levels->hierarchy();
    sum += hierarchy.log.recordBytes() + hierarchy.cache.bytes + bytesOf(hierarchy.coarse.mesh) +
      2 * bytesOf(hierarchy.intermediate.mesh);
  }
  return sum;
}

void RemeshMemory::clear()
{
  levels.reset(); // before the surface that they refer to
  *this = {};
}

PreparedSurface RemeshMemory::refined() const
{
  return *surface_;
}

PreparedSurface RemeshMemory::prepared() const
{
  if (prepared_)
  {
    return *prepared_;
  }
  PreparedSurface surface = *surface_;
  surface.mesh.flags = before_.flags;
  surface.hash = before_.hash;
  surface.repair = before_.repair;
  surface.notice = before_.notice;
  return surface;
}

PreparedSurface RemeshMemory::takePrepared()
{
  levels.reset();
  PreparedSurface surface = prepared_ ? std::move(*prepared_) : prepared();
  clear();
  return surface;
}

void RemeshMemory::keep(const Key& key, PreparedSurface prepared, const PreparedSurface& refined,
  std::vector<std::string> notices)
{
  clear();
  auto surface = std::make_unique<PreparedSurface>(refined);
  if (!(key.closeHandles > 0))
  {
    forgetRequests(*surface);
  }
  area_ = prepared.area;
  boundingBoxDiagonal_ = prepared.boundingBoxDiagonal;
  if (refined.mesh.faceCount() != prepared.mesh.faceCount() || key.closeHandles > 0 ||
    key.removeSmallComponents || !refined.mesh.sizing.empty())
  {
    forgetRequests(prepared);
    prepared_ = std::move(prepared);
  }
  else
  {
    before_ = { std::move(prepared.mesh.flags), prepared.hash, prepared.repair, prepared.notice };
  }
  notices_ = std::move(notices);
  key_ = key;
  surface_ = std::move(surface); // the last, as it says that there is something
}

} // namespace quadrille
