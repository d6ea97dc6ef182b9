// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What connections join in quads without them.
#include "Pipeline/ConnectionEnds.h"

#include "Pipeline/DrawnOnSurface.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

struct IrregularPlace
{
  Vector3 place;
  int valence;
};

/// Points of quads with edges of length 1, of which only what ends look at is there: regular ones along x and irregular
/// ones among them, and a feature from (0, 9, 0) to (20, 9, 0).
RemeshResult quadsWithIrregular(const std::vector<IrregularPlace>& irregular)
{
  RemeshResult made;
  made.targetEdgeLength = 1;
  QuadMesh& quads = made.quads;
  for (int x = 0; x <= 20; ++x)
  {
    quads.points.emplace_back(x, 5, 0);
    quads.valence.push_back(kRegularValence);
  }
  for (const auto& [place, valence] : irregular)
  {
    quads.points.push_back(place);
    quads.valence.push_back(valence);
  }
  quads.lines.push_back({ static_cast<Index>(quads.points.size()),
    static_cast<Index>(quads.points.size() + 1), kInvalidIndex, false });
  quads.points.insert(quads.points.end(), { { 0, 9, 0 }, { 20, 9, 0 } });
  quads.valence.insert(quads.valence.end(), { 3, 5 });
  quads.onBoundary.assign(quads.points.size(), 0);
  return made;
}

SurfaceInput asking(std::vector<std::vector<Vector3>> connections)
{
  SurfaceInput input;
  for (std::vector<Vector3>& points : connections)
  {
    input.curves.push_back({ CurveKind::Connection, std::move(points) });
  }
  return input;
}

using Valences = std::array<int, 2>;

TEST(ConnectionEnds, AreTheNearestIrregularVerticesOrCurves)
{
  RemeshResult made = quadsWithIrregular(
    { { { 1, 0, 0 }, 3 }, { { 6, 0, 0 }, 5 }, { { 9, 0, 0 }, 6 }, { { 15, 6.5, 0 }, 5 } });
  // From beside the first one to beside the second one; from the third one to the feature, which is nearer than the
  // last one at its other end; to one that is nearer than the feature.
  SurfaceInput input = asking({ { { 0, 1, 0 }, { 6.5, 0, 0 } }, { { 9, 0, 0 }, { 15, 8, 0 } },
    { { 1, 0, 0 }, { 15, 7.5, 0 } } });
  const RemeshOptions options;
  ConnectionEnds ends(input, options);
  ASSERT_TRUE(ends.areMissing());
  EXPECT_TRUE(ends.drawn().curves.empty());
  EXPECT_TRUE(ends.findIn(made));
  EXPECT_FALSE(ends.areMissing());
  EXPECT_EQ(input.curves[0].ends, (Valences{ 3, 5 }));
  EXPECT_EQ(input.curves[1].ends, (Valences{ 6, 0 }));
  EXPECT_EQ(input.curves[2].ends, (Valences{ 3, 5 }));
  // The vertices come to the ends.
  EXPECT_EQ(input.curves[0].points.front(), Vector3(0, 1, 0));
  EXPECT_EQ(ends.drawn().curves.size(), 3U);
}

TEST(ConnectionEnds, OthersStayWhereTheQuadsHaveThem)
{
  RemeshResult made =
    quadsWithIrregular({ { { 1, 0, 0 }, 3 }, { { 6, 0, 0 }, 5 }, { { 9, 0, 0 }, 6 } });
  SurfaceInput input = asking({ { { 1, 0, 0 }, { 6, 0, 0 } } });
  const RemeshOptions options;
  ConnectionEnds ends(input, options);
  ASSERT_TRUE(ends.findIn(made));
  const SurfaceInput drawn = ends.drawn();
  EXPECT_TRUE(drawn.regularElsewhere);
  EXPECT_EQ(drawn.drawn.valences,
    (std::vector<ValencePlace>{ { { 9, 0, 0 }, 6, true } })); // not those on the feature either
  // Until a run has shown that there is no line so.
  RemeshResult unmet, met;
  unmet.curves.resize(1);
  met.curves.resize(1);
  met.curves[0].met = true;
  EXPECT_TRUE(ends.mayFreeOthers(unmet));
  EXPECT_FALSE(ends.mayFreeOthers(met));
  ends.freeOthers();
  EXPECT_FALSE(ends.drawn().regularElsewhere);
  EXPECT_TRUE(ends.drawn().drawn.valences.empty());
  EXPECT_FALSE(ends.mayFreeOthers(unmet));
  EXPECT_TRUE(ends.isBetter(met, unmet));
  EXPECT_FALSE(ends.isBetter(unmet, met));
}

TEST(ConnectionEnds, ALineEndsWhereAValenceIsAskedFor)
{
  RemeshResult made = quadsWithIrregular({ { { 1, 0, 0 }, 3 }, { { 6, 0, 0 }, 5 } });
  SurfaceInput input = asking({ { { 1.5, 0, 0 }, { 6.5, 0, 0 } } });
  // One that is to stay, and one that was held where it lay before it was smoothed.
  input.drawn.valences = { { { 1.01, 0, 0 }, 3 }, { { 5, 0, 0 }, 5, true } };
  const RemeshOptions options;
  ConnectionEnds ends(input, options);
  ASSERT_TRUE(ends.findIn(made));
  EXPECT_EQ(input.curves[0].points.front(), Vector3(1.01, 0, 0));
  EXPECT_EQ(input.curves[0].points.back(), Vector3(6.5, 0, 0));
  EXPECT_EQ(ends.drawn().drawn.valences, (std::vector<ValencePlace>{ { { 1.01, 0, 0 }, 3 } }));
}

/// Both sides of a wall, unit quads from 0 to 8, a tenth of an edge apart; side 0 is seen from above.
Index pointOfWall(Index side, Index x, Index y)
{
  return (side * 9 + y) * 9 + x;
}

RemeshResult thinWall()
{
  RemeshResult made;
  made.targetEdgeLength = 1;
  QuadMesh& quads = made.quads;
  for (const Index side : { 0U, 1U })
  {
    for (Index y = 0; y <= 8; ++y)
    {
      for (Index x = 0; x <= 8; ++x)
      {
        quads.points.emplace_back(x, y, -0.1 * side);
      }
    }
    for (Index y = 0; y < 8; ++y)
    {
      for (Index x = 0; x < 8; ++x)
      {
        quads.quads.push_back({ pointOfWall(side, x, y), pointOfWall(side, x + 1, y),
          pointOfWall(side, x + 1, y + 1), pointOfWall(side, x, y + 1) });
        if (side == 1)
        {
          std::swap(quads.quads.back()[1], quads.quads.back()[3]);
        }
      }
    }
  }
  quads.valence.assign(quads.points.size(), kRegularValence);
  quads.onBoundary.assign(quads.points.size(), 0);
  return made;
}

TEST(ConnectionEnds, AreOnTheirSideOfAThinWall)
{
  RemeshResult made = thinWall();
  QuadMesh& quads = made.quads;
  quads.valence[pointOfWall(0, 2, 4)] = 3;
  quads.valence[pointOfWall(1, 1, 4)] = 5; // under the first end
  // Features along x, on this side farther from the second end than on the other one.
  quads.lines = { { pointOfWall(0, 5, 6), pointOfWall(0, 6, 6), kInvalidIndex, false },
    { pointOfWall(1, 5, 5), pointOfWall(1, 6, 5), kInvalidIndex, false } };
  SurfaceInput input = asking({ { { 1, 4, 0 }, { 5.5, 5, 0 } } });
  // Held where it lay before it was smoothed, on the other side, and what is held there stays so.
  input.drawn.valences = { { { 2, 4, -0.1 }, 3, true } };
  const RemeshOptions options;
  ConnectionEnds ends(input, options);
  ASSERT_TRUE(ends.findIn(made));
  EXPECT_EQ(input.curves[0].ends, (Valences{ 3, 0 }));
  EXPECT_EQ(
    input.curves[0].points, (std::vector<Vector3>{ { 1, 4, 0 }, { 5.5, 5, 0 }, { 5.5, 6, 0 } }));
  EXPECT_EQ(input.drawn.valences.size(), 1U);
}

TEST(ConnectionEnds, TakeThePlaceOfTheSameValenceOnTheirSideOnly)
{
  PreparedSurface surface;
  surface.mesh = test::unitCube(8);
  for (Vector3& p : surface.mesh.position.editAll())
  {
    p = Vector3(8 * p.x(), 8 * p.y(), 0.1 * p.z());
  }
  const Vector3 begin(2, 4, 0.1), end(6, 4, 0.1), under(2, 4, 0), beside(2.2, 4, 0.1);
  surface.curves = { { CurveKind::Connection, { begin, end }, Valences{ 3, 5 } } };
  EXPECT_EQ(withEnds(surface, { { under, 3 }, { beside, 3 }, { beside, 6 } }, 1, 1),
    (std::vector<ValencePlace>{ { under, 3 }, { beside, 6 }, { begin, 3 }, { end, 5 } }));
}

TEST(ConnectionEnds, ThatAreNotFoundAreTold)
{
  RemeshResult made = quadsWithIrregular({ { { 1, 0, 0 }, 3 }, { { 6, 0, 0 }, 5 } });
  SurfaceInput input = asking({ { { 1, 0, 0 }, { 13, 0, 0 } }, { { 0.5, 0, 0 }, { 1.5, 0, 0 } },
    { { 1, 0, 0 }, { 6, 0, 0 } } });
  const RemeshOptions options;
  ConnectionEnds ends(input, options);
  ASSERT_TRUE(ends.findIn(made));
  // What the third one changes may have ends for the others.
  EXPECT_TRUE(ends.areMissing());
  EXPECT_EQ(ends.drawn().curves.size(), 1U);
  EXPECT_FALSE(ends.findIn(made));
  EXPECT_FALSE(ends.areMissing());
  RemeshResult result;
  result.curves.resize(1);
  result.curves[0].met = true;
  ends.tell(result);
  ASSERT_EQ(result.curves.size(), 3U);
  EXPECT_NE(result.curves[0].why.find("within 3 quads of (13, 0, 0)"), std::string::npos);
  EXPECT_NE(result.curves[1].why.find("nearest to the same vertex"), std::string::npos);
  EXPECT_TRUE(result.curves[2].met);
}

TEST(ConnectionEnds, OfMethodsThatRoundThereAreNone)
{
  SurfaceInput input = asking({ { { 1, 0, 0 }, { 6, 0, 0 } } });
  RemeshOptions options;
  options.method = MapMethod::MixedInteger;
  const ConnectionEnds ends(input, options);
  EXPECT_FALSE(ends.areMissing());
  RemeshResult result;
  ends.tell(result);
  ASSERT_EQ(result.curves.size(), 1U);
  EXPECT_NE(result.curves[0].why.find("choose scale aware"), std::string::npos);
}

TEST(ConnectionEnds, QuadsOfAStoppedRunAreNone)
{
  RemeshResult made = quadsWithIrregular({ { { 1, 0, 0 }, 3 }, { { 6, 0, 0 }, 5 } });
  made.stopped = "attempt 1";
  SurfaceInput input = asking({ { { 1, 0, 0 }, { 6, 0, 0 } } });
  const RemeshOptions options;
  ConnectionEnds ends(input, options);
  EXPECT_FALSE(ends.findIn(made));
  EXPECT_EQ(made.status.code, StatusCode::Cancelled);
  EXPECT_TRUE(made.quads.quads.empty());
}

} // namespace
} // namespace quadrille
