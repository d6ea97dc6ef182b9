// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The triangles of a source by pieces, each of cells that lie beside each other, and the points that pieces share.
#pragma once

#include "Pieces/RemeshInPieces.h"

#include <Eigen/Geometry>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace quadrille
{

struct SourceExtent
{
  Eigen::AlignedBox3d box;
  double area = 0;

  double diagonal() const { return box.diagonal().norm(); }
};

/// Of all triangles; throws InvalidInput for a point that is not finite.
SourceExtent extentOf(const TriangleSource& source, int threads);

/// The triangles by pieces.
struct PieceCut
{
  std::vector<Index> order;       ///< triangles, piece after piece, ascending in each
  std::vector<std::size_t> first; ///< #pieces + 1, into order
  double area = 0;
  double diagonal = 0;

  std::size_t pieces() const { return first.size() - 1; }
};

PieceCut cutIntoPieces(const TriangleSource& source, std::size_t trianglesOfPiece, int threads);

/// Which points belong to several pieces.
class SharedPoints
{
public:
  SharedPoints(const TriangleSource& source, const PieceCut& cut, int threads);

  bool has(Index point) const { return piece_[point].load(std::memory_order_relaxed) == kShared; }

private:
  static constexpr std::uint16_t kShared = std::numeric_limits<std::uint16_t>::max();

  /// Whichever comes first, the end is the same: none, one piece, or shared.
  void add(Index point, std::uint16_t piece)
  {
    std::uint16_t known = 0;
    std::atomic<std::uint16_t>& at = piece_[point];
    if (!at.compare_exchange_strong(known, piece, std::memory_order_relaxed) && known != piece)
    {
      at.store(kShared, std::memory_order_relaxed);
    }
  }

  std::vector<std::atomic<std::uint16_t>> piece_; ///< 0: none yet; else the piece + 1
};

} // namespace quadrille
