// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Convert/AskedArrays.h"

#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Convert/ArrayNames.h"
#include "Convert/PolyData.h"
#include "Requests/AskedValues.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <cstddef>

namespace quadrille
{

namespace
{

/// A real array with so many components, or null where there is none of this name.
vtkDataArray* realArray(
  vtkDataSetAttributes* attributes, const char* element, const char* name, int components)
{
  vtkDataArray* array = attributes->GetArray(name);
  if (!array)
  {
    if (attributes->HasArray(name))
    {
      refuse(element, " array '", name, "' does not hold numbers");
    }
    return nullptr;
  }
  const int type = array->GetDataType();
  if (array->GetNumberOfComponents() != components || (type != VTK_FLOAT && type != VTK_DOUBLE))
  {
    refuse(element, " array '", name, "' must have ", components, " real number(s) a ", element,
      ", it has ", array->GetNumberOfComponents(), " of type ", array->GetDataTypeAsString());
  }
  return array;
}

} // namespace

//------------------------------------------------------------------------------
GuideArrays::GuideArrays(vtkPolyData* data)
  : directions_(realArray(data->GetCellData(), "cell", arrays::kGuidingDirection, 3)),
    weights_(realArray(data->GetCellData(), "cell", arrays::kGuidingWeight, 1))
{
}

//------------------------------------------------------------------------------
Vector3 GuideArrays::direction(vtkIdType cell) const
{
  Vector3 d;
  directions_->GetTuple(cell, d.data());
  requireDirection(cell, d);
  return d;
}

//------------------------------------------------------------------------------
double GuideArrays::weight(vtkIdType cell) const
{
  const double weight = weights_ ? weights_->GetTuple1(cell) : 1;
  requireGuideWeight(cell, weight);
  return weight;
}

//------------------------------------------------------------------------------
std::vector<float> pointSizes(vtkPolyData* data)
{
  std::vector<float> sizes;
  vtkDataArray* array = realArray(data->GetPointData(), "point", arrays::kSizing, 1);
  if (!array)
  {
    return sizes;
  }
  sizes.resize(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (std::size_t i = 0; i < sizes.size(); ++i)
  {
    pollNowAndThen(i);
    const auto point = static_cast<vtkIdType>(i);
    sizes[i] = requireSize(point, array->GetTuple1(point));
  }
  return sizes;
}

//------------------------------------------------------------------------------
std::vector<int> readPointValences(vtkPolyData* data)
{
  std::vector<int> valences;
  vtkDataArray* array = data->GetPointData()->GetArray(arrays::kTargetValence);
  if (!array)
  {
    if (data->GetPointData()->HasArray(arrays::kTargetValence))
    {
      refuse("point array '", arrays::kTargetValence, "' does not hold numbers");
    }
    return valences;
  }
  if (array->GetNumberOfComponents() != 1)
  {
    refuse("point array '", arrays::kTargetValence, "' must have one whole number a point");
  }
  requireWhole(array, "point");
  valences.resize(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (std::size_t i = 0; i < valences.size(); ++i)
  {
    const auto point = static_cast<vtkIdType>(i);
    const double valence = array->GetTuple1(point);
    Vector3 place; // of its own: another thread may read the points, too
    data->GetPoint(point, place.data());
    requireValence(point, place, valence);
    valences[i] = static_cast<int>(valence);
  }
  return valences;
}

} // namespace quadrille
