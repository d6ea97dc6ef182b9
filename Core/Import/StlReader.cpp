// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Import/SurfaceFile.h"

#include "Base/Parallel.h"
#include "Base/Refuse.h"
#include "Base/Types.h"
#include "Import/FixedRows.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numeric>
#include <vector>

namespace quadrille
{
namespace
{

constexpr std::uint64_t kStlHeaderBytes = 84;
constexpr std::size_t kRowBytes = 50;
constexpr std::uint64_t kMostTriangles =
  400000000; // their corners, and the slots of a table, have 31 bits

/// What the file announces; 0 where it is too short to do so.
std::uint64_t announcedTriangles(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  std::array<unsigned char, kStlHeaderBytes> header{};
  file.read(reinterpret_cast<char*>(header.data()), kStlHeaderBytes);
  std::uint64_t count = 0;
  for (std::size_t i = 4; file && i-- > 0;)
  {
    count = count << 8 | header[80 + i];
  }
  return count;
}

/// Numbers equal points in the order in which they first come. Any number of threads may put corners into the table at
/// once; each of its slots keeps the lowest corner at one point.
class UniqueCorners
{
public:
  /// coordinates: three a corner.
  UniqueCorners(const std::vector<float>& coordinates, int threads)
    : coordinates_(coordinates), threads_(threads)
  {
    while (size_ < coordinates.size() / 3 + coordinates.size() / 9)
    {
      size_ *= 2;
    }
    table_.reset(new std::atomic<Index>[size_]);
    parallelForEach(size_, kLightChunk, threads,
      [&](std::size_t i) { table_[i].store(kInvalidIndex, std::memory_order_relaxed); });
  }

  /// Fills the numbers of the corners; returns the points.
  NumberArray number(std::int32_t* ids)
  {
    const std::size_t corners = coordinates_.size() / 3;
    parallelForEach(corners, kLightChunk, threads_,
      [&](std::size_t i) { ids[i] = static_cast<std::int32_t>(put(static_cast<Index>(i))); });
    const auto isFirst = [&](std::size_t i)
    { return table_[static_cast<std::size_t>(ids[i])].load(std::memory_order_relaxed) == i; };
    const auto counts = parallelParts<Index>(corners, kLightChunk, threads_,
      [&](std::size_t begin, std::size_t end, Index& count)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          count += isFirst(i) ? 1 : 0;
        }
      });
    std::vector<Index> firsts(counts.size() + 1, 0);
    std::partial_sum(counts.begin(), counts.end(), firsts.begin() + 1);
    NumberArray points(NumberType::Float32, 3, firsts.back());
    auto* const to = points.as<float>();
    parallelFor(corners, kLightChunk, threads_,
      [&](std::size_t begin, std::size_t end)
      {
        Index next = firsts[begin / kLightChunk];
        for (std::size_t i = begin; i < end; ++i)
        {
          if (
            isFirst(
              i)) // the number of a point is no higher than its first corner, so no other one is taken for it
          {
            std::memcpy(to + 3 * std::size_t{ next }, &coordinates_[3 * i], 3 * sizeof(float));
            table_[static_cast<std::size_t>(ids[i])].store(next++, std::memory_order_relaxed);
          }
        }
      });
    parallelForEach(corners, kLightChunk, threads_,
      [&](std::size_t i)
      {
        ids[i] = static_cast<std::int32_t>(
          table_[static_cast<std::size_t>(ids[i])].load(std::memory_order_relaxed));
      });
    return points;
  }

private:
  /// Compared as bits, so that what is no number equals itself; both zeros are one coordinate.
  using Bits = std::array<std::uint32_t, 3>;

  Bits bitsOf(Index corner) const
  {
    Bits bits{};
    for (std::size_t k = 0; k < 3; ++k)
    {
      const float x = coordinates_[3 * std::size_t{ corner } + k] + 0.0F;
      std::memcpy(&bits[k], &x, sizeof(x));
    }
    return bits;
  }

  /// The slot of a corner's point.
  std::size_t put(Index corner)
  {
    const Bits bits = bitsOf(corner);
    std::uint64_t hash = 0;
    for (const std::uint32_t b : bits)
    {
      hash = (hash ^ b) * 0x9e3779b97f4a7c15ULL;
      hash ^= hash >> 32;
    }
    for (std::size_t slot = hash & (size_ - 1);; slot = (slot + 1) & (size_ - 1))
    {
      std::atomic<Index>& entry = table_[slot];
      Index there = entry.load(std::memory_order_relaxed);
      if (there == kInvalidIndex &&
        entry.compare_exchange_strong(there, corner, std::memory_order_relaxed))
      {
        return slot;
      }
      if (bitsOf(there) == bits)
      {
        while (
          corner < there && !entry.compare_exchange_weak(there, corner, std::memory_order_relaxed))
        {
        }
        return slot;
      }
    }
  }

  const std::vector<float>& coordinates_;
  int threads_;
  std::size_t size_ = 16;
  std::unique_ptr<std::atomic<Index>[]> table_;
};

/// Triangles of three different points, in their order; the number of them.
std::size_t dropDegenerate(std::int32_t* ids, std::size_t triangles)
{
  std::size_t kept = 0;
  for (std::size_t f = 0; f < triangles; ++f)
  {
    const std::int32_t* p = ids + 3 * f;
    if (p[0] != p[1] && p[1] != p[2] && p[2] != p[0])
    {
      std::memmove(ids + 3 * kept++, p, 3 * sizeof(std::int32_t));
    }
  }
  return kept;
}

/// coordinates: nine a triangle.
SurfaceFile joinCorners(const std::vector<float>& coordinates, int threads)
{
  const std::size_t triangles = coordinates.size() / 9;
  SurfaceFile file;
  NumberArray& ids = file.polygons.ids;
  ids = NumberArray(NumberType::Int32, 1, 3 * triangles);
  file.points = UniqueCorners(coordinates, threads).number(ids.as<std::int32_t>());
  const std::size_t kept = dropDegenerate(ids.as<std::int32_t>(), triangles);
  ids.shorten(3 * kept);
  file.polygons.offsets = NumberArray(NumberType::Int32, 1, kept + 1);
  for (std::size_t f = 0; f <= kept; ++f)
  {
    file.polygons.offsets.as<std::int32_t>()[f] = static_cast<std::int32_t>(3 * f);
  }
  return file;
}

} // namespace

bool isBinaryStl(const std::string& path)
{
  std::error_code code;
  const std::uint64_t size = std::filesystem::file_size(path, code);
  const std::uint64_t triangles = code || size < kStlHeaderBytes ? 0 : announcedTriangles(path);
  return triangles > 0 && size == kStlHeaderBytes + kRowBytes * triangles;
}

SurfaceFile readBinaryStl(const std::string& path, int threads)
{
  const std::uint64_t triangles = isBinaryStl(path) ? announcedTriangles(path) : 0;
  refuseIf(triangles == 0 || triangles > kMostTriangles, path,
    triangles == 0 ? ": is no binary STL file, or its length is not that of its triangles"
                   : ": has more than 400 million triangles");
  std::vector<float> coordinates(9 * triangles);
  constexpr std::size_t kNormalBytes = 12, kCornerBytes = 36;
  const std::size_t read = readFixedRows(path, kStlHeaderBytes, triangles, kRowBytes, threads,
    [&](std::size_t first, std::size_t rows, const unsigned char* bytes)
    {
      for (std::size_t i = 0; i < rows; ++i)
      {
        std::memcpy(&coordinates[9 * (first + i)], bytes + i * kRowBytes + kNormalBytes,
          kCornerBytes); // x86 and ARM are little-endian
      }
      return rows;
    });
  refuseIf(read < triangles, path, ": triangle ", read, " cannot be read");
  return joinCorners(coordinates, threads);
}

SurfaceFile readTextStl(const std::string& path, int threads)
{
  std::ifstream file(path);
  refuseIf(!file, path, ": cannot be opened for reading");
  std::vector<float> coordinates;
  std::string word;
  const auto fail = [&](const std::string& reason) {
    throw InvalidInput(path + ": facet " + std::to_string(coordinates.size() / 9) + " " + reason);
  };
  bool isStl = false;
  while (file >> word)
  {
    isStl = isStl || word == "facet";
    if (word == "vertex")
    {
      for (int k = 0; k < 3; ++k)
      {
        // As a word, as streams do not read "nan" and refuse what is too small for a float.
        char* end = nullptr;
        file >> word;
        coordinates.push_back(std::strtof(word.c_str(), &end));
        if (!file || end == word.c_str() || *end != '\0')
        {
          fail("has a vertex without three numbers");
        }
      }
    }
    else if (word == "endfacet" && coordinates.size() % 9 != 0)
    {
      fail("has not three vertices");
    }
  }
  refuseIf(!isStl || coordinates.size() % 9 != 0, path,
    isStl ? ": ends within a facet" : ": is no STL file: it has no facets");
  return joinCorners(coordinates, threads);
}

} // namespace quadrille
