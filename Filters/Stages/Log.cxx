// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Stages/Log.h"

#include "Base/Error.h"
#include "Common/Report.h"

#include <vtkDataObject.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cstdio>

namespace quadrille
{

namespace
{

constexpr const char* kLog = "DecimationLog";
constexpr const char* kHash = "SurfaceHash";
constexpr const char* kFeatureAngle = "RecipeFeatureAngle";
constexpr const char* kFeatureCriterion = "RecipeFeatureCriterion";
constexpr const char* kEdgeLength = "RecipeEdgeLength";
constexpr const char* kPatchArray = "RecipePatchArray";
constexpr const char* kCurveMarks = "RecipeCurveMarks";

template <class Array>
Array* require(vtkDataObject* data, const char* name)
{
  auto* array = Array::SafeDownCast(data->GetFieldData()->GetAbstractArray(name));
  if (!array)
  {
    throw InvalidInput(std::string("the log input has no field array '") + name +
      "'; connect the log port of vtkDecimationHierarchy");
  }
  return array;
}

} // namespace

void writeLog(const DecimationLog& log, const SurfaceRecipe& recipe, vtkDataObject* data)
{
  const std::vector<std::uint8_t> bytes = log.serialize();
  vtkNew<vtkUnsignedCharArray> array;
  array->SetName(kLog);
  array->SetNumberOfValues(static_cast<vtkIdType>(bytes.size()));
  std::copy(bytes.begin(), bytes.end(), array->GetPointer(0));
  data->GetFieldData()->AddArray(array);
  char hash[20];
  std::snprintf(hash, sizeof(hash), "%016llx", static_cast<unsigned long long>(log.fineHash));
  addText(data, kHash, { hash });
  // Negative: no feature detection.
  addNumber(data, kFeatureAngle, recipe.featureAngle.value_or(-1));
  addNumber(data, kFeatureCriterion, static_cast<double>(recipe.featureCriterion));
  addNumber(data, kEdgeLength, recipe.edgeLength);
  addText(data, kPatchArray, { recipe.patchArray });
  vtkNew<vtkIdTypeArray> marks;
  marks->SetName(kCurveMarks);
  marks->SetNumberOfComponents(2);
  for (const FeatureMark& mark : recipe.curveMarks)
  {
    const vtkIdType tuple[2] = { mark.polygon, mark.bits };
    marks->InsertNextTypedTuple(tuple);
  }
  data->GetFieldData()->AddArray(marks);
}

SurfaceRecipe readRecipe(vtkDataObject* data)
{
  SurfaceRecipe recipe;
  const double angle = require<vtkDataArray>(data, kFeatureAngle)->GetTuple1(0);
  if (angle > 0)
  {
    recipe.featureAngle = angle;
  }
  // Logs of earlier versions have none: there was the angle only.
  auto* criterion =
    vtkDataArray::SafeDownCast(data->GetFieldData()->GetAbstractArray(kFeatureCriterion));
  recipe.featureCriterion =
    criterion && criterion->GetTuple1(0) == 0 ? FeatureCriterion::Creases : FeatureCriterion::Angle;
  recipe.edgeLength = require<vtkDataArray>(data, kEdgeLength)->GetTuple1(0);
  recipe.patchArray = require<vtkStringArray>(data, kPatchArray)->GetValue(0);
  // An array without tuples does not survive every file format, and says the same as none.
  auto* marks = vtkDataArray::SafeDownCast(data->GetFieldData()->GetAbstractArray(kCurveMarks));
  for (vtkIdType i = 0; marks && i < marks->GetNumberOfTuples(); ++i)
  {
    recipe.curveMarks.push_back({ static_cast<Index>(marks->GetComponent(i, 0)),
      static_cast<std::uint8_t>(marks->GetComponent(i, 1)) });
  }
  return recipe;
}

DecimationLog readLog(vtkDataObject* data, std::uint64_t expectedHash)
{
  auto* array = require<vtkUnsignedCharArray>(data, kLog);
  const std::uint8_t* begin = array->GetPointer(0);
  return DecimationLog::deserialize(
    std::vector<std::uint8_t>(begin, begin + array->GetNumberOfValues()), expectedHash);
}

} // namespace quadrille
