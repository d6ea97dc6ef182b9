// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIntegerGridMapComparison.h"

#include "Base/Refuse.h"
#include "Blocks/Blocks.h"
#include "Common/NewArray.h"
#include "Common/Report.h"
#include "Evaluation/SingularityDistance.h"
#include "Stages/MapMeasures.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <cmath>
#include <sstream>

vtkStandardNewMacro(vtkIntegerGridMapComparison);

namespace
{

using quadrille::Index;
using quadrille::MeasuredMap;

/// Refuses maps of two surfaces.
void requireSameSurface(const quadrille::Mesh& mesh, const quadrille::Mesh& reference)
{
  if (mesh.vertexCount() != reference.vertexCount() || mesh.faceCount() != reference.faceCount())
  {
    quadrille::refuse("the two inputs are not the same surface: ", mesh.faceCount(),
      " triangles on ", mesh.vertexCount(), " points, and ", reference.faceCount(), " on ",
      reference.vertexCount(), "; carry both maps to the same surface (Integer-Grid Map Upmap)");
  }
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.origin[h] != reference.origin[h] ||
      mesh.position[mesh.origin[h]] != reference.position[mesh.origin[h]])
    {
      quadrille::refuse("the two inputs are not the same surface: corner ", h % 3, " of cell ",
        h / 3, " differs; carry both maps to the same surface (Integer-Grid Map Upmap)");
    }
  }
}

void writeMoves(
  const quadrille::Mesh& mesh, const quadrille::SingularityDistance& distance, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  const auto turns = quadrille::newArray<vtkIntArray>("Turns");
  const auto length = quadrille::newArray<vtkDoubleArray>("Length");
  for (const quadrille::SingularityMove& move : distance.moves)
  {
    const vtkIdType ends[2] = { points->InsertNextPoint(mesh.position[move.from].data()),
      points->InsertNextPoint(mesh.position[move.to].data()) };
    lines->InsertNextCell(2, ends);
    turns->InsertNextValue(move.turns);
    length->InsertNextValue(move.length);
  }
  output->SetPoints(points);
  output->SetLines(lines);
  output->GetCellData()->AddArray(turns);
  output->GetCellData()->AddArray(length);
  output->GetCellData()->SetActiveScalars(length->GetName());
}

/// emd: in quarter turns times edge lengths. The rows "valence below 3 or above 5" are the extreme ones.
void writeMeasures(
  const MeasuredMap& map, const MeasuredMap& reference, double emd, vtkTable* table)
{
  std::vector<std::string> names;
  std::vector<double> ours, theirs, distances, medians, otherMedians;
  const auto columns = quadrille::measureColumns(map.quality);
  const auto others = quadrille::measureColumns(reference.quality);
  for (std::size_t i = 0; i < columns.size(); ++i)
  {
    names.emplace_back(columns[i].name);
    ours.push_back(columns[i].unit * columns[i].distribution.mean());
    theirs.push_back(others[i].unit * others[i].distribution.mean());
    medians.push_back(columns[i].unit * columns[i].distribution.quantile(0.5));
    otherMedians.push_back(others[i].unit * others[i].distribution.quantile(0.5));
    distances.push_back(columns[i].unit *
      quadrille::wassersteinDistance(columns[i].distribution, others[i].distribution));
  }
  const auto extreme = [](const MeasuredMap& measured)
  {
    std::size_t sum = 0;
    for (const auto& [turns, count] : measured.valences)
    {
      sum += turns < 3 || turns > 5 ? count : 0;
    }
    return static_cast<double>(sum);
  };
  names.emplace_back("Irregular vertices");
  ours.push_back(static_cast<double>(quadrille::irregularCount(map)));
  theirs.push_back(static_cast<double>(quadrille::irregularCount(reference)));
  distances.push_back(emd);
  names.emplace_back("Extreme valences");
  ours.push_back(extreme(map));
  theirs.push_back(extreme(reference));
  distances.push_back(std::abs(ours.back() - theirs.back()));
  names.emplace_back("Inverted triangles");
  ours.push_back(static_cast<double>(map.quality.inverted));
  theirs.push_back(static_cast<double>(reference.quality.inverted));
  distances.push_back(std::abs(ours.back() - theirs.back()));
  // Counts have no median; they stand in all columns of a side.
  medians.insert(
    medians.end(), ours.begin() + static_cast<std::ptrdiff_t>(columns.size()), ours.end());
  otherMedians.insert(
    otherMedians.end(), theirs.begin() + static_cast<std::ptrdiff_t>(columns.size()), theirs.end());
  quadrille::addTextColumn(table, "Measure", names);
  quadrille::addNumberColumn(table, "Map", ours);
  quadrille::addNumberColumn(table, "Reference", theirs);
  quadrille::addNumberColumn(table, "Distance", distances);
  quadrille::addNumberColumn(table, "MapMedian", medians);
  quadrille::addNumberColumn(table, "ReferenceMedian", otherMedians);
}

void writeBothHistograms(const MeasuredMap& map, const MeasuredMap& reference, vtkTable* table)
{
  const auto columns = quadrille::measureColumns(map.quality);
  const auto others = quadrille::measureColumns(reference.quality);
  for (std::size_t i = 0; i < columns.size(); ++i)
  {
    const std::string name = columns[i].name;
    quadrille::addNumberColumn(table, (name + "Bin").c_str(), quadrille::binCentres(columns[i]));
    quadrille::addNumberColumn(table, (name + "Map").c_str(), quadrille::percentInBins(columns[i]));
    quadrille::addNumberColumn(
      table, (name + "Reference").c_str(), quadrille::percentInBins(others[i]));
  }
}

void writeBothValences(const MeasuredMap& map, const MeasuredMap& reference, vtkTable* table)
{
  std::map<int, std::array<double, 2>> counts;
  for (const auto& [turns, count] : map.valences)
  {
    counts[turns][0] = static_cast<double>(count);
  }
  for (const auto& [turns, count] : reference.valences)
  {
    counts[turns][1] = static_cast<double>(count);
  }
  std::vector<double> valence, ours, theirs;
  for (const auto& [turns, count] : counts)
  {
    valence.push_back(turns);
    ours.push_back(count[0]);
    theirs.push_back(count[1]);
  }
  quadrille::addNumberColumn(table, "Valence", valence);
  quadrille::addNumberColumn(table, "Map", ours);
  quadrille::addNumberColumn(table, "Reference", theirs);
}

} // namespace

//------------------------------------------------------------------------------
vtkIntegerGridMapComparison::vtkIntegerGridMapComparison()
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(4);
}

vtkIntegerGridMapComparison::~vtkIntegerGridMapComparison() = default;

//------------------------------------------------------------------------------
const char* vtkIntegerGridMapComparison::GetBlockType(int outputPort) const
{
  return outputPort == 0 ? "vtkPolyData" : "vtkTable";
}

//------------------------------------------------------------------------------
vtkTable* vtkIntegerGridMapComparison::GetMeasures()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(1));
}

//------------------------------------------------------------------------------
vtkTable* vtkIntegerGridMapComparison::GetHistograms()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(2));
}

//------------------------------------------------------------------------------
vtkTable* vtkIntegerGridMapComparison::GetValences()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(3));
}

//------------------------------------------------------------------------------
void vtkIntegerGridMapComparison::Execute(quadrille::Block& block)
{
  if (!(this->TextureScale > 0 && std::isfinite(this->TextureScale)))
  {
    quadrille::refuse("TextureScale must be above 0 and finite");
  }
  if (!block.input(1))
  {
    quadrille::refuse("there is no map to compare with: connect the second input");
  }
  const MeasuredMap reference = quadrille::measureMap(
    block.input(1), this->EdgeLength, this->TextureScale, this->NumberOfThreads);
  const MeasuredMap map = quadrille::measureMap(
    block.input(), reference.edgeLength, this->TextureScale, this->NumberOfThreads);
  requireSameSurface(map.mesh, reference.mesh);
  const quadrille::SingularityDistance distance = quadrille::singularityDistance(
    reference.mesh, reference.turns, map.turns, this->NumberOfThreads);
  if (distance.unmatched > 0)
  {
    this->AddNotice(std::to_string(distance.unmatched) +
      " quarter turns of irregular vertices have no partner on their component, as one of the maps "
      "turns otherwise at the boundary or is no map of the whole surface: the earth mover's "
      "distance leaves them out");
  }
  const double emd = distance.work / reference.edgeLength;
  writeMoves(reference.mesh, distance, block.output(0));
  quadrille::addNumber(block.output(0), "EdgeLength", reference.edgeLength);
  vtkTable* measures = block.outputTable(1);
  writeMeasures(map, reference, emd, measures);
  quadrille::addCount(measures, "UnmatchedTurns", static_cast<std::size_t>(distance.unmatched));
  writeBothHistograms(map, reference, block.outputTable(2));
  writeBothValences(map, reference, block.outputTable(3));

  std::ostringstream text;
  text.precision(4);
  text << quadrille::irregularCount(map) << " irregular vertices against "
       << quadrille::irregularCount(reference) << ", " << emd
       << " quarter turns times edge lengths apart";
  this->SetResult(text.str());
}

//------------------------------------------------------------------------------
void vtkIntegerGridMapComparison::AddSettings(std::ostream& os) const
{
  this->Superclass::AddSettings(os);
  os << "EdgeLength " << this->EdgeLength << '\n' << "TextureScale " << this->TextureScale << '\n';
}

//------------------------------------------------------------------------------
void vtkIntegerGridMapComparison::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "EdgeLength: " << this->EdgeLength << "\n";
  os << indent << "TextureScale: " << this->TextureScale << "\n";
}
