// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleStl.h"

#include "Base/Error.h"
#include "Base/Parallel.h"
#include "Base/Types.h"
#include "QuadrilleFixedRows.h"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTypeInt32Array.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

namespace quadrille
{
namespace
{

constexpr std::uint64_t kStlHeaderBytes = 84;
constexpr std::size_t kRowBytes = 50;
constexpr std::uint64_t kMostTriangles =
  400000000; // their corners, and the places of a table, have 31 bits
constexpr std::size_t kCornerChunk = std::size_t{ 1 } << 16;

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
/// once; each of its places keeps the lowest corner at one point.
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
    parallelFor(size_, kCornerChunk, threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          table_[i].store(kInvalidIndex, std::memory_order_relaxed);
        }
      });
  }

  /// Fills the numbers of the corners; returns the points.
  vtkSmartPointer<vtkFloatArray> number(std::int32_t* ids)
  {
    const std::size_t corners = coordinates_.size() / 3;
    parallelFor(corners, kCornerChunk, threads_,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          ids[i] = static_cast<std::int32_t>(put(static_cast<Index>(i)));
        }
      });
    const auto isFirst = [&](std::size_t i)
    { return table_[static_cast<std::size_t>(ids[i])].load(std::memory_order_relaxed) == i; };
    std::vector<Index> firsts((corners + kCornerChunk - 1) / kCornerChunk + 1, 0);
    parallelFor(corners, kCornerChunk, threads_,
      [&](std::size_t begin, std::size_t end)
      {
        Index count = 0;
        for (std::size_t i = begin; i < end; ++i)
        {
          count += isFirst(i) ? 1 : 0;
        }
        firsts[begin / kCornerChunk + 1] = count;
      });
    for (std::size_t chunk = 1; chunk < firsts.size(); ++chunk)
    {
      firsts[chunk] += firsts[chunk - 1];
    }
    auto points = vtkSmartPointer<vtkFloatArray>::New();
    points->SetNumberOfComponents(3);
    points->SetNumberOfTuples(firsts.back());
    float* const to = points->GetPointer(0);
    parallelFor(corners, kCornerChunk, threads_,
      [&](std::size_t begin, std::size_t end)
      {
        Index next = firsts[begin / kCornerChunk];
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
    parallelFor(corners, kCornerChunk, threads_,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          ids[i] = static_cast<std::int32_t>(
            table_[static_cast<std::size_t>(ids[i])].load(std::memory_order_relaxed));
        }
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

  /// The place of a corner's point.
  std::size_t put(Index corner)
  {
    const Bits bits = bitsOf(corner);
    std::uint64_t hash = 0;
    for (const std::uint32_t b : bits)
    {
      hash = (hash ^ b) * 0x9e3779b97f4a7c15ULL;
      hash ^= hash >> 32;
    }
    for (std::size_t place = hash & (size_ - 1);; place = (place + 1) & (size_ - 1))
    {
      std::atomic<Index>& entry = table_[place];
      Index there = entry.load(std::memory_order_relaxed);
      if (there == kInvalidIndex &&
        entry.compare_exchange_strong(there, corner, std::memory_order_relaxed))
      {
        return place;
      }
      if (bitsOf(there) == bits)
      {
        while (
          corner < there && !entry.compare_exchange_weak(there, corner, std::memory_order_relaxed))
        {
        }
        return place;
      }
    }
  }

  const std::vector<float>& coordinates_;
  int threads_;
  std::size_t size_ = 16;
  std::unique_ptr<std::atomic<Index>[]> table_;
};

/// Triangles of three different points, in their order; the number of them.
vtkIdType dropDegenerate(std::int32_t* ids, vtkIdType triangles)
{
  vtkIdType kept = 0;
  for (vtkIdType f = 0; f < triangles; ++f)
  {
    const std::int32_t* p = ids + 3 * f;
    if (p[0] != p[1] && p[1] != p[2] && p[2] != p[0])
    {
      std::memmove(ids + 3 * kept++, p, 3 * sizeof(std::int32_t));
    }
  }
  return kept;
}

} // namespace

bool isBinaryStl(const std::string& path)
{
  std::error_code code;
  const std::uint64_t size = std::filesystem::file_size(path, code);
  const std::uint64_t triangles = code || size < kStlHeaderBytes ? 0 : announcedTriangles(path);
  return triangles > 0 && size == kStlHeaderBytes + kRowBytes * triangles;
}

vtkSmartPointer<vtkPolyData> readBinaryStl(const std::string& path, int threads)
{
  const std::uint64_t triangles = isBinaryStl(path) ? announcedTriangles(path) : 0;
  if (triangles == 0 || triangles > kMostTriangles)
  {
    throw InvalidInput(path +
      (triangles == 0 ? ": is no binary STL file, or its length is not that of its triangles"
                      : ": has more than 400 million triangles"));
  }
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
  if (read < triangles)
  {
    throw InvalidInput(path + ": triangle " + std::to_string(read) + " cannot be read");
  }
  vtkNew<vtkTypeInt32Array> ids;
  ids->SetNumberOfValues(static_cast<vtkIdType>(3 * triangles));
  vtkNew<vtkPoints> points;
  points->SetData(UniqueCorners(coordinates, threads).number(ids->GetPointer(0)));
  const vtkIdType kept = dropDegenerate(ids->GetPointer(0), static_cast<vtkIdType>(triangles));
  ids->SetNumberOfValues(3 * kept);
  vtkNew<vtkTypeInt32Array> offsets;
  offsets->SetNumberOfValues(kept + 1);
  for (vtkIdType f = 0; f <= kept; ++f)
  {
    offsets->SetValue(f, static_cast<std::int32_t>(3 * f));
  }
  vtkNew<vtkCellArray> polys;
  polys->SetData(offsets, ids);
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(polys);
  return data;
}

} // namespace quadrille
