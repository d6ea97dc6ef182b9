// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Progress.h"
#include "Pipeline/Levels.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

/// Guides over all of a plane, and the levels that they are on.
struct GuidedPlane
{
  PlannedSurface surface;
  HierarchyOptions options;

  GuidedPlane()
  {
    auto prepared = std::make_shared<PreparedSurface>();
    prepared->mesh = gridPlane(60, 60);
    surface = withoutPlan(std::move(prepared), 1);
    options.targetEdgeLength = 4;
    options.coarseVertices = 80;
    options.threads = 1;
    for (Index f = 0; f < surface->mesh.faceCount(); ++f)
    {
      options.guides.push_back({ f, { Vector3(1, 0.3, 0).normalized(), 1 } });
    }
  }
};

TEST(Levels, AChangeOfGuidesDecimatesNothing)
{
  GuidedPlane plane;
  Levels levels(nullptr);
  const std::vector<Index> faces = levels.make(plane.surface, plane.options).coarse.fineFace;
  EXPECT_EQ(levels.hierarchy().coarse.guides.size(), faces.size());
  EXPECT_TRUE(levels.stages().has("phase2"));
  plane.options.guides.clear();
  levels.make(plane.surface, plane.options);
  EXPECT_TRUE(levels.hierarchy().coarse.guides.empty());
  EXPECT_FALSE(levels.stages().has("phase2"));
  EXPECT_EQ(levels.hierarchy().coarse.fineFace, faces);
}

TEST(Levels, GuidesAreThereAgainAfterAStop)
{
  const GuidedPlane plane;
  HierarchyOptions other = plane.options;
  other.coarseVertices = 60;
  Levels levels(nullptr);
  const std::vector<Guide> guides = levels.make(plane.surface, plane.options).coarse.guides;
  EXPECT_FALSE(guides.empty());
  {
    PollScope scope([](double, const std::string&) { return false; });
    std::this_thread::sleep_for(PollScope::kInterval);
    EXPECT_THROW(levels.make(plane.surface, other), Cancelled);
  }
  EXPECT_TRUE(levels.make(plane.surface, plane.options).coarse.guides == guides);
}

} // namespace
} // namespace quadrille
