// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Report.h"

#include "Common/VtkJson.h"
#include "Evaluation/QuadQuality.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVariant.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>
#include <vector>

namespace quadrille
{

namespace
{

using Json = nlohmann::ordered_json;

/// Counts that VTK holds as real numbers are written without a decimal point; what is no number is null.
Json number(double value)
{
  constexpr double kExact = 9007199254740992; // 2^53
  return value == std::floor(value) && std::abs(value) < kExact
    ? Json(static_cast<long long>(value))
    : Json(value);
}

/// Members from a field array of names and one of values beside it.
Json pairs(vtkPolyData* data, const char* namesName, const char* valuesName)
{
  auto* names = vtkStringArray::SafeDownCast(data->GetFieldData()->GetAbstractArray(namesName));
  vtkDataArray* values = data->GetFieldData()->GetArray(valuesName);
  Json json = Json::object();
  for (vtkIdType i = 0; names && values && i < names->GetNumberOfValues(); ++i)
  {
    json[names->GetValue(i)] = number(values->GetTuple1(i));
  }
  return json;
}

/// What was tried otherwise: how often, and how often that is used.
Json triesOf(vtkPolyData* quads)
{
  Json tries = Json::object();
  const Json taken = pairs(quads, "TryNames", "TriesTaken");
  const Json led = pairs(quads, "TryNames", "TriesLed");
  for (const auto& [name, times] : taken.items())
  {
    tries[name] = { { "taken", times }, { "led", led[name] } };
  }
  return tries;
}

QuadQuality measureQuads(vtkPolyData* data)
{
  std::vector<Vector3> points(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    data->GetPoint(static_cast<vtkIdType>(i), points[i].data());
  }
  std::vector<std::array<Index, 4>> quads;
  auto cells = vtk::TakeSmartPointer(data->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCurrentCell(count, ids);
    quads.push_back({ static_cast<Index>(ids[0]), static_cast<Index>(ids[1]),
      static_cast<Index>(ids[2]), static_cast<Index>(ids[3]) });
  }
  return evaluateQuads(points, quads);
}

Json qualityOf(vtkPolyData* quads)
{
  const QuadQuality quality = measureQuads(quads);
  Json valences = Json::object();
  for (const auto& [valence, count] : quality.interiorValences)
  {
    valences[std::to_string(valence)] = count;
  }
  return {
    { "manifold", quality.manifold },
    { "closed", quality.closed },
    { "components", quality.components },
    { "boundary_loops", quality.boundaryLoops },
    { "euler_characteristic", quality.eulerCharacteristic },
    { "mean_scaled_jacobian", number(quality.scaledJacobian.mean) },
    { "minimum_scaled_jacobian", number(quality.scaledJacobian.minimum) },
    { "quads_not_positive", quality.nonPositiveJacobians },
    { "mean_edge_length", number(quality.edgeLength.mean) },
    { "edge_length_deviation", number(quality.edgeLength.deviation) },
    { "irregular_vertices", quality.irregularVertices },
    { "interior_valences", valences },
  };
}

Json linesOf(const std::string& text)
{
  Json lines = Json::array();
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
  {
    lines.push_back(line);
  }
  return lines;
}

Json stagesOf(RemeshRun& run, double readSeconds)
{
  const long long cells = vtkPolyData::SafeDownCast(run.filter()->GetInput())->GetNumberOfCells();
  std::vector<StageRow> rows = run.stages();
  rows.insert(rows.begin(), { "read", readSeconds, cells, cells });
  Json stages = Json::array();
  for (const StageRow& row : rows)
  {
    stages.push_back({ { "stage", row.stage }, { "seconds", number(row.seconds) },
      { "elements_in", row.elementsIn }, { "elements_out", row.elementsOut } });
  }
  return stages;
}

void addSuccess(Json& json, vtkPolyData* quads)
{
  const auto field = [quads](const char* name) { return number(fieldNumber(quads, name)); };
  json["estimated_seconds"] = field("EstimatedSeconds");
  json["estimated_megabytes"] = field("EstimatedMegabytes");
  json["target_edge_length"] = field("TargetEdgeLength");
  json["quads_asked"] = field("TargetQuads");
  json["quads_actual"] = quads->GetNumberOfPolys();
  json["attempts"] = field("Attempts");
  json["recoveries"] = pairs(quads, "RecoveryNames", "RecoveryCounts");
  json["tries"] = triesOf(quads);
  json["repair"] = pairs(quads, "RepairNames", "RepairCounts");
  json["extraction"] = pairs(quads, "ExtractionNames", "ExtractionCounts");
  json["sizes"] = { { "surface_faces", field("SurfaceFaces") },
    { "coarse_vertices", field("CoarseVertices") }, { "quad_points", quads->GetNumberOfPoints() } };
  json["certificate"] = { { "valid", fieldNumber(quads, "CertificateValid") != 0 } };
  json["certificate"].update(pairs(quads, "CertificateNames", "CertificateValues"));
  if (quads->GetFieldData()->GetArray("WrapAlpha"))
  {
    json["wrap"] = { { "alpha", field("WrapAlpha") }, { "offset", field("WrapOffset") },
      { "points_on_surface", field("PointsOnSurface") } };
  }
  if (quads->GetFieldData()->GetArray("AnisotropyLimit"))
  {
    json["anisotropy_limit"] = field("AnisotropyLimit");
    json["share_beyond_anisotropy_limit"] = field("BeyondAnisotropyLimit");
  }
  if (quads->GetFieldData()->GetArray("DistortionBefore"))
  {
    json["distortion_before"] = pairs(quads, "DistortionNames", "DistortionBefore");
    json["distortion_after"] = pairs(quads, "DistortionNames", "DistortionAfter");
    json["optimization_steps"] = field("OptimizationSteps");
  }
  if (quads->GetFieldData()->GetArray("SymmetryOrigin"))
  {
    const auto values = [quads](const char* name)
    {
      vtkDataArray* array = quads->GetFieldData()->GetArray(name);
      Json list = Json::array();
      for (int i = 0; i < array->GetNumberOfComponents(); ++i)
      {
        list.push_back(number(array->GetComponent(0, i)));
      }
      return list;
    };
    json["symmetry"] = { { "origin", values("SymmetryOrigin") },
      { "deviation", values("SymmetryDeviation") },
      { "moved_points", field("SymmetryMovedPoints") },
      { "farthest_moved", field("SymmetryFarthestMoved") } };
    if (quads->GetFieldData()->GetArray("SymmetryNormal"))
    {
      json["symmetry"]["normal"] = values("SymmetryNormal");
    }
    else
    {
      json["symmetry"]["direction"] = values("SymmetryDirection");
      json["symmetry"]["order"] = field("SymmetryOrder");
    }
  }
  json["quality"] = qualityOf(quads);
}

/// A row of the Constraint Table each; see vtkQuadRemesh.
Json constraintsOf(vtkTable* table)
{
  Json constraints = Json::array();
  for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
  {
    const auto value = [&](const char* column)
    { return number(table->GetValueByName(row, column).ToDouble()); };
    const auto text = [&](const char* column)
    { return table->GetValueByName(row, column).ToString(); };
    constraints.push_back(
      { { "id", value("Id") }, { "kind", text("Kind") }, { "source_id", value("SourceId") },
        { "place", Json::array({ value("X"), value("Y"), value("Z") }) },
        { "met", value("Met") != 0 }, { "deviation", value("Deviation") },
        { "deviation_95", value("Deviation95") }, { "unit", text("Unit") },
        { "reason", text("Reason") }, { "remark", text("Remark") } });
  }
  return constraints;
}

/// A point of the output Small Details each; see vtkQuadRemesh.
Json detailsOf(vtkPolyData* places)
{
  vtkPointData* data = places->GetPointData();
  const auto text = [data](const char* name, vtkIdType i)
  { return vtkStringArray::SafeDownCast(data->GetAbstractArray(name))->GetValue(i); };
  Json details = Json::array();
  for (vtkIdType i = 0; i < places->GetNumberOfPoints(); ++i)
  {
    std::array<double, 3> place{};
    places->GetPoint(i, place.data());
    details.push_back({ { "kind", text("Kind", i) },
      { "place", Json::array({ number(place[0]), number(place[1]), number(place[2]) }) },
      { "size", number(data->GetArray("Size")->GetTuple1(i)) }, { "decision", text("Decision", i) },
      { "result", text("Result", i) } });
  }
  return details;
}

/// The least, the mean and the largest value of each measure, and its histogram.
Json measuresOf(vtkQuadElements* filter)
{
  Json json = Json::object();
  vtkTable* histograms = filter->GetHistograms();
  for (vtkIdType c = 0; c + 2 < histograms->GetNumberOfColumns(); c += 3)
  {
    const std::string column = histograms->GetColumnName(c);
    const std::string name = column.substr(0, column.size() - std::string("From").size());
    vtkDataArray* values = filter->GetElements()->GetCellData()->GetArray(name.c_str());
    double least = std::numeric_limits<double>::infinity(), most = -least, sum = 0;
    for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
    {
      least = std::min(least, values->GetTuple1(i));
      most = std::max(most, values->GetTuple1(i));
      sum += values->GetTuple1(i);
    }
    Json bounds = Json::array({ number(histograms->GetValue(0, c).ToDouble()) });
    Json counts = Json::array();
    for (vtkIdType row = 0; row < histograms->GetNumberOfRows(); ++row)
    {
      bounds.push_back(number(histograms->GetValue(row, c + 1).ToDouble()));
      counts.push_back(number(histograms->GetValue(row, c + 2).ToDouble()));
    }
    json[name] = { { "least", number(least) },
      { "mean", number(sum / static_cast<double>(values->GetNumberOfTuples())) },
      { "most", number(most) }, { "histogram_bounds", bounds }, { "histogram_counts", counts } };
  }
  return json;
}

Json worstOf(vtkPolyData* places)
{
  Json worst = Json::array();
  vtkPointData* data = places->GetPointData();
  for (vtkIdType i = 0; i < places->GetNumberOfPoints(); ++i)
  {
    std::array<double, 3> place{};
    places->GetPoint(i, place.data());
    worst.push_back({ { "element", number(data->GetArray("ElementId")->GetTuple1(i)) },
      { "measure", data->GetAbstractArray("Measure")->GetVariantValue(i).ToString() },
      { "value", number(data->GetArray("Value")->GetTuple1(i)) },
      { "place", Json::array({ number(place[0]), number(place[1]), number(place[2]) }) } });
  }
  return worst;
}

Json requirementsOf(vtkFieldData* data)
{
  Json requirements = Json::array();
  auto* texts = vtkStringArray::SafeDownCast(data->GetAbstractArray("Requirements"));
  vtkDataArray* failed = data->GetArray("FailedElements");
  for (vtkIdType i = 0; texts && failed && i < texts->GetNumberOfValues(); ++i)
  {
    requirements.push_back({ { "requirement", std::string(texts->GetValue(i)) },
      { "failed_elements", number(failed->GetTuple1(i)) } });
  }
  return requirements;
}

/// Ids of elements count from 0.
Json elementsOf(vtkQuadElements* filter)
{
  vtkUnstructuredGrid* grid = filter->GetElements();
  vtkFieldData* data = grid->GetFieldData();
  Json json = { { "order", filter->GetOrder() }, { "elements", grid->GetNumberOfCells() },
    { "nodes", grid->GetNumberOfPoints() } };
  for (const auto& [name, array] : { std::pair("nodes_per_element", "NodesPerElement"),
         std::pair("nodes_moved_along", "NodesMovedAlong"),
         std::pair("nodes_moved_off", "NodesMovedOff"),
         std::pair("nodes_by_nearest", "NodesByNearest"),
         std::pair("edges_without_curve", "EdgesWithoutCurve"),
         std::pair("inverted_elements", "InvertedElements"),
         std::pair("elements_without_direction", "ElementsWithoutDirection") })
  {
    if (vtkDataArray* value = data->GetArray(array))
    {
      json[name] = number(value->GetTuple1(0));
    }
  }
  json["measures"] = measuresOf(filter);
  json["requirements"] = requirementsOf(data);
  json["failed_elements"] = filter->GetNumberOfFailedElements();
  json["worst"] = worstOf(filter->GetWorstElements());
  return json;
}

Json beginReport(const RunFiles& files, ExitCode code, const std::string& error)
{
  return { { "input", files.input }, { "output", files.output },
    { "exit_code", static_cast<int>(code) }, { "error", error } };
}

/// Names of files need not be UTF-8: what is not is replaced, as JSON knows nothing else.
std::string textOf(const Json& json)
{
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace

double fieldNumber(vtkPolyData* data, const char* name)
{
  vtkDataArray* array = data->GetFieldData()->GetArray(name);
  return array && array->GetNumberOfTuples() > 0 ? array->GetTuple1(0) : 0;
}

std::string makeReport(const RunFiles& files, RemeshRun& run, const ElementRun& elements,
  ExitCode code, const RunTimes& times)
{
  vtkQuadRemesh* filter = run.filter();
  vtkPolyData* input = vtkPolyData::SafeDownCast(filter->GetInput());
  const ExitCode exitCode = elements.isGood() ? code : kNoValidResult;
  Json json = beginReport(files, exitCode,
    !elements.isGood()      ? elements.failure()
      : code == kValidQuads ? ""
                            : run.error());
  json["input_points"] = input->GetNumberOfPoints();
  json["input_cells"] = input->GetNumberOfCells();
  json["seconds_total"] = number(times.total);
  json["handles"] = filter->GetHandles();
  json["components_without_quads"] = filter->GetComponentsWithoutQuads();
  json["unresolved_handles"] = filter->GetUnresolvedHandles();
  json["shortest_loop_over_edge_length"] = number(filter->GetShortestLoopOverEdgeLength());
  json["shortest_boundary_over_edge_length"] = number(filter->GetShortestBoundaryOverEdgeLength());
  if (hasQuads(code))
  {
    addSuccess(json, filter->GetOutput());
    json["constraints"] = constraintsOf(filter->GetConstraintTable());
    json["details"] = detailsOf(filter->GetDetailPlaces());
    if (elements.filter())
    {
      json["elements"] = elementsOf(elements.filter());
    }
  }
  json["stages"] = stagesOf(run, times.read);
  json["stage_times"] = linesOf(filter->GetStageTimesText());
  json["certificate_text"] = filter->GetCertificateText();
  json["notices"] = linesOf(run.notices());
  return textOf(json);
}

std::string makeFailureReport(const RunFiles& files, ExitCode code, const std::string& error)
{
  return textOf(beginReport(files, code, error));
}

} // namespace quadrille
