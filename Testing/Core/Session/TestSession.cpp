// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// States of a session, and what is made for them.
#include "NearestPoint.h"
#include "SessionHelpers.h"
#include "SphereWithoutRoom.h"

#include "Mesh/Distance.h"
#include "Quads/QuadChains.h"

#include <algorithm>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

const GuideStroke kStroke{ { { 0.9, -0.3, 0.3 }, { 0.9, 0.3, 0.4 } }, 1, 0.3 };

TEST(Session, MakesOnlyWhatAStateNeeds)
{
  Session session(dents(), sessionOptions(400));
  const SessionReport& cold = session.update();
  ASSERT_TRUE(cold.status.ok()) << cold.status.message;
  EXPECT_EQ(cold.runs, 1);
  EXPECT_TRUE(hasRun(cold, "phase1"));
  const QuadMesh first = session.result()->quads;

  const SessionReport again = session.update();
  EXPECT_EQ(again.runs, 0);
  EXPECT_TRUE(again.stages.empty());
  EXPECT_EQ(again.reused, std::vector<std::string>{ "all" });

  session.add(kStroke);
  const SessionReport guided = session.update();
  ASSERT_TRUE(guided.status.ok());
  for (const char* stage : { "repair", "order", "connectivity", "refine", "phase1" })
  {
    EXPECT_FALSE(hasRun(guided, stage)) << stage;
  }
  EXPECT_TRUE(hasRun(guided, "field"));
  const QuadMesh second = session.result()->quads;
  EXPECT_FALSE(areSame(first, second));

  ASSERT_TRUE(session.undo());
  EXPECT_FALSE(session.undo());
  EXPECT_EQ(session.update().runs, 0);
  EXPECT_TRUE(areSame(session.result()->quads, first));
  ASSERT_TRUE(session.redo());
  EXPECT_FALSE(session.redo());
  EXPECT_EQ(session.update().runs, 0);
  EXPECT_TRUE(areSame(session.result()->quads, second));
}

TEST(Session, IsTheSameAsFromNothing)
{
  Session session(dents(), sessionOptions(400));
  session.update();
  const int guide = session.add(kStroke);
  session.add(ValenceAt{ { 0, 0, 1 }, 5 });
  session.update();
  GuideStroke turned = kStroke;
  turned.points.back() = Vector3(0.9, 0.1, 0.6);
  session.edit(guide, turned);
  session.update();
  session.remove(guide);
  session.add(kStroke);
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;

  Session fresh(dents(), sessionOptions(400));
  fresh.add(ValenceAt{ { 0, 0, 1 }, 5 });
  fresh.add(kStroke);
  ASSERT_TRUE(fresh.update().status.ok());
  EXPECT_TRUE(areSame(session.result()->quads, fresh.result()->quads));
}

TEST(Session, IdsStay)
{
  Session session(dents(), sessionOptions(400));
  const int a = session.add(ValenceAt{ { 1, 0, 0 }, 5 });
  const int b = session.add(ValenceAt{ { 0, 1, 0 }, 5 });
  session.remove(a);
  ASSERT_EQ(session.constraints().size(), 1u);
  EXPECT_EQ(session.constraints()[0]->id, b);
  session.undo();
  session.undo();
  const int c = session.add(ValenceAt{ { 0, 0, 1 }, 5 });
  EXPECT_NE(c, a);
  EXPECT_NE(c, b);
  EXPECT_FALSE(session.canRedo());
  EXPECT_THROW(session.remove(b), InvalidInput);
  EXPECT_THROW(session.edit(c, kStroke), InvalidInput); // of another kind
  EXPECT_EQ(session.constraints().back()->id, c);
}

TEST(Session, ValencesComeOutAndAreTold)
{
  Session session(dents(), sessionOptions(400));
  const Vector3 place = session.surface().points[100];
  session.add(ValenceAt{ place, 5 });
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  ASSERT_EQ(report.constraints.size(), 1u);
  EXPECT_TRUE(report.constraints[0].isMet) << report.constraints[0].reason;
  EXPECT_EQ(report.constraints[0].kind, "valence");
  EXPECT_EQ(quadValenceAt(session.result()->quads, place), 5);
  EXPECT_EQ(valencesOf(*session.result())[place], 5);
}

TEST(Session, PointsOffTheSurfaceAreToldWithTheirPlace)
{
  Session session(dents(), sessionOptions(400));
  const Vector3 place = session.surface().points[100];
  session.add(ValenceAt{ 1.7 * place, 5 }); // farther from the middle
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  const ConstraintReport& word = report.constraints[0];
  EXPECT_TRUE(word.isOffSurface);
  EXPECT_NE(word.remark.find("off the surface"), std::string::npos) << word.remark;
  EXPECT_EQ(word.isMet, word.reason.empty()) << word.reason;
  EXPECT_EQ(std::count_if(report.notices.begin(), report.notices.end(),
              [&](const std::string& notice) {
                return notice.find(word.text + ": ") == 0 &&
                  notice.find(word.remark) != std::string::npos;
              }),
    1);
  session.remove(1);
  session.add(ValenceAt{ place, 5 });
  EXPECT_FALSE(session.update().constraints[0].isOffSurface);
}

TEST(Session, TheLaterOfTwoThatContradictIsLeftOut)
{
  Session session(dents(), sessionOptions(400));
  const Vector3 place = session.surface().points[100];
  session.add(ValenceAt{ place, 5 });
  session.add(ValenceAt{ place, 3 });
  const SessionReport report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_TRUE(report.constraints[0].isMet);
  EXPECT_FALSE(report.constraints[1].isMet);
  EXPECT_EQ(report.constraints[1].text, "valence 2");
  EXPECT_NE(report.constraints[1].reason.find("valence 1"), std::string::npos)
    << report.constraints[1].reason;
  session.remove(1);
  EXPECT_TRUE(session.update().constraints[0].isMet);
}

TEST(Session, WhatIsInfeasibleWithTheRestIsLeftOut)
{
  // The irregular vertices are all given, and have the sum of a sphere: one more has no partner.
  SurfaceInput input = dents();
  input.targetValences.assign(input.points.size(), 0);
  input.regularElsewhere = true;
  for (std::size_t i = 0; i < 8; ++i)
  {
    input.targetValences[12 + 20 * i] = 3;
  }
  Session session(input, sessionOptions(400));
  session.add(ValenceAt{ input.points[700], 4 });
  session.add(ValenceAt{ input.points[500], 5 });
  session.add(ValenceAt{ input.points[600], 4 });
  const SessionReport report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_GT(report.runs, 1);
  EXPECT_TRUE(report.constraints[0].isMet);
  EXPECT_FALSE(report.constraints[1].isMet);
  EXPECT_TRUE(report.constraints[2].isMet);
  EXPECT_NE(report.constraints[1].reason.find("together with valence 1"), std::string::npos)
    << report.constraints[1].reason;
  EXPECT_EQ(indexSum(session.result()->quads), 8);
  // With the partner it is met.
  session.add(ValenceAt{ input.points[1100], 3 });
  for (const ConstraintReport& word : session.update().constraints)
  {
    EXPECT_TRUE(word.isMet) << word.text << ": " << word.reason;
  }
}

TEST(Session, LaterGuidesCountWhereTheyOverlap)
{
  Session session(dents(), sessionOptions(400));
  session.add(kStroke);
  GuideStroke across = kStroke;
  across.points = { { 0.9, 0, 0 }, { 0.9, 0.2, 0.8 } };
  session.add(across);
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.status.ok());
  ASSERT_FALSE(report.constraints[0].isMet);
  EXPECT_NE(report.constraints[0].reason.find("guide 2, which is later"), std::string::npos)
    << report.constraints[0].reason;
}

TEST(Session, FeaturesBecomeEdges)
{
  Session session(toInput(gridPlane(16, 16)), sessionOptions(100));
  session.add(FeatureLine{ { { 3, 0, 0 }, { 3, 16, 0 } } });
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_TRUE(report.constraints[0].isMet) << report.constraints[0].reason;
  std::size_t onLine = 0;
  for (const Vector3& p : session.result()->quads.points)
  {
    onLine += std::abs(p.x() - 3) < 1e-9;
  }
  EXPECT_GE(onLine, 5u);
}

/// Feature edges of the quads on the edge of the unit cube where y = 0 and z = 1, and all of them.
std::pair<std::size_t, std::size_t> featuresOfCube(const QuadMesh& quads)
{
  std::size_t there = 0;
  for (const QuadLine& line : quads.lines)
  {
    const Vector3 middle = 0.5 * (quads.points[line.a] + quads.points[line.b]);
    there += std::abs(middle.y()) < 0.01 && std::abs(middle.z() - 1) < 0.01 ? 1 : 0;
  }
  return { there, quads.lines.size() };
}

TEST(Session, AClearedFeatureIsNone)
{
  RemeshOptions options = sessionOptions(600);
  options.featureAngle = 0.7;
  Session session(toInput(unitCube(8)), options);
  session.update();
  const auto [before, all] = featuresOfCube(session.result()->quads);
  ASSERT_GT(before, 5u);
  session.add(ClearedAt{ { 0.5, 0, 1 } });
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_TRUE(report.constraints[0].isMet) << report.constraints[0].reason;
  EXPECT_EQ(report.constraints[0].text, "cleared feature 1");
  const auto [after, rest] = featuresOfCube(session.result()->quads);
  EXPECT_EQ(after, 0u);
  EXPECT_GT(rest, all / 2);
  const QuadMesh cleared = session.result()->quads;
  session.undo();
  session.update();
  EXPECT_EQ(featuresOfCube(session.result()->quads).first, before);
  // Another run than the one that went on from the levels of the first gives the same.
  Session fresh(toInput(unitCube(8)), options);
  fresh.add(ClearedAt{ { 0.5, 0, 1 } });
  fresh.update();
  EXPECT_TRUE(areSame(fresh.result()->quads, cleared));
}

TEST(Session, WhatIsDrawnOverAClearedFeatureIsOne)
{
  RemeshOptions options = sessionOptions(600);
  options.featureAngle = 0.7;
  Session session(toInput(unitCube(8)), options);
  session.add(ClearedAt{ { 0.5, 0, 1 } });
  session.add(FeatureLine{ { { 0, 0, 1 }, { 1, 0, 1 } } });
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_FALSE(report.constraints[0].isMet);
  EXPECT_NE(report.constraints[0].reason.find("drawn there"), std::string::npos);
  EXPECT_TRUE(report.constraints[1].isMet) << report.constraints[1].reason;
}

TEST(Session, NothingIsClearedFarFromFeatures)
{
  RemeshOptions options = sessionOptions(600);
  options.featureAngle = 0.7;
  Session session(toInput(unitCube(8)), options);
  session.add(ClearedAt{ { 0.5, 0.5, 1 } });
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_TRUE(std::any_of(report.notices.begin(), report.notices.end(),
    [](const std::string& notice)
    { return notice.find("no feature was cleared at (0.5, 0.5, 1)") != std::string::npos; }));
}

/// Two irregular vertices near each other that no chain joins.
std::pair<IrregularVertex, IrregularVertex> nearestPair(const SessionResult& result)
{
  const QuadChains chains(result.quads);
  const auto pointAt = [&](const IrregularVertex& vertex)
  { return nearestPoint(result.quads.points, vertex.place); };
  std::pair<IrregularVertex, IrregularVertex> best;
  double least = std::numeric_limits<double>::infinity();
  for (const IrregularVertex& a : result.irregular)
  {
    for (const IrregularVertex& b : result.irregular)
    {
      const double apart = (a.place - b.place).norm();
      if (PlaceOrder()(a.place, b.place) && apart < least &&
        chains.between(pointAt(a), pointAt(b)).empty())
      {
        least = apart;
        best = { a, b };
      }
    }
  }
  EXPECT_TRUE(std::isfinite(least));
  return best;
}

TEST(Session, ConnectionsAreChainsOfEdges)
{
  Session session(dents(), sessionOptions(600));
  session.update();
  const SessionResult before = *session.result();
  const auto [first, second] = nearestPair(before);
  session.add(Connection{ { first.place, second.place } });
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  ASSERT_TRUE(report.constraints[0].isMet) << report.constraints[0].reason;
  const QuadMesh& quads = session.result()->quads;
  const std::array<Index, 2> ends{ nearestPoint(quads.points, first.place),
    nearestPoint(quads.points, second.place) };
  EXPECT_FALSE(QuadChains(quads).between(ends[0], ends[1]).empty());
  const double near = 0.2 * session.result()->targetEdgeLength;
  EXPECT_LT((quads.points[ends[0]] - first.place).norm(), near);
  EXPECT_LT((quads.points[ends[1]] - second.place).norm(), near);
  EXPECT_EQ(quads.valence[ends[0]], first.valence);
  EXPECT_EQ(quads.valence[ends[1]], second.valence);
  // No other has come or gone.
  EXPECT_EQ(irregularPoints(quads).size(), irregularPoints(before.quads).size());
}

// What connections join is in no list of irregular vertices, and stays what it was when others are moved.
TEST(Session, ConnectionsStayWhenVerticesAreMoved)
{
  Session session(dents(), sessionOptions(600));
  session.update();
  const auto [first, second] = nearestPair(*session.result());
  const int connection = session.add(Connection{ { first.place, second.place } });
  session.update();
  const SessionResult joined = *session.result();
  ASSERT_EQ(joined.joined.size(), 1U);
  EXPECT_EQ(joined.joined[0].startValence, first.valence);
  EXPECT_EQ(joined.joined[0].endValence, second.valence);
  const IrregularVertex& far = *std::max_element(joined.irregular.begin(), joined.irregular.end(),
    [&first = first](const IrregularVertex& a, const IrregularVertex& b)
    { return (a.place - first.place).norm() < (b.place - first.place).norm(); });
  const Vector3 aside = far.place + 2 * joined.targetEdgeLength * Vector3(0.6, 0.8, 0);
  session.add(IrregularEdit{ IrregularOperation::Move, { far.place, aside }, {}, {}, {}, {} });
  const std::string path = ::testing::TempDir() + "moved_beside_connection.qsession";
  session.save(path);
  for (Session& opened : std::array<Session, 2>{ std::move(session), Session::load(path, dents()) })
  {
    const SessionReport& report = opened.update();
    ASSERT_TRUE(report.status.ok()) << report.status.message;
    for (const ConstraintReport& word : report.constraints)
    {
      EXPECT_TRUE(word.isMet) << word.text << ": " << word.reason;
    }
    EXPECT_EQ(irregularPoints(opened.result()->quads).size(), irregularPoints(joined.quads).size());
    // Without it they are irregular all the same.
    opened.remove(connection);
    const SessionReport& without = opened.update();
    ASSERT_TRUE(without.status.ok()) << without.status.message;
    EXPECT_TRUE(without.constraints.front().isMet) << without.constraints.front().reason;
    EXPECT_EQ(irregularPoints(opened.result()->quads).size(), irregularPoints(joined.quads).size());
  }
}

TEST(Session, CyclesClose)
{
  Session session(dents(), sessionOptions(600));
  Cycle cycle;
  for (int i = 0; i < 24; ++i)
  {
    const double t = 2 * kPi * i / 24;
    cycle.points.push_back(Vector3(0.5 * std::sin(t), std::cos(t), 0.8 * std::sin(t)).normalized());
  }
  session.add(cycle);
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_TRUE(report.constraints[0].isMet) << report.constraints[0].reason;
  EXPECT_FALSE(QuadChains(session.result()->quads).closedNear(cycle.points, 0.7).empty());
}

/// A cube of 12 triangles, with quads much smaller than these.
class SessionOnACube : public ::testing::Test
{
protected:
  SessionOnACube() : session_(toInput(unitCube(1)), sessionOptions(2400)) {}

  const ConstraintReport& word()
  {
    const SessionReport& report = session_.update();
    EXPECT_TRUE(report.status.ok()) << report.status.message;
    const ConstraintReport& word = report.constraints[0];
    EXPECT_TRUE(word.isMet) << word.text << ": " << word.reason;
    return word;
  }
  const QuadMesh& quads() const { return session_.result()->quads; }

  static constexpr double kEdge = 0.05; // of the quads
  Session session_;
};

TEST_F(SessionOnACube, AValenceComesToItsPlace)
{
  const Vector3 middle(0.5, 0.5, 1);
  session_.add(ValenceAt{ middle, 3 });
  EXPECT_LE(word().deviation, 0.3);
  double least = 1e300;
  for (std::size_t i = 0; i < quads().points.size(); ++i)
  {
    const bool isAsked = quads().valence[i] == 3 && quads().points[i].z() > 1 - 1e-9;
    least = isAsked ? std::min(least, (quads().points[i] - middle).norm()) : least;
  }
  EXPECT_LE(least, 0.3 * kEdge);
}

TEST_F(SessionOnACube, AFeatureRunsAslantAcrossASide)
{
  const Vector3 a(0.2, 0.1, 1), b(0.9, 0.8, 1);
  session_.add(FeatureLine{ { a, b } });
  word();
  constexpr int kSteps = 100;
  for (int i = 0; i <= kSteps; ++i)
  {
    const Vector3 p = a + (b - a) * i / kSteps;
    double least = 1e300;
    for (const std::array<Index, 4>& quad : quads().quads)
    {
      for (std::size_t k = 0; k < 4; ++k)
      {
        const Vector3& c = quads().points[quad[k]];
        const Vector3& d = quads().points[quad[(k + 1) % 4]];
        least = std::min(least, distanceToSegment(p, c, d));
      }
    }
    EXPECT_LE(least, 0.3 * kEdge) << p.transpose();
  }
}

/// The mean angle between a direction on the upper side and the edges of the quads, of those near a segment.
double meanAngle(const QuadMesh& quads, const Vector3& a, const Vector3& b, double reach)
{
  double sum = 0;
  std::size_t count = 0;
  for (const std::array<Index, 4>& quad : quads.quads)
  {
    const auto at = [&](std::size_t k) { return quads.points[quad[k]]; };
    const Vector3 centre = 0.25 * (at(0) + at(1) + at(2) + at(3));
    if (centre.z() < 1 - 1e-9 || distanceToSegment(centre, a, b) > reach)
    {
      continue;
    }
    double least = kPi / 2;
    for (const Vector3& edge :
      { Vector3(at(1) + at(2) - at(0) - at(3)), Vector3(at(2) + at(3) - at(0) - at(1)) })
    {
      least = std::min(least, std::atan2(edge.cross(b - a).norm(), std::abs(edge.dot(b - a))));
    }
    sum += least * 180 / kPi;
    ++count;
  }
  return sum / static_cast<double>(count);
}

/// The cube's edges leave the quads of a side no room to turn all the way, which the word says.
TEST_F(SessionOnACube, StrokesTurnTheQuadsWithinTheirRadius)
{
  constexpr double kAngle = 56 * kPi / 180;
  const Vector3 along(std::cos(kAngle), std::sin(kAngle), 0), middle(0.5, 0.5, 1);
  const Vector3 a = middle - 0.25 * along, b = middle + 0.25 * along;
  QuadMesh before;
  for (const double radius : { 0.1, 0.3 })
  {
    const int id = session_.add(GuideStroke{ { a, b }, 1, radius });
    const SessionReport& report = session_.update();
    ASSERT_TRUE(report.status.ok()) << report.status.message;
    const double angle = meanAngle(quads(), a, b, radius);
    EXPECT_LT(angle, 12); // of 34 without it
    EXPECT_NEAR(report.constraints[0].deviation, angle, 1.5);
    EXPECT_EQ(report.constraints[0].isMet, report.constraints[0].deviation <= 5);
    EXPECT_FALSE(areSame(quads(), before)) << radius;
    before = quads();
    session_.remove(id);
  }
}

TEST_F(SessionOnACube, SizesHoldWithinTheirRadius)
{
  const Vector3 middle(0.5, 0.5, 1);
  session_.add(SizeAt{ middle, 0.2, 0.4 });
  word();
  double near = 0, all = 0;
  std::size_t nearCount = 0;
  for (const std::array<Index, 4>& quad : quads().quads)
  {
    const double area = 0.5 *
      (quads().points[quad[2]] - quads().points[quad[0]])
        .cross(quads().points[quad[3]] - quads().points[quad[1]])
        .norm();
    all += area;
    if ((quads().points[quad[0]] - middle).norm() < 0.2)
    {
      near += area;
      ++nearCount;
    }
  }
  EXPECT_NEAR(all, 6, 1e-3);
  ASSERT_GT(nearCount, 0U);
  const double length = std::sqrt(near / static_cast<double>(nearCount));
  EXPECT_LT(length, 0.6 * session_.result()->targetEdgeLength);
}

TEST_F(SessionOnACube, ACycleIsMetInWordsAndNotices)
{
  session_.add(Cycle{ { { 0.5, 0.5, 1 }, { 1, 0.5, 0.5 }, { 0.5, 0.5, 0 }, { 0, 0.5, 0.5 } } });
  EXPECT_LE(word().deviation, 0.05);
  for (const std::string& notice : session_.update().notices)
  {
    EXPECT_EQ(notice.find("not met"), std::string::npos) << notice;
  }
}

TEST(Session, SizesMakeSmallerQuads)
{
  Session session(dents(), sessionOptions(600));
  session.add(SizeAt{ { 0, 0, 1 }, 0.5, 0.4 });
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  const QuadMesh& quads = session.result()->quads;
  double near = 0, far = 0;
  std::size_t nearCount = 0, farCount = 0;
  for (const std::array<Index, 4>& quad : quads.quads)
  {
    const double area = (quads.points[quad[2]] - quads.points[quad[0]])
                          .cross(quads.points[quad[3]] - quads.points[quad[1]])
                          .norm() /
      2;
    const bool isNear = (quads.points[quad[0]] - Vector3(0, 0, 1)).norm() < 0.3;
    (isNear ? near : far) += area;
    ++(isNear ? nearCount : farCount);
  }
  ASSERT_GT(nearCount, 0u);
  EXPECT_LT(near / static_cast<double>(nearCount), 0.5 * far / static_cast<double>(farCount));
}

TEST(Session, StatesHaveNamesAndAreCompared)
{
  Session session(dents(), sessionOptions(400));
  session.update();
  session.nameState("plain");
  const int guide = session.add(kStroke);
  RemeshOptions finer = session.settings();
  finer.quads = 500;
  session.setSettings(finer);
  session.update();
  session.nameState("guided");
  const StateComparison comparison = session.compare("plain", "guided");
  EXPECT_EQ(comparison.settings, std::vector<std::string>{ "quads: 400, 500" });
  EXPECT_EQ(comparison.onlySecond, std::vector<int>{ guide });
  EXPECT_TRUE(comparison.onlyFirst.empty());
  EXPECT_TRUE(comparison.changed.empty());
  ASSERT_TRUE(comparison.results.has_value());
  EXPECT_GT(comparison.results->quads[1], comparison.results->quads[0]);
  // On a closed surface the sums of indices are equal.
  EXPECT_EQ(comparison.results->unmatched, 0);
  const StateComparison same = session.compare("guided", "");
  EXPECT_TRUE(same.settings.empty() && same.onlyFirst.empty() && same.onlySecond.empty());
  EXPECT_EQ(same.results->distance, 0.0);

  session.goTo("plain");
  EXPECT_TRUE(session.constraints().empty());
  EXPECT_EQ(session.update().runs, 0);
  session.undo();
  EXPECT_EQ(session.constraints().size(), 1u);
  EXPECT_THROW(session.goTo("nothing"), InvalidInput);
}

TEST(Session, PreviewsAreOnTheWayToTheResult)
{
  Session session(dents(), sessionOptions(400));
  session.add(kStroke);
  const SessionResult preview = session.preview();
  ASSERT_TRUE(preview.report.status.ok()) << preview.report.status.message;
  EXPECT_TRUE(hasRun(preview.report, "preview"));
  EXPECT_FALSE(hasRun(preview.report, "replay"));
  EXPECT_FALSE(session.result());

  // All up to the coarse map is there; its integers are those of the preview, and so is the number of quads.
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  for (const char* stage :
    { "repair", "order", "phase1", "phase2", "field", "seamless", "quantize", "embed" })
  {
    EXPECT_TRUE(hasRun(preview.report, stage)) << stage;
    EXPECT_FALSE(hasRun(report, stage)) << stage;
  }
  EXPECT_TRUE(hasRun(report, "replay"));
  const QuadMesh quads = session.result()->quads;
  EXPECT_EQ(preview.quads.quads.size(), quads.quads.size());

  // With the result at hand it is still made, and the result stays.
  const SessionResult again = session.preview();
  ASSERT_TRUE(again.report.status.ok()) << again.report.status.message;
  EXPECT_TRUE(areSame(again.quads, preview.quads));
  EXPECT_EQ(session.update().runs, 0);
  EXPECT_TRUE(areSame(session.result()->quads, quads));

  Session fresh(dents(), sessionOptions(400));
  fresh.add(kStroke);
  ASSERT_TRUE(fresh.update().status.ok());
  EXPECT_TRUE(areSame(fresh.result()->quads, quads));
}

TEST(Session, AStoppedPreviewSaysSo)
{
  Session session(dents(), sessionOptions(400));
  session.setProgress([](double, const std::string&) { return false; });
  const SessionResult preview = session.preview();
  EXPECT_EQ(preview.report.status.code, StatusCode::Cancelled);
  EXPECT_TRUE(preview.quads.quads.empty());
}

TEST(Session, AStopLeavesNoResult)
{
  Session session(dents(), sessionOptions(400));
  session.setProgress([](double, const std::string&) { return false; });
  EXPECT_EQ(session.update().status.code, StatusCode::Cancelled);
  EXPECT_FALSE(session.result());
  session.setProgress({});
  EXPECT_TRUE(session.update().status.ok());
}

TEST(Session, AStopKeepsTheQuadsSoFarUntilTheNextUpdate)
{
  Session fresh(test::sphereWithoutRoom(), sessionOptions(100));
  ASSERT_TRUE(fresh.update().status.ok());
  ASSERT_TRUE(fresh.update().stopped.empty());

  Session session(test::sphereWithoutRoom(), sessionOptions(100));
  bool isOver = false;
  session.setProgress(
    [&](double, const std::string& text)
    {
      isOver = isOver || text.rfind("Attempt 2", 0) == 0;
      return !isOver;
    });
  const SessionReport& report = session.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_EQ(report.stopped.rfind("Attempt 2", 0), 0U) << report.stopped;
  ASSERT_TRUE(session.result());
  EXPECT_GT(session.result()->quads.quads.size(), 70U);
  // A change of the state has none.
  RemeshOptions other = session.settings();
  other.quads = 150;
  session.setSettings(other);
  EXPECT_FALSE(session.result());
  ASSERT_TRUE(session.undo());
  EXPECT_TRUE(session.result());
  // An operation on irregular vertices needs the result itself.
  IrregularEdit edit;
  edit.operation = IrregularOperation::Move;
  edit.points = { { 1, 0, 0 }, { 0, 1, 0 } };
  isOver = false;
  EXPECT_THROW(session.add(edit), InvalidInput);

  session.setProgress({});
  EXPECT_TRUE(session.update().stopped.empty());
  EXPECT_TRUE(areSame(session.result()->quads, fresh.result()->quads));
}

TEST(Session, RefusesWhatCannotBe)
{
  EXPECT_THROW(Session(SurfaceInput{}, sessionOptions(10)), InvalidInput);
  RemeshOptions nothing;
  nothing.quads = 0;
  EXPECT_THROW(Session(dents(), nothing), InvalidInput);
  Session session(dents(), sessionOptions(100));
  EXPECT_THROW(session.add(FeatureLine{ { { 0, 0, 1 } } }), InvalidInput);
  EXPECT_THROW(session.add(ValenceAt{ { 0, 0, 1 }, 9 }), InvalidInput);
  EXPECT_THROW(session.add(ValenceAt{ { 0, 0, std::nan("") }, 5 }), InvalidInput);
  EXPECT_THROW(session.add(GuideRegion{ { 1000000 }, { 1, 0, 0 }, 1 }), InvalidInput);
  EXPECT_THROW(session.add(GuideRegion{ { 1 }, { 0, 0, 0 }, 1 }), InvalidInput);
  EXPECT_THROW(session.add(SizeAt{ { 0, 0, 1 }, 0.1, 0 }), InvalidInput);
  EXPECT_THROW(session.add(Cycle{ { { 0, 0, 1 }, { 1, 0, 0 } } }), InvalidInput);
  EXPECT_TRUE(session.constraints().empty());
  EXPECT_FALSE(session.canUndo());
}

} // namespace
} // namespace quadrille
