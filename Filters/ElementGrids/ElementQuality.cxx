// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "ElementGrids/ElementQuality.h"

#include "Base/Parallel.h"
#include "Base/Refuse.h"
#include "Common/NewArray.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkMeshQuality.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkQuad.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace quadrille
{

namespace
{

constexpr double kUnbounded = 1e30; ///< what Verdict says of a measure that is infinite

using MeasureFunction = double (*)(vtkCell*);

// Functions of VTK 9.6 have a second argument with a default, so their own addresses are of another type.
constexpr std::array<MeasureFunction, kMeasureCount> kFunctions{
  [](vtkCell* cell) { return vtkMeshQuality::QuadScaledJacobian(cell); },
  [](vtkCell* cell) { return vtkMeshQuality::QuadAspectRatio(cell); },
  [](vtkCell* cell) { return vtkMeshQuality::QuadSkew(cell); },
  [](vtkCell* cell) { return vtkMeshQuality::QuadWarpage(cell); },
  [](vtkCell* cell) { return vtkMeshQuality::QuadTaper(cell); },
  [](vtkCell* cell) { return vtkMeshQuality::QuadEdgeRatio(cell); },
  [](vtkCell* cell) { return vtkMeshQuality::QuadMinAngle(cell); },
  [](vtkCell* cell) { return vtkMeshQuality::QuadMaxAngle(cell); },
};

std::string withoutSpaces(const std::string& text)
{
  std::string result;
  std::copy_if(text.begin(), text.end(), std::back_inserter(result),
    [](unsigned char c) { return std::isspace(c) == 0; });
  return result;
}

std::string measureNames()
{
  std::string names;
  for (const ElementMeasure& measure : elementMeasures())
  {
    names += (names.empty() ? "" : ", ") + std::string(measure.name);
  }
  return names;
}

[[noreturn]] void refuseRequirement(const std::string& text, const std::string& why)
{
  refuse("the requirement '", text, "' ", why,
    "; give a measure, <, <=, > or >=, and a number, as in scaled-jacobian>0.2; measures are ",
    measureNames());
}

bool isBounded(double value)
{
  return std::abs(value) < kUnbounded; // false for what is no number
}

} // namespace

const std::array<ElementMeasure, kMeasureCount>& elementMeasures()
{
  static const std::array<ElementMeasure, kMeasureCount> measures{
    ElementMeasure{ "scaled-jacobian", "ScaledJacobian", true },
    ElementMeasure{ "aspect-ratio", "AspectRatio", false }, ElementMeasure{ "skew", "Skew", false },
    ElementMeasure{ "warpage", "Warpage", true }, ElementMeasure{ "taper", "Taper", false },
    ElementMeasure{ "edge-ratio", "EdgeRatio", false },
    ElementMeasure{ "minimum-angle", "MinimumAngle", true },
    ElementMeasure{ "maximum-angle", "MaximumAngle", false }
  };
  return measures;
}

bool ElementRequirement::isKeptBy(double value) const
{
  switch (relation)
  {
    case Relation::Less:
      return value < limit;
    case Relation::LessOrEqual:
      return value <= limit;
    case Relation::Greater:
      return value > limit;
    default:
      return value >= limit;
  }
}

bool ElementRequirement::isLowBad() const
{
  return relation == Relation::Greater || relation == Relation::GreaterOrEqual;
}

ElementRequirement parseRequirement(const std::string& given)
{
  const std::string text = withoutSpaces(given);
  const std::size_t at = text.find_first_of("<>");
  if (at == std::string::npos)
  {
    refuseRequirement(given, "has no limit");
  }
  ElementRequirement requirement;
  requirement.text = text;
  const bool orEqual = text.size() > at + 1 && text[at + 1] == '=';
  requirement.relation = text[at] == '<'
    ? (orEqual ? ElementRequirement::Relation::LessOrEqual : ElementRequirement::Relation::Less)
    : (orEqual ? ElementRequirement::Relation::GreaterOrEqual
               : ElementRequirement::Relation::Greater);
  const std::string name = text.substr(0, at);
  const auto& measures = elementMeasures();
  const auto found = std::find_if(measures.begin(), measures.end(),
    [&name](const ElementMeasure& m) { return name == m.name || name == m.array; });
  if (found == measures.end())
  {
    refuseRequirement(
      given, name.empty() ? "names no measure" : "has the unknown measure '" + name + "'");
  }
  requirement.measure = static_cast<std::size_t>(found - measures.begin());
  const std::string number = text.substr(at + (orEqual ? 2 : 1));
  char* end = nullptr;
  requirement.limit = std::strtod(number.c_str(), &end);
  if (number.empty() || *end != '\0' || !std::isfinite(requirement.limit))
  {
    refuseRequirement(given, "has the limit '" + number + "', which is no number");
  }
  return requirement;
}

std::vector<double> measureElements(vtkUnstructuredGrid* grid, std::size_t measure, int threads)
{
  const MeasureFunction function = kFunctions[measure];
  std::vector<double> values(static_cast<std::size_t>(grid->GetNumberOfCells()));
  vtkCellArray* cells = grid->GetCells();
  parallelFor(values.size(), kMediumChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      vtkNew<vtkQuad> quad;
      vtkNew<vtkIdList> ids;
      for (std::size_t i = begin; i < end; ++i)
      {
        cells->GetCellAtId(static_cast<vtkIdType>(i), ids);
        bool isPlaced = true;
        for (vtkIdType k = 0; k < 4; ++k)
        {
          std::array<double, 3> p{};
          grid->GetPoints()->GetPoint(ids->GetId(k), p.data());
          quad->GetPoints()->SetPoint(k, p.data());
          isPlaced = isPlaced && std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
        }
        // What Verdict makes of a corner without a place differs from version to version.
        values[i] = isPlaced ? function(quad) : std::numeric_limits<double>::quiet_NaN();
      }
    });
  return values;
}

void addMeasure(vtkUnstructuredGrid* grid, std::size_t measure, const std::vector<double>& values)
{
  auto array = newArray<vtkDoubleArray>(elementMeasures()[measure].array, 1, values.size());
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  grid->GetCellData()->AddArray(array);
}

void addHistogram(vtkTable* table, std::size_t measure, const std::vector<double>& values, int bins)
{
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double value : values)
  {
    if (isBounded(value))
    {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  const bool isEmpty = !(low <= high);
  const double width = isEmpty ? 0 : (high - low) / bins;
  const std::string name = elementMeasures()[measure].array;
  const auto count = static_cast<std::size_t>(bins);
  auto from = newArray<vtkDoubleArray>((name + "From").c_str(), 1, count);
  auto to = newArray<vtkDoubleArray>((name + "To").c_str(), 1, count);
  auto elements = newArray<vtkIdTypeArray>((name + "Elements").c_str(), 1, count);
  for (int i = 0; i < bins; ++i)
  {
    from->SetValue(i, isEmpty ? 0 : low + i * width);
    to->SetValue(i, isEmpty ? 0 : i + 1 == bins ? high : low + (i + 1) * width);
    elements->SetValue(i, 0);
  }
  for (const double value : values)
  {
    if (isBounded(value))
    {
      const int bin = width > 0 ? static_cast<int>((value - low) / width) : 0;
      const int inRange = std::min(bin, bins - 1);
      elements->SetValue(inRange, elements->GetValue(inRange) + 1);
    }
  }
  table->AddColumn(from);
  table->AddColumn(to);
  table->AddColumn(elements);
}

std::vector<vtkIdType> worstElements(
  const std::vector<double>& values, bool isLowBad, std::size_t count)
{
  std::vector<vtkIdType> ids(values.size());
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    ids[i] = static_cast<vtkIdType>(i);
  }
  const auto badness = [&](vtkIdType id)
  {
    const double value = values[static_cast<std::size_t>(id)];
    return std::isnan(value) ? std::numeric_limits<double>::infinity() : isLowBad ? -value : value;
  };
  const auto last = ids.begin() + static_cast<std::ptrdiff_t>(std::min(count, ids.size()));
  std::partial_sort(ids.begin(), last, ids.end(),
    [&](vtkIdType a, vtkIdType b)
    {
      const double x = badness(a), y = badness(b);
      return x > y || (x == y && a < b);
    });
  ids.erase(last, ids.end());
  return ids;
}

Vector3 centreOfElement(vtkUnstructuredGrid* grid, vtkIdType element)
{
  vtkNew<vtkIdList> ids;
  grid->GetCells()->GetCellAtId(element, ids);
  Vector3 sum = Vector3::Zero();
  for (vtkIdType k = 0; k < 4; ++k)
  {
    Vector3 p;
    grid->GetPoints()->GetPoint(ids->GetId(k), p.data());
    sum += p / 4;
  }
  return sum;
}

void writeWorst(
  vtkUnstructuredGrid* grid, const std::vector<WorstElement>& worst, vtkPolyData* target)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> vertices;
  auto ids = newArray<vtkIdTypeArray>("ElementId", 1, worst.size());
  auto values = newArray<vtkDoubleArray>("Value", 1, worst.size());
  auto measures = newArray<vtkStringArray>("Measure", 1, worst.size());
  for (std::size_t i = 0; i < worst.size(); ++i)
  {
    const auto id = static_cast<vtkIdType>(i);
    points->InsertNextPoint(centreOfElement(grid, worst[i].element).data());
    vertices->InsertNextCell({ id });
    ids->SetValue(id, worst[i].element);
    values->SetValue(id, worst[i].value);
    measures->SetValue(id, elementMeasures()[worst[i].measure].array);
  }
  target->SetPoints(points);
  target->SetVerts(vertices);
  target->GetPointData()->AddArray(ids);
  target->GetPointData()->AddArray(measures);
  target->GetPointData()->AddArray(values);
  target->GetPointData()->SetActiveScalars("Value");
}

} // namespace quadrille
