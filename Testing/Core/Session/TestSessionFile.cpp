// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Sessions that go to a file and come back.
#include "SessionHelpers.h"

#include "Session/SessionJson.h"

#include <cstdio>
#include <fstream>
#include <sstream>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

class SessionFile : public ::testing::Test
{
protected:
  SessionFile()
    : path_(::testing::TempDir() + "quadrille-" +
        ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".json")
  {
  }
  ~SessionFile() override { std::remove(path_.c_str()); }

  std::string text() const
  {
    std::ifstream file(path_);
    std::ostringstream all;
    all << file.rdbuf();
    return all.str();
  }
  void write(const std::string& all) const { std::ofstream(path_) << all; }
  void replaceIn(std::string all, const std::string& from, const std::string& to) const
  {
    const std::size_t at = all.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write(all.replace(at, from.size(), to));
  }
  std::string messageOfLoad(SurfaceInput surface) const
  {
    try
    {
      Session::load(path_, std::move(surface));
    }
    catch (const InvalidInput& error)
    {
      return error.what();
    }
    return "loaded";
  }

  std::string path_;
};

TEST_F(SessionFile, ComesBackAsItWas)
{
  Session session(dents(), sessionOptions(400));
  session.update();
  session.nameState("first");
  session.add(GuideStroke{ { { 0.9, -1.0 / 3, 0.3 }, { 0.9, 0.3, 0.4 } }, 0.7, 0.1 });
  session.add(ValenceAt{ session.surface().points[100], 5 });
  session.add(GuideRegion{ { 3, 4, 5 }, { 0.1, 0.2, 1e-300 }, 1 });
  const std::vector<IrregularVertex> irregular =
    session.result() ? session.result()->irregular : std::vector<IrregularVertex>();
  session.update();
  const IrregularVertex from =
    *std::find_if(session.result()->irregular.begin(), session.result()->irregular.end(),
      [](const IrregularVertex& vertex) { return vertex.valence == 3; });
  session.add(IrregularEdit{ IrregularOperation::Move,
    { from.place, emptiestPlace(session, session.result()->irregular) }, {}, {}, {}, {} });
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  session.save(path_);
  const std::string saved = text();

  Session loaded = Session::load(path_, dents());
  EXPECT_EQ(loaded.stateNames(), std::vector<std::string>{ "first" });
  loaded.save(path_);
  EXPECT_EQ(text(), saved);
  ASSERT_TRUE(loaded.update().status.ok());
  EXPECT_TRUE(areSame(loaded.result()->quads, session.result()->quads));
  EXPECT_GT(loaded.add(ValenceAt{ { 0, 0, 1 }, 5 }), session.constraints().back()->id);
  loaded.goTo("first");
  EXPECT_TRUE(loaded.constraints().empty());
}

/// There irregular vertices had ids of points.
TEST_F(SessionFile, FilesOfVersionOneAreRead)
{
  Session session(dents(), sessionOptions(400));
  session.update();
  const IrregularVertex from = session.result()->irregular.front();
  session.add(IrregularEdit{ IrregularOperation::Move,
    { from.place, emptiestPlace(session, session.result()->irregular) }, {}, {}, {}, {} });
  ASSERT_TRUE(session.update().status.ok());
  session.save(path_);
  SessionJson json = SessionJson::parse(text());
  json["version"] = 1;
  SessionJson& resolved = json["state"]["constraints"][0]["resolved"];
  const std::vector<Vector3>& points = session.surface().points;
  for (const char* list : { "before", "changes" })
  {
    for (SessionJson& each : resolved[list])
    {
      const Vector3 place(each["place"][0], each["place"][1], each["place"][2]);
      const auto found = std::find(points.begin(), points.end(), place);
      ASSERT_NE(found, points.end());
      each["point"] = static_cast<std::size_t>(found - points.begin());
      if (std::string(list) == "changes")
      {
        each.erase("place");
      }
    }
  }
  write(json.dump());
  Session loaded = Session::load(path_, dents());
  ASSERT_TRUE(loaded.update().status.ok());
  EXPECT_TRUE(areSame(loaded.result()->quads, session.result()->quads));
  resolved["changes"][0]["point"] = points.size();
  write(json.dump());
  EXPECT_NE(messageOfLoad(dents()).find("names point 2562"), std::string::npos);
}

/// What a user saw before a move is compared with the quads after it.
TEST_F(SessionFile, TheWordOnAMoveComparesTheQuadsBeforeAndAfter)
{
  Session session(dents(), sessionOptions(400));
  session.update();
  const IrregularVertex from = session.result()->irregular.front();
  session.add(IrregularEdit{ IrregularOperation::Move,
    { from.place, emptiestPlace(session, session.result()->irregular) }, {}, {}, {}, {} });
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.constraints[0].isMet) << report.constraints[0].reason;
  session.save(path_);
  const SessionJson saved = SessionJson::parse(text());
  const auto wordWith = [&](const auto& change)
  {
    SessionJson json = saved;
    change(json["state"]["constraints"][0]["resolved"]["shown"]);
    write(json.dump());
    Session loaded = Session::load(path_, dents());
    return loaded.update().constraints[0];
  };
  EXPECT_TRUE(wordWith([](SessionJson&) {}).isMet);
  // One more was there, one less, or one elsewhere.
  const ConstraintReport more = wordWith(
    [](SessionJson& shown)
    {
      shown.push_back(shown.back());
      shown.back()["valence"] = 7;
    });
  EXPECT_FALSE(more.isMet);
  EXPECT_NE(more.reason.find("1 other irregular vertices"), std::string::npos) << more.reason;
  EXPECT_FALSE(wordWith([](SessionJson& shown) { shown.erase(shown.size() - 1); }).isMet);
  EXPECT_FALSE(wordWith([](SessionJson& shown) { shown.back()["place"] = { 9, 9, 9 }; }).isMet);
  // Files of version 1 do not know.
  EXPECT_TRUE(wordWith([](SessionJson& shown) { shown.clear(); }).isMet);
}

TEST_F(SessionFile, KeepsEveryBit)
{
  const double values[] = { 0.1, 1.0 / 3, 5e-324, 1.7976931348623157e308, -0.0, 123456789.123456789,
    std::nextafter(1.0, 2.0) };
  std::vector<Vector3> points;
  for (const double value : values)
  {
    points.emplace_back(value, -value, value);
  }
  Session session(dents(), sessionOptions(100));
  session.add(FeatureLine{ points });
  session.save(path_);
  const Session loaded = Session::load(path_, dents());
  const auto& line = std::get<FeatureLine>(loaded.constraints()[0]->content);
  ASSERT_EQ(line.points.size(), points.size());
  EXPECT_EQ(std::memcmp(line.points.data(), points.data(), points.size() * sizeof(Vector3)), 0);
}

TEST_F(SessionFile, RefusesOtherSurfaces)
{
  Session session(dents(), sessionOptions(100));
  session.save(path_);
  const std::string other = messageOfLoad(toInput(sphere(2)));
  EXPECT_NE(other.find("another surface"), std::string::npos) << other;
  EXPECT_NE(other.find("\"points\":2562"), std::string::npos) << other;
  EXPECT_NE(other.find("\"points\":162"), std::string::npos) << other;
  SurfaceInput moved = dents();
  moved.points.edit()[7].x() = std::nextafter(moved.points[7].x(), 10.0);
  EXPECT_NE(messageOfLoad(moved).find("another surface"), std::string::npos);
  EXPECT_EQ(messageOfLoad(dents()), "loaded");
}

TEST_F(SessionFile, RefusesDamage)
{
  Session session(dents(), sessionOptions(100));
  session.add(ValenceAt{ { 0, 0, 1 }, 5 });
  session.add(GuideStroke{ { { 0, 0, 1 }, { 1, 0, 0 } }, 1, 0 });
  session.save(path_);
  const std::string good = text();
  const auto expectMessage =
    [&](const std::string& from, const std::string& to, const std::string& expected)
  {
    replaceIn(good, from, to);
    const std::string message = messageOfLoad(dents());
    EXPECT_NE(message.find(expected), std::string::npos) << message;
    EXPECT_NE(message.find(path_), std::string::npos) << message;
  };
  expectMessage("\"kind\": \"guide\"", "\"kind\": \"spiral\"", "constraint 2");
  expectMessage("\"kind\": \"guide\"", "\"kind\": \"spiral\"", "\"spiral\"");
  expectMessage("\"valence\": 5", "\"valence\": 5.5", "whole number");
  expectMessage("\"valence\": 5", "\"valence\": 55", "valence 55");
  expectMessage("\"version\": 2", "\"version\": 3", "only versions 1 and 2");
  expectMessage("\"quads\": 100", "\"quads\": -100", "\"quads\"");
  expectMessage("\"quads\": 100", "\"quats\": 100", "\"quats\"");
  expectMessage("\"next_id\": 3", "\"next_id\": 2", "\"next_id\"");
  expectMessage("\"id\": 2", "\"id\": 1", "twice");
  expectMessage("quadrille-session", "something", "no file of a session");
  // Cut off anywhere it is no JSON any more.
  for (std::size_t length = 0; length + 2 < good.size(); length += 37)
  {
    write(good.substr(0, length));
    EXPECT_NE(messageOfLoad(dents()), "loaded") << length;
  }
  std::remove(path_.c_str());
  EXPECT_THROW(Session::load(path_, dents()), std::runtime_error);
  EXPECT_THROW(session.save(path_ + "/no/such/folder"), std::runtime_error);
}

} // namespace
} // namespace quadrille
