// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Edits that make no sense, one after the other: nothing crashes, and whatever is not met has a reason.
#include "SessionHelpers.h"

#include "Extraction/QuadTopology.h"

#include <cstdlib>
#include <random>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

class RandomSession
{
public:
  RandomSession(SurfaceInput surface, std::uint32_t seed)
    : session_(std::move(surface), sessionOptions(200)), random_(seed)
  {
  }

  void run()
  {
    for (int i = 0; i < 10; ++i)
    {
      try
      {
        edit();
      }
      catch (const InvalidInput& error)
      {
        EXPECT_NE(std::string(error.what()), "");
      }
      check(session_.update());
    }
  }

private:
  std::size_t upTo(std::size_t count)
  {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_);
  }
  Vector3 place() { return session_.surface().points[upTo(session_.surface().points.size())]; }

  void edit()
  {
    switch (upTo(11))
    {
      case 0:
        session_.add(GuideStroke{ { place(), place() }, 1, 0.1 });
        break;
      case 1:
        session_.add(ValenceAt{ place(), static_cast<int>(2 + upTo(7)) });
        break;
      case 2:
        session_.add(FeatureLine{ { place(), place() } });
        break;
      case 3:
        session_.add(SizeAt{ place(), 0.3, 0.5 });
        break;
      case 4:
        session_.add(IrregularEdit{
          static_cast<IrregularOperation>(upTo(5)), { place(), place() }, {}, {}, {}, {} });
        break;
      case 5:
        session_.add(
          IrregularEdit{ IrregularOperation::Move, { place(), place() }, {}, {}, {}, {} });
        break;
      case 9:
        session_.add(Connection{ { place(), place() } });
        break;
      case 10:
        session_.add(Cycle{ { place(), place(), place() } });
        break;
      case 6:
        session_.undo();
        break;
      case 7:
        if (!session_.constraints().empty())
        {
          session_.remove(session_.constraints()[upTo(session_.constraints().size())]->id);
        }
        break;
      default:
        session_.redo();
    }
  }

  void check(const SessionReport& report)
  {
    ASSERT_EQ(report.constraints.size(), session_.constraints().size());
    for (const ConstraintReport& word : report.constraints)
    {
      EXPECT_EQ(word.isMet, word.reason.empty()) << word.text << ": " << word.reason;
    }
    if (!report.status.ok())
    {
      EXPECT_NE(report.status.message, "");
      return;
    }
    const QuadMesh& quads = session_.result()->quads;
    const QuadTopology topology = analyzeQuads(quads.quads, quads.points.size());
    EXPECT_TRUE(topology.manifold()) << topology.text();
    EXPECT_EQ(indexSum(quads), 4 * topology.eulerCharacteristic);
  }

  Session session_;
  std::mt19937 random_;
};

/// QUADRILLE_RANDOM_SESSIONS: how many on each surface in place of one.
void runOn(const SurfaceInput& surface, std::uint32_t firstSeed)
{
  const char* asked = std::getenv("QUADRILLE_RANDOM_SESSIONS");
  const int count = asked ? std::max(1, std::atoi(asked)) : 1;
  for (int i = 0; i < count; ++i)
  {
    const std::uint32_t seed = firstSeed + 100 * static_cast<std::uint32_t>(i);
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomSession(surface, seed).run();
  }
}

TEST(RandomSessions, OnASphere)
{
  runOn(dents(), 1);
  runOn(dents(), 2);
}

TEST(RandomSessions, OnATorus)
{
  runOn(toInput(torus(48, 24)), 3);
  runOn(toInput(torus(48, 24)), 4);
}

TEST(RandomSessions, OnAnOpenSurface)
{
  runOn(toInput(openCylinder(36, 16)), 5);
  runOn(toInput(plateL(8)), 6);
}

TEST(RandomSessions, OnABoxWithFeatures)
{
  runOn(toInput(unitCube(8)), 7);
  runOn(toInput(squareTorus(4)), 8);
}

} // namespace
} // namespace quadrille
