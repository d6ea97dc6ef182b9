// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Parts of a binary file all of whose rows have the same length, read by several threads and without the file in
/// memory: the triangles of an STL file; of a PLY file vertices, and faces where all are triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace quadrille
{

/// Calls body(first row, rows, their bytes) for consecutive parts of `rows` rows of rowBytes bytes each, that begin at
/// byte `begin` of the file, on `threads` threads (0: all). body returns how many rows of the part it took; fewer
/// than it got mean that the next one was refused. Returns the lowest refused row, or `rows` where there is none; a
/// row that the file does not hold is refused, too.
std::size_t readFixedRows(const std::string& path, std::uint64_t begin, std::size_t rows,
  std::size_t rowBytes, int threads,
  const std::function<std::size_t(std::size_t, std::size_t, const unsigned char*)>& body);

/// Where the numbers of a property go: that of row i to `to` + i * stride.
struct RowTarget
{
  std::size_t offset = 0; ///< in the row
  std::size_t size = 0;   ///< 1, 2, 4 or 8 bytes
  unsigned char* to = nullptr;
  std::size_t stride = 0; ///< bytes
};

/// Copies the numbers of consecutive rows; swapped: with their bytes in reverse order.
void copyRows(const unsigned char* bytes, std::size_t firstRow, std::size_t rows,
  std::size_t rowBytes, bool swapped, const std::vector<RowTarget>& targets);

} // namespace quadrille
