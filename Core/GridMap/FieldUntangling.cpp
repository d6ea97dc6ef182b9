// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/FieldUntangling.h"

#include "Base/TryCount.h"
#include "Mesh/BreadthFirst.h"
#include "Numerics/LocalProblem.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace quadrille
{
namespace
{

/// Newton steps: of 50 real coarse meshes none that needed more ended well.
constexpr int kMostNewtonSteps = 100;
/// Of the whole map: what is left after these is a matter of some places.
constexpr int kStepsOfWhole = 30;
/// Of the map near such places: so many rings of triangles round each, which have this many times the weight next to
/// it, in each round again.
constexpr int kRings = 8;
/// All of it together may take as much work as the whole map took times this: what takes longer is no matter of places.
constexpr std::size_t kWorkNearby = 2;
constexpr double kStiffening = 10;
/// Rounds with more weight, one after the other, that lessened nothing: in the runs looked at, a third one did not
/// either.
constexpr int kIdleRounds = 2;
/// A valid map has converged where a step lessens its energy by a smaller share.
constexpr double kLeastGain = 0.01;

} // namespace

UntangleOptions fieldUntangleOptions(const ProgressCallback& progress)
{
  UntangleOptions options;
  // Keeps the map rotated like the field, and with it the winding of the vertices.
  options.alignmentWeight = 1;
  // Equations without constants let a map shrink to a point; the area term keeps it from that.
  options.areaWeight = 1;
  // Most maps have converged by then. One whose vertices came back to slivers, as along features without a corner, is
  // positive but far from its minimum: its quads would be longer than wide by hundreds.
  options.polishSteps = 4;
  options.leastGain = kLeastGain;
  options.maximumSteps = kMostNewtonSteps;
  options.progress = progress;
  return options;
}

namespace
{

class Untangling
{
public:
  Untangling(const Mesh& mesh, const CrossField& field, const UntangleProblem& problem,
    const Snap& snap, const ProgressCallback& progress)
    : mesh_(mesh), field_(field), problem_(problem), snap_(snap),
      options_(fieldUntangleOptions(progress)), weight_(problem.weight)
  {
  }

  FieldUntangling run(const Eigen::VectorXd& start)
  {
    options_.maximumSteps = kStepsOfWhole;
    UntangleResult first = ofWhole(start);
    const std::size_t work = first.work;
    keepIfBetter(std::move(first));
    if (best_.defects.none())
    {
      return std::move(best_);
    }
    mendNearby(kWorkNearby * work);
    if (best_.defects.none())
    {
      countTryLed(Try::MoreWeight);
      // From a valid map no vertex can change its winding any more: without the weights, until that has converged.
      options_.polishSteps = options_.maximumSteps = kMostNewtonSteps;
      best_ = mapOf(ofWhole(best_.y));
    }
    return std::move(best_);
  }

private:
  /// Where the bound of work is reached, that tells how far it came.
  UntangleResult ofWhole(const Eigen::VectorXd& start) const
  {
    try
    {
      return untangle(problem_, start, options_);
    }
    catch (const UntanglingSpent& spent)
    {
      throw SpentInFaces(failedFacesOf(mesh_, findDefects(mesh_, field_, snap_(spent.y))));
    }
  }

  /// With the steps of all attempts.
  FieldUntangling mapOf(UntangleResult&& result) const
  {
    FieldUntangling map;
    map.uv = snap_(result.y);
    map.y = std::move(result.y);
    map.defects = findDefects(mesh_, field_, map.uv);
    map.newtonSteps = best_.newtonSteps + result.steps;
    return map;
  }

  bool keepIfBetter(UntangleResult&& result)
  {
    FieldUntangling map = mapOf(std::move(result));
    const bool isBetter = best_.uv.empty() || map.defects.count() < best_.defects.count();
    best_.newtonSteps = map.newtonSteps;
    if (isBetter)
    {
      best_ = std::move(map);
    }
    return isBetter;
  }

  void mendNearby(std::size_t mostWork)
  {
    try
    {
      const WorkScope scope(mostWork);
      options_.maximumSteps = kMostNewtonSteps;
      for (int idle = 0; !best_.defects.none() && idle < kIdleRounds;)
      {
        countTry(Try::MoreWeight);
        idle = keepIfBetter(nearby()) ? 0 : idle + 1;
      }
    }
    catch (const WorkSpent&)
    {
      if (workLeft() == 0)
      {
        throw SpentInFaces(failedFacesOf(mesh_, best_.defects));
      }
    }
  }

  /// The map near its defects again, from its references with more weight next to them; all else is held.
  UntangleResult nearby()
  {
    const std::vector<int> ring = ringsFrom(mesh_, verticesOf(mesh_, best_.defects), kRings);
    std::vector<std::uint8_t> isNear(static_cast<std::size_t>(problem_.basis.rows()) / 2, 0);
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      isNear[problem_.triangles[Mesh::face(h)][h % 3]] |= ring[mesh_.origin[h]] <= kRings ? 1 : 0;
    }
    LocalProblem local = localProblem(problem_, best_.y, isNear);
    for (std::size_t t = 0; t < local.triangles.size(); ++t)
    {
      const Index f = local.triangles[t];
      if (f < mesh_.faceCount())
      {
        const Index* v = &mesh_.origin[3 * f];
        weight_[f] *= std::min({ ring[v[0]], ring[v[1]], ring[v[2]] }) <= 1 ? kStiffening : 1;
        local.problem.weight[t] = weight_[f];
      }
    }
    UntangleResult result = untangle(local.problem, fitReferences(local.problem), options_);
    result.y = local.put(result.y, best_.y);
    return result;
  }

  const Mesh& mesh_;
  const CrossField& field_;
  const UntangleProblem& problem_;
  const Snap& snap_;
  UntangleOptions options_;
  std::vector<double> weight_; ///< of all rounds nearby, per triangle
  FieldUntangling best_;
};

} // namespace

FieldUntangling untangleAlongField(const Mesh& mesh, const CrossField& field,
  const UntangleProblem& problem, const Eigen::VectorXd& start, const Snap& snap,
  const ProgressCallback& progress)
{
  return Untangling(mesh, field, problem, snap, progress).run(start);
}

void followRequests(const Mesh& mesh, const CrossField& field, const UntangleProblem& problem,
  double limit, const Snap& snap, const ProgressCallback& progress, FieldUntangling& untangling)
{
  const bool hasGuides = !problem.offAxis.empty();
  if ((limit == 0 && !hasGuides) || !untangling.defects.none())
  {
    return;
  }
  // Of guides against the energy that the map has anyway.
  constexpr double kGuideWeight = 30;
  // Of the way from 1 to the limit, where the penalty begins: it is zero there and small at first, so that triangles
  // come to rest a little further on.
  constexpr double kAnisotropyStart = 0.85;
  UntangleOptions options = fieldUntangleOptions(progress);
  if (limit > 0)
  {
    options.anisotropyLimit = 1 + kAnisotropyStart * (limit - 1);
    options.limitedTriangles = mesh.faceCount();
  }
  options.axisWeight = hasGuides ? kGuideWeight : 0;
  options.polishSteps = kStepsOfWhole;
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
