// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/Embed.h"

#include "Base/Angles.h"
#include "Base/Refuse.h"
#include "Base/TryCount.h"
#include "GridMap/FieldUntangling.h"
#include "GridMap/LockedMap.h"
#include "GridMap/MapCheck.h"
#include "GridMap/MapShape.h"
#include "Mesh/Sizing.h"
#include "Numerics/Untangler.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille
{
namespace
{

constexpr double kFirstStep = 0.25;
/// On the models in the data, no way that led to the end needed a shorter one.
constexpr double kShortestStep = 1.0 / 256;
constexpr int kMaximumTries = 80;
/// Steps that start with more inverted triangles than this are halved before a solver is asked.
constexpr int kFewInverted = 4;
constexpr double kAlwaysTried = 1.0 / 64;

Vector2 edge(const Eigen::VectorXd& x, Index from, Index to)
{
  return x.segment<2>(2 * Eigen::Index(to)) - x.segment<2>(2 * Eigen::Index(from));
}

/// Measures the map against the seamless one, whose coordinates are x, instead of the surface: there the way
/// begins without stress. Holds for the faces and for the guards of constrained edges behind them.
void referTo(const Eigen::VectorXd& x, Index faces, UntangleProblem& problem)
{
  for (std::size_t t = 0; t < problem.triangles.size(); ++t)
  {
    const std::array<Index, 3>& points = problem.triangles[t];
    Eigen::Matrix2d reference;
    reference << edge(x, points[0], points[1]), edge(x, points[0], points[2]);
    problem.inverseReference[t] = reference.inverse();
    problem.weight[t] =
      t < faces ? 0.5 * reference.determinant() : kGuardWeight * reference.col(0).squaredNorm();
  }
}

class Continuation
{
public:
  Continuation(const Mesh& mesh, const CrossField& field, const std::vector<FixedVec2>& seamlessUv,
    const LockedMap& integers, const ProgressCallback& progress)
    : mesh_(mesh), field_(field)
  {
    const LockedMap begin(mesh, field, seamlessUv, false);
    problem_ = integers.problem(1);
    endOffset_ = problem_.offset;
    y_ = begin.start();
    beginOffset_ = begin.problem(1).offset;
    referTo(problem_.basis * y_ + beginOffset_, mesh.faceCount(), problem_);
    const Eigen::VectorXd endFit = fitReferences(problem_);
    problem_.offset = beginOffset_;
    direction_ = endFit - fitReferences(problem_);
    options_.alignmentWeight = 1;
    options_.areaWeight = 1;
    options_.polishSteps = 2;
    options_.maximumSteps = 60;
    options_.progress = progress;
  }

  ContinuationResult run()
  {
    ContinuationResult result;
    double step = kFirstStep;
    for (int i = 0; i < kMaximumTries && result.reached < 1 && step >= kShortestStep; ++i)
    {
      step = std::min(step, 1 - result.reached); // a longer one would be the same again
      if (advance(result, result.reached + step))
      {
        result.reached += step;
        step *= 2;
      }
      else
      {
        step /= 2;
      }
    }
    if (result.reached == 1)
    {
      result.y = y_;
    }
    return result;
  }

private:
  bool advance(ContinuationResult& result, double next)
  {
    const double step = next - result.reached;
    problem_.offset = (1 - next) * beginOffset_ + next * endOffset_;
    const Eigen::VectorXd ahead = y_ + step * direction_;
    const int invertedAhead = countInverted(ahead), invertedHere = countInverted(y_);
    if (std::min(invertedAhead, invertedHere) > kFewInverted && step > kAlwaysTried)
    {
      return false;
    }
    const UntangleResult untangled =
      untangle(problem_, invertedAhead <= invertedHere ? ahead : y_, options_);
    result.newtonSteps += untangled.steps;
    result.blocked.clear();
    for (const Index t : untangled.inverted)
    {
      result.blocked.push_back(Mesh::face(problem_.triangles[t][0])); // points are corners
    }
    if (!untangled.inverted.empty() || !windsAsField(untangled.y))
    {
      return false;
    }
    y_ = untangled.y;
    return true;
  }

  int countInverted(const Eigen::VectorXd& y) const
  {
    const Eigen::VectorXd x = problem_.basis * y + problem_.offset;
    return static_cast<int>(std::count_if(problem_.triangles.begin(), problem_.triangles.end(),
      [&](const std::array<Index, 3>& t)
      { return !(parallelogram(edge(x, t[0], t[1]), edge(x, t[0], t[2])) > 0); }));
  }

  /// Where every determinant is positive the angle sums are multiples of 90 degrees but for rounding.
  bool windsAsField(const Eigen::VectorXd& y) const
  {
    const Eigen::VectorXd x = problem_.basis * y + problem_.offset;
    std::vector<double> angle(mesh_.vertexCount(), 0);
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      const Vector2 a = edge(x, h, Mesh::next(h)), b = edge(x, h, Mesh::previous(h));
      angle[mesh_.origin[h]] += std::atan2(parallelogram(a, b), a.dot(b));
    }
    for (Index v = 0; v < mesh_.vertexCount(); ++v)
    {
      if (std::lround(angle[v] / kRightAngle) != field_.turns[v])
      {
        return false;
      }
    }
    return true;
  }

  const Mesh& mesh_;
  const CrossField& field_;
  UntangleProblem problem_;
  Eigen::VectorXd beginOffset_, endOffset_;
  Eigen::VectorXd direction_; ///< of the unknowns that fit best, over the whole way
  Eigen::VectorXd y_;
  UntangleOptions options_;
};

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
      (mesh.sizing.empty() ? mesh.doubleAreaNormal(f).norm() : 2 * sizedArea(mesh, f));
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
  result.failedAt = verticesOf(mesh, cause);
  result.failedFaces = failedFacesOf(mesh, cause);
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

ContinuationResult continueToIntegers(const Mesh& mesh, const CrossField& field,
  const std::vector<FixedVec2>& seamlessUv, const LockedMap& integers,
  const ProgressCallback& progress)
{
  return Continuation(mesh, field, seamlessUv, integers, progress).run();
}

} // namespace quadrille
