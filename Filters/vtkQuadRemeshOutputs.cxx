// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadRemesh.h"

#include "Base/PlaceText.h"
#include "Base/Types.h"
#include "Blocks/Blocks.h"
#include "Common/Report.h"
#include "Constraints/ConstraintTable.h"
#include "Constraints/Constraints.h"
#include "Convert/PolyData.h"
#include "Convert/Quads.h"
#include "Quads/QuadShape.h"
#include "Runs/Problems.h"
#include "Runs/RunOfBlock.h"
#include "Runs/SmallDetails.h"
#include "Runs/Symmetry.h"
#include "Ways/Ways.h"

#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace
{

quadrille::QuadSource sourceOf(const quadrille::QuadsMade& made,
  const quadrille::ConvertedSurface& converted, vtkPolyData* input, int threads)
{
  quadrille::QuadSource source;
  source.carrier = input;
  source.patchArray = converted.patchArray;
  source.threads = threads;
  source.carrierCell = [&made, &converted](quadrille::Index face)
  { return converted.cell(made.polygonOf(face)); };
  const std::vector<quadrille::SourceLocation> ofPoints = made.pointSources(threads);
  for (const quadrille::SourceLocation& at : ofPoints)
  {
    source.pointOrigins.push_back(quadrille::pointOrigin(at, converted, input));
    source.pointCells.push_back(converted.cell(at.polygon));
  }
  for (const quadrille::Index polygon : made.quadPolygons(ofPoints))
  {
    source.quadCells.push_back(converted.cell(polygon));
  }
  return source;
}

std::vector<quadrille::Vector3> middlesOfInverted(const quadrille::QuadMesh& quads)
{
  std::vector<quadrille::Vector3> middles;
  for (const quadrille::Index q : quadrille::invertedQuads(quads.points, quads.quads))
  {
    quadrille::Vector3 sum = quadrille::Vector3::Zero();
    for (const quadrille::Index p : quads.quads[q])
    {
      sum += quads.points[p];
    }
    middles.push_back(sum / 4);
  }
  return middles;
}

/// What is wrong comes first.
std::string defectText(
  const quadrille::RemeshResult& result, const std::vector<quadrille::Vector3>& inverted)
{
  std::ostringstream text;
  const quadrille::FailedParts& failed = result.failed;
  if (failed.components > 0)
  {
    text << failed.countText() << ", without quads: ";
  }
  if (!inverted.empty())
  {
    text << inverted.size()
         << (inverted.size() == 1 ? " quad inverted near " : " quads inverted, one near ")
         << quadrille::placeText(inverted.front()) << ": ask for smaller quads. ";
  }
  return text.str();
}

/// asked: what the run was asked for, without sizes.
std::string resultText(
  const quadrille::RemeshResult& result, vtkIdType irregular, const quadrille::RemeshOptions& asked)
{
  std::ostringstream text;
  if (result.quads.quads.empty())
  {
    text << "No quads, as the method makes none: the mapped surface is the result.";
    return text.str();
  }
  const char* const who = !asked.growsWithShape ? "asked for"
    : result.targetQuads > *asked.quads         ? "for its shape"
                                                : "by default";
  text << result.quads.quads.size() << " quads (about " << result.targetQuads << ' ' << who << "), "
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

} // namespace

//------------------------------------------------------------------------------
void vtkQuadRemesh::WriteQuads(quadrille::Block& block, const quadrille::RunOfBlock& run)
{
  const quadrille::RemeshResult& result = run.made.remeshed;
  const std::optional<quadrille::MadeSymmetry>& symmetry = run.made.symmetry;
  vtkPolyData* input = block.input();
  quadrille::QuadSource source = sourceOf(run.made, run.converted, input, this->NumberOfThreads);
  source.cellDataFrom = static_cast<quadrille::CellDataFrom>(this->CellDataFrom);
  const quadrille::QuadOutputs written =
    quadrille::writeOutputs(result.quads, result.surface.mesh, result.uv, source);
  std::vector<std::string>& notices = block.state->report.notices;
  notices.insert(notices.end(), written.notCarried.begin(), written.notCarried.end());
  vtkPolyData* quads = block.output(0);
  quads->ShallowCopy(written.quads);
  quadrille::addFields(quads, quadrille::runFields(result));
  quadrille::addFields(
    quads, quadrille::methodFields(static_cast<quadrille::MapMethod>(this->Method)));
  quadrille::addFields(
    quads, quadrille::anisotropyFields(this->AnisotropyLimit, result.beyondAnisotropyLimit));
  if (symmetry)
  {
    quadrille::addSymmetry(quads, *symmetry);
  }
  block.output(2)->ShallowCopy(written.lines);
  block.output(3)->ShallowCopy(written.separatrices);
  block.output(4)->ShallowCopy(written.irregular);
  std::vector<quadrille::ConstraintWord> words =
    quadrille::judgeConstraints(run.asked, result.quads,
      quadrille::valuesOf(written.quads->GetPointData()->GetArray(quadrille::arrays::kSizing)));
  const std::vector<std::string> off = quadrille::offSurfaceNotices(words);
  notices.insert(notices.end(), off.begin(), off.end());
  for (const std::string& warning : quadrille::unmetNotices(words, run.asked))
  {
    notices.push_back(warning);
    this->WarnInForeground(warning);
  }
  quadrille::addText(quads, "Notices", notices);
  block.output(5)->ShallowCopy(quadrille::writeConstraints(
    run.asked.placed, result.quads, quadrille::metOfDrawn(words, run.asked)));
  if (symmetry)
  {
    words.push_back(quadrille::judgeSymmetry(*symmetry));
    quadrille::addMirrorLines(block.output(5), result.quads, *symmetry, words.back().isMet);
  }
  block.outputTable(6)->ShallowCopy(quadrille::writeConstraintTable(words));
  block.output(7)->ShallowCopy(
    quadrille::writeSmallDetails(result.details, result.givenUpFeatures));
  quadrille::Problems problems;
  problems.failed = result.failed.places;
  problems.inverted = middlesOfInverted(result.quads);
  problems.surface = result.failed.components > 0 ? input : nullptr;
  problems.isWhole = false;
  for (const quadrille::Index polygon : result.failed.polygons)
  {
    problems.cells.push_back(run.converted.cell(polygon));
  }
  const std::string defect = defectText(result, problems.inverted);
  problems.words = { defect };
  block.output(this->GetProblemPort())->ShallowCopy(quadrille::writeProblems(problems));
  block.state->report.hasDefect = !defect.empty();
  block.state->report.numbers["InvertedQuads"] = static_cast<double>(problems.inverted.size());
  block.state->report.result = defect +
    resultText(result, written.irregular->GetNumberOfPoints(), this->MakeOptions(block)) +
    (defect.empty() && !result.quads.quads.empty() ? ", all valid" : "") + constraintText(words);
  block.state->report.numbers["ActualQuads"] = static_cast<double>(quads->GetNumberOfPolys());
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
  block.output(5)->ShallowCopy(
    quadrille::writeConstraints(asked.placed, result.quads, quadrille::metOfDrawn(words, asked)));
  block.outputTable(6)->ShallowCopy(quadrille::writeConstraintTable(words));
  block.output(7)->ShallowCopy(
    quadrille::writeSmallDetails(result.details, result.givenUpFeatures));
  this->SetResult("preview: " +
    resultText(result, written.irregular->GetNumberOfPoints(), this->MakeOptions(block)) +
    constraintText(words));
  block.state->report.numbers["ActualQuads"] = static_cast<double>(quads->GetNumberOfPolys());
}
