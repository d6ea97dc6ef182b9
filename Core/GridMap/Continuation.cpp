// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/Continuation.h"

#include "Base/Angles.h"
#include "GridMap/MapShape.h"
#include "Numerics/Untangler.h"

#include <algorithm>
#include <cmath>

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

} // namespace

ContinuationResult continueToIntegers(const Mesh& mesh, const CrossField& field,
  const std::vector<FixedVec2>& seamlessUv, const LockedMap& integers,
  const ProgressCallback& progress)
{
  return Continuation(mesh, field, seamlessUv, integers, progress).run();
}

} // namespace quadrille
