// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Common/Report.h"

#include <vtkDataObject.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkStringArray.h>

#include <cstdio>
#include <sstream>
#include <variant>

namespace quadrille
{

namespace
{

void addArray(vtkDataObject* data, vtkAbstractArray* array)
{
  data->GetFieldData()->RemoveArray(array->GetName());
  data->GetFieldData()->AddArray(array);
}

void addCounts(vtkDataObject* data, const char* name, const std::vector<std::size_t>& values)
{
  vtkNew<vtkIdTypeArray> array;
  array->SetName(name);
  for (const std::size_t value : values)
  {
    array->InsertNextValue(static_cast<vtkIdType>(value));
  }
  addArray(data, array);
}

void addNumbers(vtkDataObject* data, const char* name, const std::vector<double>& values)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  for (const double value : values)
  {
    array->InsertNextValue(value);
  }
  addArray(data, array);
}

} // namespace

void requireOk(const Status& status, const std::string& stage)
{
  if (!status.ok())
  {
    throw StageFailure(status.code, status.message.empty() ? stage + " failed" : status.message);
  }
}

std::string stageTimesText(const std::vector<StageRecord>& stages)
{
  std::string text;
  double sum = 0;
  char line[160];
  for (const StageRecord& stage : stages)
  {
    std::snprintf(line, sizeof(line), "%s: %.3f s, %zu -> %zu\n", stage.stage.c_str(),
      stage.seconds, stage.elementsIn, stage.elementsOut);
    text += line;
    sum += stage.seconds;
  }
  std::snprintf(line, sizeof(line), "sum: %.3f s", sum);
  return text + line;
}

std::string wrapLines(const std::string& text, std::size_t width)
{
  std::string wrapped;
  for (const std::string& line : splitLines(text))
  {
    std::istringstream words(line);
    std::size_t used = 0;
    wrapped += wrapped.empty() ? "" : "\n";
    for (std::string word; words >> word;)
    {
      if (used > 0 && used + 1 + word.size() > width)
      {
        wrapped += "\n  ";
        used = 2;
      }
      else if (used > 0)
      {
        wrapped += " ";
        ++used;
      }
      wrapped += word;
      used += word.size();
    }
  }
  return wrapped;
}

std::vector<std::string> splitLines(const std::string& text)
{
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
  {
    if (!line.empty())
    {
      lines.push_back(line);
    }
  }
  return lines;
}

void addText(vtkDataObject* data, const char* name, const std::vector<std::string>& lines)
{
  vtkNew<vtkStringArray> array;
  array->SetName(name);
  for (const std::string& line : lines)
  {
    array->InsertNextValue(line);
  }
  addArray(data, array);
}

void addNumber(vtkDataObject* data, const char* name, double value)
{
  addNumbers(data, name, { value });
}

void addCount(vtkDataObject* data, const char* name, std::size_t value)
{
  addCounts(data, name, { value });
}

void addFields(vtkDataObject* data, const RunFields& fields)
{
  for (const RunField& field : fields)
  {
    const char* name = field.name.c_str();
    if (const auto* texts = std::get_if<std::vector<std::string>>(&field.values))
    {
      addText(data, name, *texts);
    }
    else if (const auto* counts = std::get_if<std::vector<std::size_t>>(&field.values))
    {
      addCounts(data, name, *counts);
    }
    else
    {
      addNumbers(data, name, std::get<std::vector<double>>(field.values));
    }
  }
}

MapMethod readMethod(vtkDataObject* data)
{
  auto* array = vtkStringArray::SafeDownCast(data->GetFieldData()->GetAbstractArray("Method"));
  for (const MapMethod method :
    { MapMethod::MixedInteger, MapMethod::QuadCover, MapMethod::Seamless })
  {
    if (array && array->GetNumberOfValues() > 0 && array->GetValue(0) == nameOf(method))
    {
      return method;
    }
  }
  return MapMethod::ScaleAware;
}

} // namespace quadrille
