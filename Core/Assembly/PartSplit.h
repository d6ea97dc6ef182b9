// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The result for a joint surface, taken apart again: each part gets its own faces and quads.
#pragma once

#include "Assembly/JoinParts.h"
#include "Assembly/SheetJoints.h"
#include "Pipeline/Pipeline.h"

#include <vector>

namespace quadrille
{

/// What a part has of the result.
struct PartResult
{
  /// surface: its faces, without requests and hash; sourcePolygon and sourcePoints are those of the part, and its
  /// border to other parts is boundary. framePositions, uv, turns (at the border those within the part) and quads are
  /// those of that surface, curves those of the part, details and givenUpFeatures those that lie nearest to it. charts
  /// and targetQuads are 0, the levels are empty, and what else there is tells of the whole run.
  RemeshResult result;
  /// Per quad, whether the part's own polygons there run the other way round: repair gives all parts that hang
  /// together one orientation.
  std::vector<std::uint8_t> reversed;
};

/// Every quad goes to the part of the face under its centre, so none is lost and none is doubled. A point that several
/// parts have is at the same place, to the bit, in each. Where quads of a part meet in a point only, each fan has a
/// point of its own.
std::vector<PartResult> splitParts(const RemeshResult& result, const JoinedParts& joined);

/// The same of a surface that was cut into sheets, which meet again: faces and quads of a polygon that several parts
/// have go to each of them. Sheets of a part have one orientation, and their quads one point where they meet; the
/// surface of a part stays cut there.
std::vector<PartResult> splitSheets(const RemeshResult& result, const JoinedParts& joined,
  const JointSheets& sheets, const MetSheets& met);

} // namespace quadrille
