// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Stages/MapMeasures.h"

#include "Base/Angles.h"
#include "Base/Refuse.h"
#include "Common/NewArray.h"
#include "Common/Report.h"
#include "Convert/ArrayNames.h"
#include "Convert/PolyData.h"
#include "Evaluation/SingularityDistance.h"
#include "Stages/MappedInput.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

#include <cmath>

namespace quadrille
{
namespace
{

/// With which the map has as many quads as squares of this size cover the surface.
double naturalEdgeLength(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  double area = 0, mapped = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    area += mesh.edgeVector(3 * f).cross(mesh.edgeVector(3 * f + 1)).norm() / 2;
    const Vector2 a = toDouble(uv[3 * f + 1] - uv[3 * f]);
    const Vector2 b = toDouble(uv[3 * f + 2] - uv[3 * f]);
    mapped += std::abs(a.x() * b.y() - a.y() * b.x()) / 2;
  }
  if (!(area > 0 && mapped > 0))
  {
    refuse("the surface, or its map, has no area");
  }
  return std::sqrt(area / mapped);
}

double targetEdgeLength(vtkPolyData* data)
{
  vtkDataArray* array = data->GetFieldData()->GetArray("TargetEdgeLength");
  return array && array->GetNumberOfTuples() == 1 ? array->GetTuple1(0) : 0;
}

} // namespace

MeasuredMap measureMap(vtkPolyData* data, double edgeLength, double textureScale, int threads)
{
  MeasuredMap result;
  std::vector<FixedVec2> uv;
  if (readMethod(data) == MapMethod::Seamless && data->GetCellData()->HasArray(arrays::kIgm))
  {
    result.mesh = readMesh(data, threads); // there is nothing whole in it to be checked
    uv = readMap(data, threads);
  }
  else
  {
    MappedInput input = readMappedInput(data, textureScale, threads);
    result.notice = input.notice();
    result.mesh = std::move(input.mesh);
    uv = std::move(input.map.uv);
  }
  result.edgeLength = edgeLength > 0 ? edgeLength : targetEdgeLength(data);
  if (!(result.edgeLength > 0))
  {
    result.edgeLength = naturalEdgeLength(result.mesh, uv);
  }
  result.quality = measureMapQuality(result.mesh, uv, result.edgeLength);
  result.turns = turnsOfMap(result.mesh, uv);
  result.valences = singularityHistogram(result.mesh, result.turns);
  return result;
}

std::size_t irregularCount(const MeasuredMap& map)
{
  std::size_t sum = 0;
  for (const auto& [turns, count] : map.valences)
  {
    sum += count;
  }
  return sum;
}

std::vector<MeasureColumn> measureColumns(const MapQuality& quality)
{
  return { { "Sizing", quality.sizing, sizingBins(), 1 },
    { "Anisotropy", quality.anisotropy, anisotropyBins(), 1 },
    { "Shear", quality.shear, shearBins(), 180 / kPi } };
}

std::vector<double> binCentres(const MeasureColumn& column)
{
  const bool byRatio = std::string(column.name) == "Sizing";
  std::vector<double> centres;
  for (std::size_t i = 0; i + 1 < column.edges.size(); ++i)
  {
    const double a = column.edges[i], b = column.edges[i + 1];
    centres.push_back(column.unit * (byRatio ? std::sqrt(a * b) : (a + b) / 2));
  }
  return centres;
}

std::vector<double> percentInBins(const MeasureColumn& column)
{
  std::vector<double> shares = column.distribution.histogram(column.edges);
  for (double& share : shares)
  {
    share *= 100;
  }
  return shares;
}

void addTextColumn(vtkTable* table, const char* name, const std::vector<std::string>& values)
{
  auto array = newArray<vtkStringArray>(name);
  for (const std::string& value : values)
  {
    array->InsertNextValue(value);
  }
  table->AddColumn(array);
}

void addNumberColumn(vtkTable* table, const char* name, const std::vector<double>& values)
{
  auto array = newArray<vtkDoubleArray>(name, 1, values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    array->SetValue(static_cast<vtkIdType>(i), values[i]);
  }
  table->AddColumn(array);
}

} // namespace quadrille
