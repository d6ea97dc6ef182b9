// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Edits that make no sense, one after the other: nothing crashes, and whatever is not met has a reason.
#include "SessionHelpers.h"

#include "PlyFile.h"
#include "Quads/QuadTopology.h"
#include "StaggeredTube.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <random>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

class RandomSession
{
public:
  RandomSession(SurfaceInput surface, std::size_t quads, std::uint32_t seed)
    : session_(surface, sessionOptions(quads)), surface_(std::move(surface)), random_(seed),
      number_(quads)
  {
    quads_.emplace_back();
    for (const Vector3& p : surface_.points)
    {
      size_ = std::max(size_, (p - surface_.points.front()).norm());
    }
  }

  void run()
  {
    const std::shared_ptr<const SessionResult> plain = make();
    ASSERT_TRUE(plain != nullptr);
    euler_ = eulerOf(plain->quads);
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
      make();
    }
  }

private:
  std::size_t upTo(std::size_t count)
  {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_);
  }
  double between(double low, double high)
  {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vector3 place() { return surface_.points[upTo(surface_.points.size())]; }
  Vector3 direction() { return { between(-1, 1), between(-1, 1), between(-1, 1) }; }
  std::vector<Vector3> line(std::size_t count)
  {
    std::vector<Vector3> points(count);
    std::generate(points.begin(), points.end(), [this] { return place(); });
    return points;
  }
  std::vector<Index> polygons()
  {
    std::vector<Index> ids(1 + upTo(20));
    std::generate(ids.begin(), ids.end(),
      [this] { return static_cast<Index>(upTo(surface_.polygonOffsets.size() - 1)); });
    return ids;
  }
  /// That of an irregular vertex, or anywhere.
  Vector3 irregularPlace()
  {
    const std::shared_ptr<const SessionResult> now = session_.result();
    return !now || now->irregular.empty() || upTo(5) == 0
      ? place()
      : now->irregular[upTo(now->irregular.size())].place;
  }

  void add(ConstraintContent content)
  {
    const auto& there = session_.constraints();
    const auto same = std::find_if(there.begin(), there.end(),
      [&](const auto& constraint) { return constraint->content.index() == content.index(); });
    if (same != there.end() && upTo(4) == 0)
    {
      session_.edit((*same)->id, std::move(content));
    }
    else
    {
      session_.add(std::move(content));
    }
    entered();
  }
  void entered()
  {
    quads_.resize(at_ + 1);
    quads_.emplace_back();
    ++at_;
  }

  IrregularEdit operation()
  {
    IrregularEdit made;
    made.operation = static_cast<IrregularOperation>(upTo(5));
    made.points = { irregularPlace(), irregularPlace() };
    if (made.operation == IrregularOperation::Move || made.operation == IrregularOperation::Add)
    {
      made.points[1] = place();
    }
    if (made.operation == IrregularOperation::Split)
    {
      made.points = { irregularPlace(), place(), place() };
      made.valences = { 3, static_cast<int>(4 + upTo(3)) };
    }
    return made;
  }

  void changeSettings()
  {
    RemeshOptions settings = session_.settings();
    switch (upTo(4))
    {
      case 0:
        settings.quads = number_ / 2 + upTo(2 * number_); // much fewer would close handles
        break;
      case 1:
        settings.smoothingSteps = static_cast<int>(upTo(4));
        break;
      case 2:
        settings.coarseVertices = static_cast<Index>(150 + upTo(200));
        break;
      default:
        settings.threads = 1;
    }
    const RemeshOptions& before = session_.settings();
    const bool isNew = settings.quads != before.quads ||
      settings.smoothingSteps != before.smoothingSteps ||
      settings.coarseVertices != before.coarseVertices;
    session_.setSettings(settings);
    if (isNew)
    {
      entered();
    }
  }

  void saveAndLoad()
  {
    const std::string path = ::testing::TempDir() + "random_session_" +
      std::to_string(reinterpret_cast<std::uintptr_t>(this)) + ".json";
    session_.save(path);
    session_ = Session::load(path, surface_);
    std::remove(path.c_str());
    session_.setThreads(2);
    quads_ = { quads_[at_] };
    at_ = 0;
  }

  void edit()
  {
    const std::size_t kind = upTo(22);
    switch (kind)
    {
      case 0:
        add(GuideStroke{ line(2 + upTo(3)), between(0.1, 1), between(0, 0.2) * size_ });
        break;
      case 1:
        add(GuideRegion{ polygons(), direction(), between(0.1, 1) });
        break;
      case 2:
        add(ValenceAt{ place(), static_cast<int>(2 + upTo(7)) });
        break;
      case 3:
        upTo(3) == 0 ? add(ClearedAt{ place() }) : add(FeatureLine{ line(2 + upTo(2)) });
        break;
      case 4:
        add(SizeAt{ place(), between(0, 0.3) * size_, between(0.4, 2.5) });
        break;
      case 5:
        add(SizeRegion{ polygons(), between(0.4, 2.5) });
        break;
      case 6:
      case 7:
      case 8:
        add(operation());
        break;
      case 9:
      case 10:
        add(Connection{ { irregularPlace(), irregularPlace() } });
        break;
      case 11:
        add(Connection{ line(3) });
        break;
      case 12:
        add(Cycle{ line(3 + upTo(6)) });
        break;
      case 13:
        add(upTo(2) == 0 ? MirrorSymmetry{}
                         : MirrorSymmetry{ MirrorPlane{ Vector3::Zero(), direction() } });
        break;
      case 14:
        changeSettings();
        break;
      case 15:
      case 16:
        EXPECT_EQ(session_.undo(), at_ > 0);
        at_ -= at_ > 0 ? 1 : 0;
        break;
      case 17:
        EXPECT_EQ(session_.redo(), at_ + 1 < quads_.size());
        at_ += at_ + 1 < quads_.size() ? 1 : 0;
        break;
      case 18:
        session_.nameState("kept");
        EXPECT_FALSE(session_.compare("kept", "").settings.size() > 0);
        break;
      case 19:
        session_.goTo("kept"); // refused where nothing has the name
        entered();
        break;
      case 20:
        saveAndLoad();
        break;
      default:
        if (upTo(2) == 0)
        {
          const SessionResult preview = session_.preview(); // refused with a symmetry
          EXPECT_TRUE(preview.report.status.ok() || preview.report.status.message != "");
        }
        else if (!session_.constraints().empty())
        {
          session_.remove(session_.constraints()[upTo(session_.constraints().size())]->id);
          entered();
        }
    }
  }

  static int eulerOf(const QuadMesh& quads)
  {
    return analyzeQuads(quads.quads, quads.points.size()).eulerCharacteristic;
  }

  /// Null where there are no quads.
  std::shared_ptr<const SessionResult> make()
  {
    const SessionReport& report = session_.update();
    EXPECT_EQ(report.constraints.size(), session_.constraints().size());
    for (const ConstraintReport& word : report.constraints)
    {
      EXPECT_EQ(word.isMet, word.reason.empty()) << word.text << ": " << word.reason;
      EXPECT_TRUE(!word.isOffSurface || !word.remark.empty()) << word.text;
      EXPECT_TRUE(word.place.allFinite()) << word.text;
    }
    if (!report.status.ok())
    {
      EXPECT_NE(report.status.message, "");
      return nullptr;
    }
    std::shared_ptr<const SessionResult> result = session_.result();
    const QuadMesh& quads = result->quads;
    const QuadTopology topology = analyzeQuads(quads.quads, quads.points.size());
    EXPECT_TRUE(topology.manifold()) << topology.text();
    EXPECT_EQ(indexSum(quads), 4 * topology.eulerCharacteristic);
    EXPECT_EQ(topology.eulerCharacteristic, euler_.value_or(topology.eulerCharacteristic));
    for (const Vector3& p : quads.points)
    {
      EXPECT_TRUE(p.allFinite());
    }
    if (quads_[at_])
    {
      EXPECT_TRUE(areSame(*quads_[at_], quads));
    }
    quads_[at_] = quads;
    return result;
  }

  Session session_;
  SurfaceInput surface_;
  std::mt19937 random_;
  std::size_t number_; ///< of quads, at first
  double size_ = 0;
  std::optional<int> euler_;
  std::vector<std::optional<QuadMesh>> quads_; ///< of every state in the history, once it is made
  std::size_t at_ = 0;
};

/// QUADRILLE_RANDOM_SESSIONS: how many on each surface in place of one.
int sessionCount()
{
  const char* asked = std::getenv("QUADRILLE_RANDOM_SESSIONS");
  return asked ? std::max(1, std::atoi(asked)) : 1;
}

void runOn(const SurfaceInput& surface, std::uint32_t firstSeed, std::size_t quads = 200)
{
  for (int i = 0; i < sessionCount(); ++i)
  {
    const std::uint32_t seed = firstSeed + 100 * static_cast<std::uint32_t>(i);
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomSession(surface, quads, seed).run();
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

/// Some of whose faces between features have no map.
TEST(RandomSessions, OnPatchesThatAreFilled)
{
  const PatchedMesh tube = staggeredTube(0.02);
  SurfaceInput surface = toInput(tube.mesh);
  surface.patchIds = tube.patch;
  runOn(surface, 11);
}

TEST(RandomSessions, OnAFileWithHandles)
{
  const auto surface = loadPly(QUADRILLE_DATA "/frame.ply");
  ASSERT_TRUE(surface);
  runOn(*surface, 9, 800);
}

/// With features, rounded edges, holes and boundaries: only where more than one of each is asked for.
TEST(RandomSessions, OnAPart)
{
  if (sessionCount() == 1)
  {
    GTEST_SKIP() << "set QUADRILLE_RANDOM_SESSIONS to 2 or more";
  }
  const auto surface = loadPly(QUADRILLE_DATA "/part.ply");
  ASSERT_TRUE(surface);
  runOn(*surface, 10, 1500);
}

} // namespace
} // namespace quadrille
