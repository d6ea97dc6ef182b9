// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/Embed.h"

#include "Base/Refuse.h"
#include "Base/TryCount.h"
#include "GridMap/Continuation.h"
#include "GridMap/FieldUntangling.h"
#include "GridMap/LockedMap.h"
#include "GridMap/MapCheck.h"
#include "GridMap/MapShape.h"
#include "Mesh/Sizing.h"

#include <cmath>
#include <utility>

namespace quadrille
{
namespace
{

constexpr int kEmbedRounds = 3;

/// Moving a free vertex does not change the signed area of a map, so it tells the size that the integers
/// were made for, which may differ from the one that was asked.
double lengthOfUnit(
  const Mesh& mesh, const CrossField& field, const std::vector<FixedVec2>& uv, double edgeLength)
{
  double mapped = 0;
  double area = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    mapped += 2 * mappedArea(uv, f);
    area += areaStretch(field, f) *
      (mesh.sizing.empty() ? mesh.edgeVector(3 * f).cross(mesh.edgeVector(3 * f + 1)).norm()
                           : 2 * sizedArea(mesh, f));
  }
  return mapped > 0 && area > 0 ? std::sqrt(area / mapped) : edgeLength;
}

/// The given map or the Poisson solution, whichever has fewer defects. A start near an earlier map comes before them
/// where nothing is wrong with it.
Eigen::VectorXd startOf(const Mesh& mesh, const CrossField& field, const LockedMap& locked,
  const UntangleProblem& problem, const CarriedMap* previous, bool& fromPrevious)
{
  if (previous != nullptr && previous->knownFaces > 0)
  {
    countTry(Try::NearEmbedded);
    const UntangleProblem nearby = referToMap(problem, *previous, previous->uv, {}, 1);
    Eigen::VectorXd start = fitReferences(nearby);
    fromPrevious = findDefects(mesh, field, locked.snap(start)).none();
    if (fromPrevious)
    {
      countTryLed(Try::NearEmbedded);
      return start;
    }
  }
  Eigen::VectorXd given = locked.start(), fitted = fitReferences(problem);
  const auto defects = [&](const Eigen::VectorXd& start)
  { return findDefects(mesh, field, locked.snap(start)).count(); };
  return defects(fitted) < defects(given) ? fitted : given;
}

/// Follows the way from the seamless map; the map changes only if it leads to the end.
void embedFromSeamless(const Mesh& mesh, const CrossField& field, const LockedMap& locked,
  const UntangleProblem& problem, const EmbedOptions& options, FieldUntangling& untangling)
{
  countTry(Try::FromSeamless);
  const ContinuationResult way =
    continueToIntegers(mesh, field, *options.seamlessUv, locked, options.progress);
  untangling.newtonSteps += way.newtonSteps;
  if (!way.y)
  {
    return;
  }
  const UntangleResult polished = untangle(problem, *way.y, fieldUntangleOptions(options.progress));
  untangling.newtonSteps += polished.steps;
  for (const Eigen::VectorXd* y : { &polished.y, &*way.y })
  {
    std::vector<FixedVec2> uv = locked.snap(*y);
    MapDefects left = findDefects(mesh, field, uv);
    if (left.none())
    {
      countTryLed(Try::FromSeamless);
      untangling.uv = std::move(uv);
      untangling.y = *y;
      untangling.defects = std::move(left);
      return;
    }
  }
}

void failEmbedding(const Mesh& mesh, StatusCode code, const std::string& message,
  const MapDefects& cause, EmbedResult& result)
{
  result.status = { code, "embedding: " + message };
  result.offenders = verticesOf(mesh, cause);
  result.inverted = findNotPositive(mesh, result.uv);
}

} // namespace

EmbedResult embedMap(const Mesh& mesh, const CrossField& field,
  const std::vector<FixedVec2>& integerUv, const EmbedOptions& options)
{
  refuseIf(!(options.edgeLength > 0) || !std::isfinite(options.edgeLength),
    "embedding: the edge length must be positive and finite");
  checkAnisotropyLimit(options.anisotropyLimit);
  report(options.progress, 0, "embedding the map");
  EmbedResult result;
  const LockedMap locked(mesh, field, integerUv);
  const MapDefects hopeless = locked.hopeless();
  if (!hopeless.none())
  {
    result.uv = integerUv;
    failEmbedding(
      mesh, StatusCode::Infeasible, "the integers alone make " + hopeless.text(), hopeless, result);
    return result;
  }
  const UntangleProblem problem =
    locked.problem(lengthOfUnit(mesh, field, integerUv, options.edgeLength));
  const Eigen::VectorXd start =
    startOf(mesh, field, locked, problem, options.previous, result.startedFromPrevious);
  const auto snap = [&](const Eigen::VectorXd& y) { return locked.snap(y); };
  FieldUntangling untangled = untangleAlongField(
    mesh, field, problem, start, kEmbedRounds, Try::MoreWeightEmbedded, snap, options.progress);
  if (!untangled.defects.none() && options.seamlessUv != nullptr &&
    verticesOf(mesh, untangled.defects) != options.failedBefore)
  {
    embedFromSeamless(mesh, field, locked, problem, options, untangled);
  }
  followRequests(mesh, field, problem, options.anisotropyLimit, snap, options.progress, untangled);
  result.uv = std::move(untangled.uv);
  result.newtonSteps = untangled.newtonSteps;
  if (!untangled.defects.none())
  {
    failEmbedding(
      mesh, StatusCode::NotConverged, untangled.defects.text(), untangled.defects, result);
  }
  return result;
}

} // namespace quadrille
