// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Moves of irregular vertices that are drawn, by the places where the quads show them.
#include "SessionHelpers.h"

#include "Evaluation/ConstraintMeasures.h"
#include "Session/IrregularMatch.h"
#include "Session/Moves.h"
#include "Symmetry/Isometry.h"

#include <optional>
#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

class Moves : public ::testing::Test
{
protected:
  Moves() : options_(sessionOptions(400))
  {
    options_.keepsPositions = true;
    quads_ = remesh(dents(), options_).quads;
    for (Index p = 0; p < quads_.points.size(); ++p)
    {
      if (quads_.valence[p] == 3)
      {
        threes_.push_back(quads_.points[p]);
      }
    }
  }

  UncutResult run(SurfaceInput input, const RemeshOptions& options) const
  {
    const bool isMoved = input.regularElsewhere;
    UncutResult made;
    if (input.regularOnFeatures && !holdsFeatures_)
    {
      made.remeshed.status = { StatusCode::Infeasible, "they are not" };
      return made;
    }
    made.remeshed = remesh(std::move(input), options);
    if (isMoved && losesAComponent_)
    {
      made.remeshed.failed.components = 2;
      made.remeshed.failed.ofComponents = 5;
      made.remeshed.failed.why = "there is no map";
    }
    else if (losesAComponent_)
    {
      made.remeshed.failed.components = 1;
    }
    return made;
  }

  /// One 3 is dragged onto another.
  UncutResult move()
  {
    PlacedConstraint placed;
    placed.kind = ConstraintKind::Move;
    placed.given = placed.path = { threes_.front(), threes_.back() };
    placed_ = { placed };
    return remeshWithMoves(
      dents(), options_,
      [this](SurfaceInput input, const RemeshOptions& options)
      { return run(std::move(input), options); },
      {}, placed_, notices_);
  }

  RemeshOptions options_;
  QuadMesh quads_; ///< before
  std::vector<Vector3> threes_;
  bool losesAComponent_ = false, holdsFeatures_ = true;
  std::vector<PlacedConstraint> placed_;
  std::vector<std::string> notices_;
};

TEST_F(Moves, OfTwoBallsOneIsLeft)
{
  ASSERT_GT(threes_.size(), 1U);
  const UncutResult made = move();
  const QuadMesh& quads = made.remeshed.quads;
  ASSERT_EQ(placed_[0].whyNot, "");
  EXPECT_EQ(placed_[0].valence, 2);
  ASSERT_TRUE(placed_[0].irregular);
  const ConstraintMeasure word = ConstraintMeasures(quads).move(placed_[0]);
  EXPECT_TRUE(word.isMet) << word.reason;
  const double edgeLength = made.remeshed.targetEdgeLength;
  std::size_t irregular = 0;
  for (Index p = 0; p < quads.points.size(); ++p)
  {
    irregular += quads.valence[p] != 4 && (quads.points[p] - threes_.back()).norm() < edgeLength;
    EXPECT_TRUE(quads.valence[p] == 4 || (quads.points[p] - threes_.front()).norm() > edgeLength);
  }
  EXPECT_EQ(irregular, 1U);
}

TEST_F(Moves, OneThatLosesAComponentIsLeftOut)
{
  losesAComponent_ = true;
  const UncutResult made = move();
  EXPECT_TRUE(areSame(made.remeshed.quads, quads_));
  EXPECT_EQ(made.remeshed.failed.components, 1U); // as without the move
  EXPECT_NE(placed_[0].whyNot.find("with it 2 of 5 connected components"), std::string::npos)
    << placed_[0].whyNot;
  ASSERT_EQ(notices_.size(), 1U);
  EXPECT_EQ(notices_[0], "an irregular vertex is not moved: " + placed_[0].whyNot);
}

/// Nothing that was asked for is left undone.
TEST_F(Moves, ThatFeaturesAreNotHeldIsANoticeOfTheRun)
{
  holdsFeatures_ = false;
  const UncutResult made = move();
  EXPECT_EQ(placed_[0].whyNot, "");
  EXPECT_TRUE(notices_.empty());
  const std::vector<std::string>& notices = made.remeshed.notices;
  EXPECT_EQ(std::count(notices.begin(), notices.end(),
              "moves may change irregular vertices on features, as these cannot be held: they are "
              "not"),
    1);
}

/// The word on a move of a vertex of a flange's upper side, which sharp edges bound, to a place.
ConstraintMeasure wordOnPart(const Vector3& to)
{
  constexpr double kFeatureAngle = 40 * 3.14159265358979323846 / 180;
  const auto surface = loadPly(QUADRILLE_DATA "/part.ply");
  RemeshOptions options = sessionOptions(3000);
  options.coarseVertices = 1000;
  options.featureAngle = kFeatureAngle;
  options.keepsPositions = true;
  PlacedConstraint placed;
  placed.kind = ConstraintKind::Move;
  placed.given = placed.path = { { -33.7, -43.1, 12 }, to };
  std::vector<PlacedConstraint> all{ placed };
  std::vector<std::string> notices;
  const UncutResult made = remeshWithMoves(
    *surface, options,
    [](SurfaceInput input, const RemeshOptions& asked)
    {
      UncutResult result;
      result.remeshed = remesh(std::move(input), asked);
      return result;
    },
    {}, all, notices);
  EXPECT_EQ(all[0].whyNot, "");
  return ConstraintMeasures(made.remeshed.quads).move(all[0]);
}

/// As in a session: the vertex is where it was to be, but others have come on the sides that the features bound.
TEST(MovesOnAPart, TheWordOnOneAcrossAFeatureTellsWhatItChanges)
{
  const ConstraintMeasure word = wordOnPart({ -18.7, -49.8, 11.9 });
  EXPECT_LT(word.deviation, 0.3);
  EXPECT_FALSE(word.isMet);
  EXPECT_NE(word.reason.find("other irregular vertices are not as they were"), std::string::npos)
    << word.reason;
  EXPECT_NE(word.reason.find("cannot pass features"), std::string::npos) << word.reason;
}

TEST(MovesOnAPart, OneThatLeavesTheOthersIsMet)
{
  const ConstraintMeasure word = wordOnPart({ -28.6, -36.6, 12 });
  EXPECT_TRUE(word.isMet) << word.reason;
}

TEST(ExpectedIrregular, HasTheImagesOfASymmetry)
{
  const std::vector<IrregularVertex> shown{ { Vector3(1, 2, 3), 5 }, { Vector3(4, 5, 6), 3 } };
  EXPECT_EQ(expectedIrregular(shown, std::nullopt).size(), 2U);
  const std::vector<ValencePlace> mirrored =
    expectedIrregular(shown, Isometry::of(MirrorPlane{ Vector3::Zero(), Vector3::UnitX() }));
  ASSERT_EQ(mirrored.size(), 4U);
  EXPECT_EQ(mirrored[0].place, shown[0].place);
  EXPECT_EQ(mirrored[3].place, Vector3(-4, 5, 6));
  EXPECT_EQ(mirrored[3].valence, 3);
  const std::vector<ValencePlace> turned =
    expectedIrregular(shown, Isometry::of(RotationAxis{ Vector3::Zero(), Vector3::UnitZ() }, 4));
  ASSERT_EQ(turned.size(), 8U);
  EXPECT_TRUE(turned[2].place.isApprox(Vector3(-1, -2, 3)));
}

} // namespace
} // namespace quadrille
