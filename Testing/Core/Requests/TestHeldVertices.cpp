// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Sectors of vertices on features are found again, whatever the order they are listed in.
#include "Requests/HeldVertices.h"

#include "Mesh/Surface.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

/// A cube with its edges as features: corners of three sectors, all others straight.
class HeldSectors : public ::testing::Test
{
protected:
  HeldSectors() : ids_(cube_.vertexCount()), isCorner_(cube_.vertexCount(), 0)
  {
    std::iota(ids_.begin(), ids_.end(), 0);
    std::vector<int> features(cube_.vertexCount(), 0);
    for (Index h = 0; h < cube_.halfEdgeCount(); ++h)
    {
      features[cube_.origin[h]] += cube_.isConstrained(h) ? 1 : 0;
    }
    turns_.assign(cube_.halfEdgeCount(), 0);
    for (Index h = 0; h < cube_.halfEdgeCount(); ++h)
    {
      const Index v = cube_.origin[h];
      isCorner_[v] = features[v] == 3;
      if (cube_.isConstrained(h))
      {
        // Different ones at a corner, so that a rotation would be seen.
        turns_[h] = static_cast<std::int8_t>(isCorner_[v] != 0 ? 1 + next_[v]++ : 2);
      }
    }
  }

  PreparedSurface asked(bool rotated) const
  {
    PreparedSurface surface;
    surface.mesh = cube_;
    surface.regularOnFeatures = true;
    surface.sectorRequests = sectorsOf(cube_, turns_, isCorner_, ids_);
    for (SectorRequest& request : surface.sectorRequests)
    {
      std::rotate(request.sectors.begin(), request.sectors.begin() + (rotated ? 1 : 0),
        request.sectors.end());
    }
    return surface;
  }

  Mesh cube_ = markFeatures(unitCube(4), 1); // radians
  std::vector<Index> ids_;
  std::vector<std::uint8_t> isCorner_;
  std::vector<int> next_ = std::vector<int>(cube_.vertexCount(), 0);
  std::vector<std::int8_t> turns_;
};

TEST_F(HeldSectors, AreThoseThatWereListed)
{
  for (const bool rotated : { false, true })
  {
    const PreparedSurface surface = asked(rotated);
    EXPECT_EQ(surface.sectorRequests.size(), 8);
    const std::vector<int> found = levelSectors(surface, cube_, ids_);
    ASSERT_EQ(found.size(), turns_.size());
    for (Index h = 0; h < cube_.halfEdgeCount(); ++h)
    {
      const Index on = cube_.rotateCounterclockwise(h);
      const bool isSingle =
        cube_.isConstrained(h) && (on == kInvalidIndex || cube_.isConstrained(on));
      EXPECT_EQ(found[h], isSingle ? 0 : turns_[h]) << "half-edge " << h;
    }
  }
}

TEST_F(HeldSectors, AreFreeWhereNothingIsAsked)
{
  PreparedSurface surface = asked(false);
  surface.regularOnFeatures = false;
  EXPECT_TRUE(levelSectors(surface, cube_, ids_).empty());
}

} // namespace
} // namespace quadrille
