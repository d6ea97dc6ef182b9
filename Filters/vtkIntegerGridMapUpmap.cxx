// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIntegerGridMapUpmap.h"

#include "QuadrilleBlocks.h"
#include "QuadrilleConvert.h"
#include "QuadrilleLog.h"
#include "QuadrilleReport.h"
#include "QuadrilleStages.h"
#include "Transfer/Charts.h"
#include "Transfer/Transfer.h"

#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

vtkStandardNewMacro(vtkIntegerGridMapUpmap);

namespace
{

/// A point array of the coarse level, one whole number a vertex.
std::vector<int> coarseNumbers(vtkPolyData* coarse, const char* name)
{
  vtkDataArray* array = coarse->GetPointData()->GetArray(name);
  if (!array || array->GetNumberOfComponents() != 1)
  {
    throw quadrille::InvalidInput(std::string("the coarse level has no point array '") + name +
      "'; it is made by vtkIntegerGridMap");
  }
  std::vector<int> values(static_cast<std::size_t>(array->GetNumberOfTuples()));
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    values[i] = static_cast<int>(array->GetTuple1(static_cast<vtkIdType>(i)));
  }
  return values;
}

/// Vertices that the decimation removed are regular and need no integers.
std::vector<int> expectedTurns(const quadrille::Mesh& mesh)
{
  std::vector<int> turns(mesh.vertexCount(), 4);
  for (quadrille::Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isBoundary(h))
    {
      turns[mesh.origin[h]] = 2;
    }
  }
  return turns;
}

struct Expectation
{
  std::vector<int> turns;
  std::vector<std::uint8_t> integerVertex;
};

Expectation expectationOf(
  const quadrille::Mesh& mesh, const quadrille::Level& coarse, vtkPolyData* coarseData)
{
  Expectation expected{ expectedTurns(mesh), std::vector<std::uint8_t>(mesh.vertexCount(), 0) };
  const std::vector<int> turns = coarseNumbers(coarseData, quadrille::arrays::kTurns);
  const std::vector<int> integer = coarseNumbers(coarseData, quadrille::arrays::kIntegerVertex);
  for (std::size_t v = 0; v < coarse.fineVertex.size(); ++v)
  {
    expected.turns[coarse.fineVertex[v]] = turns[v];
    expected.integerVertex[coarse.fineVertex[v]] = static_cast<std::uint8_t>(integer[v]);
  }
  return expected;
}

} // namespace

//------------------------------------------------------------------------------
vtkIntegerGridMapUpmap::vtkIntegerGridMapUpmap()
{
  this->SetNumberOfInputPorts(3);
}

vtkIntegerGridMapUpmap::~vtkIntegerGridMapUpmap() = default;

//------------------------------------------------------------------------------
vtkQuadrilleAlgorithm::PortRole vtkIntegerGridMapUpmap::GetPortRole(int port) const
{
  return port == 0 ? PortRole::Mesh : port == 1 ? PortRole::Surface : PortRole::Log;
}

//------------------------------------------------------------------------------
void vtkIntegerGridMapUpmap::Execute(quadrille::Block& block)
{
  vtkPolyData* coarseData = block.input(0);
  vtkPolyData* source = block.input(1);
  vtkTable* logData = block.inputTable(2);
  if (!source || !logData)
  {
    throw quadrille::InvalidInput("the surface or the log is missing");
  }
  const quadrille::SurfaceRecipe recipe = quadrille::readRecipe(logData);
  quadrille::ConvertedSurface converted = quadrille::convertSurface(source, recipe.patchArray);
  quadrille::addFeatureMarks(converted.input, recipe.curveMarks);
  quadrille::StageClock clock;
  quadrille::PreparedSurface surface = quadrille::prepareFromRecipe(
    converted.input, recipe, this->NumberOfThreads, this->MakeProgress(0.0, 0.4), clock);
  quadrille::refineFromRecipe(surface, recipe, this->MakeProgress(0.4, 0.5), clock);

  const quadrille::DecimationLog log = quadrille::readLog(logData, surface.hash);
  const quadrille::Level coarse = quadrille::readLevel(coarseData, surface.mesh);
  const Expectation expected = expectationOf(surface.mesh, coarse, coarseData);
  quadrille::TransferOptions options;
  options.threads = this->NumberOfThreads;
  options.progress = this->MakeProgress(0.5, 0.9);
  quadrille::TransferResult map =
    quadrille::transferMap(surface.mesh, coarse, log, quadrille::readMap(coarseData), options);
  clock.lap("replay", coarse.mesh.faceCount(), surface.mesh.faceCount());
  const quadrille::ChartCounts charts = quadrille::mergeCharts(surface.mesh, map.uv);
  clock.lap("charts", surface.mesh.faceCount(), charts.charts);

  const quadrille::Certificate certificate =
    quadrille::certify(surface.mesh, map.uv, expected.turns, expected.integerVertex);
  this->SetStageRecords(clock.records);
  this->SetCertificate(certificate);
  if (!quadrille::hasPromised(certificate, quadrille::readMethod(coarseData)) ||
    certificate.notPositive > 0)
  {
    this->AddNotice("map on the surface: " + certificate.text());
    vtkWarningMacro(<< "map on the surface: " << certificate.text());
  }
  vtkPolyData* output = block.output();
  std::vector<std::string> notCarried;
  output->ShallowCopy(quadrille::writeMappedSurface(surface, map.uv,
    quadrille::matchingOf(surface.mesh, map.uv, this->NumberOfThreads), expected.turns, source,
    converted, this->TextureCoordinates != 0, this->NumberOfThreads, &notCarried));
  for (const std::string& notice : notCarried)
  {
    this->AddNotice(notice);
  }
  output->GetFieldData()->PassData(coarseData->GetFieldData());
  quadrille::addStages(output, clock.records);
  quadrille::addCertificate(output, certificate);
  quadrille::addCount(output, "Charts", charts.charts);
  quadrille::addCount(output, "SeamEdges", charts.seamEdges);
  quadrille::addCount(output, "ReplayInvertedStars", map.invertedStars);
  quadrille::addCount(output, "ReplayMovedToKernel", map.movedToKernel);
  quadrille::addCount(output, "ReplayWithoutKernel", map.withoutKernel);
  quadrille::addCount(output, "ReplayMendedPatches", map.mendedPatches);
}

//------------------------------------------------------------------------------
void vtkIntegerGridMapUpmap::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "TextureCoordinates: " << this->TextureCoordinates << "\n";
}
