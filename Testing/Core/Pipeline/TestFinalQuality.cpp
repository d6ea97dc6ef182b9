// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Pipeline.h"
#include "Prepare/Prepare.h"

#include "MeshInput.h"
#include "PlyFile.h"
#include "Quads/QuadShape.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace quadrille
{
namespace
{

RemeshResult solve(const SurfaceInput& input, FinalQuality level, std::size_t quads,
  int threads = 0, const ProgressCallback& progress = {}, std::optional<double> memory = {})
{
  RemeshOptions options;
  options.quads = quads;
  options.finalQuality = level;
  options.threads = threads;
  options.progress = progress;
  options.memoryLimit = memory;
  return remesh(input, options);
}

std::map<std::pair<int, bool>, std::size_t> valences(const QuadMesh& quads)
{
  std::map<std::pair<int, bool>, std::size_t> counts;
  for (std::size_t p = 0; p < quads.points.size(); ++p)
  {
    ++counts[{ quads.valence[p], quads.onBoundary[p] != 0 }];
  }
  return counts;
}

std::size_t invertedCount(const QuadMesh& quads)
{
  return static_cast<std::size_t>(std::count_if(quads.quads.begin(), quads.quads.end(),
    [&](const std::array<Index, 4>& q)
    {
      return !(scaledJacobian({ quads.points[q[0]], quads.points[q[1]], quads.points[q[2]],
                 quads.points[q[3]] }) > 0);
    }));
}

/// What has to hold on both levels for any surface.
void expectLessDistortion(const SurfaceInput& input, std::size_t quads)
{
  const RemeshResult coarse = solve(input, FinalQuality::Coarse, quads);
  ASSERT_TRUE(coarse.status.ok()) << coarse.status.message;
  EXPECT_EQ(coarse.finalQuality.elements, 0U);
  double least = measureDistortion(coarse.surface.mesh, coarse.uv).mean;
  const double carried = least;
  for (const FinalQuality level : { FinalQuality::Intermediate, FinalQuality::Input })
  {
    const RemeshResult fine = solve(input, level, quads);
    ASSERT_TRUE(fine.status.ok()) << fine.status.message;
    EXPECT_TRUE(fine.finalQuality.improved) << fine.finalQuality.notice;
    // The run measures in its own coordinates, which are on a grid.
    EXPECT_NEAR(fine.finalQuality.before.mean, carried, 1e-6);
    EXPECT_LT(fine.finalQuality.after.mean, least);
    least = fine.finalQuality.after.mean;
    EXPECT_NEAR(measureDistortion(fine.surface.mesh, fine.uv).mean, least, 1e-6);
    EXPECT_TRUE(fine.certificate.valid()) << fine.certificate.text();
    // The integers are the same, so is all that can be counted.
    EXPECT_EQ(fine.certificate.area, coarse.certificate.area);
    EXPECT_EQ(fine.quads.quads.size(), coarse.quads.quads.size());
    EXPECT_EQ(valences(fine.quads), valences(coarse.quads));
    EXPECT_LE(invertedCount(fine.quads), invertedCount(coarse.quads));
    EXPECT_TRUE(std::any_of(fine.stages.begin(), fine.stages.end(),
      [&](const StageRecord& stage)
      { return stage.stage == "optimize" && stage.elementsIn == fine.finalQuality.elements; }));
  }
}

TEST(FinalQuality, LowersTheDistortionOfAClosedSurface)
{
  expectLessDistortion(test::toInput(test::torus(90, 45)), 500);
}

TEST(FinalQuality, LowersTheDistortionWithFeatures)
{
  const auto input = test::loadPly(std::string(QUADRILLE_DATA) + "/part.ply");
  ASSERT_TRUE(input);
  expectLessDistortion(*input, 1000);
}

TEST(FinalQuality, LowersTheDistortionOfAnOpenSurface)
{
  // A dented plate.
  Mesh mesh = test::gridPlane(40, 40);
  for (Vector3& p : mesh.position.editAll())
  {
    p.z() = 6 * std::exp(-(p - Vector3(17, 23, 0)).squaredNorm() / 60);
  }
  expectLessDistortion(test::toInput(mesh), 300);
}

TEST(FinalQuality, SameBytesForAnyNumberOfThreads)
{
  const SurfaceInput input = test::toInput(test::torus(90, 45));
  for (const FinalQuality level : { FinalQuality::Intermediate, FinalQuality::Input })
  {
    const RemeshResult one = solve(input, level, 500, 1);
    for (const int threads : { 2, 4 })
    {
      const RemeshResult more = solve(input, level, 500, threads);
      EXPECT_TRUE(one.uv == more.uv) << threads;
      EXPECT_TRUE(one.quads.points == more.quads.points) << threads;
    }
  }
}

TEST(FinalQuality, TooLittleMemoryKeepsTheMapAndSaysSo)
{
  const SurfaceInput input = test::toInput(test::torus(90, 45));
  const RemeshResult coarse = solve(input, FinalQuality::Coarse, 500);
  // Enough for the run, by its estimate, but not for the solver.
  FinalQualityOptions options;
  options.level = FinalQuality::Input;
  options.maximumBytes = 1000;
  SurfaceMap map{ coarse.uv, coarse.certificate };
  const FinalQualityReport report = improveMap(coarse.surface, coarse.turns,
    std::vector<std::uint8_t>(coarse.turns.size(), 0), {}, options, map);
  EXPECT_FALSE(report.improved);
  EXPECT_NE(report.notice.find("MB"), std::string::npos) << report.notice;
  EXPECT_TRUE(map.uv == coarse.uv);
}

/// A map that cannot become better stays bit for bit.
TEST(FinalQuality, WhatIsBestAlreadyStays)
{
  const Mesh mesh = test::gridPlane(6, 6);
  PrepareOptions prepare;
  const PreparedSurface surface = prepareSurface(test::toInput(mesh), prepare);
  std::vector<FixedVec2> uv;
  std::vector<int> turns(surface.mesh.vertexCount(), 0);
  std::vector<std::uint8_t> integer(surface.mesh.vertexCount(), 0);
  for (const Index v : surface.mesh.origin)
  {
    const Vector3& p = surface.mesh.position[v];
    const bool sideU = p.x() == 0 || p.x() == 6, sideV = p.y() == 0 || p.y() == 6;
    turns[v] = sideU && sideV ? 1 : sideU || sideV ? 2 : 4;
    integer[v] = sideU && sideV;
    uv.push_back(toFixed(Vector2(p.head<2>())));
  }
  FinalQualityOptions options;
  options.level = FinalQuality::Input;
  options.maximumBytes = 1e9;
  options.edgeLength = 1;
  SurfaceMap map{ uv, certify(surface.mesh, uv, turns, integer) };
  ASSERT_TRUE(map.certificate.valid());
  const FinalQualityReport report = improveMap(surface, turns, integer, {}, options, map);
  EXPECT_FALSE(report.improved);
  EXPECT_NE(report.notice.find("distortion"), std::string::npos) << report.notice;
  EXPECT_TRUE(map.uv == uv);
}

TEST(FinalQuality, StopsOnRequest)
{
  const SurfaceInput input = test::toInput(test::torus(90, 45));
  const RemeshResult result = solve(input, FinalQuality::Input, 500, 0,
    [](double, const std::string& text) { return text.rfind("Optimizing", 0) != 0; });
  EXPECT_EQ(result.status.code, StatusCode::Cancelled);
  EXPECT_TRUE(result.quads.quads.empty());
}

#ifdef QUADRILLE_SHARED_DATA
/// Its ear has a pocket narrower than a quad: a map that follows it turns quads over. Where points move over the
/// surface afterwards they can be mended, else the carried map is held there.
TEST(FinalQuality, TurnsNoQuadOver)
{
  const auto input = test::loadPly(std::string(QUADRILLE_SHARED_DATA) + "/scan/igea.ply");
  ASSERT_TRUE(input);
  RemeshOptions options;
  options.quads = 12000;
  options.finalQuality = FinalQuality::Input;
  const RemeshResult moved = remesh(*input, options);
  ASSERT_TRUE(moved.status.ok());
  EXPECT_TRUE(moved.finalQuality.improved);
  EXPECT_EQ(invertedCount(moved.quads), 0U);

  options.smoothingSteps = 0;
  const RemeshResult raw = remesh(*input, options);
  ASSERT_TRUE(raw.status.ok());
  EXPECT_GT(raw.finalQuality.holds, 0);
  options.finalQuality = FinalQuality::Coarse;
  EXPECT_LE(invertedCount(raw.quads), invertedCount(remesh(*input, options).quads));
}

/// Its map has hundreds of crushed triangles that no step may crush further; they must not keep the others from moving.
TEST(FinalQuality, CrushedTrianglesDoNotStopTheRest)
{
  const auto input = test::loadPly(std::string(QUADRILLE_SHARED_DATA) + "/scan/lucy_100k.ply");
  ASSERT_TRUE(input);
  const RemeshResult middle = solve(*input, FinalQuality::Intermediate, 10000);
  const RemeshResult fine = solve(*input, FinalQuality::Input, 10000);
  ASSERT_TRUE(fine.status.ok());
  EXPECT_LT(fine.finalQuality.after.mean, middle.finalQuality.after.mean);
  EXPECT_LT(fine.finalQuality.after.p99, 2.5);
}
#endif

} // namespace
} // namespace quadrille
