// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/FieldOfMap.h"

#include "Base/Clock.h"
#include "Base/Progress.h"
#include "CrossField/CrossField.h"
#include "Requests/DrawnLines.h"
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
  if (hasStraightLines_ && hasLines(options_.curves))
  {
    fieldOptions.sectorTurns =
      straightAlong(mesh_, options_.curves, std::move(fieldOptions.sectorTurns));
  }
  result_.field = computeCrossField(mesh_, fieldOptions);
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

CurveOutcome FieldOfMap::outcomeOf(const CurveRequest& curve) const
{
  CurveOutcome outcome;
  outcome.start = curve.points.front();
  outcome.end = curve.kind == CurveKind::Cycle ? outcome.start : curve.points.back();
  outcome.ends = curve.ends;
  if (!curve.isDrawn() || !result_.status.ok())
  {
    return outcome;
  }
  outcome.met = isStraightAlong(mesh_, curve, result_.field.sectorTurns);
  if (!outcome.met)
  {
    outcome.why = "features and irregular vertices leave the quads no room to go straight on along "
                  "it: draw it farther from them, or ask for smaller quads";
  }
  return outcome;
}

void FieldOfMap::judgeLines()
{
  for (const CurveRequest& curve : options_.curves)
  {
    result_.curves.push_back(outcomeOf(curve));
  }
}

} // namespace quadrille
