// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "BothPhases.h"
#include "Hierarchy/Hierarchy.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

constexpr std::uint64_t kHash = 0x0123456789abcdefULL;

const DecimationLog& sampleLog()
{
  static const DecimationLog log = []()
  {
    HierarchyOptions options;
    options.targetEdgeLength = 0.5;
    options.coarseVertices = 40;
    return buildHierarchy(torus(40, 20), kHash, options).log;
  }();
  return log;
}

std::string refusal(const std::vector<std::uint8_t>& bytes, std::uint64_t hash)
{
  try
  {
    DecimationLog::deserialize(bytes, hash);
  }
  catch (const InvalidInput& error)
  {
    return error.what();
  }
  return "accepted";
}

} // namespace

TEST(DecimationLog, RoundTripsThroughBytes)
{
  const DecimationLog& log = sampleLog();
  ASSERT_GT(log.collapses, 0U);
  ASSERT_GT(log.flips, 0U);
  const std::vector<std::uint8_t> bytes = log.serialize();
  const DecimationLog copy = DecimationLog::deserialize(bytes, kHash);
  EXPECT_EQ(copy.blocks, log.blocks);
  EXPECT_EQ(copy.serialize(), bytes);
  EXPECT_EQ(copy.intermediateRounds, log.intermediateRounds);
}

TEST(DecimationLog, AnEmptyLogRoundTrips)
{
  HierarchyOptions options;
  options.targetEdgeLength = 1e-3;
  const DecimationLog log = buildHierarchy(sphere(1), kHash, options).log;
  EXPECT_EQ(log.collapses, 0U);
  EXPECT_EQ(DecimationLog::deserialize(log.serialize(), kHash).rounds.size(), 0U);
}

TEST(DecimationLog, RefusesALogOfAnotherSurface)
{
  EXPECT_NE(refusal(sampleLog().serialize(), kHash + 1).find("another surface"), std::string::npos);
}

TEST(DecimationLog, RefusesEveryTruncation)
{
  const std::vector<std::uint8_t> bytes = sampleLog().serialize();
  for (std::size_t length = 0; length < bytes.size(); length += length < 200 ? 1 : 97)
  {
    const std::vector<std::uint8_t> part(
      bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_NE(refusal(part, kHash), "accepted") << length;
  }
  std::vector<std::uint8_t> longer = bytes;
  longer.push_back(0);
  EXPECT_NE(refusal(longer, kHash), "accepted");
}

TEST(DecimationLog, RefusesEveryFlippedBit)
{
  // A 64-bit CRC finds every single-bit error; the header's own checks may speak first.
  std::vector<std::uint8_t> bytes = sampleLog().serialize();
  for (std::size_t i = 0; i < bytes.size(); i += i < 200 ? 1 : 61)
  {
    for (int bit = 0; bit < 8; ++bit)
    {
      bytes[i] ^= static_cast<std::uint8_t>(1 << bit);
      EXPECT_NE(refusal(bytes, kHash), "accepted") << "byte " << i << " bit " << bit;
      bytes[i] ^= static_cast<std::uint8_t>(1 << bit);
    }
  }
}

TEST(DecimationLog, RefusesRecordsThatNameWhatIsNotThere)
{
  // With a right checksum, as a faulty writer would make it.
  DecimationLog log = sampleLog();
  log.fineFaces = 10; // nearly every slot is out of range now
  EXPECT_NE(refusal(log.serialize(), kHash).find("does not exist"), std::string::npos);
  log = sampleLog();
  log.blocks.back().back() = 200; // a collapse with more faces than any ring has
  EXPECT_NE(refusal(log.serialize(), kHash).find("not well formed"), std::string::npos);
  log = sampleLog();
  log.collapses += 1;
  EXPECT_NE(refusal(log.serialize(), kHash).find("as many records"), std::string::npos);
  log = sampleLog();
  log.rounds.back().blockCount += 1;
  EXPECT_NE(refusal(log.serialize(), kHash).find("add up"), std::string::npos);
}
