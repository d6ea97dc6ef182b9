// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/StripWays.h"

#include "GridMap/MapCheck.h"
#include "Integers/LockedVertices.h"
#include "Integers/QuantizeIntegers.h"
#include "Integers/StripSearch.h"
#include "Integers/UvDecimation.h"
#include "SyntheticMaps.h"

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <vector>

namespace quadrille::test
{
namespace
{

constexpr double kAnyCost = std::numeric_limits<double>::infinity();

/// Valid integers of a map, about as far apart as they can be.
class SmallIntegers
{
public:
  explicit SmallIntegers(const SyntheticMap& map)
    : uvMesh(UvMesh::from(map.mesh, map.field, map.uv)), editor_(uvMesh)
  {
    LockedVertices locked =
      lockedVertices(map.mesh, uvMesh, integerVertices(map.mesh, map.field), {});
    decimateInUv(uvMesh, editor_, locked.keep);
    integers.emplace(uvMesh, editor_, locked.integer);
    EXPECT_TRUE(findValidIntegers(*integers, {}).valid);
  }

  UvMesh uvMesh;
  std::optional<IntegerMap> integers;

private:
  UvEditor editor_;
};

/// Calls visit(h, e) for all shifts that are allowed.
template <typename Visit>
void forAllShifts(const IntegerMap& integers, Visit visit)
{
  for (const Index f : integers.faces())
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      for (int direction = 0; direction < 4; ++direction)
      {
        const FixedVec2 e = stepVector(direction, kGrain);
        if (integers.mayShift(h, e))
        {
          visit(h, e);
        }
      }
    }
  }
}

std::vector<SyntheticMap> smallMaps()
{
  return { axisAlignedMap(markFeatures(unitCube(5), 0.7), 1, 5, 1.2, 1),
    staircaseMap(4, 4, 4, 4, 1.2, true, 2),
    axisAlignedMap(markFeatures(doubleTorus(4), 0.7), 5, 4, 1.2, 3),
    plateMap(plateWithHole(5), 3, 5, 1.2, 4), plateMap(plateL(6), 2, 6, 1.2, 5) };
}

TEST(StripWays, TellWhereThereIsAStrip)
{
  int with = 0, without = 0;
  for (const SyntheticMap& map : smallMaps())
  {
    const SmallIntegers small(map);
    StripSearch search(*small.integers, StripCost::KeepSound);
    StripWays ways(*small.integers);
    ways.find(kGrain, kAnyCost);
    forAllShifts(*small.integers,
      [&](Index h, FixedVec2 e)
      {
        const bool found = search.through(h, e, kAnyCost).found();
        EXPECT_EQ(ways.mayHave(h, e, kAnyCost), found) << h << " " << e.u << " " << e.v;
        (found ? with : without) += 1;
      });
  }
  EXPECT_GT(with, 100);
  EXPECT_GT(without, 100);
}

/// Edges that cost as much are in no strip, and what is asked beyond that cost is not known.
TEST(StripWays, KnowTheirCost)
{
  int ruledOut = 0;
  for (const SyntheticMap& map : smallMaps())
  {
    const SmallIntegers small(map);
    StripSearch search(*small.integers, StripCost::KeepSound);
    StripWays any(*small.integers), cheap(*small.integers);
    any.find(kGrain, kAnyCost);
    const double cost = 0.5;
    cheap.find(kGrain, cost);
    forAllShifts(*small.integers,
      [&](Index h, FixedVec2 e)
      {
        if (small.integers->energyChange(h, e) >= cost)
        {
          return;
        }
        EXPECT_TRUE(cheap.mayHave(h, e, cost) || !search.through(h, e, cost).found());
        EXPECT_TRUE(any.mayHave(h, e, cost) || !cheap.mayHave(h, e, cost));
        EXPECT_TRUE(cheap.mayHave(h, e, 2 * cost));
        ruledOut += any.mayHave(h, e, cost) && !cheap.mayHave(h, e, cost) ? 1 : 0;
      });
  }
  EXPECT_GT(ruledOut, 10);
}

TEST(StripWays, TellNothingOfAnotherMapOrLength)
{
  const SmallIntegers small(smallMaps().front());
  StripWays ways(*small.integers);
  const auto ruledOut = [&](std::int64_t length)
  {
    int count = 0;
    forAllShifts(*small.integers,
      [&](Index h, FixedVec2 e)
      {
        const FixedVec2 step{ e.u / kGrain * length, e.v / kGrain * length };
        count += ways.mayHave(h, step, 1) ? 0 : 1;
      });
    return count;
  };
  EXPECT_EQ(ruledOut(kGrain), 0);
  ways.find(kGrain, kAnyCost);
  EXPECT_GT(ruledOut(kGrain), 0);
  EXPECT_EQ(ruledOut(2 * kGrain), 0);
  ways.forget();
  EXPECT_EQ(ruledOut(kGrain), 0);
}

} // namespace
} // namespace quadrille::test
