// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Hierarchy/LogRecords.h"
#include "ReplayChecks.h"
#include "TestMaps.h"
#include "TestMeshes.h"
#include "Transfer/Replay.h"
#include "Transfer/Transfer.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

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

TEST(Replay, PartsGiveWhatTheWholeGives)
{
  const Mesh mesh = torus(90, 45);
  const Hierarchy h = decimate(mesh, 0.3, 120);
  std::vector<FixedVec2> coarseUv =
    torusMap(h.coarse.mesh, 1, 40 * kOne, 16 * kOne, [](Index) { return FixedVec2{}; });
  shuffleCharts(coarseUv, 3);
  const std::vector<FixedVec2> start = onSlots(mesh, h.coarse, coarseUv);
  std::vector<FixedVec2> whole = start;
  replayAll(h.log, whole, 1);
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

TEST(Replay, ReachesTheIntermediateLevel)
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

TEST(Replay, RefusesRangesAndLevelsThatDoNotFit)
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

TEST(Replay, KeepsEveryTransitionOfSmoothMaps)
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

TEST(Replay, DamagedLogsWithARightChecksumNeverHarm)
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
      const ReplayCounts counts = replayAll(log, uv, 1);
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

TEST(Replay, RecordsAreAsShortAsThePapers)
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
