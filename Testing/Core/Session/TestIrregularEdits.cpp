// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Operations on irregular vertices, found again in the quads.
#include "SessionHelpers.h"

#include "Base/PlaceText.h"
#include "Mesh/Requests.h"
#include "PlyFile.h"
#include "Session/IrregularEdits.h"
#include "Session/IrregularMatch.h"
#include "StaggeredTube.h"

#include <memory>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

class IrregularEdits : public ::testing::Test
{
protected:
  IrregularEdits() : session_(dents(), sessionOptions(400))
  {
    EXPECT_TRUE(session_.update().status.ok());
    before_ = session_.result()->irregular;
  }

  /// The one vertex whose neighbour among irregular ones is farthest.
  const IrregularVertex& loneliest(int valence) const
  {
    const IrregularVertex* best = nullptr;
    double farthest = -1;
    for (const IrregularVertex& vertex : before_)
    {
      double nearest = 1e300;
      for (const IrregularVertex& other : before_)
      {
        nearest = other.place == vertex.place
          ? nearest
          : std::min(nearest, (other.place - vertex.place).norm());
      }
      if (vertex.valence == valence && nearest > farthest)
      {
        farthest = nearest;
        best = &vertex;
      }
    }
    EXPECT_NE(best, nullptr);
    return *best;
  }

  /// After the update: exactly these irregular vertices, in the map and in the quads. Those that were there before are
  /// smoothed as they were then, and so lie beside their places in the map.
  void expectIrregular(PlaceValences expected)
  {
    const SessionReport& report = session_.update();
    ASSERT_TRUE(report.status.ok()) << report.status.message;
    for (const ConstraintReport& word : report.constraints)
    {
      EXPECT_TRUE(word.isMet) << word.text << ": " << word.reason;
    }
    EXPECT_FALSE(hasRun(report, "phase1"));
    const SessionResult& result = *session_.result();
    EXPECT_EQ(valencesOf(result), expected);
    EXPECT_EQ(indexSum(result.quads), 8); // of a sphere
    std::size_t irregular = 0;
    for (const int valence : result.quads.valence)
    {
      irregular += valence != 4;
    }
    EXPECT_EQ(irregular, expected.size());
    for (const auto& [place, valence] : expected)
    {
      EXPECT_TRUE(wasThere(place, valence) ? isBeside(place, valence)
                                           : quadValenceAt(result.quads, place) == valence)
        << placeText(place);
    }
  }

  bool wasThere(const Vector3& place, int valence) const
  {
    return std::any_of(before_.begin(), before_.end(),
      [&](const IrregularVertex& v) { return v.place == place && v.valence == valence; });
  }
  bool isBeside(const Vector3& place, int valence) const
  {
    const QuadMesh& quads = session_.result()->quads;
    const double edgeLength = std::sqrt(4 * 3.14159265358979323846 / 400); // of a sphere
    for (Index p = 0; p < quads.points.size(); ++p)
    {
      if (quads.valence[p] == valence && (quads.points[p] - place).norm() < edgeLength)
      {
        return true;
      }
    }
    return false;
  }

  Session session_;
  std::vector<IrregularVertex> before_;
};

TEST_F(IrregularEdits, AMovedVertexLeavesTheOthers)
{
  const IrregularVertex from = loneliest(3);
  const Vector3 to = emptiestPlace(session_, before_);
  PlaceValences expected = valencesOf(*session_.result());
  session_.add(IrregularEdit{ IrregularOperation::Move, { from.place, to }, {}, {}, {}, {} });
  expected.erase(from.place);
  expected[to] = 3;
  expectIrregular(expected);
}

/// A place that nobody asked for holds no point: quads beside it would be worse than those that the user saw.
TEST_F(IrregularEdits, AMovedVertexLeavesTheOthersAsSmoothAsTheyWere)
{
  const IrregularVertex from = loneliest(3);
  const Vector3 to = emptiestPlace(session_, before_);
  session_.add(IrregularEdit{ IrregularOperation::Move, { from.place, to }, {}, {}, {}, {} });
  ASSERT_TRUE(session_.update().status.ok());
  const QuadMesh& quads = session_.result()->quads;
  EXPECT_EQ(quadValenceAt(quads, to), 3);
  for (const IrregularVertex& vertex : before_)
  {
    EXPECT_NE(quadValenceAt(quads, vertex.place), vertex.valence) << placeText(vertex.place);
  }
}

TEST_F(IrregularEdits, APairComesAndGoes)
{
  PlaceValences expected = valencesOf(*session_.result());
  const PlaceValences first = expected;
  const Vector3 a = emptiestPlace(session_, before_);
  std::vector<IrregularVertex> with = before_;
  with.push_back({ a, 3 });
  const Vector3 b = emptiestPlace(session_, with);
  session_.add(IrregularEdit{ IrregularOperation::Add, { a, b }, {}, {}, {}, {} });
  expected[a] = 3;
  expected[b] = 5;
  expectIrregular(expected);
  session_.add(IrregularEdit{ IrregularOperation::Cancel, { b, a }, {}, {}, {}, {} });
  expectIrregular(first);
}

TEST_F(IrregularEdits, VerticesMergeAndSplit)
{
  PlaceValences expected = valencesOf(*session_.result());
  const IrregularVertex a = loneliest(3);
  // The nearest other one of valence 3.
  const IrregularVertex* b = nullptr;
  for (const IrregularVertex& vertex : before_)
  {
    if (vertex.valence == 3 && vertex.place != a.place &&
      (!b || (vertex.place - a.place).norm() < (b->place - a.place).norm()))
    {
      b = &vertex;
    }
  }
  ASSERT_NE(b, nullptr);
  const PlaceValences first = expected;
  session_.add(IrregularEdit{ IrregularOperation::Merge, { a.place, b->place }, {}, {}, {}, {} });
  expected[a.place] = 2;
  expected.erase(b->place);
  expectIrregular(expected);
  session_.add(
    IrregularEdit{ IrregularOperation::Split, { a.place, a.place, b->place }, {}, {}, {}, {} });
  expectIrregular(first);
}

/// A user gives places by the points of the quads, from which smoothing has moved the vertices of the map.
TEST_F(IrregularEdits, AVertexThatIsMovedToWhereAnotherIsSeenJoinsIt)
{
  PlaceValences expected = valencesOf(*session_.result());
  const QuadMesh& quads = session_.result()->quads;
  const ShownPlaces shown = shownPlaces(before_, quads, NearestQuads(quads));
  EXPECT_EQ(shown.size(), before_.size());
  const IrregularVertex a = loneliest(3);
  const IrregularVertex b = *std::min_element(before_.begin(), before_.end(),
    [&](const IrregularVertex& v, const IrregularVertex& w)
    {
      const auto rank = [&a](const IrregularVertex& other)
      { return std::pair(other.valence != 3 || other == a, (other.place - a.place).norm()); };
      return rank(v) < rank(w);
    });
  const ShownPlace& goal = shown.at(b.place);
  const Vector3 aside = (shown.at(a.place).point - goal.point).normalized();
  session_.add(IrregularEdit{ IrregularOperation::Move,
    { shown.at(a.place).point, goal.point + 0.4 * goal.edgeLength * aside }, {}, {}, {}, {} });
  const auto& edit = std::get<IrregularEdit>(session_.constraints().back()->content);
  const auto made = std::find_if(edit.changes.begin(), edit.changes.end(),
    [](const IrregularEdit::Change& change) { return change.after == 2; });
  ASSERT_NE(made, edit.changes.end());
  EXPECT_LT((made->place - goal.point).norm(), 0.01 * goal.edgeLength);
  expected.erase(a.place);
  expected.erase(b.place);
  expected[made->place] = 2;
  const SessionReport& report = session_.update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_EQ(valencesOf(*session_.result()), expected);
}

TEST_F(IrregularEdits, AnOperationThatIsTakenBackLeavesTheLaterOnes)
{
  PlaceValences expected = valencesOf(*session_.result());
  const Vector3 a = emptiestPlace(session_, before_);
  std::vector<IrregularVertex> with = before_;
  with.push_back({ a, 3 });
  const Vector3 b = emptiestPlace(session_, with);
  const IrregularVertex from = loneliest(3);
  const int move =
    session_.add(IrregularEdit{ IrregularOperation::Move, { from.place, a }, {}, {}, {}, {} });
  session_.update();
  const IrregularVertex other = *std::find_if(before_.begin(), before_.end(),
    [&](const IrregularVertex& v) { return v.valence == 3 && v.place != from.place; });
  session_.add(IrregularEdit{ IrregularOperation::Move, { other.place, b }, {}, {}, {}, {} });
  session_.update();
  session_.remove(move);
  expected.erase(other.place);
  expected[b] = 3;
  expectIrregular(expected);
}

TEST_F(IrregularEdits, RefusesWhatTheSumDoesNotAllow)
{
  const IrregularVertex from = loneliest(3);
  const auto messageOf = [this](const IrregularEdit& edit)
  {
    try
    {
      session_.add(edit);
    }
    catch (const InvalidInput& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  const Vector3 a = emptiestPlace(session_, before_);
  EXPECT_NE(
    messageOf({ IrregularOperation::Add, { a, from.place }, { 3, 4 }, {}, {}, {} }).find("by 1"),
    std::string::npos);
  EXPECT_NE(messageOf({ IrregularOperation::Split, { from.place, from.place, a }, {}, {}, {}, {} })
              .find("no half"),
    std::string::npos);
  EXPECT_NE(messageOf({ IrregularOperation::Move, { from.place, from.place }, {}, {}, {}, {} })
              .find("already"),
    std::string::npos);
  const IrregularVertex other = *std::find_if(before_.begin(), before_.end(),
    [&](const IrregularVertex& v) { return v.valence == 3 && v.place != from.place; });
  EXPECT_NE(messageOf({ IrregularOperation::Cancel, { from.place, other.place }, {}, {}, {}, {} })
              .find("by -2"),
    std::string::npos);
  EXPECT_TRUE(session_.constraints().empty());
}

TEST_F(IrregularEdits, ValencesThatKeepTheSumLeaveTheOthersToo)
{
  const Vector3 a = emptiestPlace(session_, before_);
  const IrregularVertex from = loneliest(3);
  session_.add(IrregularEdit{ IrregularOperation::Move, { from.place, a }, {}, {}, {}, {} });
  session_.update();
  PlaceValences expected = valencesOf(*session_.result());
  const Vector3 b = emptiestPlace(session_, session_.result()->irregular);
  std::vector<IrregularVertex> with = session_.result()->irregular;
  with.push_back({ b, 3 });
  const Vector3 c = emptiestPlace(session_, with);
  session_.add(ValenceAt{ b, 3 });
  session_.add(ValenceAt{ c, 5 });
  expected[b] = 3;
  expected[c] = 5;
  expectIrregular(expected);
}

/// A flange, whose sides are bounded by sharp edges, with triangles larger than quads.
class IrregularEditsOnAPart : public ::testing::Test
{
protected:
  void SetUp() override
  {
    const auto surface = loadPly(QUADRILLE_DATA "/part.ply");
    ASSERT_TRUE(surface);
    RemeshOptions options = sessionOptions(3000);
    options.coarseVertices = 1000;
    options.featureAngle = 40 * kDegree;
    session_ = std::make_unique<Session>(*surface, options);
    ASSERT_TRUE(session_->update().status.ok());
    before_ = session_->result()->irregular;
    // One on the flange's upper side.
    const Vector3 there(-33.7, -43.1, kUpperSide);
    from_ = *std::min_element(before_.begin(), before_.end(),
      [&](const IrregularVertex& a, const IrregularVertex& b)
      { return (a.place - there).norm() < (b.place - there).norm(); });
    ASSERT_NEAR(from_.place.z(), kUpperSide, 1e-3);
  }

  static constexpr double kDegree = 3.14159265358979323846 / 180;
  static constexpr double kUpperSide = 12;
  std::unique_ptr<Session> session_;
  std::vector<IrregularVertex> before_;
  IrregularVertex from_;
};

TEST_F(IrregularEditsOnAPart, AllOthersStay)
{
  const std::vector<HeldVertex> onFeatures = session_->result()->onFeatures;
  const Vector3 aside = from_.place * 0.85 + Vector3(0, 0, 0.15 * kUpperSide);
  session_->add(IrregularEdit{ IrregularOperation::Move, { from_.place, aside }, {}, {}, {}, {} });
  const SessionReport& report = session_->update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_TRUE(report.constraints.front().isMet) << report.constraints.front().reason;
  const std::vector<IrregularVertex>& after = session_->result()->irregular;
  EXPECT_EQ(after.size(), before_.size());
  for (const IrregularVertex& vertex : before_)
  {
    const bool stays = std::any_of(after.begin(), after.end(),
      [&](const IrregularVertex& other)
      { return other.place == vertex.place && other.valence == vertex.valence; });
    EXPECT_EQ(stays, vertex.place != from_.place);
  }
  // Other triangles of the coarse level, the same turns.
  const std::vector<HeldVertex>& there = session_->result()->onFeatures;
  ASSERT_EQ(there.size(), onFeatures.size());
  for (std::size_t i = 0; i < there.size(); ++i)
  {
    EXPECT_EQ(there[i].point, onFeatures[i].point);
    EXPECT_EQ(there[i].place, onFeatures[i].place);
    ASSERT_EQ(there[i].sectors.size(), onFeatures[i].sectors.size());
  }
}

/// Where a line crosses features there are corners, which the word on a move before it does not count as changes.
TEST_F(IrregularEditsOnAPart, AConnectionAfterAMoveLeavesTheWordOnThat)
{
  const Vector3 from(-51.294, -26.9205, kUpperSide), to(-42.6415, -22.6414, kUpperSide);
  session_->add(IrregularEdit{ IrregularOperation::Move, { from, to }, {}, {}, {}, {} });
  session_->update();
  session_->add(
    Connection{ { Vector3(51.2822, -28.9554, kUpperSide), Vector3(-10.5105, 7.00702, 0) } });
  const SessionReport& report = session_->update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  for (const ConstraintReport& word : report.constraints)
  {
    EXPECT_TRUE(word.isMet) << word.text << ": " << word.reason;
  }
}

/// Where a vertex of a feature looks irregular the nearest one inside is not what is meant.
TEST_F(IrregularEditsOnAPart, VerticesOfFeaturesDoNotMove)
{
  ASSERT_FALSE(session_->result()->fixed.edges.empty());
  const Vector3 corner = session_->result()->fixed.edges.front()[0];
  try
  {
    session_->add(
      IrregularEdit{ IrregularOperation::Move, { corner, from_.place }, {}, {}, {}, {} });
    ADD_FAILURE() << "an irregular vertex inside was taken for the corner";
  }
  catch (const InvalidInput& error)
  {
    EXPECT_NE(std::string(error.what()).find("whose vertices stay"), std::string::npos)
      << error.what();
  }
}

/// Between features the sum of indices is what it is.
TEST_F(IrregularEditsOnAPart, TheWordOnAMoveAcrossAFeatureTellsWhatItChanges)
{
  const Vector3 onTheRim(-18.7, -49.8, 11.9);
  session_->add(
    IrregularEdit{ IrregularOperation::Move, { from_.place, onTheRim }, {}, {}, {}, {} });
  const SessionReport& report = session_->update();
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  const ConstraintReport& word = report.constraints.front();
  EXPECT_FALSE(word.isMet);
  EXPECT_NE(word.reason.find("cannot pass features"), std::string::npos) << word.reason;
}

TEST(IrregularEditsOnCurves, PlacesOnFeaturesAreRefused)
{
  Session session(toInput(unitCube(8)), sessionOptions(100));
  ASSERT_TRUE(session.update().status.ok());
  EXPECT_TRUE(session.result()->irregular.empty()); // those of a cube are on its features
  EXPECT_THROW(session.add(IrregularEdit{
                 IrregularOperation::Add, { { 0, 0, 0.5 }, { 0.5, 0.5, 0 } }, {}, {}, {}, {} }),
    InvalidInput);
  EXPECT_THROW(session.add(IrregularEdit{
                 IrregularOperation::Move, { { 0, 0, 0.5 }, { 0.5, 0.5, 0 } }, {}, {}, {}, {} }),
    InvalidInput);
}

/// The quads there have irregular vertices that are those of no map.
TEST(IrregularEditsOnFilledFaces, AreRefusedWithTheFace)
{
  const PatchedMesh tube = staggeredTube(0.02);
  SurfaceInput input = toInput(tube.mesh);
  input.patchIds = tube.patch;
  RemeshOptions options = sessionOptions(300);
  options.coarseVertices = RemeshOptions().coarseVertices;
  Session session(input, options);
  ASSERT_TRUE(session.update().status.ok());
  ASSERT_FALSE(session.result()->fixed.withoutMap.empty());
  for (const IrregularVertex& vertex : session.result()->irregular)
  {
    EXPECT_GE(vertex.valence, kLeastValence);
  }
  const auto middleOf = [](const std::array<Vector3, 3>& triangle)
  { return Vector3((triangle[0] + triangle[1] + triangle[2]) / 3); };
  const std::vector<std::array<Vector3, 3>>& without = session.result()->fixed.withoutMap;
  const Vector3 first = middleOf(without.front()), second = middleOf(without.back());
  for (const IrregularOperation operation : { IrregularOperation::Move, IrregularOperation::Add })
  {
    try
    {
      session.add(IrregularEdit{ operation, { first, second }, {}, {}, {}, {} });
      ADD_FAILURE() << "no map has an irregular vertex there";
    }
    catch (const InvalidInput& error)
    {
      EXPECT_NE(std::string(error.what()).find("has no map"), std::string::npos) << error.what();
    }
  }
}

/// Both sides of a wall, unit quads from 0 to 8, a tenth of an edge apart; side 0 is seen from above.
Index pointOfWall(Index side, Index x, Index y)
{
  return (side * 9 + y) * 9 + x;
}

QuadMesh thinWall()
{
  QuadMesh quads;
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
        const Index left = pointOfWall(side, x, side == 0 ? y : y + 1);
        const Index right = pointOfWall(side, x, side == 0 ? y + 1 : y);
        quads.quads.push_back({ left, left + 1, right + 1, right });
      }
    }
  }
  quads.valence.assign(quads.points.size(), kRegularValence);
  quads.onBoundary.assign(quads.points.size(), 0);
  return quads;
}

/// On a wall one vertex is seen beside its place in the map, nearer to which is one of the other side.
class IrregularEditsOnAThinWall : public ::testing::Test
{
protected:
  IrregularEditsOnAThinWall()
  {
    quads_.valence[pointOfWall(0, 2, 4)] = quads_.valence[pointOfWall(1, 5, 4)] = 3;
    std::vector<Index> offsets{ 0 }, corners;
    for (const auto& quad : quads_.quads)
    {
      corners.insert(corners.end(), quad.begin(), quad.end());
      offsets.push_back(static_cast<Index>(corners.size()));
    }
    input_.points = quads_.points;
    input_.polygonOffsets = offsets;
    input_.polygonPoints = corners;
  }

  /// Of a move.
  IrregularEdit edited(const Vector3& from, const Vector3& to)
  {
    const SurfacePlaces places(input_);
    const NearestQuads nearest(quads_);
    const ShownPlaces shown = shownPlaces(irregular_, quads_, nearest);
    IrregularEdit edit;
    edit.points = { from, to };
    resolveEdit(edit, "move", { places, {}, 0.01, &shown, &nearest }, irregular_);
    return edit;
  }

  QuadMesh quads_ = thinWall();
  SurfaceInput input_;
  std::vector<IrregularVertex> irregular_{ { Vector3(2.5, 4, 0), 3 }, { Vector3(5, 4, -0.1), 3 } };
};

TEST_F(IrregularEditsOnAThinWall, AMoveOverOneOfTheOtherSideDoesNotJoinIt)
{
  const IrregularEdit edit = edited({ 2, 4, 0 }, { 5, 4, 0 });
  ASSERT_EQ(edit.changes.size(), 2U);
  EXPECT_EQ(edit.changes[0].place, Vector3(2.5, 4, 0));
  EXPECT_EQ(edit.changes[1].place, Vector3(5, 4, 0));
  EXPECT_EQ(edit.changes[1].after, 3);
  // From the other side it is that one.
  EXPECT_EQ(edited({ 5, 4, -0.1 }, { 2.1, 4, -0.1 }).changes[1].place, Vector3(5, 4, -0.1));
}

TEST_F(IrregularEditsOnAThinWall, AMoveTakesTheVertexOfItsSide)
{
  // Under it one of the other side.
  EXPECT_EQ(edited({ 4.9, 4, 0 }, { 4, 6, 0 }).changes[0].place, Vector3(2.5, 4, 0));
}

TEST_F(IrregularEditsOnAThinWall, AVertexIsShownOnItsOwnSide)
{
  irregular_ = { { Vector3(4, 4, 0), 3 }, { Vector3(3.5, 4, -0.1), 3 } };
  const ShownPlaces shown = shownPlaces(irregular_, quads_, NearestQuads(quads_));
  ASSERT_EQ(shown.size(), 2U);
  EXPECT_EQ(shown.at(irregular_[0].place).point, Vector3(2, 4, 0));
  EXPECT_EQ(shown.at(irregular_[1].place).point, Vector3(5, 4, -0.1));
}

TEST(IrregularMatch, PairsAsManyAsCanBe)
{
  // The nearest pair alone would leave the first one and the last one without a partner.
  const auto at = [](double x, int valence) {
    return IrregularVertex{ Vector3(x, 0, 0), valence };
  };
  const IrregularMatch match = matchIrregular(
    { at(0, 3), at(1.5, 3), at(5, 5) }, { at(0.8, 3), at(3, 3), at(5, 3) }, { 2, 2, 2 });
  ASSERT_EQ(match.actual.size(), 3U);
  EXPECT_EQ(match.actual[0], std::optional<std::size_t>(0));
  EXPECT_EQ(match.actual[1], std::optional<std::size_t>(1));
  EXPECT_FALSE(match.actual[2]);
  EXPECT_EQ(match.unexpected, std::vector<std::size_t>{ 2 });
}

} // namespace
} // namespace quadrille
