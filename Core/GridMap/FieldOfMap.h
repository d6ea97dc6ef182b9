// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The cross field of a grid map, led along the curves that the map has to have, and what becomes of their lines.
#pragma once

#include "GridMap/GridMap.h"
#include "Integers/CurveIsolines.h"
#include "Requests/SeamRequests.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

/// How a map is made that has to have curves.
struct CurveTry
{
  /// Empty, or for each curve why it is no equation; empty texts for those that are.
  std::vector<std::string> leftOut;
  /// Empty, or in place of the ways of the curves where there are some.
  std::vector<std::optional<Isoline>> ways;
  /// Whether all irregular vertices of the field without curves stay, or only those at ends of connections.
  bool holdsIrregular = true;
  int maximumSteps = 0; ///< of the seamless map; 0: as many as it takes
  /// Whether no irregular vertex may lie on cycles.
  bool straightCycles = true;
};

class FieldOfMap
{
public:
  /// All of these stay for as long as it does; `result` gets the field, and later the outcome of the curves.
  FieldOfMap(
    const Mesh& mesh, const GridMapOptions& options, const CurveTry& howto, GridMapResult& result)
    : mesh_(mesh), options_(options), try_(howto), result_(result)
  {
  }

  /// False where the mesh lacks one of them.
  bool findSeams();
  void computeField();
  void addLines();
  /// In the map as it came out, whatever was asked of it.
  void judgeLines();
  /// Of the field that the last run led along the curves.
  bool holdsIrregular() const { return holdsIrregular_; }

private:
  /// The field once more, led along the connections. All its irregular vertices stay, as they are those that the user
  /// has seen; where no field or no map has the lines so, those at the ends of connections only.
  void followCurves(CrossFieldOptions fieldOptions);
  /// Vertices of cycles lie on them but for rounding.
  double onCycle() const { return 1e-6 * options_.edgeLength; }
  void judgeCycle(const CurveRequest& cycle, CurveOutcome& outcome) const;
  /// The others round, or have no integers at all.
  bool makesLines() const { return options_.method == MapMethod::ScaleAware; }

  bool isLeftOut(std::size_t curve) const
  {
    return !try_.leftOut.empty() && !try_.leftOut[curve].empty();
  }

  std::optional<Isoline> wayOf(std::size_t curve) const
  {
    return try_.ways.empty() ? std::nullopt : try_.ways[curve];
  }

  const Mesh& mesh_;
  const GridMapOptions& options_;
  const CurveTry& try_;
  GridMapResult& result_;
  bool holdsIrregular_ = false;
  std::vector<RequestedLine> lines_;
  std::vector<SeamEdges> seams_;
  std::vector<std::vector<Index>> straight_;
};

/// A map of one try: its field, the maps of its components, and these as one.
struct TriedMap
{
  GridMapResult map;
  bool holdsIrregular = false; ///< of the field that was led along the curves
};

TriedMap mapInOneTry(const Mesh& mesh, const GridMapOptions& options, const CurveTry& howto);

} // namespace quadrille
