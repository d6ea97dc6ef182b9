// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/RepairText.h"

namespace quadrille
{

namespace
{

/// A change of count `RepairReport::*count`: "N" and one of the two texts.
struct Sentence
{
  std::size_t RepairReport::*count;
  const char* one;
  const char* many;
};

// In the order in which they are made.
constexpr Sentence kSentences[] = {
  { &RepairReport::triangulatedPolygons,
    " polygon with more than three corners was cut into triangles",
    " polygons with more than three corners were cut into triangles" },
  { &RepairReport::mergedPoints, " point was joined with another one at the same place",
    " points were joined with others at the same place" },
  { &RepairReport::degenerateFaces, " face without area was removed",
    " faces without area were removed" },
  { &RepairReport::flippedCaps, " point beside an edge was made one of the edge",
    " points beside edges were made points of the edges" },
  { &RepairReport::duplicateFaces, " face that was there already was removed",
    " faces that were there already were removed" },
  { &RepairReport::isolatedPoints, " point that no face uses was left out",
    " points that no face uses were left out" },
  { &RepairReport::nonManifoldEdges,
    " edge with more than two faces was cut open, so the quads are not joined there; mend it in "
    "the surface if they should be",
    " edges with more than two faces were cut open, so the quads are not joined there; mend them "
    "in the surface if they should be" },
  { &RepairReport::nonManifoldVertices,
    " point in which parts of the surface only touch was doubled",
    " points in which parts of the surface only touch were doubled" },
  { &RepairReport::reorientedFaces, " face was turned round to agree with its neighbours",
    " faces were turned round to agree with their neighbours" },
  { &RepairReport::removedComponents, " component too small for a quad was removed",
    " components too small for a quad were removed" },
  { &RepairReport::refinedFaces,
    " face larger than the quads was split, which does not change the shape",
    " faces larger than the quads were split, which does not change the shape" },
  { &RepairReport::closedHandles, " small handle was cut and closed, as was asked for",
    " small handles were cut and closed, as was asked for" },
};

} // namespace

std::vector<std::string> repairSentences(const RepairReport& report)
{
  std::vector<std::string> sentences;
  for (const Sentence& sentence : kSentences)
  {
    const std::size_t count = report.*sentence.count;
    if (count > 0)
    {
      sentences.push_back(std::to_string(count) + (count == 1 ? sentence.one : sentence.many));
    }
  }
  return sentences;
}

} // namespace quadrille
