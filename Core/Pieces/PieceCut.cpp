// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces/PieceCut.h"

#include "Base/LargeArray.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Mesh/SpaceFillingOrder.h"
#include "Prepare/Repair.h"

#include <algorithm>
#include <array>
#include <utility>

namespace quadrille
{
namespace
{

/// Cells of the grid that pieces are made of: 2^kCellBits an axis.
constexpr int kCellBits = 7;
constexpr std::size_t kCells = std::size_t{ 1 } << (3 * kCellBits);

/// The triangles of a chunk with their places.
class ChunkReader
{
public:
  explicit ChunkReader(const TriangleSource& source) : source_(source) {}

  void read(std::size_t begin, std::size_t end)
  {
    ids_.resize(3 * (end - begin));
    places_.resize(ids_.size());
    source_.corners(begin, end, ids_.data());
    const std::size_t points = source_.pointCount();
    for (std::size_t i = 0; i < ids_.size(); ++i)
    {
      requirePoint(begin + i / 3, ids_[i], points);
    }
    source_.positions(ids_.data(), ids_.size(), places_.data());
  }
  const Index* ids(std::size_t i) const { return &ids_[3 * i]; }
  const Vector3* places(std::size_t i) const { return &places_[3 * i]; }

private:
  const TriangleSource& source_;
  std::vector<Index> ids_;
  std::vector<Vector3> places_;
};

class Cutter
{
public:
  Cutter(const TriangleSource& source, std::size_t trianglesOfPiece, int threads)
    : source_(source), trianglesOfPiece_(trianglesOfPiece), threads_(threads)
  {
  }

  PieceCut run()
  {
    const SourceExtent extent = extentOf(source_, threads_);
    box_ = extent.box;
    cut_.area = extent.area;
    cut_.diagonal = extent.diagonal();
    findCells();
    std::vector<std::uint16_t> pieceOf = cutCells();
    std::vector<std::size_t> at = cut_.first;
    growLarge(cut_.order, cell_.size());
    for (std::size_t f = 0; f < cell_.size(); ++f)
    {
      pollNowAndThen(f);
      cut_.order[at[pieceOf[cell_[f]]]++] = static_cast<Index>(f);
    }
    return std::move(cut_);
  }

private:
  void findCells()
  {
    const std::size_t faces = source_.triangleCount();
    growLarge(cell_, faces);
    const double width = box_.diagonal().maxCoeff();
    const double scale = width > 0 ? (1 << kCellBits) / width : 0;
    parallelFor(faces, kLightChunk, threads_,
      [&](std::size_t begin, std::size_t end)
      {
        ChunkReader reader(source_);
        reader.read(begin, end);
        for (std::size_t i = 0; i < end - begin; ++i)
        {
          const Vector3* const p = reader.places(i);
          const Vector3 middle = ((p[0] + p[1] + p[2]) / 3 - box_.min()) * scale;
          std::uint32_t cell = 0;
          for (int k = 0; k < 3; ++k)
          {
            const auto along = static_cast<std::uint32_t>(
              std::clamp(middle[k], 0.0, static_cast<double>((1 << kCellBits) - 1)));
            cell = cell << kCellBits | along;
          }
          cell_[begin + i] = cell;
        }
      });
  }

  /// Runs of cells along a Hilbert curve with about as many triangles each. Fills cut_.first.
  std::vector<std::uint16_t> cutCells()
  {
    std::vector<std::size_t> count(kCells, 0);
    for (std::size_t f = 0; f < cell_.size(); ++f)
    {
      pollNowAndThen(f);
      ++count[cell_[f]];
    }
    std::vector<std::pair<std::uint64_t, std::uint32_t>> cells;
    constexpr std::uint32_t kMask = (1U << kCellBits) - 1;
    for (std::uint32_t cell = 0; cell < kCells; ++cell)
    {
      if (count[cell] > 0)
      {
        cells.emplace_back(
          hilbertKey(
            { cell >> (2 * kCellBits), cell >> kCellBits & kMask, cell & kMask }, kCellBits),
          cell);
      }
    }
    std::sort(cells.begin(), cells.end());
    const std::size_t faces = cell_.size();
    const std::size_t pieces = std::min<std::size_t>(std::numeric_limits<std::uint16_t>::max(),
      std::max<std::size_t>(1, (faces + trianglesOfPiece_ / 2) / trianglesOfPiece_));
    std::vector<std::uint16_t> pieceOf(kCells, 0);
    cut_.first = { 0 };
    std::size_t done = 0;
    for (const auto& [key, cell] : cells)
    {
      // A piece ends where its share of the triangles is reached.
      if (done * pieces >= cut_.first.size() * faces && done > cut_.first.back())
      {
        cut_.first.push_back(done);
      }
      pieceOf[cell] = static_cast<std::uint16_t>(cut_.first.size() - 1);
      done += count[cell];
    }
    cut_.first.push_back(done);
    return pieceOf;
  }

  const TriangleSource& source_;
  std::size_t trianglesOfPiece_;
  int threads_;
  Eigen::AlignedBox3d box_;
  std::vector<std::uint32_t> cell_; ///< #F
  PieceCut cut_;
};

} // namespace

SourceExtent extentOf(const TriangleSource& source, int threads)
{
  const std::size_t faces = source.triangleCount();
  const auto parts = parallelParts<SourceExtent>(faces, kLightChunk, threads,
    [&](std::size_t begin, std::size_t end, SourceExtent& part)
    {
      ChunkReader reader(source);
      reader.read(begin, end);
      for (std::size_t i = 0; i < end - begin; ++i)
      {
        const Vector3* const p = reader.places(i);
        for (int k = 0; k < 3; ++k)
        {
          requireCoordinates(reader.ids(i)[k], p[k]);
          part.box.extend(p[k]);
        }
        part.area += 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
      }
    });
  SourceExtent all;
  for (const SourceExtent& part : parts)
  {
    all.box.extend(part.box);
    all.area += part.area;
  }
  return all;
}

PieceCut cutIntoPieces(const TriangleSource& source, std::size_t trianglesOfPiece, int threads)
{
  return Cutter(source, trianglesOfPiece, threads).run();
}

SharedPoints::SharedPoints(const TriangleSource& source, const PieceCut& cut, int threads)
  : piece_(source.pointCount())
{
  parallelFor(cut.pieces(), 1, threads,
    [&](std::size_t piece, std::size_t)
    {
      std::array<Index, 3> ids{};
      for (std::size_t i = cut.first[piece]; i < cut.first[piece + 1]; ++i)
      {
        pollNowAndThen(i);
        source.corners(cut.order[i], cut.order[i] + std::size_t{ 1 }, ids.data());
        for (const Index id : ids)
        {
          add(id, static_cast<std::uint16_t>(piece + 1));
        }
      }
    });
}

} // namespace quadrille
