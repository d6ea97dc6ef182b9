// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/FieldUntangling.h"

#include "Base/TryCount.h"

#include <algorithm>
#include <utility>

namespace quadrille
{
namespace
{

constexpr double kStiffening = 10;
/// Rounds with more weight, one after the other, that lessened nothing: in the runs looked at, a third one did not
/// either.
constexpr int kIdleRounds = 2;
/// More defects than this, or than one per so many faces, have a cause that no weight mends.
constexpr std::size_t kMany = 30;
constexpr std::size_t kFacesPerDefect = 64;
constexpr int kRequestSteps = 30;
/// Of guides against the energy that the map has anyway.
constexpr double kGuideWeight = 30;
/// Of the way from 1 to the limit, where the penalty begins: it is zero there and small at first, so that triangles
/// come to rest a little further on.
constexpr double kAnisotropyStart = 0.85;

/// Multiplies the weights of the faces that touch a defect, or touch one that does.
void stiffen(const Mesh& mesh, const MapDefects& defects, std::vector<double>& weight)
{
  std::vector<bool> near(mesh.vertexCount(), false);
  for (const Index v : verticesOf(mesh, defects))
  {
    near[v] = true;
  }
  const auto touches = [&](Index f)
  {
    const Index* v = &mesh.origin[3 * f];
    return near[v[0]] || near[v[1]] || near[v[2]];
  };
  std::vector<bool> ring = near;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    for (int i = 0; i < 3 && touches(f); ++i)
    {
      ring[mesh.origin[3 * f + i]] = true;
    }
  }
  near = ring;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    weight[f] *= touches(f) ? kStiffening : 1;
  }
}

} // namespace

UntangleOptions fieldUntangleOptions(const ProgressCallback& progress)
{
  UntangleOptions options;
  // Keeps the map rotated like the field, and with it the winding of the vertices.
  options.alignmentWeight = 1;
  // Equations without constants let a map shrink to a point; the area term keeps it from that.
  options.areaWeight = 1;
  options.polishSteps = 4;
  // Of 50 real coarse meshes none that needed more ended well.
  options.maximumSteps = 100;
  options.progress = progress;
  return options;
}

namespace
{

/// The same where a bound of work is reached; best: of earlier rounds, if there were some.
UntangleResult untangleOrTell(const Mesh& mesh, const CrossField& field,
  const UntangleProblem& problem, const Eigen::VectorXd& start, const UntangleOptions& options,
  const std::function<std::vector<FixedVec2>(const Eigen::VectorXd&)>& snap,
  const FieldUntangling& best)
{
  try
  {
    return untangle(problem, start, options);
  }
  catch (const UntanglingSpent& spent)
  {
    throw SpentInFaces(failedFacesOf(
      mesh, best.uv.empty() ? findDefects(mesh, field, snap(spent.y)) : best.defects));
  }
}

} // namespace

FieldUntangling untangleAlongField(const Mesh& mesh, const CrossField& field,
  const UntangleProblem& problem, const Eigen::VectorXd& start, int rounds,
  const std::function<std::vector<FixedVec2>(const Eigen::VectorXd&)>& snap,
  const ProgressCallback& progress, int maximumSteps)
{
  FieldUntangling best;
  UntangleOptions options = fieldUntangleOptions(progress);
  const int stepsOfAttempt = options.maximumSteps;
  UntangleProblem stiffened = problem;
  int idle = 0, kept = 0;
  const std::size_t many = std::max(kMany, mesh.faceCount() / kFacesPerDefect);
  for (int i = 0; i <= rounds; ++i)
  {
    if (maximumSteps > 0)
    {
      options.maximumSteps = std::min(stepsOfAttempt, maximumSteps - best.newtonSteps);
    }
    if (options.maximumSteps <= 0)
    {
      break;
    }
    if (i > 0)
    {
      countTry(Try::MoreWeight);
      stiffen(mesh, best.defects, stiffened.weight);
    }
    UntangleResult attempt = untangleOrTell(
      mesh, field, stiffened, i > 0 ? fitReferences(stiffened) : start, options, snap, best);
    best.newtonSteps += attempt.steps;
    if (i > 0 && findDefects(mesh, field, snap(attempt.y)).none())
    {
      // From a valid map no vertex can change its winding any more, whatever the weights.
      attempt = untangle(problem, attempt.y, options);
      best.newtonSteps += attempt.steps;
    }
    std::vector<FixedVec2> uv = snap(attempt.y);
    MapDefects defects = findDefects(mesh, field, uv);
    const bool better = i == 0 || defects.count() < best.defects.count();
    if (better)
    {
      best.defects = std::move(defects);
      best.uv = std::move(uv);
      best.y = std::move(attempt.y);
      kept = i;
    }
    idle = better ? 0 : idle + 1;
    if (best.defects.none() || idle >= kIdleRounds || best.defects.count() > many)
    {
      break;
    }
  }
  countTryLed(Try::MoreWeight, kept > 0 ? 1 : 0);
  return best;
}

void followRequests(const Mesh& mesh, const CrossField& field, const UntangleProblem& problem,
  double limit, const std::function<std::vector<FixedVec2>(const Eigen::VectorXd&)>& snap,
  const ProgressCallback& progress, FieldUntangling& untangling)
{
  const bool hasGuides = !problem.offAxis.empty();
  if ((limit == 0 && !hasGuides) || !untangling.defects.none())
  {
    return;
  }
  UntangleOptions options = fieldUntangleOptions(progress);
  if (limit > 0)
  {
    options.anisotropyLimit = 1 + kAnisotropyStart * (limit - 1);
    options.limitedTriangles = mesh.faceCount();
  }
  options.axisWeight = hasGuides ? kGuideWeight : 0;
  options.polishSteps = kRequestSteps;
  countTry(Try::RequestsFollowed);
  UntangleResult shaped = untangle(problem, untangling.y, options);
  untangling.newtonSteps += shaped.steps;
  std::vector<FixedVec2> uv = snap(shaped.y);
  if (findDefects(mesh, field, uv).none())
  {
    countTryLed(Try::RequestsFollowed);
    untangling.uv = std::move(uv);
    untangling.y = std::move(shaped.y);
  }
}

} // namespace quadrille
