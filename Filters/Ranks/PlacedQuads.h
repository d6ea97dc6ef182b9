// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Where the quads of a spread surface lie on its pieces, and which rank gets which of them.
#pragma once

#include "Base/Types.h"
#include "Ranks/Bytes.h"

#include <vtkPolyData.h>
#include <vtkType.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

class vtkDoubleArray;
class vtkIdTypeArray;

namespace quadrille
{

/// Items, points or quads, that lie on pieces of one rank.
struct PlacedItems
{
  std::vector<std::int64_t> id;         ///< global
  std::vector<std::uint32_t> piece;     ///< number on the rank
  std::vector<Index> triangle;          ///< of the piece's level
  std::vector<double> weights;          ///< 3 each
  std::vector<std::uint8_t> isOff;      ///< 1: its place is that which follows, beside the triangle
  std::vector<double> offPlaces;        ///< 3 each
  std::vector<std::uint32_t> userCount; ///< ranks that use it
  std::vector<std::uint32_t> users;     ///< of one after the other, ascending

  void pack(Packer& packer) const
  {
    packer.values(id);
    packer.values(piece);
    packer.values(triangle);
    packer.values(weights);
    packer.values(isOff);
    packer.values(offPlaces);
    packer.values(userCount);
    packer.values(users);
  }
  static PlacedItems unpack(Unpacker& unpacker)
  {
    PlacedItems items;
    items.id = unpacker.values<std::int64_t>();
    items.piece = unpacker.values<std::uint32_t>();
    items.triangle = unpacker.values<Index>();
    items.weights = unpacker.values<double>();
    items.isOff = unpacker.values<std::uint8_t>();
    items.offPlaces = unpacker.values<double>();
    items.userCount = unpacker.values<std::uint32_t>();
    items.users = unpacker.values<std::uint32_t>();
    return items;
  }
};

/// The quads of the filter with all that says where they are on the joined surface.
class PlacedQuads
{
public:
  PlacedQuads(vtkPolyData* quads, vtkPolyData* joined, const std::vector<Index>& firstTriangle,
    const std::vector<std::array<std::uint32_t, 2>>& rankOf);

  std::size_t pointCount() const { return static_cast<std::size_t>(quads_->GetNumberOfPoints()); }
  double quadCount() const { return static_cast<double>(quads_->GetNumberOfPolys()); }
  std::size_t cellCount() const { return first_.size() - 1; }
  const vtkIdType* corners(std::size_t quad) const { return corners_.data() + first_[quad]; }
  std::size_t size(std::size_t quad) const { return first_[quad + 1] - first_[quad]; }

  std::uint32_t rankOfQuad(std::size_t quad) const;

  void addPoint(std::size_t point, const std::vector<std::uint32_t>& users,
    std::vector<PlacedItems>& byRank) const;
  void addQuad(std::size_t quad, const std::vector<std::uint32_t>& users,
    std::vector<PlacedItems>& byRank) const;

private:
  void readCorners();
  double areaOfQuads() const;
  std::size_t pieceOf(vtkIdType triangle) const;
  std::array<vtkIdType, 3> cornersOf(vtkIdType triangle) const;
  std::array<Vector3, 3> placesOf(const std::array<vtkIdType, 3>& ids) const;
  void add(std::size_t id, vtkIdType triangle, const std::array<double, 3>& weights,
    const Vector3* offPlace, const std::vector<std::uint32_t>& users,
    std::vector<PlacedItems>& byRank) const;

  vtkPolyData* quads_;
  vtkPolyData* joined_;
  const std::vector<Index>& firstTriangle_;
  const std::vector<std::array<std::uint32_t, 2>>& rankOf_;
  vtkIdTypeArray* pointCell_;
  vtkIdTypeArray* pointIds_;
  vtkDoubleArray* pointWeights_;
  vtkIdTypeArray* cellCell_;
  std::vector<vtkIdType> corners_;
  std::vector<std::size_t> first_;
  double tolerance_ = 0;
};

/// Which quads and points each rank gets.
struct Distribution
{
  std::vector<std::uint32_t> rankOfQuad;
  std::vector<std::uint32_t> ownerOfPoint; ///< the lowest rank with a quad of its own at it
  std::vector<std::vector<std::size_t>> own, ghosts; ///< quads by rank, ascending
  std::vector<std::vector<std::size_t>> points;      ///< by rank, ascending

  Distribution(const PlacedQuads& quads, std::size_t ranks, int ghostLevels);

private:
  struct QuadsOfPoints;

  /// The points of a rank's own quads, and ring after ring those around them.
  void addRings(
    const PlacedQuads& quads, const QuadsOfPoints& around, std::size_t rank, int ghostLevels);
};

/// By item the ranks that use it, ascending.
std::vector<std::vector<std::uint32_t>> usersOf(
  const std::vector<std::vector<std::size_t>>& byRank, std::size_t items);

/// The place of a point.
Vector3 pointAt(vtkPolyData* data, vtkIdType id);

} // namespace quadrille
