// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadRemesh.h"

#include "Assembly/JoinParts.h"
#include "Assembly/JointSheets.h"
#include "Assembly/PartSplit.h"
#include "Base/PlaceText.h"
#include "Blocks/Blocks.h"
#include "Common/Report.h"
#include "Common/Stamps.h"
#include "Constraints/ConstraintTable.h"
#include "Constraints/Constraints.h"
#include "Constraints/Moves.h"
#include "Convert/Frame.h"
#include "Convert/PolyData.h"
#include "Convert/Quads.h"
#include "Convert/Surfaces.h"
#include "Pipeline/Pipeline.h"
#include "Pipeline/ResultStore.h"
#include "Ranks/Spread.h"
#include "Runs/InPieces.h"
#include "Runs/SmallDetails.h"
#include "Runs/Symmetry.h"
#include "Symmetry/Symmetry.h"

#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkQuadRemesh);

namespace
{

quadrille::QuadSource sourceOf(const quadrille::PreparedSurface& surface,
  const quadrille::ConvertedSurface& converted, vtkPolyData* input)
{
  quadrille::QuadSource source;
  source.carrier = input;
  source.patchArray = converted.patchArray;
  source.carrierPoint = [&surface, &converted, input](
                          quadrille::Index face, const std::array<double, 3>& weights)
  { return quadrille::pointOrigin(surface, converted, input, face, weights); };
  source.carrierCell = [&surface, &converted](quadrille::Index face)
  { return converted.cell(surface.sourcePolygon[face]); };
  return source;
}

/// The second output of the last execution, and what it was made from.
struct MappedOutput
{
  vtkPolyData* input = nullptr;
  vtkMTimeType inputTime = 0;
  vtkTypeBool textureCoordinates = 0;
  quadrille::ResultKey map = 0; ///< 0: there is none
  vtkSmartPointer<vtkPolyData> surface;
  std::uint64_t triangles = 0;         ///< hash of the surface
  bool reversed = false;               ///< its faces against those of the input
  std::vector<quadrille::Stamp> cells; ///< of the input

  /// What was written, where another surface from the same cells has the same triangles.
  vtkPolyData* sameTriangles(const quadrille::RemeshResult& result, vtkPolyData* from) const
  {
    return surface && triangles == result.surface.hash && reversed == result.frame.reversed &&
        cells == cellStamps(from)
      ? surface
      : nullptr;
  }
  static std::vector<quadrille::Stamp> cellStamps(vtkPolyData* data)
  {
    vtkNew<vtkPolyData> cells;
    cells->SetVerts(data->GetVerts());
    cells->SetLines(data->GetLines());
    cells->SetPolys(data->GetPolys());
    cells->SetStrips(data->GetStrips());
    std::vector<quadrille::Stamp> stamps;
    quadrille::addStamps(cells, stamps);
    return stamps;
  }
  /// The map's key, where another output from the same input would be the same.
  quadrille::ResultKey mapFor(vtkPolyData* other, vtkTypeBool withTextureCoordinates) const
  {
    return other == input && other->GetMTime() == inputTime &&
        withTextureCoordinates == textureCoordinates
      ? map
      : 0;
  }
};

/// What a block keeps for its next execution.
struct LevelMemory : quadrille::BlockMemory
{
  quadrille::ResultStore levels;
  MappedOutput mapped;
};

std::string resultText(const quadrille::RemeshResult& result, vtkIdType irregular)
{
  std::ostringstream text;
  if (result.quads.quads.empty())
  {
    text << "No quads, as the method makes none: the mapped surface is the result.";
    return text.str();
  }
  text << result.quads.quads.size() << " quads (about " << result.targetQuads << " asked for), "
       << irregular << " irregular vertices";
  return text.str();
}

/// What is added to the sentence above where something was asked for.
std::string constraintText(const std::vector<quadrille::ConstraintWord>& words)
{
  const auto met = std::count_if(
    words.begin(), words.end(), [](const quadrille::ConstraintWord& word) { return word.isMet; });
  const auto off = std::count_if(words.begin(), words.end(),
    [](const quadrille::ConstraintWord& word) { return word.isOffSurface; });
  std::ostringstream text;
  if (!words.empty())
  {
    text << ", " << met << " of " << words.size() << " constraints met"
         << (off > 0 ? ", " + std::to_string(off) + " with a point off the surface" : "")
         << (off > 0 || static_cast<std::size_t>(met) < words.size() ? " (see Constraint Table)"
                                                                     : "");
  }
  return text.str();
}

std::vector<const quadrille::SurfaceInput*> addressesOf(
  const std::vector<quadrille::SurfaceInput>& parts)
{
  std::vector<const quadrille::SurfaceInput*> addresses;
  for (const quadrille::SurfaceInput& part : parts)
  {
    addresses.push_back(&part);
  }
  return addresses;
}

std::vector<std::string> namesOfOthers(
  const std::vector<quadrille::Block*>& blocks, std::size_t than)
{
  std::vector<std::string> names;
  for (std::size_t i = 0; i < blocks.size(); ++i)
  {
    if (i != than)
    {
      names.push_back(blocks[i]->name);
    }
  }
  return names;
}

/// Whether a block has far more or fewer quads than were asked for.
bool isFarFrom(std::size_t target, quadrille::Block& block)
{
  constexpr double factor = 1.5;
  const auto quads = static_cast<double>(block.output(0)->GetNumberOfPolys());
  const auto wanted = static_cast<double>(target);
  return quads > factor * wanted || factor * quads < wanted;
}

/// Of conforming blocks, at the first one.
std::string togetherText(
  const std::vector<quadrille::Block*>& blocks, const quadrille::PartContacts& contacts)
{
  constexpr std::size_t told = 8;
  const std::vector<std::string> names = namesOfOthers(blocks, 0);
  std::ostringstream text;
  text << "conforming, made in one run with ";
  for (std::size_t i = 0; i < std::min(names.size(), told); ++i)
  {
    text << (i == 0 ? "'" : ", '") << names[i] << "'";
  }
  if (names.size() > told)
  {
    text << " and " << names.size() - told << " others";
  }
  text << ": they have " << contacts.edges << " edges in common";
  return text.str();
}

/// Of the polygons, each in triangles from its first corner.
double areaOfPolygons(const quadrille::SurfaceInput& input)
{
  double area = 0;
  for (std::size_t i = 0; i + 1 < input.polygonOffsets.size(); ++i)
  {
    const quadrille::Index first = input.polygonOffsets[i];
    const quadrille::Vector3& a = input.points[input.polygonPoints[first]];
    for (quadrille::Index k = first + 2; k < input.polygonOffsets[i + 1]; ++k)
    {
      area += 0.5 *
        (input.points[input.polygonPoints[k - 1]] - a)
          .cross(input.points[input.polygonPoints[k]] - a)
          .norm();
    }
  }
  return area;
}

/// Blocks that are narrower than a quad, where no quads follow their borders.
std::string withoutQuadsText(
  const std::vector<quadrille::Block*>& blocks, const std::vector<std::size_t>& withoutQuads)
{
  const auto largest = *std::max_element(withoutQuads.begin(), withoutQuads.end(),
    [&blocks](std::size_t a, std::size_t b)
    { return quadrille::areaOf(blocks[a]->input()) < quadrille::areaOf(blocks[b]->input()); });
  std::array<double, 6> box{};
  blocks[largest]->input()->GetBounds(box.data());
  const quadrille::Vector3 middle(
    0.5 * (box[0] + box[1]), 0.5 * (box[2] + box[3]), 0.5 * (box[4] + box[5]));
  std::ostringstream text;
  text << withoutQuads.size() << " of " << blocks.size() << " blocks "
       << (withoutQuads.size() == 1 ? "is" : "are")
       << " too small or too narrow for a quad and have none, the largest of them '"
       << blocks[largest]->name << "' near " << quadrille::placeText(middle)
       << ": their place went to quads of blocks beside; ask for more quads, or join these blocks "
          "with others";
  return text.str();
}

std::string sheetsText(const quadrille::MetSheets& met)
{
  std::ostringstream text;
  text << met.segments << " curves are common to more than two sheets";
  if (met.strips > 0)
  {
    text << "; " << met.strips
         << (met.strips == 1 ? " strip of quads was" : " strips of quads were")
         << " put in so that all sheets have the same points there";
  }
  if (met.inverted > 0)
  {
    text << "; " << met.inverted << " quads are inverted: more quads often help";
  }
  return text.str();
}

std::string touchingText(const quadrille::JointSheets& sheets)
{
  std::ostringstream text;
  text
    << "sheets that go on beyond touch at " << sheets.touching << " edges, one of them near "
    << quadrille::placeText(sheets.touchingPlace)
    << ", as solids do that have a curve in common and no face: there is no result with the same "
       "points in all of them there, so they are not made to meet at these edges; ask for more "
       "quads, or cut the blocks in two there";
  return text.str();
}

/// Of the joint surface, with a factor a part; the smaller one counts where parts meet. asked: those of the points
/// without it, or empty.
std::vector<float> sizesOf(const quadrille::JoinedParts& joined, const std::vector<float>& asked,
  const std::vector<double>& factors)
{
  std::vector<float> sizes(joined.input.points.size(), std::numeric_limits<float>::max());
  for (std::size_t p = 0; p < joined.parts.size(); ++p)
  {
    for (const auto& [joint, own] : joined.parts[p].points)
    {
      const float size = asked.empty() ? 1.0F : asked[joint];
      sizes[joint] = std::min(sizes[joint], size * static_cast<float>(factors[p]));
    }
  }
  return sizes;
}

/// What the surface's own arrays come from.
struct MappedSource
{
  vtkPolyData* input = nullptr;
  const quadrille::ConvertedSurface* converted = nullptr;
  bool textureCoordinates = false;
  vtkPolyData* earlier = nullptr; ///< see writeMappedSurface
};

void writeMapped(const quadrille::RemeshResult& result, const quadrille::RemeshOptions& options,
  const MappedSource& source, vtkPolyData* mapped)
{
  mapped->ShallowCopy(quadrille::writeMappedSurface(result.surface, result.uv,
    quadrille::matchingOf(result.surface.mesh, result.uv, options.threads), result.turns,
    source.input, *source.converted, source.textureCoordinates, options.threads, nullptr,
    source.earlier));
  if (!result.framePositions.empty()) // of sheets that were moved there are none
  {
    quadrille::addFrame(mapped, result.frame, result.framePositions);
  }
  quadrille::addFields(mapped, quadrille::methodFields(options.method));
  quadrille::addFields(
    mapped, quadrille::anisotropyFields(options.anisotropyLimit, result.beyondAnisotropyLimit));
  quadrille::addFields(mapped, quadrille::certificateFields(result.certificate));
  quadrille::addCount(mapped, "Charts", result.charts.charts);
  quadrille::addCount(mapped, "SeamEdges", result.charts.seamEdges);
}

} // namespace

/// What is written of one block.
struct vtkQuadRemesh::RunOfBlock
{
  const quadrille::ConvertedSurface& converted;
  const quadrille::AskedConstraints& asked;
  const quadrille::RemeshResult& result;
  const quadrille::SymmetricResult* symmetric; ///< null where nothing symmetric was asked for
  const quadrille::PiecesResult* pieces;       ///< null where the surface was not cut
};

//------------------------------------------------------------------------------
vtkQuadRemesh::vtkQuadRemesh()
{
  this->SetNumberOfInputPorts(7);
  this->SetNumberOfOutputPorts(8);
}

vtkQuadRemesh::~vtkQuadRemesh() = default;

//------------------------------------------------------------------------------
int vtkQuadRemesh::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == 6)
  {
    info->Set(vtkAlgorithm::INPUT_IS_REPEATABLE(), 1);
  }
  return this->Superclass::FillInputPortInformation(port, info);
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::SetKeepLevels(vtkTypeBool on)
{
  if (!on)
  {
    this->VisitStates(
      [](quadrille::BlockState& state)
      {
        state.memory.reset();
        state.earlier.clear();
      });
  }
  if (this->KeepLevels != on)
  {
    this->KeepLevels = on;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
double vtkQuadRemesh::GetRememberedMegabytes() const
{
  std::size_t bytes = 0;
  this->VisitStates(
    [&bytes](quadrille::BlockState& state)
    {
      bytes += state.memory ? state.memoryAs<LevelMemory>().levels.bytes() : 0;
      bytes += state.bytesOfEarlier();
    });
  return 1e-6 * static_cast<double>(bytes);
}

//------------------------------------------------------------------------------
vtkPolyData* vtkQuadRemesh::GetPolyDataOutputAt(int port)
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(port));
}

//------------------------------------------------------------------------------
const char* vtkQuadRemesh::GetBlockType(int outputPort) const
{
  return outputPort == 6 ? "vtkTable" : "vtkPolyData";
}

//------------------------------------------------------------------------------
vtkTable* vtkQuadRemesh::GetConstraintTable()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(6));
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::CheckProperties() const
{
  if (this->MaximumNumberOfQuads < 1)
  {
    throw quadrille::InvalidInput("MaximumNumberOfQuads must be at least 1");
  }
  if (this->SmoothingSteps < 0)
  {
    throw quadrille::InvalidInput("SmoothingSteps must be at least 0");
  }
  if (this->Preview && this->Symmetry != SYMMETRY_NONE)
  {
    throw quadrille::InvalidInput(
      "there is no preview of symmetric quads: switch Preview or Symmetry off");
  }
  if (this->Preview && this->Method == METHOD_SEAMLESS)
  {
    throw quadrille::InvalidInput("the method 'seamless' makes no quads, so there is nothing to "
                                  "preview: switch Preview off or choose another method");
  }
  if (this->Method == METHOD_SEAMLESS && !this->ComputeMappedSurface)
  {
    throw quadrille::InvalidInput(
      "the method 'seamless' makes no quads, and its result, the mapped surface, is "
      "switched off: switch ComputeMappedSurface on or choose another method");
  }
}

//------------------------------------------------------------------------------
quadrille::RemeshOptions vtkQuadRemesh::MakeRunOptions(const quadrille::Block& block)
{
  quadrille::RemeshOptions options = this->MakeOptions(block);
  options.maximumNumberOfQuads = static_cast<std::size_t>(this->MaximumNumberOfQuads);
  options.smoothingSteps = this->SmoothingSteps;
  if (this->MemoryLimit > 0)
  {
    options.memoryLimit = 1e6 * this->MemoryLimit;
  }
  options.method = static_cast<quadrille::MapMethod>(this->Method);
  options.coarsestIntegers = this->Integers == INTEGERS_COARSEST;
  options.anisotropyLimit = this->AnisotropyLimit;
  this->SetSizes(options);
  if (this->CurvatureGuides)
  {
    options.curvatureGuides = this->LeastAnisotropy;
  }
  options.closeHandles = this->CloseHandles;
  options.smallDetails = static_cast<quadrille::SmallDetails>(this->SmallDetails);
  options.removeSmallComponents = this->SmallComponents == REMOVE_SMALL_COMPONENTS;
  options.finalQuality = static_cast<quadrille::FinalQuality>(this->FinalQuality);
  options.distortionMetric = this->DistortionMetric != 0;
  options.mergeCharts = this->ComputeMappedSurface != 0;
  options.keepsPositions = this->ComputeMappedSurface != 0 || this->Symmetry != SYMMETRY_NONE ||
    this->CellDataFrom != CELL_DATA_FROM_CENTRE;
  options.progress = this->MakeProgress(0.02, 0.95);
  options.warmStart = this->WarmStart != 0;
  options.preview = this->Preview != 0;
  return options;
}

//------------------------------------------------------------------------------
quadrille::SymmetricResult vtkQuadRemesh::RunPipeline(quadrille::SurfaceInput surface,
  const quadrille::RemeshOptions& options, quadrille::ResultStore* levels)
{
  if (this->Symmetry == SYMMETRY_NONE)
  {
    quadrille::SymmetricResult plain;
    plain.remeshed = levels != nullptr ? quadrille::remesh(std::move(surface), options, *levels)
                                       : quadrille::remesh(std::move(surface), options);
    return plain;
  }
  quadrille::SymmetryOptions symmetry;
  symmetry.planeCurve = static_cast<quadrille::PlaneCurve>(this->PlaneCurve);
  if (this->Symmetry == SYMMETRY_PLANE)
  {
    symmetry.plane = quadrille::MirrorPlane{ quadrille::Vector3(this->SymmetryOrigin),
      quadrille::Vector3(this->SymmetryNormal) };
  }
  if (this->Symmetry == SYMMETRY_AXIS || this->Symmetry == SYMMETRY_AXIS_FOUND)
  {
    symmetry.rotation = quadrille::RotationRequest{ this->RotationOrder, std::nullopt };
  }
  if (this->Symmetry == SYMMETRY_AXIS)
  {
    symmetry.rotation->axis = quadrille::RotationAxis{ quadrille::Vector3(this->SymmetryOrigin),
      quadrille::Vector3(this->SymmetryNormal) };
  }
  return quadrille::remeshSymmetric(std::move(surface), options, symmetry, levels);
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::TellRun(quadrille::Block& block, const quadrille::RemeshResult& result)
{
  if (!result.stopped.empty())
  {
    this->KeepSoFar();
  }
  quadrille::BlockReport& report = block.state->report;
  report.reusedStages = result.reused;
  report.numbers["TargetQuads"] = static_cast<double>(result.targetQuads);
  this->SetStageRecords(result.stages);
  this->SetCertificate(result.certificate);
  const quadrille::SmallParts& parts = result.smallParts;
  report.numbers["Handles"] = static_cast<double>(parts.handles);
  report.numbers["UnresolvedHandles"] = static_cast<double>(parts.unresolvedHandles);
  if (result.targetEdgeLength > 0) // what is refused before has none
  {
    report.numbers["ShortestLoopOverEdgeLength"] = parts.shortestLoop / result.targetEdgeLength;
    report.numbers["ShortestBoundaryOverEdgeLength"] =
      parts.boundary.shortest / result.targetEdgeLength;
  }
  for (const std::string& notice : result.notices)
  {
    this->AddNotice(notice);
  }
  quadrille::requireOk(result.status, "remeshing");
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::Execute(quadrille::Block& block)
{
  this->CheckProperties();
  vtkPolyData* input = block.input();
  quadrille::RemeshOptions options = this->MakeRunOptions(block);
  quadrille::AskedConstraints asked;
  const std::unique_ptr<quadrille::TriangleSource> toCut = this->TrianglesToCut(block, options);
  const bool isThinned = !toCut && this->IsWorthThinning(block, options);
  quadrille::ConvertedSurface converted =
    toCut ? this->ConvertForPieces(block) : this->ConvertInputs(block, &asked);
  quadrille::PiecesResult pieces;
  LevelMemory* memory = this->KeepLevels ? &block.state->memoryAs<LevelMemory>() : nullptr;
  if (memory != nullptr && options.mergeCharts)
  {
    options.knownMap = memory->mapped.mapFor(input, this->TextureCoordinates);
  }
  quadrille::ResultStore* levels = memory != nullptr ? &memory->levels : nullptr;
  const auto run = [&](quadrille::SurfaceInput surface, const quadrille::RemeshOptions& how)
  {
    if (!toCut && !isThinned)
    {
      return this->RunPipeline(std::move(surface), how, levels);
    }
    pieces = toCut ? quadrille::remeshInPieces(*toCut, how)
                   : quadrille::remeshThinned(std::move(surface), how);
    quadrille::SymmetricResult plain;
    plain.remeshed = std::move(pieces.remeshed);
    return plain;
  };
  std::vector<std::string> notices;
  const quadrille::SymmetricResult made = quadrille::asksForMoves(asked.placed)
    ? quadrille::remeshWithMoves(converted.input, options, run, asked.placed, notices)
    : run(std::move(converted.input), options);
  for (const std::string& notice : notices)
  {
    this->AddWarning(notice);
  }
  const quadrille::RemeshResult& result = made.remeshed;
  asked.curves = result.curves;
  this->TellRun(block, result);
  if (options.preview)
  {
    this->WritePreview(block, asked, result);
    return;
  }
  const RunOfBlock whole{ converted, asked, result,
    this->Symmetry != SYMMETRY_NONE ? &made : nullptr, toCut || isThinned ? &pieces : nullptr };
  this->WriteQuads(block, whole);
  if (!block.path.empty() && options.quads && !options.coarsestIntegers &&
    isFarFrom(*options.quads, block))
  {
    this->AddNotice("has " + std::to_string(result.quads.quads.size()) +
      " quads where its share is " + std::to_string(*options.quads) +
      ": its topology and its features take so many");
  }
  if (this->ComputeMappedSurface)
  {
    vtkPolyData* mapped = block.output(1);
    if (result.mapIsKnown)
    {
      mapped->ShallowCopy(memory->mapped.surface);
    }
    else
    {
      vtkPolyData* earlier =
        memory != nullptr ? memory->mapped.sameTriangles(result, input) : nullptr;
      writeMapped(
        result, options, { input, &converted, this->TextureCoordinates != 0, earlier }, mapped);
    }
    if (memory != nullptr)
    {
      memory->mapped = { input, input->GetMTime(), this->TextureCoordinates, result.mapKey,
        vtkSmartPointer<vtkPolyData>::New(), result.surface.hash, result.frame.reversed,
        MappedOutput::cellStamps(input) };
      memory->mapped.surface->ShallowCopy(mapped);
    }
  }
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::WriteQuads(quadrille::Block& block, const RunOfBlock& run)
{
  const quadrille::RemeshResult& result = run.result;
  vtkPolyData* input = block.input();
  quadrille::QuadSource source = sourceOf(result.surface, run.converted, input);
  source.cellDataFrom = static_cast<quadrille::CellDataFrom>(this->CellDataFrom);
  source.threads = this->NumberOfThreads;
  if (run.symmetric != nullptr)
  {
    quadrille::addMirrorSources(*run.symmetric, run.converted, input, source);
  }
  if (run.pieces != nullptr)
  {
    quadrille::addPieceSources(*run.pieces, result.quads, run.converted, input, source);
    const std::string cut = run.pieces->pieces > 1
      ? "the surface was cut into " + std::to_string(run.pieces->pieces) + " pieces, which were"
      : "the surface was";
    this->AddNotice(cut + " thinned out to " + std::to_string(run.pieces->joinedTriangles) +
      " triangles before quads were made; the certificate is that of their map (Pieces Never, "
      "--pieces never, keeps the surface whole)");
  }
  const quadrille::QuadOutputs written =
    quadrille::writeOutputs(result.quads, result.surface.mesh, result.uv, source);
  std::vector<std::string>& notices = block.state->report.notices;
  notices.insert(notices.end(), written.notCarried.begin(), written.notCarried.end());
  for (const std::string& warning : quadrille::missedValences(run.asked.placed, result.quads))
  {
    notices.push_back(warning);
    vtkWarningMacro(<< warning);
  }
  vtkPolyData* quads = block.output(0);
  quads->ShallowCopy(written.quads);
  quadrille::addFields(quads, quadrille::runFields(result));
  quadrille::addFields(
    quads, quadrille::methodFields(static_cast<quadrille::MapMethod>(this->Method)));
  quadrille::addFields(
    quads, quadrille::anisotropyFields(this->AnisotropyLimit, result.beyondAnisotropyLimit));
  if (run.symmetric != nullptr)
  {
    quadrille::addSymmetry(quads, *run.symmetric);
  }
  block.output(2)->ShallowCopy(written.lines);
  block.output(3)->ShallowCopy(written.separatrices);
  block.output(4)->ShallowCopy(written.irregular);
  std::vector<quadrille::ConstraintWord> words =
    quadrille::judgeConstraints(run.asked, result.quads,
      quadrille::valuesOf(written.quads->GetPointData()->GetArray(quadrille::arrays::kSizing)));
  const std::vector<std::string> off = quadrille::offSurfaceNotices(words);
  notices.insert(notices.end(), off.begin(), off.end());
  quadrille::addText(quads, "Notices", notices);
  block.output(5)->ShallowCopy(quadrille::writeConstraints(
    run.asked.placed, run.asked.curves, result.quads, quadrille::metOfDrawn(words, run.asked)));
  if (run.symmetric != nullptr)
  {
    words.push_back(quadrille::judgeSymmetry(*run.symmetric));
    quadrille::addMirrorLines(block.output(5), *run.symmetric, words.back().isMet);
  }
  block.outputTable(6)->ShallowCopy(quadrille::writeConstraintTable(words));
  block.output(7)->ShallowCopy(
    quadrille::writeSmallDetails(result.details, result.givenUpFeatures));
  block.state->report.result =
    resultText(result, written.irregular->GetNumberOfPoints()) + constraintText(words);
  block.state->report.numbers["ActualQuads"] = static_cast<double>(quads->GetNumberOfPolys());
}

//------------------------------------------------------------------------------
std::vector<vtkQuadrilleAlgorithm::Together> vtkQuadRemesh::FindTogether(
  const std::vector<quadrille::Block*>& blocks)
{
  if (!this->Conforming || blocks.size() < 2)
  {
    return this->Superclass::FindTogether(blocks);
  }
  // What cannot be read is executed alone, where it says why.
  std::vector<quadrille::SurfaceInput> parts;
  for (const quadrille::Block* block : blocks)
  {
    try
    {
      parts.push_back(quadrille::convertSurface(block->input(), "", this->NumberOfThreads).input);
    }
    catch (const quadrille::InvalidInput&)
    {
      parts.emplace_back();
    }
  }
  const quadrille::PartContacts contacts = quadrille::findContacts(addressesOf(parts));
  std::map<quadrille::Index, Together> groups;
  for (std::size_t i = 0; i < blocks.size(); ++i)
  {
    groups[contacts.group[i]].blocks.push_back(i);
  }
  if (contacts.loosePoints > 0)
  {
    std::ostringstream text;
    text << contacts.loosePoints << " points of blocks lie at points of others where no edges have "
         << "equal ends, one of '" << blocks[contacts.looseParts[0]]->name << "' and '"
         << blocks[contacts.looseParts[1]]->name << "' at "
         << quadrille::placeText(contacts.loosePlace)
         << ": quads do not meet there; along a common curve both need the same points";
    groups[contacts.group[contacts.looseParts[0]]].notices.push_back(text.str());
  }
  std::vector<Together> all;
  for (const auto& [first, together] : groups)
  {
    all.push_back(together);
  }
  return all;
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::ExecuteTogether(const std::vector<quadrille::Block*>& blocks)
{
  this->CheckProperties();
  if (this->Symmetry != SYMMETRY_NONE)
  {
    throw quadrille::InvalidInput(
      "conforming blocks cannot be made symmetric: switch Conforming or "
      "Symmetry off");
  }
  std::vector<quadrille::ConvertedSurface> converted;
  std::vector<quadrille::AskedConstraints> asked(blocks.size());
  std::vector<quadrille::SurfaceInput> parts;
  for (std::size_t i = 0; i < blocks.size(); ++i)
  {
    this->SayOf(*blocks[i]);
    converted.push_back(this->ConvertInputs(*blocks[i], &asked[i]));
    parts.push_back(std::move(converted.back().input));
    if (quadrille::asksForMoves(asked[i].placed))
    {
      throw quadrille::InvalidInput("irregular vertices of conforming blocks cannot be moved: take "
                                    "the moves away, or switch Conforming off");
    }
  }
  this->SayOf(*blocks.front());
  const quadrille::PartContacts contacts = quadrille::findContacts(addressesOf(parts));
  const bool hasSheets = contacts.manyFaced > 0;
  if (hasSheets)
  {
    this->CheckSheets(parts, contacts, blocks);
  }
  quadrille::RemeshOptions options = this->MakeRunOptions(*blocks.front());
  options.preview = false; // what it leaves out is needed to take the quads apart
  std::vector<double> shares, sizes;
  this->ShareQuads(blocks, options, shares, sizes);
  quadrille::JoinedParts joined = quadrille::joinParts(std::move(parts), contacts);
  this->AddNotice(togetherText(blocks, contacts));
  // Faces that several blocks share are made once, but are quads of each.
  double oncePerFace = 1;
  if (hasSheets)
  {
    oncePerFace = areaOfPolygons(quadrille::cutIntoSheets(joined.input, std::nullopt).input) /
      areaOfPolygons(joined.input);
    if (options.quads)
    {
      options.quads = static_cast<std::size_t>(
        std::max(1L, std::lround(oncePerFace * static_cast<double>(*options.quads))));
    }
    else if (this->TargetType == TARGET_RELATIVE_EDGE_LENGTH && !options.edgeLength)
    {
      options.edgeLength = this->RelativeEdgeLength * quadrille::diagonalOf(joined.input);
    }
  }
  quadrille::RemeshResult result;
  std::vector<quadrille::PartResult> results;
  if (hasSheets)
  {
    quadrille::JointSheets sheets;
    quadrille::MetSheets met;
    result = this->RunSheets(*blocks.front(), joined, options, sizes, sheets, met);
    this->TellRun(*blocks.front(), result);
    quadrille::requireOk(met.status, "conforming blocks");
    this->AddNotice(sheetsText(met));
    results = quadrille::splitSheets(result, joined, sheets, met);
  }
  else
  {
    std::optional<quadrille::JointSheets> none;
    result = this->RunJoined(
      *blocks.front(), joined, options, sizes, none, quadrille::TouchingSheets::Joined);
    this->TellRun(*blocks.front(), result);
    results = quadrille::splitParts(result, joined);
  }
  std::vector<std::size_t> withoutQuads;
  for (std::size_t i = 0; i < blocks.size(); ++i)
  {
    quadrille::Block& block = *blocks[i];
    const quadrille::RemeshResult& own = results[i].result;
    results[i].result.targetQuads = static_cast<std::size_t>(
      std::lround(shares[i] * static_cast<double>(result.targetQuads) / oncePerFace));
    asked[i].curves = own.curves;
    if (own.quads.quads.empty() && this->Method != METHOD_SEAMLESS)
    {
      withoutQuads.push_back(i);
    }
    this->WriteQuads(block, { converted[i], asked[i], own, nullptr, nullptr });
    quadrille::reverseQuads(block.output(0), results[i].reversed);
    quadrille::addText(block.output(0), "ConformingWith", namesOfOthers(blocks, i));
    block.state->report.numbers["TargetQuads"] = static_cast<double>(own.targetQuads);
    if (options.quads && !options.coarsestIntegers && isFarFrom(own.targetQuads, block))
    {
      this->SayOf(block);
      this->AddNotice("has " + std::to_string(own.quads.quads.size()) +
        " quads where its share is " + std::to_string(own.targetQuads) +
        ": where it meets others it has as many edges as they have");
    }
    if (this->ComputeMappedSurface)
    {
      writeMapped(own, options,
        { block.input(), &converted[i], this->TextureCoordinates != 0, nullptr }, block.output(1));
    }
  }
  if (!withoutQuads.empty())
  {
    this->SayOf(*blocks.front());
    this->AddNotice(withoutQuadsText(blocks, withoutQuads));
  }
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::ShareQuads(const std::vector<quadrille::Block*>& blocks,
  quadrille::RemeshOptions& options, std::vector<double>& shares, std::vector<double>& sizes)
{
  // The least number that a small block gets for itself is no matter here: those without a number of their own have
  // one edge length.
  const bool isShared = this->QuadsAre == QUADS_ARE_SHARED_BY_AREA;
  std::vector<double> areas;
  double area = 0, all = 0, sharedArea = 0, sharedQuads = 0;
  for (const quadrille::Block* block : blocks)
  {
    areas.push_back(quadrille::areaOf(block->input()));
    const std::optional<std::size_t> quads = this->MakeOptions(*block).quads;
    shares.push_back(quads ? static_cast<double>(*quads) : areas.back());
    area += areas.back();
    all += shares.back();
    sharedArea += block->ownTarget > 0 ? 0 : areas.back();
    sharedQuads += block->ownTarget > 0 ? 0 : shares.back();
  }
  for (std::size_t i = 0; i < blocks.size(); ++i)
  {
    if (isShared && !(blocks[i]->ownTarget > 0) && sharedArea > 0)
    {
      shares[i] = sharedQuads * areas[i] / sharedArea;
    }
  }
  if (options.quads)
  {
    options.quads = static_cast<std::size_t>(std::lround(all));
  }
  for (std::size_t i = 0; i < blocks.size(); ++i)
  {
    shares[i] /= all;
    sizes.push_back(std::sqrt(areas[i] / area / shares[i]));
  }
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::CheckSheets(const std::vector<quadrille::SurfaceInput>& parts,
  const quadrille::PartContacts& contacts, const std::vector<quadrille::Block*>& blocks) const
{
  std::string names;
  for (const quadrille::Index part : contacts.manyFacedParts)
  {
    names += (names.empty() ? "'" : "' and '") + blocks[part]->name;
  }
  const std::string where = "more than two sheets meet, of " + names + "' near " +
    quadrille::placeText(contacts.manyFacedPlace);
  if (this->Method == METHOD_SEAMLESS)
  {
    throw quadrille::InvalidInput(where +
      ", which takes quads to be conforming: choose another method than 'seamless', or switch "
      "Conforming off");
  }
  if (std::any_of(parts.begin(), parts.end(),
        [](const quadrille::SurfaceInput& part) { return !part.curves.empty(); }))
  {
    throw quadrille::InvalidInput(where +
      ": there are no connections and cycles with that. Take them away, or switch Conforming off");
  }
}

//------------------------------------------------------------------------------
quadrille::RemeshResult vtkQuadRemesh::RunJoined(quadrille::Block& first,
  quadrille::JoinedParts& joined, const quadrille::RemeshOptions& options,
  const std::vector<double>& sizes, std::optional<quadrille::JointSheets>& sheets,
  quadrille::TouchingSheets touching)
{
  quadrille::ResultStore* levels =
    this->KeepLevels ? &first.state->memoryAs<LevelMemory>().levels : nullptr;
  const auto run = [&]()
  {
    if (!sheets)
    {
      return this->RunPipeline(joined.input, options, levels).remeshed;
    }
    sheets = quadrille::cutIntoSheets(joined.input, options.featureAngle, touching);
    const quadrille::PlaceFold fold(
      [&sheets](const quadrille::Vector3& place) { return sheets->movedBack(place); });
    return this->RunPipeline(std::move(sheets->input), options, levels).remeshed;
  };
  constexpr double nothing = 0.01;
  const bool isUniform = std::all_of(
    sizes.begin(), sizes.end(), [](double size) { return std::abs(size - 1) < nothing; });
  if (isUniform)
  {
    return run();
  }
  // Sizes that differ between parts may leave no map, as they ask for irregular vertices where features leave no room:
  // then the parts get sizes half as far from each other, and at last one.
  const std::vector<float> asked = joined.input.sizing;
  for (const double share : { 1.0, 0.5, 0.0 })
  {
    std::vector<double> factors;
    for (const double size : sizes)
    {
      factors.push_back(std::pow(size, share));
    }
    joined.input.sizing = share > 0 ? sizesOf(joined, asked, factors) : asked;
    const bool isLast = share == 0;
    quadrille::RemeshResult result = run();
    joined.input.sizing = asked;
    if (isLast || result.status.ok() || result.status.code == quadrille::StatusCode::Cancelled ||
      result.status.code == quadrille::StatusCode::TooLarge)
    {
      if (share < 1)
      {
        this->AddNotice(
          std::string("with the sizes that the blocks' own numbers of quads ask for there "
                      "is no map: ") +
          (isLast ? "all blocks have quads of one size"
                  : "the sizes differ half as much between blocks"));
      }
      return result;
    }
  }
  throw std::logic_error("no run was the last one");
}

//------------------------------------------------------------------------------
quadrille::RemeshResult vtkQuadRemesh::RunSheets(quadrille::Block& first,
  quadrille::JoinedParts& joined, const quadrille::RemeshOptions& options,
  const std::vector<double>& sizes, quadrille::JointSheets& sheets, quadrille::MetSheets& met)
{
  const std::vector<quadrille::Vector3> jointPoints = joined.input.points;
  quadrille::RemeshResult result;
  for (const auto touching : { quadrille::TouchingSheets::Joined, quadrille::TouchingSheets::Left })
  {
    std::optional<quadrille::JointSheets> cut;
    cut.emplace();
    quadrille::RemeshResult made = this->RunJoined(first, joined, options, sizes, cut, touching);
    const bool hasQuads = made.status.ok();
    const bool isStopped = made.status.code == quadrille::StatusCode::Cancelled ||
      made.status.code == quadrille::StatusCode::TooLarge;
    quadrille::MetSheets meeting;
    if (hasQuads)
    {
      meeting = quadrille::meetAtJoints(
        made, *cut, jointPoints, this->SmoothingSteps, this->NumberOfThreads);
    }
    const bool isFirst = touching == quadrille::TouchingSheets::Joined;
    const bool isGood = hasQuads && meeting.status.ok();
    if (isFirst || isGood)
    {
      sheets = std::move(*cut);
      met = std::move(meeting);
      result = std::move(made);
    }
    if (isGood && sheets.touching > 0)
    {
      this->AddNotice(touchingText(sheets));
    }
    if (isGood || isStopped ||
      (isFirst &&
        quadrille::cutIntoSheets(joined.input, std::nullopt, quadrille::TouchingSheets::Left)
            .touching == 0))
    {
      break;
    }
  }
  return result;
}

//------------------------------------------------------------------------------
std::string vtkQuadRemesh::ReasonForWhole() const
{
  if (this->Symmetry != SYMMETRY_NONE)
  {
    return "symmetric quads need the whole surface";
  }
  if (this->Preview)
  {
    return "a preview has no quads on the surface";
  }
  if (this->Method == METHOD_SEAMLESS)
  {
    return "the method 'seamless' makes no quads";
  }
  if (this->CellDataFrom != CELL_DATA_FROM_CENTRE)
  {
    return "cell data by area need all cells under a quad";
  }
  return {};
}

//------------------------------------------------------------------------------
std::string vtkQuadRemesh::ReasonNotToCut(const quadrille::Block& block) const
{
  const std::string reason = this->ReasonForWhole();
  if (!reason.empty())
  {
    return reason;
  }
  if (this->ComputeMappedSurface)
  {
    return "the mapped surface is that of the whole (Compute Mapped Surface)";
  }
  if (this->FinalQuality == Input)
  {
    return "final quality on the input needs the map of the whole surface";
  }
  if (!this->GetGuideArrayInUse().empty())
  {
    return "directions by an array are those of the whole surface";
  }
  for (std::size_t port = 1; port < block.inputs.size(); ++port)
  {
    vtkPolyData* constraints = block.input(static_cast<int>(port));
    if (constraints && constraints->GetNumberOfPoints() > 0)
    {
      return "constraints are drawn on the whole surface";
    }
  }
  const std::string array = quadrille::constrainingArray(block.input(), this->PatchArrayName);
  return array.empty() ? "" : "the array " + array + " constrains the whole surface";
}

//------------------------------------------------------------------------------
std::unique_ptr<quadrille::TriangleSource> vtkQuadRemesh::TrianglesToCut(
  const quadrille::Block& block, const quadrille::RemeshOptions& options) const
{
  vtkPolyData* input = block.input();
  const auto cells = static_cast<std::size_t>(input->GetNumberOfPolys());
  constexpr std::size_t leastWithLevels = 10000000; // what is held of the whole would be gigabytes
  if (this->Pieces == PIECES_NEVER || quadrille::isJoined(input) ||
    (this->Pieces == PIECES_AUTOMATIC &&
      cells < (this->KeepLevels ? leastWithLevels : quadrille::kTrianglesWorthPieces)))
  {
    return nullptr;
  }
  std::string reason = this->ReasonNotToCut(block);
  std::unique_ptr<quadrille::TriangleSource> triangles;
  if (reason.empty())
  {
    triangles = quadrille::trianglesOf(input);
    reason = triangles ? ""
                       : "it has polygons that are no triangles, or points that are not float "
                         "or double";
  }
  if (this->Pieces == PIECES_AUTOMATIC)
  {
    return triangles && quadrille::isWorthPieces(*triangles, options) ? std::move(triangles)
                                                                      : nullptr;
  }
  if (!triangles)
  {
    throw quadrille::InvalidInput(
      "the surface cannot be cut into pieces: " + reason + "; set Pieces to Automatic or Never");
  }
  return triangles;
}

//------------------------------------------------------------------------------
bool vtkQuadRemesh::IsWorthThinning(
  const quadrille::Block& block, const quadrille::RemeshOptions& options) const
{
  vtkPolyData* input = block.input();
  if (this->Pieces != PIECES_AUTOMATIC || this->KeepLevels || quadrille::isJoined(input) ||
    static_cast<std::size_t>(input->GetNumberOfPolys()) < quadrille::kTrianglesWorthThinning ||
    !this->ReasonNotToCut(block).empty())
  {
    return false;
  }
  const std::unique_ptr<quadrille::TriangleSource> triangles = quadrille::trianglesOf(input);
  return triangles && quadrille::isWorthThinning(*triangles, options);
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::SetSizes(quadrille::RemeshOptions& options) const
{
  if (this->ChordError > 0)
  {
    options.sizes.chordError = this->ChordError;
  }
  options.sizes.gapQuads = this->GapQuads;
  options.sizes.smallest = this->SmallestSize;
  options.sizes.largest = this->LargestSize;
}

//------------------------------------------------------------------------------
std::string vtkQuadRemesh::ReasonNotToSpread(
  const std::vector<vtkSmartPointer<vtkPolyData>>& pieces) const
{
  const std::string reason = this->ReasonForWhole();
  return reason.empty() ? quadrille::reasonNotToSpread(pieces, this->GetGuideArrayInUse()) : reason;
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::PlanSpread(const quadrille::Block& block, const quadrille::SpreadSize& size,
  quadrille::SpreadPlan& plan) const
{
  quadrille::RemeshOptions options = this->MakeOptions(block);
  this->SetSizes(options);
  plan.piece = quadrille::pieceOptionsOf(options, size.area, size.diagonal);
  plan.patchArray = this->PatchArrayName;
  plan.guideArray = this->GetGuideArrayInUse();
  plan.memoryLimit = 1e6 * this->MemoryLimit;
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::WritePreview(quadrille::Block& block, const quadrille::AskedConstraints& asked,
  const quadrille::RemeshResult& result)
{
  const quadrille::QuadOutputs written = quadrille::writePreview(result.quads);
  vtkPolyData* quads = block.output(0);
  quads->ShallowCopy(written.quads);
  quadrille::addFields(quads, quadrille::runFields(result));
  quadrille::addText(quads, "Notices", this->GetBlockNotices());
  block.output(4)->ShallowCopy(written.irregular);
  const std::vector<quadrille::ConstraintWord> words =
    quadrille::judgeConstraints(asked, result.quads, {});
  block.output(5)->ShallowCopy(quadrille::writeConstraints(
    asked.placed, asked.curves, result.quads, quadrille::metOfDrawn(words, asked)));
  block.outputTable(6)->ShallowCopy(quadrille::writeConstraintTable(words));
  block.output(7)->ShallowCopy(
    quadrille::writeSmallDetails(result.details, result.givenUpFeatures));
  this->SetResult("preview: " + resultText(result, written.irregular->GetNumberOfPoints()) +
    constraintText(words));
  block.state->report.numbers["ActualQuads"] = static_cast<double>(quads->GetNumberOfPolys());
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::AddSettings(std::ostream& os) const
{
  this->Superclass::AddSettings(os);
  const double* origin = this->SymmetryOrigin;
  const double* normal = this->SymmetryNormal;
  os << "Method " << this->Method << '\n'
     << "Integers " << this->Integers << '\n'
     << "AnisotropyLimit " << this->AnisotropyLimit << '\n'
     << "ChordError " << this->ChordError << '\n'
     << "GapQuads " << this->GapQuads << '\n'
     << "SmallestSize " << this->SmallestSize << '\n'
     << "LargestSize " << this->LargestSize << '\n'
     << "CurvatureGuides " << this->CurvatureGuides << '\n'
     << "LeastAnisotropy " << this->LeastAnisotropy << '\n'
     << "SmoothingSteps " << this->SmoothingSteps << '\n'
     << "CloseHandles " << this->CloseHandles << '\n'
     << "SmallDetails " << this->SmallDetails << '\n'
     << "SmallComponents " << this->SmallComponents << '\n'
     << "SpreadSurfaces " << this->SpreadSurfaces << '\n'
     << "Pieces " << this->Pieces << '\n'
     << "WarmStart " << this->WarmStart << '\n'
     << "Preview " << this->Preview << '\n'
     << "Conforming " << this->Conforming << '\n'
     << "FinalQuality " << this->FinalQuality << '\n'
     << "DistortionMetric " << this->DistortionMetric << '\n'
     << "CellDataFrom " << this->CellDataFrom << '\n'
     << "Symmetry " << this->Symmetry << '\n'
     << "PlaneCurve " << this->PlaneCurve << '\n'
     << "SymmetryOrigin " << origin[0] << ' ' << origin[1] << ' ' << origin[2] << '\n'
     << "SymmetryNormal " << normal[0] << ' ' << normal[1] << ' ' << normal[2] << '\n'
     << "RotationOrder " << this->RotationOrder << '\n'
     << "ComputeMappedSurface " << this->ComputeMappedSurface << '\n'
     << "TextureCoordinates " << this->TextureCoordinates << '\n';
  if (this->FinalQuality != Coarse)
  {
    os << "MemoryLimit " << this->MemoryLimit << '\n'; // by which the finer map may be left out
  }
}

//------------------------------------------------------------------------------
bool vtkQuadRemesh::AllowsEarlier(const quadrille::BlockReport& report) const
{
  const auto quads = report.numbers.find("ActualQuads");
  return quads == report.numbers.end() ||
    quads->second <= static_cast<double>(this->MaximumNumberOfQuads);
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "Integers: " << this->Integers << "\n";
  os << indent << "AnisotropyLimit: " << this->AnisotropyLimit << "\n";
  os << indent << "MaximumNumberOfQuads: " << this->MaximumNumberOfQuads << "\n";
  os << indent << "SmoothingSteps: " << this->SmoothingSteps << "\n";
  os << indent << "MemoryLimit: " << this->MemoryLimit << "\n";
  os << indent << "ChordError: " << this->ChordError << "\n";
  os << indent << "GapQuads: " << this->GapQuads << "\n";
  os << indent << "SmallestSize: " << this->SmallestSize << "\n";
  os << indent << "LargestSize: " << this->LargestSize << "\n";
  os << indent << "CurvatureGuides: " << this->CurvatureGuides << "\n";
  os << indent << "LeastAnisotropy: " << this->LeastAnisotropy << "\n";
  os << indent << "CloseHandles: " << this->CloseHandles << "\n";
  os << indent << "SmallDetails: " << this->SmallDetails << "\n";
  os << indent << "SmallComponents: " << this->SmallComponents << "\n";
  os << indent << "SpreadSurfaces: " << this->SpreadSurfaces << "\n";
  os << indent << "Pieces: " << this->Pieces << "\n";
  os << indent << "KeepLevels: " << this->KeepLevels << "\n";
  os << indent << "WarmStart: " << this->WarmStart << "\n";
  os << indent << "Preview: " << this->Preview << "\n";
  os << indent << "Conforming: " << this->Conforming << "\n";
  os << indent << "ReusedStagesText: " << this->GetReusedStagesText() << "\n";
  os << indent << "RememberedMegabytes: " << this->GetRememberedMegabytes() << "\n";
  os << indent << "FinalQuality: " << this->FinalQuality << "\n";
  os << indent << "DistortionMetric: " << this->DistortionMetric << "\n";
  os << indent << "CellDataFrom: " << this->CellDataFrom << "\n";
  os << indent << "Symmetry: " << this->Symmetry << "\n";
  os << indent << "PlaneCurve: " << this->PlaneCurve << "\n";
  os << indent << "SymmetryOrigin: " << this->SymmetryOrigin[0] << " " << this->SymmetryOrigin[1]
     << " " << this->SymmetryOrigin[2] << "\n";
  os << indent << "SymmetryNormal: " << this->SymmetryNormal[0] << " " << this->SymmetryNormal[1]
     << " " << this->SymmetryNormal[2] << "\n";
  os << indent << "RotationOrder: " << this->RotationOrder << "\n";
  os << indent << "ComputeMappedSurface: " << this->ComputeMappedSurface << "\n";
  os << indent << "TextureCoordinates: " << this->TextureCoordinates << "\n";
  os << indent << "TargetQuads: " << this->GetTargetQuads() << "\n";
  os << indent << "ActualQuads: " << this->GetActualQuads() << "\n";
  os << indent << "Handles: " << this->GetHandles() << "\n";
  os << indent << "UnresolvedHandles: " << this->GetUnresolvedHandles() << "\n";
  os << indent << "ShortestLoopOverEdgeLength: " << this->GetShortestLoopOverEdgeLength() << "\n";
  os << indent << "ShortestBoundaryOverEdgeLength: " << this->GetShortestBoundaryOverEdgeLength()
     << "\n";
}
