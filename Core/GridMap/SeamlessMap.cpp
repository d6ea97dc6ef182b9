// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/SeamlessMap.h"

#include "Base/Refuse.h"
#include "Base/TryCount.h"
#include "GridMap/FieldUntangling.h"
#include "GridMap/MapCheck.h"
#include "GridMap/MapShape.h"
#include "GridMap/SeamlessSpace.h"
#include "Numerics/Untangler.h"

#include <cmath>
#include <utility>

namespace quadrille
{
namespace
{

void failSeamless(const Mesh& mesh, StatusCode code, const std::string& message,
  const MapDefects& defects, SeamlessResult& result)
{
  result.status = { code, "seamless map: " + message };
  result.inverted = defects.notPositive;
  if (result.failedFaces.empty())
  {
    result.failedFaces = failedFacesOf(mesh, defects);
  }
  if (result.failedAt.empty())
  {
    result.failedAt = verticesOf(mesh, defects);
  }
}

/// Tells what no choice of the unknowns can mend; true when there is such a thing.
bool findHopeless(const Mesh& mesh, const CrossField& field, const SeamlessSpace& space,
  const MapDefects& defects, SeamlessResult& result)
{
  result.failedAt = crowdedVertices(mesh, field);
  if (!result.failedAt.empty())
  {
    failSeamless(mesh, StatusCode::Infeasible,
      std::to_string(result.failedAt.size()) +
        " vertices have too few triangles for their quarter turns",
      defects, result);
    return true;
  }
  MapDefects collapsed;
  collapsed.notPositive = space.collapsedFaces(defects.notPositive);
  if (collapsed.notPositive.empty())
  {
    return false;
  }
  result.failedAt = verticesOf(mesh, collapsed);
  result.failedFaces = failedFacesOf(mesh, collapsed);
  failSeamless(mesh, StatusCode::Infeasible,
    "features and irregular vertices leave no area to " +
      std::to_string(collapsed.notPositive.size()) + " triangles",
    defects, result);
  return true;
}

/// The equations are homogeneous: a multiple of a seamless map is one, too.
std::vector<FixedVec2> snapScaled(
  const SeamlessSpace& space, const Eigen::VectorXd& y, double targetQuads)
{
  const double area = space.area(y);
  return space.snap(targetQuads > 0 && area > 0 ? y * std::sqrt(targetQuads / area) : y);
}

/// A start near the earlier map: where it knows a face, the shape that it has there takes the place of the one that the
/// field asks for. The earlier map was scaled, the start is not.
Eigen::VectorXd startNear(const Mesh& mesh, const SeamlessSpace& space, const CarriedMap& previous)
{
  double wanted = 0, mapped = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    if (previous.known[f] != 0)
    {
      const FixedVec2* p = &previous.seamlessUv[3 * f];
      wanted += space.problem().weight[f]; // its area in quads
      mapped +=
        0.5 * static_cast<double>(determinant(p[0], p[1], p[2])) / double(kOne) / double(kOne);
    }
  }
  return fitReferences(referToMap(space.problem(), previous, previous.seamlessUv,
    space.graph().comb, std::sqrt(wanted / mapped)));
}

/// Looks for the cause of what untangling has left.
void explain(
  const Mesh& mesh, const SeamlessSpace& space, const MapDefects& defects, SeamlessResult& result)
{
  const std::vector<Index> chords = space.flattenedChords();
  std::string cause;
  if (!chords.empty())
  {
    MapDefects ends = defects;
    ends.reversed.insert(ends.reversed.end(), chords.begin(), chords.end());
    result.failedAt = verticesOf(mesh, ends);
    result.failedFaces = failedFacesOf(mesh, ends);
    cause = "; " + std::to_string(chords.size()) +
      " edges are chords of straight features, with no vertex between them";
  }
  failSeamless(mesh, StatusCode::NotConverged, defects.text() + cause, defects, result);
}

} // namespace

SeamlessResult computeSeamlessMap(
  const Mesh& mesh, const CrossField& field, const SeamlessOptions& options)
{
  refuseIf(!(options.edgeLength > 0) || !std::isfinite(options.edgeLength) ||
      !(options.targetQuads >= 0) || !std::isfinite(options.targetQuads),
    "seamless map: edge length and target must be positive and finite");
  checkAnisotropyLimit(options.anisotropyLimit);
  SeamlessResult result;
  report(options.progress, 0, "seamless map");
  const SeamlessSpace space(mesh, field, options.edgeLength);
  if (!space.solved())
  {
    result.uv.assign(mesh.origin.size(), FixedVec2{});
    result.status = { StatusCode::NotConverged,
      "seamless map: the equations need more than 63 bits; fewer singularities would help" };
    return result;
  }
  Eigen::VectorXd start;
  MapDefects defects;
  if (options.previous != nullptr && options.previous->knownFaces > 0)
  {
    countTry(Try::NearSeamless);
    start = startNear(mesh, space, *options.previous);
    result.uv = snapScaled(space, start, options.targetQuads);
    result.startedFromPrevious = findDefects(mesh, field, result.uv).none();
    if (result.startedFromPrevious)
    {
      countTryLed(Try::NearSeamless);
    }
  }
  if (!result.startedFromPrevious)
  {
    start = fitReferences(space.problem());
    result.uv = snapScaled(space, start, options.targetQuads);
    defects = findDefects(mesh, field, result.uv);
  }
  if (findHopeless(mesh, field, space, defects, result))
  {
    return result;
  }
  const auto snap = [&](const Eigen::VectorXd& y)
  { return snapScaled(space, y, options.targetQuads); };
  FieldUntangling untangled =
    untangleAlongField(mesh, field, space.problem(), start, snap, options.progress);
  followRequests(
    mesh, field, space.problem(), options.anisotropyLimit, snap, options.progress, untangled);
  result.uv = std::move(untangled.uv);
  result.newtonSteps = untangled.newtonSteps;
  if (!untangled.defects.none())
  {
    explain(mesh, space, untangled.defects, result);
  }
  return result;
}

} // namespace quadrille
