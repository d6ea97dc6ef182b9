// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "CrossField/CrossField.h"
#include "GridMap/GridMap.h"
#include "Hierarchy/LogRecords.h"
#include "Mesh/Surface.h"
#include "TestMaps.h"
#include "TestMeshes.h"
#include "Transfer/QuarterTurns.h"
#include "Transfer/Replay.h"
#include "Transfer/Transfer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <optional>
#include <random>
#include <sstream>
#include <string>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

Hierarchy decimate(const Mesh& mesh, double edgeLength, Index vertices)
{
  HierarchyOptions options;
  options.targetEdgeLength = edgeLength;
  options.coarseVertices = vertices;
  return buildHierarchy(mesh, 1, options);
}

/// uv on the slots of the coarse level, as replayRounds wants them.
std::vector<FixedVec2> onSlots(
  const Mesh& fine, const Level& coarse, const std::vector<FixedVec2>& coarseUv)
{
  std::vector<FixedVec2> uv(fine.halfEdgeCount());
  for (Index h = 0; h < coarse.mesh.halfEdgeCount(); ++h)
  {
    uv[3 * coarse.fineFace[h / 3] + h % 3] = coarseUv[h];
  }
  return uv;
}

/// The map seen through charts that are turned by random quarters and moved at random, face by face: every edge is
/// a seam with a transition of its own then.
void shuffleCharts(std::vector<FixedVec2>& uv, unsigned seed)
{
  std::mt19937_64 random(seed);
  for (std::size_t h = 0; h < uv.size(); h += 3)
  {
    const int turns = static_cast<int>(random() % 4);
    const FixedVec2 shift{ static_cast<std::int64_t>(random() >> 28),
      -static_cast<std::int64_t>(random() >> 28) };
    for (std::size_t i = h; i < h + 3; ++i)
    {
      uv[i] = rotate(uv[i], turns) + shift;
    }
  }
}

/// Quarter turns of the charts once round each inner vertex, modulo 4; 0 at boundary vertices.
std::vector<int> holonomy(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  std::vector<int> turns(mesh.vertexCount(), 0);
  std::vector<bool> boundary(mesh.vertexCount(), false);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    // The transitions round the origin of h are those of the half-edges that lead to it.
    const Index incoming = Mesh::previous(h);
    boundary[mesh.origin[h]] =
      boundary[mesh.origin[h]] || mesh.isBoundary(h) || mesh.isBoundary(incoming);
    if (!mesh.isBoundary(incoming))
    {
      const Index g = mesh.twin[incoming];
      const int quarter = quarterTurns(uv[h] - uv[incoming], uv[g] - uv[Mesh::next(g)]);
      EXPECT_GE(quarter, 0) << "half-edge " << incoming;
      turns[mesh.origin[h]] += quarter;
    }
  }
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    turns[v] = boundary[v] ? 0 : turns[v] & 3;
  }
  return turns;
}

/// Replays a map that is seamless on the coarse level and holds all that must be exact against it.
void expectExactReplay(const Mesh& fine, const Hierarchy& h, const std::vector<FixedVec2>& coarseUv)
{
  ASSERT_EQ(seamResiduals(h.coarse.mesh, coarseUv), 0U);
  ASSERT_EQ(constrainedEdgesOffAxis(h.coarse.mesh, coarseUv), 0U);
  std::vector<FixedVec2> uv = onSlots(fine, h.coarse, coarseUv);
  const ReplayCounts counts = replayLog(h.log, uv, 2, {});
  EXPECT_EQ(counts.lostTransitions, 0U);
  EXPECT_EQ(seamResiduals(fine, uv), 0U);
  EXPECT_EQ(constrainedEdgesOffAxis(fine, uv), 0U) << "exactly on isolines";
  std::vector<int> expected(fine.vertexCount(), 0);
  const std::vector<int> coarse = holonomy(h.coarse.mesh, coarseUv);
  for (Index v = 0; v < coarse.size(); ++v)
  {
    expected[h.coarse.fineVertex[v]] = coarse[v];
  }
  EXPECT_EQ(holonomy(fine, uv), expected);
  for (Index c = 0; c < h.coarse.mesh.halfEdgeCount(); ++c)
  {
    // A constrained vertex of the coarse level has its isoline's value on the fine one; nothing else may move it
    // either. Its corner may have gone to another vertex, but the faces' charts have not changed, so a corner that
    // still is this vertex's has its uv to the bit.
    const Index slot = 3 * h.coarse.fineFace[c / 3] + c % 3;
    if (fine.origin[slot] == h.coarse.fineVertex[h.coarse.mesh.origin[c]])
    {
      ASSERT_EQ(uv[slot], coarseUv[c]);
    }
  }
}

std::uint64_t crc64(const std::uint8_t* bytes, std::size_t count)
{
  std::uint64_t crc = ~0ULL;
  for (std::size_t i = 0; i < count; ++i)
  {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit)
    {
      crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xC96C5795D7870F42ULL : 0ULL);
    }
  }
  return ~crc;
}

void renewChecksum(std::vector<std::uint8_t>& bytes)
{
  const std::size_t size = bytes.size() - 8;
  const std::uint64_t crc = crc64(bytes.data(), size);
  for (std::size_t i = 0; i < 8; ++i)
  {
    bytes[size + i] = static_cast<std::uint8_t>(crc >> (8 * i));
  }
}

} // namespace

TEST(Replay, partsGiveWhatTheWholeGives)
{
  const Mesh mesh = torus(90, 45);
  const Hierarchy h = decimate(mesh, 0.3, 120);
  std::vector<FixedVec2> coarseUv =
    torusMap(h.coarse.mesh, 1, 40 * kOne, 16 * kOne, [](Index) { return FixedVec2{}; });
  shuffleCharts(coarseUv, 3);
  const std::vector<FixedVec2> start = onSlots(mesh, h.coarse, coarseUv);
  std::vector<FixedVec2> whole = start;
  replayLog(h.log, whole, 1, {});
  const std::size_t rounds = h.log.rounds.size();
  ASSERT_GT(rounds, h.log.intermediateRounds);
  ASSERT_GT(h.log.intermediateRounds, 1U);
  for (std::size_t middle = 0; middle <= rounds; ++middle)
  {
    std::vector<FixedVec2> uv = start;
    replayRounds(h.log, { rounds, middle }, uv, 2, {});
    replayRounds(h.log, { middle, 0 }, uv, 1, {});
    ASSERT_EQ(uv, whole) << middle;
  }
  // One round after the other, as a caller would who looks at every level.
  std::vector<FixedVec2> uv = start;
  for (std::size_t round = rounds; round > 0; --round)
  {
    replayRounds(h.log, { round, round - 1 }, uv, 1, {});
  }
  EXPECT_EQ(uv, whole);
}

TEST(Replay, reachesTheIntermediateLevel)
{
  const Mesh mesh = markFeatures(unitCube(18), kFeatureAngle);
  const Hierarchy h = decimate(mesh, 0.25, 60);
  const Level& middle = h.intermediate;
  ASSERT_GT(middle.mesh.faceCount(), h.coarse.mesh.faceCount());
  ASSERT_LT(middle.mesh.faceCount(), mesh.faceCount());
  std::vector<FixedVec2> coarseUv = cubeMap(h.coarse.mesh, 9);
  shuffleCharts(coarseUv, 4);
  const std::vector<FixedVec2> uv =
    transferToLevel(h.coarse, middle, h.log.intermediateRounds, h.log, coarseUv, TransferOptions());
  ASSERT_EQ(uv.size(), middle.mesh.halfEdgeCount());
  EXPECT_EQ(seamResiduals(middle.mesh, uv), 0U);
  EXPECT_EQ(constrainedEdgesOffAxis(middle.mesh, uv), 0U);
  EXPECT_EQ(notPositive(uv), 0U);
  for (Index c = 0; c < middle.mesh.halfEdgeCount(); ++c)
  {
    // Every side is flat, so its isometric map comes back; see TestTransfer.cpp for the tolerance.
    const Vector2 edge = toDouble(uv[Mesh::next(c)] - uv[c]);
    EXPECT_NEAR(edge.norm(), 9 * middle.mesh.edgeVector(c).norm(), 1e-5);
  }
  EXPECT_EQ(
    transferToLevel(h.coarse, h.coarse, h.log.rounds.size(), h.log, coarseUv, TransferOptions()),
    coarseUv);
}

TEST(Replay, refusesRangesAndLevelsThatDoNotFit)
{
  const Mesh mesh = torus(30, 15);
  const Hierarchy h = decimate(mesh, 0.5, 60);
  std::vector<FixedVec2> uv(mesh.halfEdgeCount());
  const std::size_t rounds = h.log.rounds.size();
  EXPECT_THROW(replayRounds(h.log, { rounds + 1, 0 }, uv, 1, {}), InvalidInput);
  EXPECT_THROW(replayRounds(h.log, { 0, 1 }, uv, 1, {}), InvalidInput);
  uv.pop_back();
  EXPECT_THROW(replayRounds(h.log, { rounds, 0 }, uv, 1, {}), InvalidInput);
  const std::vector<FixedVec2> coarseUv(h.coarse.mesh.halfEdgeCount());
  EXPECT_THROW(
    transferToLevel(h.coarse, h.intermediate, rounds + 1, h.log, coarseUv, TransferOptions()),
    InvalidInput);
  Level wrong = h.intermediate;
  wrong.fineFace.back() = mesh.faceCount();
  EXPECT_THROW(
    transferToLevel(h.coarse, wrong, h.log.intermediateRounds, h.log, coarseUv, TransferOptions()),
    InvalidInput);
}

TEST(Replay, keepsEveryTransitionOfSmoothMaps)
{
  // Random waves on maps of known surfaces, seen through charts that are all turned against each other.
  std::mt19937 random(17);
  const auto wave = [&]() { return std::uniform_real_distribution<double>(-0.3, 0.3)(random); };
  for (unsigned seed = 0; seed < 4; ++seed)
  {
    const double a = wave(), b = wave(), c = wave();
    const Mesh ring = torus(80, 40);
    const Hierarchy h = decimate(ring, 0.3, 100 + 60 * seed);
    std::vector<FixedVec2> uv = torusMap(h.coarse.mesh, 1, 40 * kOne, 16 * kOne,
      [&](Index v)
      {
        const Vector3& p = h.coarse.mesh.position[v];
        return toFixed(
          Vector2(a * std::sin(2 * p.x() + b) + c * p.z(), b * std::cos(3 * p.y()) + a * p.x()));
      });
    shuffleCharts(uv, seed);
    expectExactReplay(ring, h, uv);

    for (const Mesh& flat : { plateWithHole(12), plateL(20), gridPlane(40, 30) })
    {
      // The waves vanish across the boundaries of the lattice, so that these stay straight.
      const Hierarchy levels = decimate(flat, 8, 40);
      std::vector<FixedVec2> map = mapByPosition(levels.coarse.mesh,
        [&](const Vector3& p)
        { return Vector2(p.x() + a * std::sin(p.x()), p.y() + b * std::sin(2 * p.y())); });
      shuffleCharts(map, seed);
      expectExactReplay(flat, levels, map);
    }

    const Mesh cube = markFeatures(unitCube(16), kFeatureAngle);
    const Hierarchy levels = decimate(cube, 0.3, 60 + 20 * seed);
    std::vector<FixedVec2> map = cubeMap(levels.coarse.mesh, 7 + seed);
    shuffleCharts(map, seed);
    expectExactReplay(cube, levels, map);
  }
}

TEST(Replay, damagedLogsWithARightChecksumNeverHarm)
{
  // What a checksum cannot find, as a faulty writer would make it: each log is refused, or can be replayed.
  const Mesh mesh = torus(24, 12);
  const Hierarchy h = decimate(mesh, 0.5, 60);
  const std::vector<FixedVec2> coarseUv =
    torusMap(h.coarse.mesh, 1, 40 * kOne, 16 * kOne, [](Index) { return FixedVec2{}; });
  const std::vector<FixedVec2> start = onSlots(mesh, h.coarse, coarseUv);
  const std::vector<std::uint8_t> bytes = h.log.serialize();
  std::mt19937 random(23);
  std::size_t refused = 0;
  std::size_t replayed = 0;
  for (std::size_t i = 0; i < 2000; ++i)
  {
    // The header and the sizes of rounds and blocks as often as the records.
    std::vector<std::uint8_t> damaged = bytes;
    const std::size_t range = i % 2 == 0 ? 200 : bytes.size() - 8;
    for (std::size_t flips = 0; flips <= i % 3; ++flips)
    {
      damaged[random() % range] ^= static_cast<std::uint8_t>(1U << random() % 8);
    }
    if (i % 5 == 0)
    {
      damaged.resize(16 + random() % (bytes.size() - 16));
    }
    renewChecksum(damaged);
    try
    {
      const DecimationLog log = DecimationLog::deserialize(damaged, 1);
      std::vector<FixedVec2> uv = start; // a log of another size is refused with it
      const ReplayCounts counts = replayLog(log, uv, 1, {});
      EXPECT_EQ(counts.invertedStars, counts.movedToKernel + counts.withoutKernel);
      ++replayed;
    }
    catch (const InvalidInput& error)
    {
      EXPECT_GT(std::string(error.what()).size(), 20U) << "says what is wrong";
      ++refused;
    }
  }
  EXPECT_GT(refused, 500U);
  EXPECT_GT(replayed, 20U) << "else nothing was replayed";
}

TEST(Replay, recordsAreAsShortAsThePapers)
{
  // [Ebke et al. 2016, Appendix B]: 13 bytes a flip and 32 + 4 k a collapse; everything a file has counts.
  const Hierarchy h = decimate(torus(120, 60), 0.2, 200);
  const DecimationLog& log = h.log;
  std::size_t allowed = 13 * log.flips;
  std::size_t flipBytes = 0;
  for (const BlockRecords& block : log.blocks)
  {
    for (std::size_t end = block.size(); end > 0;)
    {
      const int faces = block[end - 1];
      allowed += faces == 0 ? 0 : 32 + 4 * static_cast<std::size_t>(faces);
      flipBytes += faces == 0 ? kFlipBytes : 0;
      end -= faces == 0 ? kFlipBytes : collapseBytes(faces);
    }
  }
  EXPECT_EQ(flipBytes, 9 * log.flips);
  EXPECT_LE(log.serialize().size(), allowed);
}

#ifdef QUADRILLE_SHARED_DATA
namespace
{

/// A binary little-endian PLY file of triangles with three float coordinates a vertex and nothing else.
std::optional<SurfaceInput> loadPly(const std::string& path)
{
  std::ifstream in(path, std::ios::binary);
  std::string line;
  std::size_t vertices = 0;
  std::size_t faces = 0;
  while (std::getline(in, line) && line.rfind("end_header", 0) != 0)
  {
    std::istringstream words(line);
    std::string keyword, what, count;
    words >> keyword >> what >> count;
    if (keyword == "element")
    {
      (what == "vertex" ? vertices : faces) = std::stoul(count);
    }
  }
  SurfaceInput surface;
  for (std::size_t v = 0; v < vertices; ++v)
  {
    std::array<float, 3> p{};
    in.read(reinterpret_cast<char*>(p.data()), 12);
    surface.points.emplace_back(double{ p[0] }, double{ p[1] }, double{ p[2] });
  }
  surface.polygonOffsets.push_back(0);
  for (std::size_t f = 0; f < faces; ++f)
  {
    std::uint8_t count = 0;
    std::array<std::int32_t, 3> corner{};
    in.read(reinterpret_cast<char*>(&count), 1);
    in.read(reinterpret_cast<char*>(corner.data()), 12);
    if (!in || count != 3)
    {
      return std::nullopt;
    }
    for (const std::int32_t v : corner)
    {
      surface.polygonPoints.push_back(static_cast<Index>(v));
    }
    surface.polygonOffsets.push_back(static_cast<Index>(surface.polygonPoints.size()));
  }
  return faces > 0 ? std::optional<SurfaceInput>(surface) : std::nullopt;
}

} // namespace

TEST(Replay, keepsEveryTransitionOfSeamlessMapsOfModels)
{
  std::size_t models = 0;
  for (const char* name : { "/scan/horse.ply", "/cad/fandisk.ply", "/cad/joint.ply",
         "/cad/of_flange.ply", "/open/mask.ply", "/open/plane_holes.ply" })
  {
    const std::optional<SurfaceInput> input = loadPly(QUADRILLE_SHARED_DATA + std::string(name));
    if (!input)
    {
      continue; // the models are large and not everywhere
    }
    SCOPED_TRACE(name);
    PrepareOptions prepareOptions;
    prepareOptions.featureAngle = kFeatureAngle;
    PreparedSurface surface = prepareSurface(*input, prepareOptions);
    const double edgeLength = std::sqrt(surface.area / 2500);
    refineSurface(surface, edgeLength, {});
    const Hierarchy h = decimate(surface.mesh, edgeLength, 1000);
    CrossFieldOptions fieldOptions;
    fieldOptions.targetEdgeLength = edgeLength;
    const CrossField field = computeCrossField(h.coarse.mesh, fieldOptions);
    SeamlessOptions options;
    options.edgeLength = edgeLength;
    SeamlessResult seamless = computeSeamlessMap(h.coarse.mesh, field, options);
    shuffleCharts(seamless.uv, 5);
    expectExactReplay(surface.mesh, h, seamless.uv);
    ++models;
  }
  if (models == 0)
  {
    GTEST_SKIP() << "no models in " QUADRILLE_SHARED_DATA;
  }
}
#endif
