// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIntegerGridMapUpmap.h"

#include "Base/PlaceText.h"
#include "Blocks/Blocks.h"
#include "Common/Report.h"
#include "Convert/Frame.h"
#include "Convert/PolyData.h"
#include "Mesh/ContentHash.h"
#include "Pipeline/GuidedMap.h"
#include "Pipeline/LeaveFrame.h"
#include "Pipeline/SizedSurface.h"
#include "Pipeline/StageRecords.h"
#include "Stages/Log.h"
#include "Stages/MappedInput.h"
#include "Stages/SharedLevels.h"
#include "Transfer/Charts.h"
#include "Transfer/ExpectedTurns.h"
#include "Transfer/Transfer.h"

#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkIntArray.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <utility>

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
struct Expectation
{
  std::vector<int> turns;
  std::vector<std::uint8_t> integerVertex;
};

Expectation expectationOf(
  const quadrille::Mesh& mesh, const quadrille::Level& coarse, vtkPolyData* coarseData)
{
  Expectation expected{ quadrille::expectedTurns(
                          mesh, coarse, coarseNumbers(coarseData, quadrille::arrays::kTurns)),
    std::vector<std::uint8_t>(mesh.vertexCount(), 0) };
  const std::vector<int> integer = coarseNumbers(coarseData, quadrille::arrays::kIntegerVertex);
  for (std::size_t v = 0; v < coarse.fineVertex.size(); ++v)
  {
    expected.integerVertex[coarse.fineVertex[v]] = static_cast<std::uint8_t>(integer[v]);
  }
  return expected;
}

/// In the frame, with its guides.
quadrille::Level intermediateLevel(
  vtkPolyData* data, const quadrille::Mesh& fine, const quadrille::Frame& frame)
{
  quadrille::Level level = quadrille::readLevel(data, fine);
  level.guides = quadrille::readGuides(data, level.mesh);
  for (quadrille::Guide& guide : level.guides)
  {
    guide.direction = frame.mirrored(guide.direction);
  }
  for (std::size_t v = 0; v < level.fineVertex.size(); ++v)
  {
    level.mesh.position.edit()[v] = fine.position[level.fineVertex[v]];
  }
  if (frame.reversed)
  {
    quadrille::reverseFaces(level.mesh);
  }
  return level;
}

/// What the surface's own array of valences does not have: those that are drawn, which smoothing is to leave where they
/// are. output: has the surface's vertices as points, with SurfacePointId where some are doubled.
void addDrawnValences(const quadrille::PreparedSurface& surface,
  const std::vector<quadrille::ValencePlace>& drawn, const quadrille::Frame& frame,
  vtkPolyData* output)
{
  if (drawn.empty())
  {
    return;
  }
  vtkPointData* points = output->GetPointData();
  vtkSmartPointer<vtkDataArray> valences = points->GetArray(quadrille::arrays::kTargetValence);
  if (!valences)
  {
    valences = vtkSmartPointer<vtkIntArray>::New();
    valences->SetName(quadrille::arrays::kTargetValence);
    valences->SetNumberOfTuples(output->GetNumberOfPoints());
    valences->Fill(0);
    points->AddArray(valences);
  }
  std::map<quadrille::Index, int> asked;
  for (const quadrille::ValencePlace& valence : drawn)
  {
    const quadrille::Vector3 place = frame.fromUser(valence.place);
    const quadrille::ValenceRequest* nearest = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const quadrille::ValenceRequest& request : surface.valenceRequests)
    {
      const double distance = (surface.mesh.position[request.vertex] - place).squaredNorm();
      if (request.valence == valence.valence && distance < least)
      {
        least = distance;
        nearest = &request;
      }
    }
    if (nearest != nullptr) // else it was left out
    {
      asked[nearest->vertex] = nearest->valence;
    }
  }
  vtkDataArray* vertices = points->GetArray(quadrille::arrays::kSurfacePointId);
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    const auto vertex =
      static_cast<quadrille::Index>(vertices ? vertices->GetTuple1(i) : static_cast<double>(i));
    const auto found = asked.find(vertex);
    if (found != asked.end())
    {
      valences->SetTuple1(i, found->second);
    }
  }
}

/// Whether the extraction takes the map as it is, bit for bit.
bool isExact(const quadrille::Certificate& certificate)
{
  return certificate.seamResiduals == 0 && certificate.offAxes == 0 &&
    certificate.offIsolines == 0 && certificate.fractionalTransitions == 0;
}

} // namespace

//------------------------------------------------------------------------------
vtkIntegerGridMapUpmap::vtkIntegerGridMapUpmap()
{
  this->SetNumberOfInputPorts(4);
}

vtkIntegerGridMapUpmap::~vtkIntegerGridMapUpmap() = default;

//------------------------------------------------------------------------------
vtkQuadrilleAlgorithm::PortRole vtkIntegerGridMapUpmap::GetPortRole(int port) const
{
  constexpr std::array<PortRole, 4> kRoles = { PortRole::Mesh, PortRole::Surface, PortRole::Log,
    PortRole::OptionalMesh };
  return kRoles.at(static_cast<std::size_t>(port));
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
  quadrille::SurfaceRecipe recipe = quadrille::readRecipe(logData);
  quadrille::ConvertedSurface converted =
    quadrille::convertSurface(source, recipe.patchArray, this->NumberOfThreads);
  converted.input.drawn = recipe.drawn;
  quadrille::FramedInput framed =
    quadrille::enterFrame(std::move(converted.input), this->NumberOfThreads);
  const quadrille::Frame& frame = framed.frame;
  const quadrille::PlaceScope places(frame.centre, frame.unit, frame.sign);
  recipe.edgeLength = frame.lengthOf(recipe.edgeLength);
  quadrille::StageLaps laps;
  auto& held = block.state->memoryAs<quadrille::SharedLevels>();
  held.map.reset();
  this->FindOrPrepare(framed.input, recipe, laps, held);
  const quadrille::PreparedSurface& surface = held.surface->surface;

  quadrille::Hierarchy levels;
  levels.log = quadrille::readLog(logData, surface.hash);
  const quadrille::DecimationLog& log = levels.log;
  laps.lap("log", 0, log.collapses + log.flips);
  levels.coarse = quadrille::readLevel(coarseData, surface.mesh);
  quadrille::Level& coarse = levels.coarse;
  std::vector<quadrille::FixedVec2> coarseUv = quadrille::readMap(coarseData);
  if (frame.reversed)
  {
    quadrille::reverseFaces(coarse.mesh);
    quadrille::reverseMap(coarseUv);
  }
  const Expectation expected = expectationOf(surface.mesh, coarse, coarseData);
  quadrille::TransferOptions options;
  options.threads = this->NumberOfThreads;
  options.progress = this->MakeProgress(0.5, 0.9);
  const auto certified = [&](const std::vector<quadrille::FixedVec2>& uv)
  {
    return quadrille::certify(
      surface.mesh, uv, expected.turns, expected.integerVertex, this->NumberOfThreads);
  };
  std::optional<quadrille::TransferResult> alongGuides;
  if (block.input(3) && quadrille::readMethod(coarseData) == quadrille::MapMethod::ScaleAware)
  {
    levels.intermediate = intermediateLevel(block.input(3), surface.mesh, frame);
    alongGuides = quadrille::transferAlongGuides(
      surface.mesh, levels, coarseUv, expected.turns, expected.integerVertex, options);
    if (alongGuides && !certified(alongGuides->uv).valid())
    {
      alongGuides.reset();
    }
  }
  const bool isAlongGuides = alongGuides.has_value();
  quadrille::TransferResult map = alongGuides
    ? std::move(*alongGuides)
    : quadrille::transferMap(surface.mesh, coarse, log, coarseUv, options);
  laps.lap("replay", coarse.mesh.faceCount(), surface.mesh.faceCount());
  const quadrille::ChartCounts charts = quadrille::mergeCharts(surface.mesh, map.uv);
  laps.lap("charts", surface.mesh.faceCount(), charts.charts);

  const quadrille::Certificate certificate = certified(map.uv);
  laps.lap("certify", surface.mesh.faceCount(), surface.mesh.faceCount());
  this->SetCertificate(certificate);
  if (!quadrille::hasPromised(certificate, quadrille::readMethod(coarseData)) ||
    certificate.notPositive > 0)
  {
    this->AddNotice("map on the surface: " + certificate.text());
    vtkWarningMacro(<< "map on the surface: " << certificate.text());
  }
  quadrille::PreparedSurface written = surface;
  quadrille::leaveFrame(written, frame, quadrille::userPositions(surface, frame, framed.points));
  if (frame.reversed)
  {
    quadrille::reverseMap(map.uv);
  }
  vtkPolyData* output = block.output();
  std::vector<std::string> notCarried;
  output->ShallowCopy(quadrille::writeMappedSurface(written, map.uv,
    quadrille::matchingOf(written.mesh, map.uv, this->NumberOfThreads), expected.turns, source,
    converted, this->TextureCoordinates != 0, this->NumberOfThreads, &notCarried));
  for (const std::string& notice : notCarried)
  {
    this->AddNotice(notice);
  }
  addDrawnValences(surface, recipe.drawn.valences, frame, output);
  if (const auto key = quadrille::mappedSurfaceHash(output, this->NumberOfThreads);
      key && isExact(certificate))
  {
    held.map =
      std::make_shared<quadrille::SharedMap>(quadrille::SharedMap{ *key, held.surface, frame });
    quadrille::share(held.map);
  }
  laps.lap("write", surface.mesh.faceCount(), surface.mesh.faceCount());
  this->SetStageRecords(laps.records.all());
  output->GetFieldData()->PassData(coarseData->GetFieldData());
  if (isAlongGuides)
  {
    quadrille::addSmoothingGuides(
      quadrille::guidesRoundRegions(surface.mesh, levels.intermediate, recipe.edgeLength), frame,
      output);
  }
  quadrille::addFrame(output, frame, surface.mesh.position);
  quadrille::addFields(output, quadrille::stageFields(laps.records.all()));
  quadrille::addFields(output, quadrille::certificateFields(certificate));
  quadrille::addCount(output, "Charts", charts.charts);
  quadrille::addCount(output, "SeamEdges", charts.seamEdges);
  quadrille::addCount(output, "ReplayInvertedStars", map.invertedStars);
  quadrille::addCount(output, "ReplayMovedToKernel", map.movedToKernel);
  quadrille::addCount(output, "ReplayWithoutKernel", map.withoutKernel);
  quadrille::addCount(output, "ReplayMendedPatches", map.mendedPatches);
}

//------------------------------------------------------------------------------
void vtkIntegerGridMapUpmap::FindOrPrepare(quadrille::SurfaceInput& input,
  const quadrille::SurfaceRecipe& recipe, quadrille::StageLaps& laps, quadrille::SharedLevels& held)
{
  const quadrille::SurfaceKey key{ quadrille::contentHash(input, this->NumberOfThreads),
    quadrille::drawnHash(input.drawn), recipe.featureAngle, recipe.featureCriterion,
    recipe.edgeLength };
  if (auto found = quadrille::findSharedSurface(key))
  {
    held.surface = std::move(found);
  }
  else
  {
    held.surface.reset(); // before the new one takes its memory
    const auto made = std::make_shared<quadrille::SharedSurface>();
    made->key = key;
    quadrille::RemeshOptions options;
    options.edgeLength = recipe.edgeLength;
    options.featureAngle = recipe.featureAngle;
    options.featureCriterion = recipe.featureCriterion;
    options.smallDetails = quadrille::SmallDetails::Resolve; // as those of the hierarchy
    options.maximumNumberOfQuads = std::numeric_limits<std::size_t>::max();
    options.threads = this->NumberOfThreads;
    options.progress = this->MakeProgress(0.0, 3.3); // the surface is ready at 0.15 of a whole run
    quadrille::SizedSurface sized = quadrille::sizeSurface(input, options);
    laps.add(sized.stages.all());
    made->surface = std::move(*sized.surface);
    held.surface = made;
    quadrille::share(held.surface);
  }
  input = {};
  laps.lap("find", 0, held.surface->surface.mesh.faceCount());
}

//------------------------------------------------------------------------------
void vtkIntegerGridMapUpmap::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "TextureCoordinates: " << this->TextureCoordinates << "\n";
}
