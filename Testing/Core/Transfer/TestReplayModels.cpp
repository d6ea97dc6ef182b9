// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The replay of smooth seamless maps on every model there is: exact to the bit.
#include "BothPhases.h"
#include "CrossField/CrossField.h"
#include "Features/FeatureFilter.h"
#include "GridMap/SeamlessMap.h"
#include "PlyFile.h"
#include "Prepare/Prepare.h"
#include "Prepare/Refine.h"
#include "ReplayChecks.h"
#include "TestMaps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

constexpr double kQuads = 2500;

/// The same mesh, stretched and bent at random, smoothly: each coordinate gets a factor and a wave as long as the mesh.
Mesh bentAtRandom(Mesh mesh, unsigned seed)
{
  std::mt19937 random(seed);
  const auto number = [&](double least, double most)
  { return least + (most - least) * static_cast<double>(random()) / 4294967296.0; };
  Vector3 low = mesh.position[0];
  Vector3 high = low;
  for (const Vector3& p : mesh.position)
  {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double size = (high - low).norm();
  const Vector3 factor(number(0.7, 1.4), number(0.7, 1.4), number(0.7, 1.4));
  std::array<Vector3, 3> wave;
  for (Vector3& w : wave)
  {
    w = Vector3(number(-1, 1), number(-1, 1), number(-1, 1)).normalized() * (2 * kPi / size);
  }
  for (Vector3& p : mesh.position.editAll())
  {
    const Vector3 from = p - low;
    for (Index i = 0; i < 3; ++i)
    {
      // The slope of a wave is at most 0.3, less than any factor: nothing folds.
      p[i] = factor[i] * from[i] + 0.3 * size / (2 * kPi) * std::sin(wave[i].dot(from));
    }
  }
  return mesh;
}

/// A model's levels and a map of the coarse one.
struct MappedModel
{
  PreparedSurface surface;
  Hierarchy levels;
  std::vector<FixedVec2> coarseUv;
};

/// The map has the rotations of the model's cross field and the metric of another shape.
MappedModel mapModel(const SurfaceInput& input, std::optional<double> featureAngle, unsigned seed)
{
  MappedModel model;
  PrepareOptions prepareOptions;
  prepareOptions.featureAngle = featureAngle;
  model.surface = prepareSurface(input, prepareOptions);
  const double edgeLength = std::sqrt(model.surface.area / kQuads);
  removeUnresolvedFeatures(model.surface.mesh, edgeLength);
  refineSurface(model.surface, edgeLength, {});
  HierarchyOptions levels;
  levels.targetEdgeLength = edgeLength;
  model.levels = buildHierarchy(model.surface.mesh, 1, levels);
  const Mesh& coarse = model.levels.coarse.mesh;
  CrossFieldOptions fieldOptions;
  fieldOptions.targetEdgeLength = edgeLength;
  const CrossField field = computeCrossField(coarse, fieldOptions);
  SeamlessOptions options;
  options.edgeLength = edgeLength;
  model.coarseUv = computeSeamlessMap(bentAtRandom(coarse, seed), field, options).uv;
  return model;
}

/// An edge without length has no rotation, so its transition is none that could be kept.
std::size_t edgesWithoutLength(const std::vector<FixedVec2>& uv)
{
  std::size_t count = 0;
  for (Index h = 0; h < static_cast<Index>(uv.size()); ++h)
  {
    count += uv[h] == uv[Mesh::next(h)] ? 1 : 0;
  }
  return count;
}

void expectExactReplayOf(const std::string& path, unsigned seed)
{
  SCOPED_TRACE(path);
  const std::optional<SurfaceInput> input = loadPly(path);
  ASSERT_TRUE(input);
  MappedModel model = mapModel(*input, kFeatureAngle, seed);
  if (edgesWithoutLength(model.coarseUv) > 0)
  {
    // The features of cgal_cheese, input_wheel and vtk_gears are denser than 2,500 quads: their equations leave
    // no room between some of them. Without features these models have maps as well.
    model = mapModel(*input, std::nullopt, seed);
  }
  ASSERT_EQ(edgesWithoutLength(model.coarseUv), 0U);
  shuffleCharts(model.coarseUv, seed);
  expectExactReplay(model.surface.mesh, model.levels, model.coarseUv);
}

std::size_t expectExactReplays(
  const std::string& folder, std::uintmax_t leastBytes, std::uintmax_t mostBytes)
{
  std::size_t models = 0;
  for (const std::string& path : plyFilesIn(folder))
  {
    const std::uintmax_t bytes = std::filesystem::file_size(path);
    if (bytes >= leastBytes && bytes < mostBytes)
    {
      expectExactReplayOf(path, static_cast<unsigned>(++models));
    }
  }
  return models;
}

/// A model of 500,000 faces has about this size.
constexpr std::uintmax_t kLargeModel = 9500000;

} // namespace

TEST(ReplayModels, AreExactOnTheProjectsMeshes)
{
  EXPECT_EQ(expectExactReplays(QUADRILLE_DATA, 0, kLargeModel), 3U);
}

#ifdef QUADRILLE_SHARED_DATA
class ReplayModels : public testing::TestWithParam<const char*>
{
};

TEST_P(ReplayModels, AreExact)
{
  const std::string folder = std::string(QUADRILLE_SHARED_DATA) + "/" + GetParam();
  if (expectExactReplays(folder, 0, kLargeModel) == 0)
  {
    GTEST_SKIP() << "no models in " << folder;
  }
}

/// Takes a minute and gigabytes; run it with --gtest_also_run_disabled_tests after a change of the replay.
TEST_P(ReplayModels, DISABLED_OfMillionsOfFacesAreExact)
{
  const std::string folder = std::string(QUADRILLE_SHARED_DATA) + "/" + GetParam();
  expectExactReplays(folder, kLargeModel, std::numeric_limits<std::uintmax_t>::max());
}

INSTANTIATE_TEST_SUITE_P(Folders, ReplayModels, testing::Values("scan", "cad", "open"),
  [](const testing::TestParamInfo<const char*>& folder) { return std::string(folder.param); });
#endif
