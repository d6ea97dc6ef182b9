// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/QuantizeIntegers.h"

#include "Base/Lists.h"
#include "Base/TryCount.h"
#include "Base/WorkCount.h"
#include "Integers/StripSearch.h"
#include "Integers/StripSteps.h"
#include "Integers/StripWays.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

namespace quadrille
{

namespace
{

/// Energies are of order one; changes below this are rounding.
constexpr double kLeastEnergyGain = 1e-7;
/// Steps of searches that a repair may take, a face; those of rounded integers that succeeded took up to 4,100, others
/// more than 11,000.
constexpr std::size_t kMostIntegerSteps = 5000;
/// Rounds of improvement with a new triangulation each.
constexpr int kMaximumRounds = 6;

std::vector<FixedVec2> stepsIn(FixedVec2 p)
{
  std::vector<FixedVec2> steps;
  if (p.u != 0)
  {
    steps.push_back({ p.u > 0 ? kGrain : -kGrain, 0 });
  }
  if (p.v != 0)
  {
    steps.push_back({ 0, p.v > 0 ? kGrain : -kGrain });
  }
  return steps;
}

/// Carries the residuals of all triangles to each other, or out. False when one cannot leave its face.
bool closeTriangles(IntegerMap& map, StripSearch& search)
{
  std::vector<FixedVec2> residuals(map.mesh().alive.size());
  for (const Index f : map.faces())
  {
    residuals[f] = map.residual(f);
  }
  for (const Index f : map.faces())
  {
    while (residuals[f] != FixedVec2{})
    {
      poll();
      Strip best;
      for (const FixedVec2 e : stepsIn(residuals[f]))
      {
        const Strip strip = search.discharge(f, e, residuals);
        if (strip.found() && strip.cost < best.cost)
        {
          best = strip;
        }
      }
      if (!best.found())
      {
        return false;
      }
      apply(map, best);
      for (const Index touched : crossedFaces(map.mesh(), best).faces)
      {
        residuals[touched] = map.residual(touched);
      }
    }
  }
  return true;
}

/// Lengthens boundary loops that are too short for quads, by the strip that costs least each time. One where no strip
/// keeps all triangles sound stays as it is.
void lengthenLoops(IntegerMap& map, StripSearch& search)
{
  const auto accept = [&](const Strip& strip)
  {
    const std::int64_t before = map.shortageOfLoops();
    const CrossedFaces crossed = crossedFaces(map.mesh(), strip);
    apply(map, strip);
    if (map.shortageOfLoops() < before && brokenness(map, crossed.faces) == 0 &&
      (!crossed.repeated || map.isValid()))
    {
      return true;
    }
    revert(map, strip);
    return false;
  };
  bool changed = true;
  while (changed && map.shortageOfLoops() > 0)
  {
    poll();
    std::vector<Strip> strips;
    for (const Index h : map.shortLoops())
    {
      strips.push_back(search.through(h, map.along(h), kInfinity));
    }
    std::stable_sort(
      strips.begin(), strips.end(), [](const Strip& a, const Strip& b) { return a.cost < b.cost; });
    changed = std::any_of(strips.begin(), strips.end(),
      [&](const Strip& strip) { return strip.found() && accept(strip); });
  }
}

/// Mends broken triangles by steps that lower the weighted sum of what is broken. A triangle at which nothing helps
/// gains weight, so that others are broken in its stead and mended where there is more room (the breakout
/// method of local search); the number of times that this may happen is bounded.
class Repair
{
public:
  explicit Repair(IntegerMap& map)
    : map_(map), weight_(map.mesh().alive.size(), 1), search_(map, StripCost::Repair, &weight_),
      breakouts_(kBreakouts + map.faces().size() / 4)
  {
  }

  std::size_t steps() const { return search_.work(); }
  bool hasBrokenOut() const { return hasBrokenOut_; }

  bool run()
  {
    while (true)
    {
      poll();
      const Index worst = firstBroken();
      if (worst == kInvalidIndex)
      {
        return true;
      }
      if (flipAt(worst) || moveAt(worst) || stripAt(worst))
      {
        continue;
      }
      if (breakouts_ == 0 || search_.work() > kMostIntegerSteps * map_.faces().size())
      {
        return false;
      }
      countTry(Try::Breakout);
      hasBrokenOut_ = true;
      --breakouts_;
      weight_[worst] *= 2;
    }
  }

private:
  /// Goes round the faces, so that no face starves the others.
  Index firstBroken()
  {
    const std::vector<Index>& faces = map_.faces();
    for (std::size_t i = 0; i < faces.size(); ++i)
    {
      position_ = position_ + 1 < faces.size() ? position_ + 1 : 0;
      if (!map_.isSound(faces[position_]))
      {
        return faces[position_];
      }
    }
    return kInvalidIndex;
  }

  double weighted(Index f, std::int64_t determinant) const
  {
    return weight_[f] * static_cast<double>(IntegerMap::brokenness(determinant));
  }

  double weighted(const std::vector<Index>& faces) const
  {
    double sum = 0;
    for (const Index f : faces)
    {
      sum += weighted(f, map_.determinant(f));
    }
    return sum;
  }

  /// Flips the edge of f that leaves least broken, if that is less than now.
  bool flipAt(Index f)
  {
    Index best = kInvalidIndex;
    double bestChange = -kLeastMend;
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      if (!map_.mayFlip(h))
      {
        continue;
      }
      const auto after = map_.flippedDeterminants(h);
      const Index other = Mesh::face(map_.mesh().twin[h]);
      const double change =
        weighted(f, after[0]) + weighted(other, after[1]) - weighted({ f, other });
      if (change < bestChange)
      {
        bestChange = change;
        best = h;
      }
    }
    if (best != kInvalidIndex)
    {
      map_.flip(best);
    }
    return best != kInvalidIndex;
  }

  /// Moves a corner of f that need not be whole.
  bool moveAt(Index f)
  {
    const std::vector<Index>& all = map_.freeVertices();
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      const Index v = map_.mesh().origin[h];
      if (std::binary_search(all.begin(), all.end(), v) && moveVertex(v))
      {
        return true;
      }
    }
    return false;
  }

  bool moveVertex(Index v)
  {
    const std::vector<Index> faces = facesAround(map_.mesh(), v);
    const double before = weighted(faces);
    double bestChange = -kLeastMend;
    FixedVec2 best;
    for (std::int64_t length = kGrain; length >= 1; length /= 2)
    {
      for (int direction = 0; direction < 4; ++direction)
      {
        const FixedVec2 e = stepVector(direction, length);
        if (!map_.mayMove(v, e))
        {
          continue;
        }
        map_.moveVertex(v, e);
        const double change = weighted(faces) - before;
        map_.moveVertex(v, -e);
        if (change < bestChange)
        {
          bestChange = change;
          best = e;
        }
      }
    }
    if (best != FixedVec2{})
    {
      map_.moveVertex(v, best);
    }
    return best != FixedVec2{};
  }

  bool stripAt(Index f)
  {
    Strip best;
    std::pair<double, double> bestChange{ -kLeastMend, 0 };
    double bound = 0;
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      for (int direction = 0; direction < 4; ++direction)
      {
        const FixedVec2 e = stepVector(direction, kGrain);
        if (!map_.mayShift(h, e))
        {
          continue;
        }
        Strip strip = search_.through(h, e, bound);
        if (!strip.found())
        {
          continue;
        }
        const auto change = measure(strip);
        if (change < bestChange)
        {
          bound = std::min(bound, strip.cost);
          bestChange = change;
          best = std::move(strip);
        }
      }
    }
    apply(map_, best);
    return best.found();
  }

  /// Change of what is broken, and of the energy.
  std::pair<double, double> measure(const Strip& strip)
  {
    const std::vector<Index> faces = crossedFaces(map_.mesh(), strip).faces;
    const double before = weighted(faces);
    const double energy = applyMeasured(map_, strip);
    const double after = weighted(faces);
    revert(map_, strip);
    return { after - before, energy };
  }

  static constexpr double kLeastMend = 0.5; ///< below one unit of brokenness
  static constexpr std::size_t kBreakouts = 40;

  IntegerMap& map_;
  std::vector<double> weight_; ///< #F
  StripSearch search_;
  std::size_t breakouts_;
  bool hasBrokenOut_ = false;
  std::size_t position_ = 0;
};

class Improvement
{
public:
  explicit Improvement(IntegerMap& map)
    : map_(map), search_(map, StripCost::KeepSound), ways_(map),
      changed_(map.mesh().alive.size(), 0)
  {
  }

  void run(const ProgressCallback& progress)
  {
    std::int64_t longest = longestStep();
    for (int round = 0; round < kMaximumRounds; ++round)
    {
      bool improved = false;
      for (std::int64_t length = longest; length >= kGrain; length /= 2)
      {
        refused_.assign(4 * map_.mesh().origin.size(), {});
        report(progress, 0.5, "improving integers");
        settleFreeVertices();
        while (sweepStrips(length))
        {
          improved = true;
          report(progress, 0.5, "improving integers");
          settleFreeVertices();
        }
      }
      if (!improved)
      {
        break;
      }
      map_.makeDelaunay();
      ways_.forget();
      longest = kGrain;
    }
  }

private:
  struct Candidate
  {
    double gain;
    Index halfEdge;
    int direction;
  };

  /// The largest step that could still bring a half-edge nearer to what is wanted.
  std::int64_t longestStep() const
  {
    double farthest = 0;
    for (const Index f : map_.faces())
    {
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        const Vector2 target = double(kGrain) * map_.target(h);
        farthest = std::max({ farthest, std::abs(static_cast<double>(map_[h].u) - target.x()),
          std::abs(static_cast<double>(map_[h].v) - target.y()) });
      }
    }
    std::int64_t length = kGrain;
    while (static_cast<double>(2 * length) < farthest)
    {
      length *= 2;
    }
    return length;
  }

  std::vector<Candidate> candidates(std::int64_t length) const
  {
    std::vector<Candidate> result;
    for (const Index f : map_.faces())
    {
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        for (int direction = 0; map_.mesh().twin[h] >= h && direction < 4; ++direction)
        {
          const FixedVec2 e = stepVector(direction, length);
          const double gain = -map_.energyChange(h, e);
          if (gain > kLeastEnergyGain && map_.mayShift(h, e))
          {
            result.push_back({ gain, h, direction });
          }
        }
      }
    }
    std::sort(result.begin(), result.end(),
      [](const Candidate& a, const Candidate& b) {
        return std::tie(b.gain, a.halfEdge, a.direction) <
          std::tie(a.gain, b.halfEdge, b.direction);
      });
    return result;
  }

  bool sweepStrips(std::int64_t length)
  {
    bool improved = false;
    for (const Candidate& candidate : candidates(length))
    {
      poll();
      const FixedVec2 e = stepVector(candidate.direction, length);
      Refusal& refusal = refused_[4 * candidate.halfEdge + candidate.direction];
      double gain = -map_.energyChange(candidate.halfEdge, e);
      while (gain > kLeastEnergyGain && !isUpToDate(refusal) &&
        mayHaveStrip(candidate.halfEdge, e, gain) &&
        accept(search_.through(candidate.halfEdge, e, gain), refusal))
      {
        improved = true;
        gain = -map_.energyChange(candidate.halfEdge, e);
      }
    }
    return improved;
  }

  /// A search that led to nothing, and the faces that it depends on.
  struct Refusal
  {
    std::uint64_t time = 0; ///< of the clock; 0: none
    std::vector<Index> faces;
  };

  bool isUpToDate(const Refusal& refusal) const
  {
    return refusal.time > 0 &&
      std::all_of(refusal.faces.begin(), refusal.faces.end(),
        [&](Index f) { return changed_[f] <= refusal.time; });
  }

  /// Ways tell of a single map and gain, and take as long as some searches: they are found when searches have taken as
  /// many steps for nothing.
  bool mayHaveStrip(Index h, FixedVec2 e, double gain)
  {
    if (wasted_ > ways_.states())
    {
      ways_.find(IntegerMap::lengthOf(e), gain);
      wasted_ = 0;
    }
    return ways_.mayHave(h, e, gain);
  }

  void touch(const std::vector<Index>& faces)
  {
    ways_.forget();
    ++clock_;
    for (const Index f : faces)
    {
      changed_[f] = clock_;
    }
  }

  bool accept(const Strip& strip, Refusal& refusal)
  {
    const std::size_t steps = search_.work() - std::exchange(stepsBefore_, search_.work());
    bool localReason = true;
    if (strip.found())
    {
      const CrossedFaces crossed = crossedFaces(map_.mesh(), strip);
      const std::int64_t shortage = map_.shortageOfLoops();
      const double change = applyMeasured(map_, strip);
      if (map_.shortageOfLoops() > shortage)
      {
        localReason = false;
      }
      else if (change < -kLeastEnergyGain && brokenness(map_, crossed.faces) == 0)
      {
        // A triangle that is crossed once keeps its sign on the way, so the winding cannot change; one that
        // is crossed twice may be rotated by 180 degrees.
        if (!crossed.repeated || map_.isValid())
        {
          touch(crossed.faces);
          return true;
        }
        localReason = false;
      }
      revert(map_, strip);
    }
    wasted_ += steps;
    refusal.time = localReason ? clock_ : 0;
    refusal.faces = search_.visitedFaces();
    return false;
  }

  /// Moves cost next to nothing beside searches, each of which they make out of date.
  void settleFreeVertices()
  {
    while (moveFreeVertices())
    {
    }
  }

  bool moveFreeVertices()
  {
    bool improved = false;
    for (const Index v : map_.freeVertices())
    {
      const std::vector<Index> faces = facesAround(map_.mesh(), v);
      for (std::int64_t length = kGrain; length >= 1; length /= 2)
      {
        for (int direction = 0; direction < 4; ++direction)
        {
          const FixedVec2 e = stepVector(direction, length);
          while (map_.mayMove(v, e) && map_.moveEnergy(v, e) < -kLeastEnergyGain)
          {
            map_.moveVertex(v, e);
            if (brokenness(map_, faces) > 0)
            {
              map_.moveVertex(v, -e);
              break;
            }
            touch(faces);
            improved = true;
          }
        }
      }
    }
    return improved;
  }

  IntegerMap& map_;
  StripSearch search_;
  StripWays ways_;
  std::size_t stepsBefore_ = 0; ///< of all searches but the last one
  std::size_t wasted_ = 0;      ///< steps of searches that found nothing, since ways were found
  std::uint64_t clock_ = 1;
  std::vector<std::uint64_t> changed_; ///< #F: time of the last change
  std::vector<Refusal> refused_;       ///< 4 #H: by half-edge and direction, for one length of step
};

} // namespace

IntegerStart repairIntegers(IntegerMap& map)
{
  IntegerStart start;
  StripSearch search(map, StripCost::Repair);
  const bool closed = closeTriangles(map, search);
  start.steps = search.work();
  if (closed)
  {
    Repair repair(map);
    start.valid = repair.run() && map.isValid();
    if (start.valid && repair.hasBrokenOut())
    {
      countTryLed(Try::Breakout);
    }
    start.steps += repair.steps();
  }
  if (start.valid && map.shortageOfLoops() > 0)
  {
    StripSearch lengthening(map, StripCost::KeepSound);
    lengthenLoops(map, lengthening);
  }
  return start;
}

IntegerStart findValidIntegers(IntegerMap& map, const ProgressCallback& progress)
{
  IntegerStart start;
  for (; start.scale <= kMaximumScale; start.scale *= std::sqrt(2.0))
  {
    report(progress, 0.2, "rounding at scale " + std::to_string(start.scale));
    if (start.scale > 1)
    {
      countTry(Try::FinerScale);
    }
    map.round(start.scale);
    const IntegerStart atScale = repairIntegers(map);
    start.steps += atScale.steps;
    start.valid = atScale.valid;
    if (start.valid && start.scale > 1)
    {
      countTryLed(Try::FinerScale);
    }
    // What fails at two scales in full fails at the others, too.
    if (start.valid || start.steps > 2 * kMostIntegerSteps * map.faces().size())
    {
      return start;
    }
  }
  return start;
}

std::vector<Index> brokenFaces(const IntegerMap& map)
{
  std::vector<Index> broken;
  std::copy_if(map.faces().begin(), map.faces().end(), std::back_inserter(broken),
    [&](Index f) { return map.residual(f) != FixedVec2{} || !map.isSound(f); });
  if (broken.empty())
  {
    for (const Index v : map.wrongWindings())
    {
      append(broken, facesAround(map.mesh(), v));
    }
    sortUnique(broken);
  }
  return broken;
}

void improveIntegers(IntegerMap& map, const ProgressCallback& progress)
{
  const WorkScope scope(workLeft() / 2);
  try
  {
    Improvement(map).run(progress);
  }
  catch (const WorkSpent&)
  {
    // What was improved so far is valid; where the whole bound is reached, the next step tells.
  }
}

} // namespace quadrille
