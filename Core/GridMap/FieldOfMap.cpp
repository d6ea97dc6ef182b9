// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/FieldOfMap.h"

#include "Base/Clock.h"
#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "CrossField/CrossField.h"
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
    if (!isLeftOut(i))
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
    if (led.status.ok() && (!all || cyclesClose(led, curves)))
    {
      countTryLed(Try::IrregularAtEnds, isOther ? 1 : 0);
      holdsIrregular_ = all;
      result_.field = std::move(led);
      return;
    }
    result_.curvesFailedAt = std::move(led.failedAt);
  }
}

bool FieldOfMap::cyclesClose(
  const CrossField& field, const std::vector<FollowedCurve>& curves) const
{
  return std::all_of(curves.begin(), curves.end(),
    [&](const FollowedCurve& followed)
    {
      return followed.curve.kind != CurveKind::Cycle ||
        lineOf(mesh_, field, followed.curve, options_.edgeLength).hasLine;
    });
}

void FieldOfMap::addLines()
{
  for (std::size_t i = 0; i < options_.curves.size(); ++i)
  {
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

void FieldOfMap::judgeLines()
{
  for (RequestedLine& line : lines_)
  {
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
        "' makes no connections and cycles: choose scale aware";
    }
    if (line.outcome.met)
    {
      line.outcome.why.clear();
    }
    result_.curves.push_back(line.outcome);
  }
}

} // namespace quadrille
