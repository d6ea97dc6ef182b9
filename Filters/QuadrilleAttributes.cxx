// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleAttributes.h"

#include "QuadrilleConvert.h"

#include <vtkAbstractArray.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkIdList.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <string>
#include <vector>

namespace quadrille
{

namespace
{

/// Arrays that describe the source itself and would be wrong on anything made from it.
bool isOwn(const std::string& name)
{
  static const std::array<const char*, 16> own = { arrays::kFeatureEdges, arrays::kIgm,
    arrays::kMatching, arrays::kDeterminant, arrays::kTwin, arrays::kFineFace, arrays::kFineVertex,
    arrays::kTurns, arrays::kIndex, arrays::kIntegerVertex, arrays::kSurfacePointId,
    arrays::kTextureCoordinates, arrays::kSourcePointIds, arrays::kSourceWeights,
    arrays::kSourceBarycentric, arrays::kValence };
  return std::any_of(own.begin(), own.end(), [&name](const char* n) { return name == n; });
}

bool isColour(vtkAbstractArray* array)
{
  return array->GetDataType() == VTK_UNSIGNED_CHAR &&
    (array->GetNumberOfComponents() == 3 || array->GetNumberOfComponents() == 4);
}

bool isInterpolated(vtkAbstractArray* array)
{
  const int type = array->GetDataType();
  return type == VTK_FLOAT || type == VTK_DOUBLE || isColour(array);
}

vtkSmartPointer<vtkAbstractArray> newLike(vtkAbstractArray* array, vtkIdType count)
{
  auto result = vtk::TakeSmartPointer(vtkAbstractArray::CreateArray(array->GetDataType()));
  result->SetName(array->GetName());
  result->SetNumberOfComponents(array->GetNumberOfComponents());
  result->CopyComponentNames(array);
  result->SetNumberOfTuples(count);
  return result;
}

int largest(const std::array<double, 3>& weights)
{
  return static_cast<int>(std::max_element(weights.begin(), weights.end()) - weights.begin());
}

void normalize(vtkDataArray* normals)
{
  for (vtkIdType i = 0; i < normals->GetNumberOfTuples(); ++i)
  {
    double n[3];
    normals->GetTuple(i, n);
    if (vtkMath::Normalize(n) > 0)
    {
      normals->SetTuple(i, n);
    }
  }
}

/// Makes the same arrays active as on the source; ids stay plain arrays, as they are no longer unique.
void copyActive(vtkDataSetAttributes* source, vtkDataSetAttributes* target)
{
  for (const int type :
    { vtkDataSetAttributes::SCALARS, vtkDataSetAttributes::VECTORS, vtkDataSetAttributes::NORMALS,
      vtkDataSetAttributes::TCOORDS, vtkDataSetAttributes::TENSORS })
  {
    vtkAbstractArray* active = source->GetAbstractAttribute(type);
    if (active && active->GetName() && target->GetAbstractArray(active->GetName()))
    {
      target->SetActiveAttribute(active->GetName(), type);
    }
  }
}

template <class Fill>
void carry(vtkDataSetAttributes* source, vtkDataSetAttributes* target, vtkIdType count, Fill fill)
{
  for (int i = 0; i < source->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = source->GetAbstractArray(i);
    if (!array->GetName() || isOwn(array->GetName()))
    {
      continue;
    }
    vtkSmartPointer<vtkAbstractArray> result = newLike(array, count);
    fill(array, result.Get());
    target->AddArray(result);
  }
  copyActive(source, target);
}

} // namespace

void carryPointArrays(vtkDataSetAttributes* source, vtkDataSetAttributes* target, vtkIdType count,
  const std::function<PointOrigin(vtkIdType)>& origin)
{
  vtkNew<vtkIdList> ids;
  ids->SetNumberOfIds(3);
  carry(source, target, count,
    [&](vtkAbstractArray* from, vtkAbstractArray* to)
    {
      const bool interpolated = isInterpolated(from);
      for (vtkIdType i = 0; i < count; ++i)
      {
        PointOrigin o = origin(i);
        if (interpolated)
        {
          std::copy(o.ids.begin(), o.ids.end(), ids->GetPointer(0));
          to->InterpolateTuple(i, ids, from, o.weights.data());
        }
        else
        {
          to->SetTuple(i, o.ids[largest(o.weights)], from);
        }
      }
      if (from == source->GetAbstractAttribute(vtkDataSetAttributes::NORMALS) && interpolated)
      {
        normalize(vtkDataArray::SafeDownCast(to));
      }
    });
}

void carryCellArrays(vtkDataSetAttributes* source, vtkDataSetAttributes* target, vtkIdType count,
  const std::function<vtkIdType(vtkIdType)>& origin)
{
  carry(source, target, count,
    [&](vtkAbstractArray* from, vtkAbstractArray* to)
    {
      for (vtkIdType i = 0; i < count; ++i)
      {
        to->SetTuple(i, origin(i), from);
      }
    });
}

} // namespace quadrille
