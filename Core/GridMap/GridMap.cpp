// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/GridMap.h"

#include "Base/Refuse.h"
#include "Base/TryCount.h"
#include "Base/WorkCount.h"
#include "GridMap/FieldOfMap.h"
#include "GridMap/MapShape.h"
#include "Requests/DrawnLines.h"

#include <array>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

/// Lines are straight in it, unless there is none so.
GridMapResult mapWithLines(const Mesh& mesh, const GridMapOptions& options)
{
  const WorkScope work;
  GridMapResult map = mapInOneTry(mesh, options, true);
  if (!map.status.ok() && hasLines(options.curves))
  {
    countTry(Try::BentLines);
    GridMapResult bent = mapInOneTry(mesh, options, false);
    countTryLed(Try::BentLines, bent.status.ok() ? 1 : 0);
    bent.addWork(map);
    map = std::move(bent);
  }
  map.work = work.done();
  return map;
}

} // namespace

bool hasPromised(const Certificate& certificate, MapMethod method)
{
  switch (method)
  {
    case MapMethod::ScaleAware:
      return certificate.valid();
    case MapMethod::Seamless:
      return certificate.seamless();
    default:
      return certificate.whole();
  }
}

const char* nameOf(MapMethod method)
{
  constexpr std::array<const char*, 4> kNames{ "scale aware", "mixed integer", "QuadCover",
    "seamless" };
  return kNames[static_cast<std::size_t>(method)];
}

void MapWork::addWork(const MapWork& other)
{
  work += other.work;
  secondsField += other.secondsField;
  secondsSeamless += other.secondsSeamless;
  secondsQuantize += other.secondsQuantize;
  secondsEmbed += other.secondsEmbed;
  processorField += other.processorField;
  processorSeamless += other.processorSeamless;
  processorQuantize += other.processorQuantize;
  processorEmbed += other.processorEmbed;
  seamlessSteps += other.seamlessSteps;
  embedSteps += other.embedSteps;
}

GridMapResult computeGridMap(const Mesh& mesh, const GridMapOptions& options)
{
  refuseIf(!(options.edgeLength > 0) || !std::isfinite(options.edgeLength),
    "the target edge length must be a positive number");
  checkAnisotropyLimit(options.anisotropyLimit);
  refuseIf(options.anisotropyLimit > 0 &&
      (options.method == MapMethod::MixedInteger || options.method == MapMethod::QuadCover),
    "an anisotropy limit needs the scale aware or the seamless method");
  if (mesh.vertexCount() > options.maximumVertices)
  {
    GridMapResult result;
    result.status = { StatusCode::TooLarge,
      "the coarse level has " + std::to_string(mesh.vertexCount()) + " vertices, more than " +
        std::to_string(options.maximumVertices) +
        "; folds, noise or features hold them: smooth or repair the surface, raise the feature "
        "angle, or ask for longer "
        "edges" };
    return result;
  }
  refuseIf(options.previous != nullptr && options.vertexIds.size() != mesh.vertexCount(),
    "grid map: ", options.vertexIds.size(), " vertex ids for ", mesh.vertexCount(), " vertices");
  if (!options.stretch.empty() && options.stretch.size() != mesh.faceCount())
  {
    throw InvalidInput("grid map: " + std::to_string(options.stretch.size()) + " stretches for " +
      std::to_string(mesh.faceCount()) + " faces");
  }
  GridMapResult result = mapWithLines(mesh, options);
  if (!result.status.ok() && !options.seams.empty() && !options.fewIrregular)
  {
    GridMapOptions fewer = options;
    fewer.fewIrregular = true;
    countTry(Try::SeamsFewer);
    GridMapResult again = mapWithLines(mesh, fewer);
    if (again.status.ok())
    {
      countTryLed(Try::SeamsFewer);
      again.addWork(result);
      return again;
    }
  }
  if (result.reuse.any() && !result.status.ok())
  {
    GridMapOptions cold = options;
    cold.previous = nullptr;
    countTry(Try::WithoutEarlier);
    GridMapResult again = mapWithLines(mesh, cold);
    countTryLed(Try::WithoutEarlier, again.status.ok() ? 1 : 0);
    again.addWork(result);
    return again;
  }
  return result;
}

PreviousMap previousMap(
  const Mesh& mesh, const GridMapResult& map, const std::vector<Index>& vertexIds)
{
  assert(map.status.ok());
  return { mesh, vertexIds, map.field, map.seamlessUv, map.uv };
}

} // namespace quadrille
