// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// One surface from its pieces, in an order that does not depend on how it was cut.
///
/// Readers, sources and filters cut a surface into pieces with points of their own along the cuts: those at the same
/// place become one point, after coordinates were rounded to about the last bit of a single number of the size of the
/// surface (2^-31 of it where numbers are double), as each piece may have computed its own. Points are then in the
/// order of their coordinates and faces in that of their points, so that any way to cut a surface gives the same one
/// again, to the bit. A face that several pieces have is taken once. Faces of volume cells in which two pieces meet,
/// one from each side, are inside of the volume and left out.
#pragma once

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

class vtkDataSetAttributes;
class vtkPolyData;

namespace quadrille
{

/// Cell array of a piece (unsigned char): 1 on faces of volume cells. It does not outlast joinPieces.
constexpr const char* kVolumeFace = "QuadrilleVolumeFace";

/// Polygons and strips (as triangles) of the pieces; vertices and lines are left behind. All arrays come along: where a
/// piece lacks one that others have, 0 stands for it (1 for Sizing and GuidingWeight), and arrays that differ in their
/// type or components are left behind; notices tell both.
vtkSmartPointer<vtkPolyData> joinPieces(
  const std::vector<vtkSmartPointer<vtkPolyData>>& pieces, std::vector<std::string>& notices);

/// The piece itself, or a copy that lacks kVolumeFace where it has that.
vtkSmartPointer<vtkPolyData> withoutMarks(vtkPolyData* piece);

/// Whether a coordinate needs double precision; filters upstream may have changed the type of the numbers, not what
/// they are.
bool needsDouble(vtkPolyData* piece);

/// What coordinates are rounded to multiples of, see above, for a surface with this diagonal of the box around it. 0:
/// no rounding.
double unitOfPlaces(double diagonal, bool inDouble);

/// A point's coordinates rounded, as numbers that are the same where these are, and in their order.
std::array<std::uint64_t, 3> placeKey(vtkPolyData* piece, vtkIdType point, double unit);

/// A tuple of the arrays of one of several sources.
struct TupleOrigin
{
  std::size_t source = 0;
  vtkIdType tuple = 0;
};

/// The arrays of all sources, a tuple for each origin; see joinPieces for arrays that differ.
void gatherArrays(const std::vector<vtkDataSetAttributes*>& sources,
  const std::vector<TupleOrigin>& origins, vtkDataSetAttributes* target,
  std::vector<std::string>& notices);

} // namespace quadrille
