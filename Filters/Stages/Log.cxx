// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Stages/Log.h"

#include "Base/Refuse.h"
#include "Common/Report.h"

#include <vtkDataObject.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cstdio>
#include <utility>

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
/// Of version 1.0 and before: edges of the surface that feature curves took.
constexpr const char* kCurveMarks = "RecipeCurveMarks";
/// Points of each feature curve, and of all of them one after the other.
constexpr const char* kFeatureSizes = "RecipeFeatureSizes";
constexpr const char* kFeaturePoints = "RecipeFeaturePoints";
/// A place, and its valence; or its radius, factor and order.
constexpr const char* kValencePlaces = "RecipeValencePlaces";
constexpr const char* kSizePlaces = "RecipeSizePlaces";
constexpr const char* kClearedPlaces = "RecipeClearedPlaces";

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

void addRows(
  vtkDataObject* data, const char* name, int components, const std::vector<double>& values)
{
  if (values.empty()) // an array without tuples does not survive every file format
  {
    return;
  }
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()) / components);
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  data->GetFieldData()->AddArray(array);
}

/// One row after the other; empty where there is no such array.
std::vector<double> rowsOf(vtkDataObject* data, const char* name, int components)
{
  auto* array = vtkDataArray::SafeDownCast(data->GetFieldData()->GetAbstractArray(name));
  std::vector<double> values;
  if (array && array->GetNumberOfComponents() != components)
  {
    refuse("the field array '", name, "' of the log input has ", array->GetNumberOfComponents(),
      " components, but needs ", components, ": make the levels anew");
  }
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    for (int k = 0; k < components; ++k)
    {
      values.push_back(array->GetComponent(i, k));
    }
  }
  return values;
}

void add(std::vector<double>& values, const Vector3& p)
{
  values.insert(values.end(), p.data(), p.data() + 3);
}

void writeDrawn(const DrawnRequests& drawn, vtkDataObject* data)
{
  std::vector<double> sizes, points, valences, places, cleared;
  for (const FeatureRequest& feature : drawn.features)
  {
    sizes.push_back(static_cast<double>(feature.points.size()));
    for (const Vector3& p : feature.points)
    {
      add(points, p);
    }
  }
  for (const ValencePlace& asked : drawn.valences)
  {
    add(valences, asked.place);
    valences.push_back(asked.valence);
  }
  for (const SizeRequest& size : drawn.sizes)
  {
    add(places, size.place);
    places.insert(places.end(), { size.radius, size.factor, static_cast<double>(size.order) });
  }
  for (const Vector3& place : drawn.cleared)
  {
    add(cleared, place);
  }
  addRows(data, kFeatureSizes, 1, sizes);
  addRows(data, kFeaturePoints, 3, points);
  addRows(data, kValencePlaces, 4, valences);
  addRows(data, kSizePlaces, 6, places);
  addRows(data, kClearedPlaces, 3, cleared);
}

DrawnRequests readDrawn(vtkDataObject* data)
{
  if (!rowsOf(data, kCurveMarks, 2).empty())
  {
    refuse("the log input is of an earlier version, in which feature curves took edges of the "
           "surface: make the levels anew");
  }
  DrawnRequests drawn;
  const std::vector<double> points = rowsOf(data, kFeaturePoints, 3);
  std::size_t next = 0;
  for (const double size : rowsOf(data, kFeatureSizes, 1))
  {
    FeatureRequest feature;
    for (double i = 0; i < size && next + 3 <= points.size(); ++i, next += 3)
    {
      feature.points.emplace_back(points[next], points[next + 1], points[next + 2]);
    }
    if (!(static_cast<double>(feature.points.size()) == size) || feature.points.size() < 2)
    {
      refuse("the field arrays '", kFeatureSizes, "' and '", kFeaturePoints,
        "' of the log input do not fit each other: make the levels anew");
    }
    drawn.features.push_back(std::move(feature));
  }
  const std::vector<double> valences = rowsOf(data, kValencePlaces, 4);
  for (std::size_t i = 0; i < valences.size(); i += 4)
  {
    drawn.valences.push_back(
      { { valences[i], valences[i + 1], valences[i + 2] }, static_cast<int>(valences[i + 3]) });
  }
  const std::vector<double> places = rowsOf(data, kSizePlaces, 6);
  for (std::size_t i = 0; i < places.size(); i += 6)
  {
    drawn.sizes.push_back({ { places[i], places[i + 1], places[i + 2] }, places[i + 3],
      places[i + 4], static_cast<int>(places[i + 5]) });
  }
  const std::vector<double> cleared = rowsOf(data, kClearedPlaces, 3);
  for (std::size_t i = 0; i < cleared.size(); i += 3)
  {
    drawn.cleared.emplace_back(cleared[i], cleared[i + 1], cleared[i + 2]);
  }
  return drawn;
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
  writeDrawn(recipe.drawn, data);
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
  recipe.drawn = readDrawn(data);
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
