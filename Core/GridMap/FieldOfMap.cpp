// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/FieldOfMap.h"

#include "Base/Clock.h"
#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "CrossField/CrossField.h"
#include "Requests/CycleSectors.h"
#include "Requests/StraightRequests.h"

#include <algorithm>
#include <utility>

namespace quadrille
{

void FieldOfMap::computeField()
{
  const TimedScope timed(result_.secondsField, result_.processorField);
  CrossFieldOptions fieldOptions;
  fieldOptions.targetEdgeLength = options_.edgeLength;
  fieldOptions.progress = subProgress(options_.progress, 0.0, 0.1);
  fieldOptions.guides = options_.guides;
  fieldOptions.targetValences = options_.targetValences;
  fieldOptions.sizes = options_.sizes;
  fieldOptions.regular.assign(options_.fewIrregular ? mesh_.vertexCount() : 0, 1);
  fieldOptions.sectorTurns =
    straightSectors(mesh_, straight_, seamSectors(mesh_, seams_, options_.sectorTurns));
  if (try_.straightCycles && hasCycles(options_.curves))
  {
    fieldOptions.sectorTurns = straightAlong(
      mesh_, edgesOfCycles(mesh_, options_.curves, onCycle()), std::move(fieldOptions.sectorTurns));
  }
  result_.field = computeCrossField(mesh_, fieldOptions);
  if (!options_.curves.empty() && makesLines() && result_.field.status.ok())
  {
    followCurves(fieldOptions);
  }
  result_.field.stretch = options_.stretch;
  result_.field.seams = seams_;
}

bool FieldOfMap::findSeams()
{
  seams_ = quadrille::findSeams(mesh_, options_.seams);
  if (std::any_of(seams_.begin(), seams_.end(), [](const SeamEdges& s) { return s.empty(); }))
  {
    result_.status = { StatusCode::Infeasible,
      "the coarse mesh does not have the two sides of the cut" };
    return false;
  }
  straight_ = findStraightParts(mesh_, options_.straight);
  if (std::any_of(
        straight_.begin(), straight_.end(), [](const auto& part) { return part.empty(); }))
  {
    result_.status = { StatusCode::Infeasible,
      "the coarse mesh does not have a part of the boundary that is to be straight" };
    return false;
  }
  return true;
}

void FieldOfMap::followCurves(CrossFieldOptions fieldOptions)
{
  std::vector<FollowedCurve> curves;
  for (std::size_t i = 0; i < options_.curves.size(); ++i)
  {
    if (!isLeftOut(i) && options_.curves[i].kind == CurveKind::Connection)
    {
      curves.push_back({ options_.curves[i], wayOf(i) });
    }
  }
  if (curves.empty())
  {
    return;
  }
  CurvesInField followed =
    followedCurves(mesh_, result_.field, curves, options_.edgeLength, options_.guides);
  fieldOptions.guides = std::move(followed.guides);
  fieldOptions.lines = std::move(followed.lines);
  fieldOptions.regular = std::move(followed.regular);
  for (const bool all : { true, false })
  {
    if (all && !try_.holdsIrregular)
    {
      continue;
    }
    fieldOptions.targetValences = all ? valencesOf(mesh_, result_.field, options_.targetValences)
                                      : valencesWithEnds(mesh_, result_.field, curves,
                                          options_.edgeLength, options_.targetValences);
    const bool isOther = !all && try_.holdsIrregular;
    countTry(Try::IrregularAtEnds, isOther ? 1 : 0);
    CrossField led = computeCrossField(mesh_, fieldOptions);
    if (led.status.ok())
    {
      countTryLed(Try::IrregularAtEnds, isOther ? 1 : 0);
      holdsIrregular_ = all;
      result_.field = std::move(led);
      return;
    }
    result_.curvesFailedAt = std::move(led.failedAt);
  }
}

void FieldOfMap::addLines()
{
  for (std::size_t i = 0; i < options_.curves.size(); ++i)
  {
    if (options_.curves[i].kind == CurveKind::Cycle)
    {
      lines_.emplace_back();
      lines_.back().outcome.start = lines_.back().outcome.end = options_.curves[i].points.front();
      continue;
    }
    lines_.push_back(lineOf(mesh_, result_.field, options_.curves[i], options_.edgeLength));
    RequestedLine& line = lines_.back();
    if (isLeftOut(i))
    {
      line.outcome.why = try_.leftOut[i];
    }
    else if (line.hasLine && makesLines())
    {
      // A way of an earlier try may join other vertices than those that are irregular now.
      const std::optional<Isoline> way = wayOf(i);
      if (way && mesh_.origin[way->start] == line.outcome.from &&
        mesh_.origin[way->end] == line.outcome.to)
      {
        line.line = *way;
        line.line.axis = axisAlong(mesh_, result_.field, line.line);
      }
      result_.field.isolines.push_back(line.line);
    }
  }
}

void FieldOfMap::judgeCycle(const CurveRequest& cycle, CurveOutcome& outcome) const
{
  outcome.met = result_.status.ok() &&
    isStraightAlong(mesh_, edgesOfCycles(mesh_, { cycle }, onCycle()), result_.field.sectorTurns);
  if (result_.status.ok() && !outcome.met)
  {
    outcome.why = "features and irregular vertices leave the quads no room to go straight on along "
                  "it: draw it farther from them, or ask for smaller quads";
  }
}

void FieldOfMap::judgeLines()
{
  for (std::size_t i = 0; i < lines_.size(); ++i)
  {
    RequestedLine& line = lines_[i];
    if (options_.curves[i].kind == CurveKind::Cycle)
    {
      judgeCycle(options_.curves[i], line.outcome);
      result_.curves.push_back(line.outcome);
      continue;
    }
    if (result_.status.ok() && line.isWanted() && makesLines())
    {
      line.outcome.met = hasGridLine(mesh_, result_.field, result_.uv, line, options_.edgeLength);
      if (!line.outcome.met && line.outcome.why.empty())
      {
        line.outcome.why =
          "an irregular vertex stands in the way of the line: move it aside, or draw another way";
      }
    }
    if (!makesLines())
    {
      line.outcome.why = std::string("the method '") + nameOf(options_.method) +
        "' makes no connections: choose scale aware";
    }
    if (line.outcome.met)
    {
      line.outcome.why.clear();
    }
    result_.curves.push_back(line.outcome);
  }
}

} // namespace quadrille
