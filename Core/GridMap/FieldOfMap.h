// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The cross field of a grid map, straight along the lines that the map has to have, and what becomes of these.
#pragma once

#include "GridMap/GridMap.h"
#include "Requests/SeamRequests.h"

#include <vector>

namespace quadrille
{

class FieldOfMap
{
public:
  /// All of these stay for as long as it does; `result` gets the field, and later the outcome of the curves.
  /// hasStraightLines: whether no irregular vertex may lie on lines.
  FieldOfMap(
    const Mesh& mesh, const GridMapOptions& options, bool hasStraightLines, GridMapResult& result)
    : mesh_(mesh), options_(options), hasStraightLines_(hasStraightLines), result_(result)
  {
  }

  /// False where the mesh lacks one of them.
  bool findSeams();
  void computeField();
  /// In the map as it came out, whatever was asked of it.
  void judgeLines();

private:
  CurveOutcome outcomeOf(const CurveRequest& curve) const;

  const Mesh& mesh_;
  const GridMapOptions& options_;
  bool hasStraightLines_;
  GridMapResult& result_;
  std::vector<SeamEdges> seams_;
  std::vector<std::vector<Index>> straight_;
};

/// A map of one try: its field, the maps of its components, and these as one. hasStraightLines: see FieldOfMap.
GridMapResult mapInOneTry(const Mesh& mesh, const GridMapOptions& options, bool hasStraightLines);

} // namespace quadrille
