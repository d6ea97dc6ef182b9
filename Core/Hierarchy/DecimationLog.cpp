// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/DecimationLog.h"

#include "Base/Error.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <utility>

namespace quadrille
{

namespace
{

// File layout, little-endian: magic (8 bytes), version, fineFaces (32 bit), fineHash, collapses, flips,
// intermediateRounds, number of rounds, of blocks, of record bytes (64 bit each); blocks per round, bytes
// per block (64 bit each); records; CRC-64 of all before it.
constexpr std::array<std::uint8_t, 8> kMagic{ 'Q', 'D', 'R', 'L', 'D', 'L', 'O', 'G' };
constexpr std::uint32_t kLogVersion = 2;
constexpr std::size_t kLogHeaderBytes = 8 + 4 + 4 + 7 * 8;

/// CRC-64 of ECMA-182 in its reflected form, eight bytes at a time [Kounavis and Berry 2005].
class Crc64
{
public:
  Crc64()
  {
    for (std::uint64_t i = 0; i < 256; ++i)
    {
      std::uint64_t crc = i;
      for (int bit = 0; bit < 8; ++bit)
      {
        crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xC96C5795D7870F42ULL : 0ULL);
      }
      table_[0][i] = crc;
    }
    for (std::size_t slice = 1; slice < 8; ++slice)
    {
      for (std::size_t i = 0; i < 256; ++i)
      {
        const std::uint64_t before = table_[slice - 1][i];
        table_[slice][i] = (before >> 8) ^ table_[0][before & 0xFFU];
      }
    }
  }
  std::uint64_t operator()(const std::uint8_t* bytes, std::size_t count) const
  {
    std::uint64_t crc = ~0ULL;
    for (; count >= 8; count -= 8, bytes += 8)
    {
      crc ^= loadLittleEndian(bytes) | std::uint64_t{ loadLittleEndian(bytes + 4) } << 32;
      std::uint64_t next = 0;
      for (std::size_t i = 0; i < 8; ++i)
      {
        next ^= table_[7 - i][crc >> (8 * i) & 0xFFU];
      }
      crc = next;
    }
    for (; count > 0; --count, ++bytes)
    {
      crc = (crc >> 8) ^ table_[0][(crc ^ *bytes) & 0xFFU];
    }
    return ~crc;
  }

private:
  std::array<std::array<std::uint64_t, 256>, 8> table_{};
};

/// Writes numbers one after the other into bytes that are there already.
class Writer
{
public:
  explicit Writer(std::uint8_t* bytes) : bytes_(bytes) {}
  void put32(std::uint32_t value)
  {
    storeLittleEndian(bytes_, value);
    bytes_ += 4;
  }
  void put64(std::uint64_t value)
  {
    put32(static_cast<std::uint32_t>(value));
    put32(static_cast<std::uint32_t>(value >> 32));
  }
  template <typename Bytes>
  void putBytes(const Bytes& source)
  {
    bytes_ = std::copy(source.begin(), source.end(), bytes_);
  }

private:
  std::uint8_t* bytes_;
};

[[noreturn]] void refuse(const std::string& reason)
{
  throw InvalidInput("The decimation log cannot be used: " + reason);
}

/// Reads numbers off the front; the caller has checked that they are there.
class Reader
{
public:
  explicit Reader(const std::uint8_t* bytes) : bytes_(bytes) {}
  std::uint32_t get32()
  {
    bytes_ += 4;
    return loadLittleEndian(bytes_ - 4);
  }
  std::uint64_t get64()
  {
    const std::uint64_t low = get32();
    return low | std::uint64_t{ get32() } << 32;
  }
  const std::uint8_t* position() const { return bytes_; }

private:
  const std::uint8_t* bytes_;
};

void checkCollapse(const std::uint8_t* begin, const std::uint8_t* end, Index slots)
{
  const int faces = end[-1];
  const unsigned kind = static_cast<std::size_t>(end - begin) < 2 ? 0xFFU : end[-2];
  if (faces > kMaximumRing || (kind & ~unsigned{ kOnCurveBit }) > 2 ||
    static_cast<std::size_t>(end - begin) < collapseBytes(faces))
  {
    refuse("a collapse record is not well formed.");
  }
  CollapseRecord record;
  readCollapse(end, record);
  bool fits = faces >= (record.kind == CollapseKind::Interior ? 3 : 2);
  for (int i = 0; i < faces; ++i)
  {
    fits = fits && record.slot[static_cast<std::size_t>(i)] < slots;
  }
  for (const std::uint8_t ring : record.ring)
  {
    fits = fits && ring < record.ringSize();
  }
  if (!fits)
  {
    refuse("a collapse record names a slot or a ring vertex that does not exist.");
  }
}

void checkFlip(const std::uint8_t* begin, const std::uint8_t* end, Index slots)
{
  if (static_cast<std::size_t>(end - begin) < kFlipBytes || loadLittleEndian(end - 9) >= slots ||
    loadLittleEndian(end - 5) >= slots)
  {
    refuse("a flip record is not well formed.");
  }
}

/// Walks all records backwards, as the replay does, so that the replay need not check anything.
void checkRecords(const DecimationLog& log)
{
  const Index slots = 3 * log.fineFaces;
  std::size_t collapses = 0;
  std::size_t flips = 0;
  for (const BlockRecords& block : log.blocks)
  {
    const std::uint8_t* begin = block.data();
    const std::uint8_t* end = begin + block.size();
    while (end > begin)
    {
      if (end[-1] == 0)
      {
        checkFlip(begin, end, slots);
        end -= kFlipBytes;
        ++flips;
      }
      else
      {
        checkCollapse(begin, end, slots);
        end -= collapseBytes(end[-1]);
        ++collapses;
      }
    }
  }
  if (collapses != log.collapses || flips != log.flips)
  {
    refuse("it does not hold as many records as it says.");
  }
}

} // namespace

void DecimationLog::truncate(const End& end)
{
  rounds.resize(end.rounds);
  blocks.resize(end.blocks);
  collapses = end.collapses;
  flips = end.flips;
}

void DecimationLog::append(BlockRecords records, std::size_t newCollapses, std::size_t newFlips)
{
  if (records.empty())
  {
    return;
  }
  rounds.push_back({ blocks.size(), 1 });
  blocks.push_back(std::move(records));
  collapses += newCollapses;
  flips += newFlips;
}

void DecimationLog::append(DecimationLog more)
{
  for (Round round : more.rounds)
  {
    round.firstBlock += blocks.size();
    rounds.push_back(round);
  }
  std::move(more.blocks.begin(), more.blocks.end(), std::back_inserter(blocks));
  collapses += more.collapses;
  flips += more.flips;
}

std::size_t DecimationLog::recordBytes() const
{
  std::size_t bytes = 0;
  for (const BlockRecords& block : blocks)
  {
    bytes += block.size();
  }
  return bytes;
}

std::vector<std::uint8_t> DecimationLog::serialize() const
{
  std::vector<std::uint8_t> bytes(
    kLogHeaderBytes + 8 * (rounds.size() + blocks.size()) + recordBytes() + 8);
  Writer writer(bytes.data());
  writer.putBytes(kMagic);
  writer.put32(kLogVersion);
  writer.put32(fineFaces);
  for (const std::uint64_t value : { fineHash, std::uint64_t{ collapses }, std::uint64_t{ flips },
         std::uint64_t{ intermediateRounds }, std::uint64_t{ rounds.size() },
         std::uint64_t{ blocks.size() }, std::uint64_t{ recordBytes() } })
  {
    writer.put64(value);
  }
  for (const Round& round : rounds)
  {
    writer.put64(round.blockCount);
  }
  for (const BlockRecords& block : blocks)
  {
    writer.put64(block.size());
  }
  for (const BlockRecords& block : blocks)
  {
    writer.putBytes(block);
  }
  writer.put64(Crc64()(bytes.data(), bytes.size() - 8));
  return bytes;
}

DecimationLog DecimationLog::deserialize(
  const std::vector<std::uint8_t>& bytes, std::uint64_t expectedHash)
{
  if (bytes.size() < kMagic.size() || !std::equal(kMagic.begin(), kMagic.end(), bytes.begin()))
  {
    refuse("these bytes are no decimation log.");
  }
  if (bytes.size() < kLogHeaderBytes + 8)
  {
    refuse("it is truncated.");
  }
  Reader reader(bytes.data() + kMagic.size());
  const std::uint32_t version = reader.get32();
  if (version != kLogVersion)
  {
    refuse("it has version " + std::to_string(version) + ", this program reads version " +
      std::to_string(kLogVersion) + ".");
  }
  DecimationLog log;
  log.fineFaces = reader.get32();
  log.fineHash = reader.get64();
  log.collapses = reader.get64();
  log.flips = reader.get64();
  log.intermediateRounds = reader.get64();
  const std::uint64_t roundCount = reader.get64();
  const std::uint64_t blockCount = reader.get64();
  const std::uint64_t recordBytes = reader.get64();
  const std::uint64_t rest = bytes.size() - kLogHeaderBytes - 8;
  if (roundCount > rest / 8 || blockCount > rest / 8 || 8 * (roundCount + blockCount) > rest ||
    rest - 8 * (roundCount + blockCount) != recordBytes)
  {
    refuse("it is truncated or has bytes too many.");
  }
  if (Reader(bytes.data() + bytes.size() - 8).get64() != Crc64()(bytes.data(), bytes.size() - 8))
  {
    refuse("it is damaged (its checksum does not fit).");
  }
  if (log.fineHash != expectedHash)
  {
    refuse("it was made for another surface.");
  }
  std::size_t firstBlock = 0;
  for (std::uint64_t i = 0; i < roundCount; ++i)
  {
    log.rounds.push_back({ firstBlock, reader.get64() });
    firstBlock += std::min(log.rounds.back().blockCount, std::size_t{ blockCount } + 1);
  }
  std::vector<std::uint64_t> lengths;
  std::uint64_t sum = 0;
  for (std::uint64_t i = 0; i < blockCount; ++i)
  {
    lengths.push_back(std::min(reader.get64(), recordBytes + 1));
    sum = std::min(sum + lengths.back(), recordBytes + 1);
  }
  if (firstBlock != blockCount || sum != recordBytes || log.intermediateRounds > roundCount)
  {
    refuse("its rounds and blocks do not add up.");
  }
  const std::uint8_t* records = reader.position();
  for (const std::uint64_t length : lengths)
  {
    log.blocks.emplace_back(records, records + length);
    records += length;
  }
  checkRecords(log);
  return log;
}

} // namespace quadrille
