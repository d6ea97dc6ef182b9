// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Carries point and cell arrays from a surface to what was made from it.
///
/// All arrays are carried, also those without a name, but Quadrille's own, which would be wrong on the result. They
/// stay active scalars, vectors, normals, texture coordinates or tensors; ids stay plain arrays, as they are no
/// longer unique. Vectors and tensors are not rotated. Arrays go one by one, each in parallel; the result does not
/// depend on the number of threads. All functions return what could not be carried, as text: arrays with fewer tuples
/// than the source has points or cells.
#pragma once

#include <vtkType.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

class vtkDataSetAttributes;

namespace quadrille
{

/// A point of the result as a barycentric combination of three points of the source.
struct PointOrigin
{
  std::array<vtkIdType, 3> ids{};
  std::array<double, 3> weights{}; ///< sum 1
};

/// A cell of the result as parts of cells of the source.
struct CellOrigins
{
  struct Share
  {
    vtkIdType cell = 0;
    double weight = 0; ///< the sum of a cell's is 1
  };
  std::vector<std::size_t> first; ///< #cells + 1 offsets into shares
  std::vector<Share> shares;      ///< per cell; the one under its centre comes first
};

/// Real numbers and colours (three or four unsigned char) are interpolated; whole numbers (ids, labels), bits and
/// strings come from the point with the largest weight, the first of several. The active normals keep unit length;
/// where they cancel out, that of the point with the largest weight is taken. A point with weight 0 has no influence.
std::vector<std::string> carryPointArrays(vtkDataSetAttributes* source, vtkIdType sourcePoints,
  vtkDataSetAttributes* target, const std::vector<PointOrigin>& origins, int threads);

/// Everything comes from cell origins[i].
std::vector<std::string> carryCellArrays(vtkDataSetAttributes* source, vtkIdType sourceCells,
  vtkDataSetAttributes* target, const std::vector<vtkIdType>& origins, int threads);

/// Real numbers and colours are averaged over the shares (active normals keep unit length); of whole numbers, bits and
/// strings that tuple is taken that has the largest part, of several within rounding that under the centre if it is
/// one of them, else the one of the lowest cell.
std::vector<std::string> carryCellArrays(vtkDataSetAttributes* source, vtkIdType sourceCells,
  vtkDataSetAttributes* target, const CellOrigins& origins, int threads);

} // namespace quadrille
