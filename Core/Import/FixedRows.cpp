// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Import/FixedRows.h"

#include "Base/Parallel.h"

#include <algorithm>
#include <cstring>
#include <fstream>

namespace quadrille
{

namespace
{

/// Bytes that a thread reads at once: they stay in its second level cache until they are taken apart.
constexpr std::size_t kPartBytes = std::size_t{ 1 } << 19;

template <std::size_t kSize>
void copyColumn(const unsigned char* bytes, std::size_t firstRow, std::size_t rows,
  std::size_t rowBytes, bool swapped, const RowTarget& target)
{
  const unsigned char* from = bytes + target.offset;
  unsigned char* to = target.to + firstRow * target.stride;
  for (std::size_t i = 0; i < rows; ++i, from += rowBytes, to += target.stride)
  {
    if (swapped)
    {
      std::reverse_copy(from, from + kSize, to);
    }
    else
    {
      std::memcpy(to, from, kSize);
    }
  }
}

} // namespace

std::size_t readFixedRows(const std::string& path, std::uint64_t begin, std::size_t rows,
  std::size_t rowBytes, int threads,
  const std::function<std::size_t(std::size_t, std::size_t, const unsigned char*)>& body)
{
  const std::size_t part = std::max<std::size_t>(1, kPartBytes / rowBytes);
  std::vector<std::size_t> refused((rows + part - 1) / part, rows);
  parallelFor(rows, part, threads,
    [&](std::size_t first, std::size_t last)
    {
      std::vector<unsigned char> bytes((last - first) * rowBytes);
      std::ifstream file(path, std::ios::binary);
      file.seekg(static_cast<std::streamoff>(begin + std::uint64_t{ first } * rowBytes));
      file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
      const std::size_t there =
        file.gcount() > 0 ? static_cast<std::size_t>(file.gcount()) / rowBytes : 0;
      const std::size_t taken = body(first, there, bytes.data());
      if (taken < last - first)
      {
        refused[first / part] = first + taken;
      }
    });
  return refused.empty() ? rows : *std::min_element(refused.begin(), refused.end());
}

void copyRows(const unsigned char* bytes, std::size_t firstRow, std::size_t rows,
  std::size_t rowBytes, bool swapped, const std::vector<RowTarget>& targets)
{
  for (const RowTarget& target : targets)
  {
    switch (target.size)
    {
      case 1:
        copyColumn<1>(bytes, firstRow, rows, rowBytes, false, target);
        break;
      case 2:
        copyColumn<2>(bytes, firstRow, rows, rowBytes, swapped, target);
        break;
      case 4:
        copyColumn<4>(bytes, firstRow, rows, rowBytes, swapped, target);
        break;
      default:
        copyColumn<8>(bytes, firstRow, rows, rowBytes, swapped, target);
    }
  }
}

} // namespace quadrille
