// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/Embed.h"
#include "Integers/Quantize.h"
#include "SyntheticMaps.h"

#include <gtest/gtest.h>

namespace quadrille::test
{
namespace
{

/// Follows the way from the seamless map to its quantization and certifies what it finds.
void expectWayToIntegers(const SyntheticMap& map)
{
  const QuantizeResult quantized = quantizeMap(map.mesh, map.field, map.uv, {});
  ASSERT_TRUE(quantized.status.ok()) << quantized.status.message;
  const LockedMap locked(map.mesh, map.field, quantized.uv);
  const ContinuationResult way = continueToIntegers(map.mesh, map.field, map.uv, locked, {});
  ASSERT_TRUE(way.y.has_value()) << "blocked at " << way.reached;
  EXPECT_EQ(way.reached, 1);
  const Certificate certificate =
    certify(map.mesh, locked.snap(*way.y), map.field.turns, integerVertices(map.mesh, map.field));
  EXPECT_TRUE(certificate.valid()) << certificate.text();
}

TEST(Continuation, LeadsToAValidMap)
{
  // Blocks of about a quad and less: the integers distort the map by factors of two and more.
  expectWayToIntegers(staircaseMap(4, 4, 4, 4, 0.5, false, 2));
  expectWayToIntegers(staircaseMap(4, 4, 4, 4, 1.0, true, 2));
  expectWayToIntegers(axisAlignedMap(doubleTorus(4), 5, 4, 0.6, 3));
  expectWayToIntegers(plateMap(plateWithHole(5), 3, 5, 0.7, 4));
}

TEST(Continuation, StopsWhereIntegersCrushATriangle)
{
  // A plate whose right side is moved onto its left one: nothing in between can be positive.
  const SyntheticMap map = plateMap(gridPlane(4, 4), 1, 4, 5, 1);
  QuantizeResult quantized = quantizeMap(map.mesh, map.field, map.uv, {});
  ASSERT_TRUE(quantized.status.ok());
  for (FixedVec2& p : quantized.uv)
  {
    p.u = 0;
  }
  const LockedMap locked(map.mesh, map.field, quantized.uv);
  const ContinuationResult way = continueToIntegers(map.mesh, map.field, map.uv, locked, {});
  EXPECT_FALSE(way.y.has_value());
  EXPECT_LT(way.reached, 1);
}

} // namespace
} // namespace quadrille::test
