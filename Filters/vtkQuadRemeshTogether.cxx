// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadRemesh.h"

#include "Assembly/JoinParts.h"
#include "Assembly/JointSheets.h"
#include "Assembly/PartSplit.h"
#include "Assembly/SheetJoints.h"
#include "Base/PlaceText.h"
#include "Blocks/Blocks.h"
#include "Blocks/LevelMemory.h"
#include "Blocks/Together.h"
#include "Common/Report.h"
#include "Convert/MappedOutput.h"
#include "Convert/PolyData.h"
#include "Convert/Quads.h"
#include "Convert/Surfaces.h"
#include "Evaluation/ConstraintMeasures.h"
#include "Evaluation/ConstraintWords.h"
#include "Pipeline/Pipeline.h"
#include "Pipeline/ResultStore.h"
#include "Requests/SurfacePlaces.h"
#include "Runs/RunOfBlock.h"
#include "Session/Moves.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace
{

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

} // namespace

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
    converted.push_back(this->ConvertInputs(*blocks[i], asked[i]));
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
  options.preview =
    false; // what it leaves out is needed to take the quads apart, and so are positions
  options.keepsPositions = true;
  std::vector<double> shares, sizes;
  this->ShareQuads(blocks, options, shares, sizes);
  quadrille::JoinedParts joined = quadrille::joinParts(std::move(parts), contacts);
  this->AddNotice(quadrille::togetherText(blocks, contacts));
  // Faces that several blocks share are made once, but are quads of each.
  double oncePerFace = 1;
  if (hasSheets)
  {
    oncePerFace =
      quadrille::areaOfPolygons(quadrille::cutIntoSheets(joined.input, std::nullopt).input) /
      quadrille::areaOfPolygons(joined.input);
    if (options.quads)
    {
      options.quads = static_cast<std::size_t>(
        std::max(1L, std::lround(oncePerFace * static_cast<double>(*options.quads))));
    }
    else if (this->TargetType == TARGET_RELATIVE_EDGE_LENGTH && !options.edgeLength)
    {
      options.edgeLength = this->RelativeEdgeLength * quadrille::diagonalOf(joined.input.points);
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
    this->AddNotice(quadrille::sheetsText(met));
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
    quadrille::QuadsMade made;
    made.remeshed = std::move(results[i].result);
    quadrille::RemeshResult& own = made.remeshed;
    own.targetQuads = static_cast<std::size_t>(
      std::lround(shares[i] * static_cast<double>(result.targetQuads) / oncePerFace));
    asked[i].curves = own.curves;
    asked[i].edgeLength = quadrille::lengthOfSizeOne(own.targetEdgeLength,
      options.quads ? std::optional<std::size_t>(own.targetQuads) : std::nullopt,
      own.quads.quads.size());
    if (own.quads.quads.empty() && this->Method != METHOD_SEAMLESS)
    {
      withoutQuads.push_back(i);
    }
    this->WriteQuads(block, { converted[i], asked[i], made });
    quadrille::reverseQuads(block.output(0), results[i].reversed);
    quadrille::addText(block.output(0), "ConformingWith", quadrille::namesOfOthers(blocks, i));
    block.state->report.numbers["TargetQuads"] = static_cast<double>(own.targetQuads);
    if (options.quads && !options.coarsestIntegers && quadrille::isFarFrom(own.targetQuads, block))
    {
      this->SayOf(block);
      this->AddNotice("has " + std::to_string(own.quads.quads.size()) +
        " quads where its share is " + std::to_string(own.targetQuads) +
        ": where it meets others it has as many edges as they have");
    }
    if (this->ComputeMappedSurface)
    {
      quadrille::writeMapped(own, options,
        { block.input(), &converted[i], this->TextureCoordinates != 0, nullptr }, block.output(1));
    }
  }
  if (!withoutQuads.empty())
  {
    this->SayOf(*blocks.front());
    this->AddNotice(quadrille::withoutQuadsText(blocks, withoutQuads));
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
  quadrille::QuadProblem problem;
  problem.options = options;
  problem.cellsByArea = this->CellDataFrom != CELL_DATA_FROM_CENTRE;
  problem.thinning = quadrille::Thinning::Never;
  problem.store =
    this->KeepLevels ? &first.state->memoryAs<quadrille::LevelMemory>().levels : nullptr;
  const auto run = [&]()
  {
    quadrille::SurfaceInput whole;
    if (!sheets)
    {
      whole = joined.input;
      problem.surface = quadrille::given(whole);
      return quadrille::remesh(problem).remeshed;
    }
    sheets = quadrille::cutIntoSheets(joined.input, options.featureAngle, touching);
    const quadrille::PlaceFold fold(
      [&sheets](const quadrille::Vector3& place) { return sheets->movedBack(place); });
    problem.surface = quadrille::given(sheets->input);
    return quadrille::remesh(problem).remeshed;
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
    joined.input.sizing = share > 0 ? quadrille::sizesOf(joined, asked, factors) : asked;
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
      this->AddNotice(quadrille::touchingText(sheets));
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
