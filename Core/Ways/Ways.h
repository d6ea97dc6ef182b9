// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The one place that chooses the way of a run: whether the quads are made on all of the surface, on the half or wedge
/// of a symmetry, on its triangles thinned out, or on pieces that are thinned out one by one. The library, Python, the
/// command and the filters ask here, so that the same surface with the same options has the same quads in all of them.
#pragma once

#include "Pieces/RemeshInPieces.h"
#include "Pipeline/Pipeline.h"
#include "Prepare/InputPlaces.h"
#include "Requests/DrawnConstraints.h"
#include "Symmetry/Symmetry.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

enum class Way
{
  Whole,     ///< remesh()
  Symmetric, ///< remeshSymmetric()
  Thinned,   ///< remeshThinned()
  Pieces     ///< remeshInPieces()
};

/// From how many triangles on a surface is cut into pieces, and thinned out as a whole where it is not cut. Pieces hold
/// nothing for the next run, so where a store is there they begin where its levels would be gigabytes.
constexpr std::size_t kTrianglesWorthPieces = 4000000;
constexpr std::size_t kTrianglesWorthMoreThanLevels = 10000000;
constexpr std::size_t kTrianglesWorthThinning = 1000000;
/// And from how many of them a quad: thinned surfaces have about 22.
constexpr double kTrianglesOfQuad = 66;

/// Whether a surface may be thinned out before its quads are made.
enum class Thinning : std::uint8_t
{
  Automatic, ///< cut into pieces, or as a whole, where that saves time and memory
  Always,    ///< cut into pieces, whatever its size
  Never
};

/// A surface as whoever asks has it.
struct GivenSurface
{
  std::size_t polygons = 0;
  /// The triangles where they lie, without a copy; null where they cannot be had, as it has other polygons.
  std::function<std::unique_ptr<TriangleSource>()> triangles;
  /// Why pieces of these triangles are not all that is asked for: "the array Sizing constrains the whole surface".
  std::string whyNotCut;
  /// All of it with what is asked of it; called once, unless it is cut into pieces.
  std::function<SurfaceInput()> whole;
};

/// input: has to be there during the run, which takes it.
GivenSurface given(SurfaceInput& input);

/// Quads of a surface, and what is wanted of them.
struct QuadProblem
{
  GivenSurface surface;
  /// With mergeCharts the map on the triangles of the input is wanted. Positions are kept where that takes
  /// them, whatever keepsPositions is; leavesOutFailed does not count for pieces and with a symmetry.
  RemeshOptions options;
  std::optional<SymmetryOptions> symmetry;
  bool cellsByArea =
    false; ///< the cells of the input under each quad are wanted, by their area in the map
  Thinning thinning = Thinning::Automatic;
  ResultStore* store = nullptr; ///< of earlier runs; null: none
  /// What was drawn, as it lies on the surface when GivenSurface::whole has been called. Moves of irregular vertices
  /// among it are made, and what has no quads is left out, see remeshWithDrawn. Null: nothing.
  std::vector<PlacedConstraint>* placed = nullptr;
  /// What finds places on the surface, to be asked where something was drawn; empty: it is made.
  std::function<const InputPlaces*()> places;
};

/// The quads, whatever the way.
struct QuadsMade
{
  Way way = Way::Whole;
  std::string whyNotThinned; ///< empty where the surface was thinned out
  RemeshResult remeshed;
  std::optional<MadeSymmetry> symmetry;
  std::optional<MadeThinning> thinning;
  std::vector<std::string> warnings; ///< of what was drawn and is left out

  /// Where the points lie on the input. Not of previews.
  std::vector<SourceLocation> pointSources(int threads) const;
  /// Per quad the polygon of the input under its centre. sources: those of the points.
  std::vector<Index> quadPolygons(const std::vector<SourceLocation>& sources) const;
  /// A polygon of the input on the side of features where a face of the mapped surface lies.
  Index polygonOf(Index face) const;
};

/// Why a problem cannot be one of thinned triangles that are spread over ranks; empty: it can.
std::string whyNotSpread(const QuadProblem& problem);

/// Refuses, by InvalidInput, what cannot be together before any work begins; else as remesh() of a surface. Throws
/// InvalidInput, too, where a surface is always to be cut and cannot be, with the reason.
QuadsMade remesh(const QuadProblem& problem);

} // namespace quadrille
