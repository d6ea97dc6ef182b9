// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/QuantizeIntegers.h"

#include "GridMap/StripSearch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace quadrille
{

namespace
{

/// Energies are of order one; changes below this are rounding.
constexpr double kLeastGain = 1e-7;
/// Sweeps of the improvement; it ends by itself long before.
constexpr int kMaximumSweeps = 100;

int signOf(std::int64_t x)
{
  return (x > 0) - (x < 0);
}

std::vector<FixedVec2> unitsIn(FixedVec2 p)
{
  std::vector<FixedVec2> units;
  if (p.u != 0)
  {
    units.push_back({ signOf(p.u), 0 });
  }
  if (p.v != 0)
  {
    units.push_back({ 0, signOf(p.v) });
  }
  return units;
}

void apply(IntegerMap& map, const Strip& strip)
{
  for (const StripStep& step : strip.steps)
  {
    map.shift(step.halfEdge, step.e);
  }
}

void revert(IntegerMap& map, const Strip& strip)
{
  for (const StripStep& step : strip.steps)
  {
    map.shift(step.halfEdge, -step.e);
  }
}

/// Applies and returns the change of energy.
double applyMeasured(IntegerMap& map, const Strip& strip)
{
  double change = 0;
  for (const StripStep& step : strip.steps)
  {
    change += map.energyChange(step.halfEdge, step.e);
    map.shift(step.halfEdge, step.e);
  }
  return change;
}

/// The faces that a strip crosses, each once; repeated tells whether it crosses one twice.
std::vector<Index> facesOf(const IntegerDomain& domain, const Strip& strip, bool& repeated)
{
  std::vector<Index> faces;
  for (const StripStep& step : strip.steps)
  {
    faces.push_back(Mesh::face(step.halfEdge));
    if (domain.twin[step.halfEdge] != kInvalidIndex)
    {
      faces.push_back(Mesh::face(domain.twin[step.halfEdge]));
    }
  }
  std::sort(faces.begin(), faces.end());
  const std::size_t sides = faces.size();
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  // Each face is entered once and left once.
  repeated = sides > 2 * faces.size();
  return faces;
}

std::int64_t brokenness(const IntegerMap& map, const std::vector<Index>& faces)
{
  std::int64_t sum = 0;
  for (const Index f : faces)
  {
    sum += std::max<std::int64_t>(0, 1 - map.determinant(f));
  }
  return sum;
}

/// Carries the defects of all triangles to each other, or out. False when one cannot leave its face.
bool closeTriangles(IntegerMap& map)
{
  const IntegerDomain& domain = map.domain();
  StripSearch search(map, StripCost::Repair);
  std::vector<FixedVec2> defects(domain.faceCount());
  for (Index f = 0; f < domain.faceCount(); ++f)
  {
    defects[f] = map.defect(f);
  }
  for (Index f = 0; f < domain.faceCount(); ++f)
  {
    while (defects[f] != FixedVec2{})
    {
      Strip best;
      for (const FixedVec2 e : unitsIn(defects[f]))
      {
        const Strip strip = search.discharge(f, e, defects);
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
      bool repeated = false;
      for (const Index touched : facesOf(domain, best, repeated))
      {
        defects[touched] = map.defect(touched);
      }
    }
  }
  return true;
}

class Repair
{
public:
  explicit Repair(IntegerMap& map) : map_(map), search_(map, StripCost::Repair) {}

  /// Strips through broken triangles as long as the sum of what is broken falls.
  bool run()
  {
    const Index faces = map_.domain().faceCount();
    bool progress = true;
    while (progress)
    {
      progress = false;
      bool broken = false;
      for (Index f = 0; f < faces; ++f)
      {
        while (map_.determinant(f) <= 0)
        {
          if (!mend(f))
          {
            broken = true;
            break;
          }
          progress = true;
        }
      }
      if (!broken && allPositive())
      {
        return true;
      }
    }
    return false;
  }

private:
  bool allPositive() const
  {
    for (Index f = 0; f < map_.domain().faceCount(); ++f)
    {
      if (map_.determinant(f) <= 0)
      {
        return false;
      }
    }
    return true;
  }

  bool mend(Index f)
  {
    Strip best;
    std::pair<std::int64_t, double> bestChange{ 0, 0 };
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      for (int direction = 0; direction < 4; ++direction)
      {
        const FixedVec2 e = unitVector(direction);
        if (!map_.mayShift(h, e))
        {
          continue;
        }
        const Strip strip = search_.through(h, e, 0);
        if (!strip.found())
        {
          continue;
        }
        const auto change = measure(strip);
        if (change < bestChange)
        {
          bestChange = change;
          best = strip;
        }
      }
    }
    if (bestChange.first >= 0)
    {
      return false;
    }
    apply(map_, best);
    return true;
  }

  std::pair<std::int64_t, double> measure(const Strip& strip)
  {
    bool repeated = false;
    const std::vector<Index> faces = facesOf(map_.domain(), strip, repeated);
    const std::int64_t before = brokenness(map_, faces);
    const double energy = applyMeasured(map_, strip);
    const std::int64_t after = brokenness(map_, faces);
    revert(map_, strip);
    return { after - before, energy };
  }

  IntegerMap& map_;
  StripSearch search_;
};

class Improvement
{
public:
  explicit Improvement(IntegerMap& map) : map_(map), search_(map, StripCost::KeepPositive) {}

  void run(const ProgressCallback& progress)
  {
    for (std::int64_t length = longestStep(); length >= 1; length /= 2)
    {
      for (int sweep = 0; sweep < kMaximumSweeps; ++sweep)
      {
        report(progress, 0.5, "improving integers");
        if (!sweepOnce(length))
        {
          break;
        }
      }
    }
  }

private:
  struct Candidate
  {
    double gain;
    Index halfEdge;
    int direction;
  };

  /// The largest power of two that could still bring a half-edge nearer to what is wanted.
  std::int64_t longestStep() const
  {
    double farthest = 0;
    const IntegerDomain& domain = map_.domain();
    for (Index h = 0; h < domain.halfEdgeCount(); ++h)
    {
      farthest =
        std::max({ farthest, std::abs(static_cast<double>(map_[h].u) - domain.wanted[h].x()),
          std::abs(static_cast<double>(map_[h].v) - domain.wanted[h].y()) });
    }
    std::int64_t length = 1;
    while (static_cast<double>(2 * length) < farthest)
    {
      length *= 2;
    }
    return length;
  }

  std::vector<Candidate> candidates(std::int64_t length) const
  {
    const IntegerDomain& domain = map_.domain();
    std::vector<Candidate> result;
    for (Index h = 0; h < domain.halfEdgeCount(); ++h)
    {
      if (domain.twin[h] < h)
      {
        continue;
      }
      for (int direction = 0; direction < 4; ++direction)
      {
        const double gain = -map_.energyChange(h, vectorOf(direction, length));
        if (gain > kLeastGain && map_.mayShift(h, vectorOf(direction, length)))
        {
          result.push_back({ gain, h, direction });
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

  static FixedVec2 vectorOf(int direction, std::int64_t length)
  {
    const FixedVec2 unit = unitVector(direction);
    return { length * unit.u, length * unit.v };
  }

  bool sweepOnce(std::int64_t length)
  {
    bool improved = false;
    for (const Candidate& candidate : candidates(length))
    {
      const FixedVec2 e = vectorOf(candidate.direction, length);
      double gain = -map_.energyChange(candidate.halfEdge, e);
      while (gain > kLeastGain && accept(search_.through(candidate.halfEdge, e, gain)))
      {
        improved = true;
        gain = -map_.energyChange(candidate.halfEdge, e);
      }
    }
    return improved;
  }

  bool accept(const Strip& strip)
  {
    if (!strip.found())
    {
      return false;
    }
    bool repeated = false;
    const std::vector<Index> faces = facesOf(map_.domain(), strip, repeated);
    const double change = applyMeasured(map_, strip);
    // A triangle that is crossed once keeps its sign on the way, so the winding cannot change; one that
    // is crossed twice may turn by 180 degrees.
    if (change < -kLeastGain && brokenness(map_, faces) == 0 && (!repeated || map_.isValid()))
    {
      return true;
    }
    revert(map_, strip);
    return false;
  }

  IntegerMap& map_;
  StripSearch search_;
};

} // namespace

IntegerStart findValidIntegers(
  IntegerMap& map, double maximumScale, const ProgressCallback& progress)
{
  IntegerStart start;
  for (; start.scale <= maximumScale; start.scale *= std::sqrt(2.0))
  {
    report(progress, 0.2, "rounding at scale " + std::to_string(start.scale));
    map.round(start.scale);
    if (closeTriangles(map) && Repair(map).run() && map.isValid())
    {
      start.valid = true;
      return start;
    }
  }
  return start;
}

void improveIntegers(IntegerMap& map, const ProgressCallback& progress)
{
  Improvement(map).run(progress);
}

} // namespace quadrille
