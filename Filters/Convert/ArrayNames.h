// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Arrays by which a user asks for something, and those that were probably meant to be one of them.
#pragma once

#include <string>
#include <vector>

class vtkDataArray;
class vtkPolyData;

namespace quadrille
{

enum class ArrayPlace
{
  Points,
  Cells
};

/// An array that is read where it is there.
struct ReadArray
{
  std::string name;
  ArrayPlace place = ArrayPlace::Points;
  int components = 1;
};

/// What the surface, lines of curves and strokes, and points with valences are asked for. patchArray: the property's
/// value.
std::vector<ReadArray> surfaceArrays(const std::string& patchArray);
std::vector<ReadArray> lineArrays();
std::vector<ReadArray> pointArrays();

/// What to do about arrays that are not read although they look as if they should be: of the right name on the other
/// kind of element, with another number of components, or of a name that differs in case, underscores, a plural or up
/// to two letters.
/// input: what the data is called in the sentence.
std::vector<std::string> arrayNotices(
  vtkPolyData* data, const std::string& input, const std::vector<ReadArray>& read);

/// What to do about arrays that are read, but say nothing without another one: GuidingWeight of the surface without
/// GuidingDirection, GuidingWeight of curves of which none is a stroke, a ConstraintType of strokes that is not theirs.
/// Null: there is no such input.
std::vector<std::string> partnerNotices(
  vtkPolyData* surface, vtkPolyData* curves, vtkPolyData* strokes);

/// Whether all values are whole; a Calculator makes doubles. Throws InvalidInput, naming array and value, where one is
/// not.
void requireWhole(vtkDataArray* array, const char* element);

} // namespace quadrille
