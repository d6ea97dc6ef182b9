// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Constraints on a surface some of whose faces between features have no map: in the others they hold.
#include "SessionHelpers.h"

#include "Mesh/Distance.h"
#include "StaggeredTube.h"

#include <algorithm>
#include <array>
#include <limits>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

/// Of four patches, which are the halves of a tube in front and behind, left and right.
class ConstraintsOnFilledFaces : public ::testing::Test
{
protected:
  ConstraintsOnFilledFaces() : session_(input(), options())
  {
    EXPECT_TRUE(session_.update().status.ok());
    EXPECT_FALSE(filled().empty());
    for (const double x : { -0.5, 0.5 })
    {
      for (const double z : { -0.5, 0.5 })
      {
        const Vector3 place(x, 0, z);
        (isFilled(place) ? inFilled_ : inRest_).push_back(place);
      }
    }
  }

  static SurfaceInput input()
  {
    const PatchedMesh tube = staggeredTube(0.02);
    SurfaceInput input = toInput(tube.mesh);
    input.patchIds = tube.patch;
    return input;
  }
  static RemeshOptions options()
  {
    RemeshOptions options = sessionOptions(600);
    options.coarseVertices = RemeshOptions().coarseVertices;
    return options;
  }

  std::vector<Vector3> filled() const { return session_.result()->fixed.insideOfFaces; }
  bool isFilled(const Vector3& place) const
  {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [a, b, c] : session_.result()->fixed.withoutMap)
    {
      least = std::min(least, (nearestOnTriangle(place, a, b, c) - place).norm());
    }
    return least < 0.02;
  }

  ConstraintReport wordOn(int id)
  {
    const SessionReport& report = session_.update();
    EXPECT_TRUE(report.status.ok()) << report.status.message;
    for (const ConstraintReport& word : report.constraints)
    {
      if (word.id == id)
      {
        return word;
      }
    }
    ADD_FAILURE() << "no word on " << id;
    return {};
  }

  Session session_;
  std::vector<Vector3> inFilled_, inRest_; ///< places on the surface, in the middle of patches
};

TEST_F(ConstraintsOnFilledFaces, SomeFacesHaveAMap)
{
  EXPECT_FALSE(inFilled_.empty());
  EXPECT_FALSE(inRest_.empty());
}

TEST_F(ConstraintsOnFilledFaces, AValenceIsMetWhereThereIsAMap)
{
  const std::size_t before = filled().size();
  const ConstraintReport word = wordOn(session_.add(ValenceAt{ inRest_.front(), 3 }));
  EXPECT_TRUE(word.isMet) << word.reason;
  EXPECT_LT(word.deviation, 1e-3);
  EXPECT_LE(filled().size(), before);
}

// A strip of quads may leave a patch with an irregular vertex over any side.
TEST_F(ConstraintsOnFilledFaces, AnIrregularVertexInOneGivesItAMap)
{
  const ConstraintReport word = wordOn(session_.add(ValenceAt{ inFilled_.front(), 5 }));
  EXPECT_TRUE(word.isMet) << word.reason;
  EXPECT_TRUE(filled().empty());
}

TEST_F(ConstraintsOnFilledFaces, OperationsLeaveTheFacesThatHaveNoMap)
{
  const std::vector<Vector3> before = filled();
  const Vector3 side = Vector3(0.25, 0, 0);
  const int added = session_.add(IrregularEdit{
    IrregularOperation::Add, { inRest_.front() - side, inRest_.front() + side }, {}, {}, {}, {} });
  ConstraintReport word = wordOn(added);
  EXPECT_TRUE(word.isMet) << word.reason;
  EXPECT_EQ(filled().size(), before.size());
  const int moved = session_.add(IrregularEdit{ IrregularOperation::Move,
    { inRest_.front() + side, inRest_.front() + side / 2 }, {}, {}, {}, {} });
  word = wordOn(moved);
  EXPECT_TRUE(word.isMet) << word.reason;
  EXPECT_EQ(filled().size(), before.size());
}

TEST_F(ConstraintsOnFilledFaces, OperationsOfAFileGiveTheSame)
{
  const Vector3 side = Vector3(0.25, 0, 0);
  session_.add(IrregularEdit{
    IrregularOperation::Add, { inRest_.front() - side, inRest_.front() + side }, {}, {}, {}, {} });
  ASSERT_TRUE(session_.update().status.ok());
  const std::string path = ::testing::TempDir() + "filled_faces.qsession";
  session_.save(path);
  Session loaded = Session::load(path, input());
  ASSERT_TRUE(loaded.update().status.ok());
  EXPECT_TRUE(areSame(loaded.result()->quads, session_.result()->quads));
}

TEST_F(ConstraintsOnFilledFaces, ALineIsMetWhereThereIsAMap)
{
  // Across the patch, from the one seam of the halves to the other one.
  const double x = inRest_.front().x(), z = inRest_.front().z();
  const std::size_t before = filled().size();
  const ConstraintReport word =
    wordOn(session_.add(Connection{ { { x, 0.5, 0 }, { x, 0, z }, { x, -0.5, 0 } } }));
  EXPECT_TRUE(word.isMet) << word.reason;
  EXPECT_LE(filled().size(), before);
}

// It cuts the patch in two, and what fills these keeps it.
TEST_F(ConstraintsOnFilledFaces, ALineThroughOneIsMet)
{
  const std::size_t before = filled().size();
  const double x = inFilled_.front().x(), z = inFilled_.front().z();
  const ConstraintReport word =
    wordOn(session_.add(Connection{ { { x, 0.5, 0 }, { x, 0, z }, { x, -0.5, 0 } } }));
  EXPECT_TRUE(word.isMet) << word.reason;
  EXPECT_LE(filled().size(), before);
}

/// The surface under such quads is joined of parts, and no way leads from one to another one on it.
TEST_F(ConstraintsOnFilledFaces, AStrokeFromThemToOthersFindsItsWay)
{
  const Vector3& from = inFilled_.front();
  const Vector3& to = *std::min_element(inRest_.begin(), inRest_.end(),
    [&](const Vector3& a, const Vector3& b) { return (a - from).norm() < (b - from).norm(); });
  const ConstraintReport word = wordOn(session_.add(GuideStroke{ { from, to } }));
  EXPECT_EQ(word.remark.find("different parts"), std::string::npos) << word.remark;
  EXPECT_TRUE(word.deviation) << word.reason; // it was measured in the quads
}

} // namespace
} // namespace quadrille
