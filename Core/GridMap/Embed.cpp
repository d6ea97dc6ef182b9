// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "GridMap/Continuation.h"
#include "GridMap/GridMap.h"
#include "GridMap/LockedMap.h"
#include "GridMap/MapCheck.h"

#include <cmath>
#include <utility>

namespace quadrille
{
namespace
{

/// Moving a free vertex does not change the signed area of a map, so it tells the size that the integers
/// were made for, which may differ from the one that was asked.
double lengthOfUnit(const Mesh& mesh, const std::vector<FixedVec2>& uv, double edgeLength)
{
  double mapped = 0;
  double area = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Vector2 a = toDouble(uv[3 * f + 1] - uv[3 * f]);
    const Vector2 b = toDouble(uv[3 * f + 2] - uv[3 * f]);
    mapped += a.x() * b.y() - a.y() * b.x();
    area += mesh.edgeVector(3 * f).cross(mesh.edgeVector(3 * f + 1)).norm();
  }
  return mapped > 0 && area > 0 ? std::sqrt(area / mapped) : edgeLength;
}

UntangleOptions untangleOptions(double alignment, const ProgressCallback& progress)
{
  UntangleOptions options;
  options.alignmentWeight = alignment;
  options.areaWeight = 1;
  options.polishSteps = 6;
  options.progress = progress;
  return options;
}

struct Attempt
{
  const Eigen::VectorXd* start;
  double alignment;
};

/// Untangles until a start has led to a map without defects; keeps the one with the fewest.
MapDefects untangleLocked(const Mesh& mesh, const CrossField& field, const LockedMap& locked,
  const UntangleProblem& problem, const ProgressCallback& progress, EmbedResult& result)
{
  const Eigen::VectorXd given = locked.start();
  const Eigen::VectorXd poisson = fitReferences(problem);
  result.uv = locked.snap(given);
  MapDefects best = findDefects(mesh, field, result.uv);
  const bool givenFirst = best.count() <= findDefects(mesh, field, locked.snap(poisson)).count();
  const Eigen::VectorXd& first = givenFirst ? given : poisson;
  const Eigen::VectorXd& second = givenFirst ? poisson : given;
  bool tried = false;
  for (const Attempt& attempt :
    { Attempt{ &first, 1 }, Attempt{ &second, 1 }, Attempt{ &first, 0.01 }, Attempt{ &first, 30 } })
  {
    const UntangleResult untangled =
      untangle(problem, *attempt.start, untangleOptions(attempt.alignment, progress));
    std::vector<FixedVec2> uv = locked.snap(untangled.y);
    MapDefects defects = findDefects(mesh, field, uv);
    result.newtonSteps += untangled.steps;
    if (!tried || defects.count() < best.count())
    {
      best = std::move(defects);
      result.uv = std::move(uv);
    }
    tried = true;
    if (best.none())
    {
      break;
    }
  }
  return best;
}

/// Follows the way from the seamless map; result and defects change only if it leads to the end.
void embedFromSeamless(const Mesh& mesh, const CrossField& field, const LockedMap& locked,
  const UntangleProblem& problem, const EmbedOptions& options, EmbedResult& result,
  MapDefects& defects)
{
  const ContinuationResult way =
    continueToIntegers(mesh, field, *options.seamlessUv, locked, options.progress);
  result.newtonSteps += way.newtonSteps;
  if (!way.y)
  {
    return;
  }
  const UntangleResult polished = untangle(problem, *way.y, untangleOptions(1, options.progress));
  result.newtonSteps += polished.steps;
  for (const Eigen::VectorXd* y : { &polished.y, &*way.y })
  {
    std::vector<FixedVec2> uv = locked.snap(*y);
    MapDefects left = findDefects(mesh, field, uv);
    if (left.none())
    {
      result.uv = std::move(uv);
      defects = std::move(left);
      return;
    }
  }
}

void fail(const Mesh& mesh, StatusCode code, const std::string& message, const MapDefects& cause,
  EmbedResult& result)
{
  result.status = { code, "embedding: " + message };
  result.offenders = verticesOf(mesh, cause);
  result.inverted = findNotPositive(mesh, result.uv);
}

} // namespace

EmbedResult embedMap(const Mesh& mesh, const CrossField& field,
  const std::vector<FixedVec2>& integerUv, const EmbedOptions& options)
{
  if (!(options.edgeLength > 0) || !std::isfinite(options.edgeLength))
  {
    throw InvalidInput("embedding: the edge length must be positive and finite");
  }
  report(options.progress, 0, "embedding the map");
  EmbedResult result;
  const LockedMap locked(mesh, field, integerUv);
  MapDefects hopeless;
  hopeless.notPositive = locked.hopelessFaces();
  if (!hopeless.none())
  {
    result.uv = integerUv;
    fail(mesh, StatusCode::Infeasible,
      "the integers leave no area to faces " + listOf(hopeless.notPositive) +
        ", whose corners are all locked",
      hopeless, result);
    return result;
  }
  const UntangleProblem problem = locked.problem(lengthOfUnit(mesh, integerUv, options.edgeLength));
  MapDefects defects = untangleLocked(mesh, field, locked, problem, options.progress, result);
  if (!defects.none() && options.seamlessUv != nullptr)
  {
    embedFromSeamless(mesh, field, locked, problem, options, result, defects);
  }
  if (!defects.none())
  {
    fail(mesh, StatusCode::NotConverged, defects.text(), defects, result);
  }
  return result;
}

} // namespace quadrille
