// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleReport.h"

#include <vtkDataObject.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkStringArray.h>

#include <cstdio>
#include <functional>
#include <sstream>

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

template <class Value>
std::vector<Value> column(
  const std::vector<StageRecord>& stages, const std::function<Value(const StageRecord&)>& of)
{
  std::vector<Value> values;
  for (const StageRecord& stage : stages)
  {
    values.push_back(of(stage));
  }
  return values;
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

std::vector<std::pair<std::string, std::size_t>> repairCounts(const RepairReport& r)
{
  return { { "triangulated_polygons", r.triangulatedPolygons }, { "merged_points", r.mergedPoints },
    { "degenerate_faces", r.degenerateFaces }, { "duplicate_faces", r.duplicateFaces },
    { "isolated_points", r.isolatedPoints }, { "non_manifold_edges", r.nonManifoldEdges },
    { "non_manifold_vertices", r.nonManifoldVertices }, { "reoriented_faces", r.reorientedFaces },
    { "removed_components", r.removedComponents }, { "refined_faces", r.refinedFaces },
    { "closed_handles", r.closedHandles }, { "filled_holes", r.filledHoles } };
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

void addStages(vtkDataObject* data, const std::vector<StageRecord>& stages)
{
  addText(
    data, "StageNames", column<std::string>(stages, [](const StageRecord& s) { return s.stage; }));
  addNumbers(
    data, "StageSeconds", column<double>(stages, [](const StageRecord& s) { return s.seconds; }));
  addCounts(data, "StageElementsIn",
    column<std::size_t>(stages, [](const StageRecord& s) { return s.elementsIn; }));
  addCounts(data, "StageElementsOut",
    column<std::size_t>(stages, [](const StageRecord& s) { return s.elementsOut; }));
}

void addCertificate(vtkDataObject* data, const Certificate& c)
{
  addText(data, "Certificate", { c.text() });
  addCount(data, "CertificateValid", c.valid() ? 1 : 0);
  addText(data, "CertificateNames",
    { "triangles", "not_positive", "wrong_turns", "seam_residuals", "off_axes", "off_isolines",
      "off_integers", "fractional_transitions", "minimum_determinant", "area" });
  addNumbers(data, "CertificateValues",
    { static_cast<double>(c.triangles), static_cast<double>(c.notPositive),
      static_cast<double>(c.wrongTurns), static_cast<double>(c.seamResiduals),
      static_cast<double>(c.offAxes), static_cast<double>(c.offIsolines),
      static_cast<double>(c.offIntegers), static_cast<double>(c.fractionalTransitions),
      c.minimumDeterminant, c.area });
}

void addSmallParts(vtkDataObject* data, const SmallParts& parts, double edgeLength)
{
  const auto coordinates = [](const Vector3& p) { return std::vector{ p.x(), p.y(), p.z() }; };
  addCount(data, "Handles", parts.handles);
  addCount(data, "UnresolvedHandles", parts.unresolvedHandles);
  addNumber(data, "ShortestLoopOverEdgeLength", parts.shortestLoop / edgeLength);
  addNumbers(data, "ShortestLoopPlace", coordinates(parts.place));
  addNumber(data, "ShortestBoundaryOverEdgeLength", parts.boundary.shortest / edgeLength);
  addNumbers(data, "ShortestBoundaryPlace", coordinates(parts.boundary.place));
}

void addAnisotropy(vtkDataObject* data, double limit, double beyond)
{
  if (limit > 0)
  {
    addNumber(data, "AnisotropyLimit", limit);
    addNumber(data, "BeyondAnisotropyLimit", beyond);
  }
}

void addFinalQuality(vtkDataObject* data, const FinalQualityReport& report)
{
  if (report.level == FinalQuality::Coarse)
  {
    return;
  }
  const auto values = [](const MapDistortion& d)
  {
    return std::vector{ d.mean, d.median, d.p90, d.p99, d.angle, d.size,
      static_cast<double>(d.left) };
  };
  addText(data, "DistortionNames", { "mean", "median", "p90", "p99", "angle", "size", "left" });
  addNumbers(data, "DistortionBefore", values(report.before));
  addNumbers(data, "DistortionAfter", values(report.after));
  addCount(data, "OptimizationSteps", static_cast<std::size_t>(report.steps));
}

namespace
{

void addNamedCounts(vtkDataObject* data, const char* namesArray, const char* countsArray,
  const std::vector<std::pair<std::string, std::size_t>>& namedCounts)
{
  std::vector<std::string> names;
  std::vector<std::size_t> counts;
  for (const auto& [name, count] : namedCounts)
  {
    names.push_back(name);
    counts.push_back(count);
  }
  addText(data, namesArray, names);
  addCounts(data, countsArray, counts);
}

} // namespace

void addRepair(vtkDataObject* data, const RepairReport& repair)
{
  addNamedCounts(data, "RepairNames", "RepairCounts", repairCounts(repair));
}

void addExtraction(vtkDataObject* data, const ExtractionCounts& counts)
{
  addNamedCounts(data, "ExtractionNames", "ExtractionCounts", namedCounts(counts));
}

void addMethod(vtkDataObject* data, MapMethod method)
{
  addText(data, "Method", { nameOf(method) });
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
