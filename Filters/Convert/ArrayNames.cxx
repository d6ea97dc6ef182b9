// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Convert/ArrayNames.h"

#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Convert/PolyData.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>

namespace quadrille
{

namespace
{

/// Names that differ by more letters than this are different names.
constexpr std::size_t kMostTypos = 2;
/// In short names two letters are half of the word.
constexpr std::size_t kShortName = 6;

/// Without what people write in different ways: case, underscores, blanks, dashes.
std::string plainName(const std::string& name)
{
  std::string plain;
  for (const char c : name)
  {
    if (std::isalnum(static_cast<unsigned char>(c)))
    {
      plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return plain;
}

/// Letters to insert, leave out or replace to come from one to the other.
std::size_t editDistance(const std::string& a, const std::string& b)
{
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{ 0 });
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j)
    {
      const std::size_t replaced = diagonal + (a[i] != b[j] ? 1 : 0);
      diagonal = row[j + 1];
      row[j + 1] = std::min({ replaced, row[j] + 1, row[j + 1] + 1 });
    }
  }
  return row.back();
}

bool isNearly(const std::string& name, const std::string& wanted)
{
  const std::string a = plainName(name);
  const std::string b = plainName(wanted);
  const std::size_t allowed = b.size() <= kShortName ? 1 : kMostTypos;
  return name != wanted && editDistance(a, b) <= allowed;
}

vtkDataSetAttributes* attributesOf(vtkPolyData* data, ArrayPlace place)
{
  return place == ArrayPlace::Points ? static_cast<vtkDataSetAttributes*>(data->GetPointData())
                                     : data->GetCellData();
}

const char* nameOf(ArrayPlace place)
{
  return place == ArrayPlace::Points ? "points" : "cells";
}

ArrayPlace other(ArrayPlace place)
{
  return place == ArrayPlace::Points ? ArrayPlace::Cells : ArrayPlace::Points;
}

/// How ParaView brings an array from one kind of element to the other.
const char* converter(ArrayPlace wanted)
{
  return wanted == ArrayPlace::Points ? "Cell Data To Point Data" : "Point Data To Cell Data";
}

void tellWrongPlace(vtkPolyData* data, const std::string& input, const ReadArray& wanted,
  std::vector<std::string>& notices)
{
  if (!attributesOf(data, wanted.place)->HasArray(wanted.name.c_str()) &&
    attributesOf(data, other(wanted.place))->HasArray(wanted.name.c_str()))
  {
    notices.push_back("array '" + wanted.name + "' of " + input + " is on " +
      nameOf(other(wanted.place)) + " and is not used: it is read on " + nameOf(wanted.place) +
      ". Make it there (in Calculator: Attribute Type), or apply " + converter(wanted.place));
  }
}

void tellNearlyRight(vtkPolyData* data, const std::string& input, const ReadArray& wanted,
  const std::vector<ReadArray>& read, std::vector<std::string>& notices)
{
  const auto isRead = [&read](const std::string& name)
  {
    return std::any_of(
      read.begin(), read.end(), [&name](const ReadArray& array) { return array.name == name; });
  };
  if (attributesOf(data, wanted.place)->HasArray(wanted.name.c_str()))
  {
    return; // the one that was meant is there
  }
  for (const ArrayPlace place : { ArrayPlace::Points, ArrayPlace::Cells })
  {
    vtkDataSetAttributes* attributes = attributesOf(data, place);
    for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
    {
      const char* name = attributes->GetArrayName(i);
      if (name && !isRead(name) && isNearly(name, wanted.name))
      {
        notices.push_back(std::string("array '") + name + "' of " + input + " is not used: if '" +
          wanted.name + "' is meant, give it this name, on " + nameOf(wanted.place) +
          " (in Calculator: Result Array Name)");
      }
    }
  }
}

void tellWrongComponents(vtkPolyData* data, const std::string& input, const ReadArray& wanted)
{
  vtkAbstractArray* array = attributesOf(data, wanted.place)->GetAbstractArray(wanted.name.c_str());
  if (!array)
  {
    return;
  }
  if (!vtkDataArray::SafeDownCast(array))
  {
    refuse("array '", wanted.name, "' of ", input, " does not hold numbers");
  }
  if (array->GetNumberOfComponents() != wanted.components)
  {
    refuse("array '", wanted.name, "' of ", input, " has ", array->GetNumberOfComponents(),
      " numbers for each of the ", nameOf(wanted.place), ", but ", wanted.components,
      wanted.components == 1 ? " is" : " are",
      " read: make it anew, in Calculator with a result of that many components, or rename it if "
      "it means something else");
  }
}

/// Null where there is no such input or array.
vtkDataArray* cellArray(vtkPolyData* data, const char* name)
{
  return data && data->GetNumberOfCells() > 0 ? data->GetCellData()->GetArray(name) : nullptr;
}

template <class Condition>
bool anyValue(vtkDataArray* array, const Condition& holds)
{
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    if (holds(array->GetComponent(i, 0)))
    {
      return true;
    }
  }
  return false;
}

} // namespace

std::vector<ReadArray> surfaceArrays(const std::string& patchArray)
{
  std::vector<ReadArray> read{ { arrays::kFeatureEdges, ArrayPlace::Cells, 1 },
    { arrays::kKnownCurvature, ArrayPlace::Cells, 6 },
    { arrays::kGuidingDirection, ArrayPlace::Cells, 3 },
    { arrays::kGuidingWeight, ArrayPlace::Cells, 1 },
    { arrays::kTargetValence, ArrayPlace::Points, 1 }, { arrays::kSizing, ArrayPlace::Points, 1 },
    { arrays::kConnectId, ArrayPlace::Points, 1 } };
  if (patchArray == arrays::kPatchId)
  {
    read.push_back({ patchArray, ArrayPlace::Cells, 1 });
  }
  return read;
}

std::vector<ReadArray> lineArrays()
{
  return { { arrays::kConstraintType, ArrayPlace::Cells, 1 },
    { arrays::kGuidingWeight, ArrayPlace::Cells, 1 },
    { arrays::kGuidingRadius, ArrayPlace::Cells, 1 },
    { arrays::kSizeFactor, ArrayPlace::Cells, 1 } };
}

std::vector<ReadArray> pointArrays()
{
  return { { arrays::kTargetValence, ArrayPlace::Points, 1 },
    { arrays::kConnectId, ArrayPlace::Points, 1 } };
}

std::vector<std::string> arrayNotices(
  vtkPolyData* data, const std::string& input, const std::vector<ReadArray>& read)
{
  std::vector<std::string> notices;
  for (const ReadArray& wanted : read)
  {
    tellWrongComponents(data, input, wanted);
    tellWrongPlace(data, input, wanted, notices);
    tellNearlyRight(data, input, wanted, read, notices);
  }
  return notices;
}

std::vector<std::string> partnerNotices(
  vtkPolyData* surface, vtkPolyData* curves, vtkPolyData* strokes)
{
  constexpr double stroke = 1; // of ConstraintType
  std::vector<std::string> notices;
  if (cellArray(surface, arrays::kGuidingWeight) && !cellArray(surface, arrays::kGuidingDirection))
  {
    notices.push_back(std::string("array '") + arrays::kGuidingWeight +
      "' of the surface is not used: there is no array '" + arrays::kGuidingDirection +
      "' on cells that it could weight. Add the directions, three numbers a cell (in Calculator: "
      "Attribute Type Cell Data), or use Stroke Weight for guiding strokes");
  }
  if (cellArray(curves, arrays::kGuidingWeight) &&
    !anyValue(
      cellArray(curves, arrays::kConstraintType), [](double type) { return type == stroke; }))
  {
    notices.push_back(std::string("array '") + arrays::kGuidingWeight +
      "' of the feature curves is not used: none of them is a guiding stroke. Give strokes to the "
      "input Guiding Strokes, or the cell array '" +
      arrays::kConstraintType + "' with 1 for each line that is one");
  }
  if (anyValue(
        cellArray(strokes, arrays::kConstraintType), [](double type) { return type != stroke; }))
  {
    notices.push_back(std::string("array '") + arrays::kConstraintType +
      "' of the guiding strokes is not used: all lines of this input are guiding strokes. Give "
      "lines that shall be features to the input Feature Curves");
  }
  return notices;
}

void requireWhole(vtkDataArray* array, const char* element)
{
  const int type = array->GetDataType();
  if (type != VTK_FLOAT && type != VTK_DOUBLE)
  {
    return;
  }
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    pollNowAndThen(static_cast<std::size_t>(i));
    const double value = array->GetComponent(i, 0);
    if (!(value == std::floor(value)) || std::isinf(value))
    {
      refuse("array '", array->GetName(), "' has the value ", value, " at ", element, " ", i,
        ", but only whole numbers are read: round it (in Calculator: floor)");
    }
  }
}

} // namespace quadrille
