// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIntegerGridMapQuality.h"

#include "Base/Angles.h"
#include "Base/Refuse.h"
#include "Blocks/Blocks.h"
#include "Common/NewArray.h"
#include "Common/Report.h"
#include "Stages/MapMeasures.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <cmath>
#include <sstream>

vtkStandardNewMacro(vtkIntegerGridMapQuality);

namespace
{

void addCellArrays(vtkPolyData* output, const quadrille::MapQuality& quality)
{
  const std::size_t count = quality.faces.size();
  const auto sizing = quadrille::newArray<vtkDoubleArray>("Sizing", 1, count);
  const auto anisotropy = quadrille::newArray<vtkDoubleArray>("Anisotropy", 1, count);
  const auto shear = quadrille::newArray<vtkDoubleArray>("Shear", 1, count);
  for (std::size_t f = 0; f < count; ++f)
  {
    const vtkIdType id = static_cast<vtkIdType>(f);
    sizing->SetValue(id, quality.faces[f].sizing);
    anisotropy->SetValue(id, quality.faces[f].anisotropy);
    shear->SetValue(id, quality.faces[f].shear * 180 / quadrille::kPi);
  }
  for (vtkDoubleArray* array : { sizing.Get(), anisotropy.Get(), shear.Get() })
  {
    output->GetCellData()->AddArray(array);
  }
  // What ParaView shows first; the others may have triangles that leave no colours to the rest.
  output->GetCellData()->SetActiveScalars(shear->GetName());
}

void writeHistograms(const quadrille::MapQuality& quality, vtkTable* table)
{
  for (const quadrille::MeasureColumn& column : quadrille::measureColumns(quality))
  {
    const std::string name = column.name;
    quadrille::addNumberColumn(table, (name + "Bin").c_str(), quadrille::binCentres(column));
    quadrille::addNumberColumn(table, (name + "Share").c_str(), quadrille::percentInBins(column));
  }
}

void writeSummary(const quadrille::MapQuality& quality, vtkTable* table)
{
  std::vector<std::string> names;
  std::vector<double> mean, minimum, low, median, high, maximum;
  for (const quadrille::MeasureColumn& column : quadrille::measureColumns(quality))
  {
    const quadrille::WeightedDistribution& d = column.distribution;
    names.emplace_back(column.name);
    mean.push_back(column.unit * d.mean());
    minimum.push_back(column.unit * d.minimum());
    low.push_back(column.unit * d.quantile(0.05));
    median.push_back(column.unit * d.quantile(0.5));
    high.push_back(column.unit * d.quantile(0.95));
    maximum.push_back(column.unit * d.maximum());
  }
  quadrille::addTextColumn(table, "Measure", names);
  quadrille::addNumberColumn(table, "Mean", mean);
  quadrille::addNumberColumn(table, "Minimum", minimum);
  quadrille::addNumberColumn(table, "Percent5", low);
  quadrille::addNumberColumn(table, "Median", median);
  quadrille::addNumberColumn(table, "Percent95", high);
  quadrille::addNumberColumn(table, "Maximum", maximum);
}

void writeValences(const std::map<int, std::size_t>& valences, vtkTable* table)
{
  std::vector<double> valence, count;
  for (const auto& [turns, vertices] : valences)
  {
    valence.push_back(turns);
    count.push_back(static_cast<double>(vertices));
  }
  quadrille::addNumberColumn(table, "Valence", valence);
  quadrille::addNumberColumn(table, "Count", count);
}

} // namespace

//------------------------------------------------------------------------------
vtkIntegerGridMapQuality::vtkIntegerGridMapQuality()
{
  this->SetNumberOfOutputPorts(4);
}

vtkIntegerGridMapQuality::~vtkIntegerGridMapQuality() = default;

//------------------------------------------------------------------------------
const char* vtkIntegerGridMapQuality::GetBlockType(int outputPort) const
{
  return outputPort == 0 ? "vtkPolyData" : "vtkTable";
}

//------------------------------------------------------------------------------
vtkTable* vtkIntegerGridMapQuality::GetHistograms()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(1));
}

//------------------------------------------------------------------------------
vtkTable* vtkIntegerGridMapQuality::GetSummary()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(2));
}

//------------------------------------------------------------------------------
vtkTable* vtkIntegerGridMapQuality::GetValences()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(3));
}

//------------------------------------------------------------------------------
void vtkIntegerGridMapQuality::Execute(quadrille::Block& block)
{
  if (!(this->TextureScale > 0 && std::isfinite(this->TextureScale)))
  {
    quadrille::refuse("TextureScale must be above 0 and finite");
  }
  const quadrille::MeasuredMap measured = quadrille::measureMap(
    block.input(), this->EdgeLength, this->TextureScale, this->NumberOfThreads);
  const quadrille::MapQuality& quality = measured.quality;
  if (!measured.notice.empty())
  {
    this->AddNotice(measured.notice);
  }
  vtkPolyData* output = block.output(0);
  output->ShallowCopy(block.input());
  addCellArrays(output, quality);
  quadrille::addNumber(output, "EdgeLength", measured.edgeLength);
  quadrille::addCount(output, "InvertedTriangles", quality.inverted);
  quadrille::addCount(output, "DegenerateTriangles", quality.degenerate);
  writeHistograms(quality, block.outputTable(1));
  writeSummary(quality, block.outputTable(2));
  writeValences(measured.valences, block.outputTable(3));

  std::ostringstream text;
  text.precision(4);
  text << "means by area: sizing " << quality.sizing.mean() << ", anisotropy "
       << quality.anisotropy.mean() << ", shear " << quality.shear.mean() * 180 / quadrille::kPi
       << " degrees; " << quadrille::irregularCount(measured) << " irregular vertices";
  if (quality.inverted > 0)
  {
    text << "; " << quality.inverted << " triangles are inverted";
  }
  this->SetResult(text.str());
}

//------------------------------------------------------------------------------
void vtkIntegerGridMapQuality::AddSettings(std::ostream& os) const
{
  this->Superclass::AddSettings(os);
  os << "EdgeLength " << this->EdgeLength << '\n' << "TextureScale " << this->TextureScale << '\n';
}

//------------------------------------------------------------------------------
void vtkIntegerGridMapQuality::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "EdgeLength: " << this->EdgeLength << "\n";
  os << indent << "TextureScale: " << this->TextureScale << "\n";
}
