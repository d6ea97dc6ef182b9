// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads of the intermediate level before those of the surface.
#include "Pipeline/Pipeline.h"

#include "MeshInput.h"
#include "Quads/QuadTopology.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

RemeshOptions previewOptions()
{
  RemeshOptions options;
  options.quads = 900;
  options.featureAngle.reset();
  options.coarseVertices = 200;
  options.threads = 2;
  return options;
}

bool hasStage(const RemeshResult& result, const char* name)
{
  return std::any_of(result.stages.begin(), result.stages.end(),
    [&](const StageRecord& record) { return record.stage == name; });
}

TEST(Preview, HasTheIntegersOfTheResult)
{
  const SurfaceInput input = toInput(torus(240, 120));
  RemeshOptions options = previewOptions();
  const RemeshResult full = remesh(input, options);
  options.preview = true;
  const RemeshResult preview = remesh(input, options);
  ASSERT_TRUE(full.status.ok()) << full.status.message;
  ASSERT_TRUE(preview.status.ok()) << preview.status.message;
  // One coarse map: the same number of quads, and the same irregular vertices.
  EXPECT_EQ(preview.quads.quads.size(), full.quads.quads.size());
  EXPECT_EQ(preview.coarseUv.size(), full.coarseUv.size());
  EXPECT_TRUE(preview.coarseUv == full.coarseUv);
  for (int valence = 2; valence < 8; ++valence)
  {
    EXPECT_EQ(std::count(preview.quads.valence.begin(), preview.quads.valence.end(), valence),
      std::count(full.quads.valence.begin(), full.quads.valence.end(), valence));
  }
  const QuadTopology topology = analyzeQuads(preview.quads.quads, preview.quads.points.size());
  EXPECT_EQ(
    topology.nonManifoldEdges + topology.nonManifoldVertices + topology.degenerateQuads, 0U);
  EXPECT_FALSE(hasStage(preview, "replay"));
  EXPECT_FALSE(hasStage(preview, "certify"));
}

TEST(Preview, LiesNearTheSurface)
{
  RemeshOptions options = previewOptions();
  options.preview = true;
  const RemeshResult preview = remesh(toInput(torus(240, 120, 1, 0.4)), options);
  ASSERT_TRUE(preview.status.ok()) << preview.status.message;
  // Edges of the intermediate level are from half a quad's to hardly twice it long, so their chords lie within
  // (2 h)^2 / 8 r of a circle of radius r = 0.4.
  const double h = preview.targetEdgeLength;
  for (const Vector3& p : preview.quads.points)
  {
    const double ring = std::hypot(p.x(), p.y()) - 1;
    EXPECT_NEAR(std::hypot(ring, p.z()), 0.4, h * h / (2 * 0.4));
  }
}

TEST(Preview, LeavesItsMapToTheResult)
{
  const SurfaceInput input = toInput(torus(240, 120));
  RemeshOptions options = previewOptions();
  const RemeshResult fromNothing = remesh(input, options);
  ResultStore store(std::size_t{ 1 } << 30);
  options.preview = true;
  ASSERT_TRUE(remesh(input, options, store).status.ok());
  options.preview = false;
  const RemeshResult full = remesh(input, options, store);
  ASSERT_TRUE(full.status.ok()) << full.status.message;
  EXPECT_TRUE(full.quads.points == fromNothing.quads.points);
  EXPECT_TRUE(full.quads.quads == fromNothing.quads.quads);
  for (const char* stage : { "phase1", "phase2", "field", "seamless", "quantize", "embed" })
  {
    EXPECT_FALSE(hasStage(full, stage)) << stage;
  }
  EXPECT_TRUE(hasStage(full, "replay"));
  // And back: the preview of a result makes nothing but its own quads.
  options.preview = true;
  const RemeshResult again = remesh(input, options, store);
  ASSERT_TRUE(again.status.ok()) << again.status.message;
  EXPECT_FALSE(hasStage(again, "embed"));
  EXPECT_TRUE(hasStage(again, "preview"));
}

} // namespace
} // namespace quadrille
