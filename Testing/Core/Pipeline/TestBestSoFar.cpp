// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a stop keeps, and how a run ends by itself.
#include "Pipeline/Pipeline.h"
#include "Pipeline/WorkBound.h"
#include "Symmetry/Symmetry.h"

#include "SphereWithoutRoom.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace quadrille
{
namespace
{

using test::sphereWithoutRoom;

RemeshOptions optionsOf(std::size_t quads)
{
  RemeshOptions options;
  options.quads = quads;
  options.threads = 1;
  return options;
}

/// Asks to stop as soon as a text begins so, from then on always.
ProgressCallback stopAt(const std::string& begin)
{
  bool isOver = false;
  return [=](double, const std::string& text) mutable
  {
    isOver = isOver || text.rfind(begin, 0) == 0;
    return !isOver;
  };
}

bool isTold(const RemeshResult& result, const std::string& text)
{
  return std::any_of(result.notices.begin(), result.notices.end(),
    [&](const std::string& notice) { return notice.find(text) != std::string::npos; });
}

void expectSameQuads(const RemeshResult& a, const RemeshResult& b)
{
  EXPECT_EQ(a.quads.points, b.quads.points);
  EXPECT_EQ(a.quads.quads, b.quads.quads);
}

TEST(BestSoFar, AStopKeepsTheQuadsOfTheAttemptsBefore)
{
  const SurfaceInput input = sphereWithoutRoom();
  RemeshOptions options = optionsOf(100);
  const RemeshResult whole = remesh(input, options);
  ASSERT_TRUE(whole.status.ok()) << whole.status.message;
  ASSERT_GE(whole.attempts.size(), 2U); // else there is nothing to stop
  EXPECT_TRUE(whole.stopped.empty());
  for (std::size_t attempt = 2; attempt <= whole.attempts.size(); ++attempt)
  {
    const std::string name = "Attempt " + std::to_string(attempt) + " of at most ";
    options.progress = stopAt(name);
    const RemeshResult stopped = remesh(input, options);
    ASSERT_TRUE(stopped.status.ok()) << stopped.status.message;
    EXPECT_EQ(stopped.stopped.rfind(name, 0), 0U) << stopped.stopped;
    EXPECT_TRUE(isTold(stopped, "stopped on request (" + stopped.stopped + ")"));
    EXPECT_EQ(stopped.attempts.size(), attempt - 1);
    // None of the others is better.
    expectSameQuads(stopped, whole);
    EXPECT_EQ(stopped.quads.quadSourceFace, whole.quads.quadSourceFace);
    EXPECT_EQ(stopped.uv, whole.uv);
  }
  options.progress = stopAt("Mapping: ");
  const RemeshResult none = remesh(input, options);
  EXPECT_EQ(none.status.code, StatusCode::Cancelled);
  EXPECT_TRUE(none.stopped.empty());
  EXPECT_TRUE(none.quads.quads.empty());
}

TEST(BestSoFar, IsNotTakenForTheFinalResult)
{
  const SurfaceInput input = sphereWithoutRoom();
  const RemeshOptions options = optionsOf(100);
  const RemeshResult fresh = remesh(input, options);
  for (const bool quadsAlone : { false, true })
  {
    ResultStore store;
    RemeshOptions stopping = options;
    stopping.progress = stopAt("Attempt 2");
    SurfaceInput lent = input;
    const RemeshResult stopped =
      quadsAlone ? remeshQuads(lent, stopping, store) : remesh(input, stopping, store);
    ASSERT_TRUE(stopped.status.ok()) << stopped.status.message;
    EXPECT_FALSE(stopped.stopped.empty());
    const RemeshResult after = remesh(input, options, store);
    EXPECT_TRUE(after.stopped.empty());
    EXPECT_EQ(after.attempts, fresh.attempts);
    expectSameQuads(after, fresh);
    EXPECT_EQ(after.uv, fresh.uv);
  }
}

TEST(BestSoFar, OfASymmetricRunIsSymmetric)
{
  SymmetryOptions symmetry;
  symmetry.plane = MirrorPlane{ Vector3::Zero(), Vector3(0, 0, 1) }; // the pole lies in front of it
  RemeshOptions options = optionsOf(150);
  options.progress = stopAt("Attempt 2");
  const SymmetricResult made = remeshSymmetric(sphereWithoutRoom(0.4), options, symmetry);
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  ASSERT_FALSE(made.remeshed.stopped.empty()); // else the case is none any more
  EXPECT_EQ(made.mirrorPoint.size(), made.remeshed.quads.points.size());
  EXPECT_EQ(made.pointSources.size(), made.remeshed.quads.points.size());
  for (Index p = 0; p < made.mirrorPoint.size(); ++p)
  {
    EXPECT_EQ(made.mirrorPoint[made.mirrorPoint[p]], p);
  }
}

TEST(BestSoFar, BoundsGrowWithTheSurfaceAndTheQuads)
{
  const WorkBound small = workBound(1000, 100);
  const WorkBound faces = workBound(2000, 100);
  const WorkBound quads = workBound(1000, 200);
  for (const WorkBound& larger : { faces, quads })
  {
    EXPECT_GT(larger.work, small.work);
    EXPECT_GT(larger.ofMap, small.ofMap);
    EXPECT_GT(larger.ofAttempt, small.ofAttempt);
  }
  // A run of 300,000 faces may take ten seconds, see WorkCount.h for the unit.
  EXPECT_LE(workBound(300000, 5000).work, 10000000U);
}

} // namespace
} // namespace quadrille
