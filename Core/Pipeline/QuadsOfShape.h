// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// How many quads a surface gets where nobody has said how many: so many that shapes the eye sees do not melt. An edge
/// over which the surface turns by more than kMostTurn does not show its shape; on kMostMelted of the area that is let
/// be, and where it is more, the number grows in steps until it is not, or to the last step.
#pragma once

#include "Base/Angles.h"
#include "Pipeline/Options.h"
#include "Pipeline/ResultStore.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace quadrille
{

struct PreparedSurface;

/// The least number; and the steps of its growth, as multiples of it.
constexpr std::size_t kLeastQuadsOfShape = 5000;
constexpr std::array<double, 5> kGrowthOfQuads{ 1, 1.4, 2, 2.8, 4 };
constexpr double kMostTurn = radians(45);
constexpr double kMostMelted = 0.05;

/// Asks for as many quads as the shape needs. No size was asked for before.
void askForQuadsOfShape(RemeshOptions& options);

/// Whether the number may grow. It does not where sizes follow the shape already, nor where the most quads that may be
/// made are less than twice the last step: quads come in larger numbers than are asked for.
bool growsQuads(const RemeshOptions& options);
/// The most that it may be; none where an edge length is asked for.
std::optional<std::size_t> mostQuads(const RemeshOptions& options);

/// The number that a run was for; none where an edge length was asked for. target: RemeshResult::targetQuads.
std::optional<std::size_t> quadsAsked(const RemeshOptions& options, std::size_t target);

/// The share of the area of the mesh on which it turns by more than `turn` (radians) over an edge: where its normal
/// curvature, averaged over a disk one edge wide that features end, is above turn / edgeLength. Looked at in 1,000
/// places, which are spread evenly over the area. Lengths in units of the mesh, edgeLength > 0.
double shareThatTurns(const Mesh& mesh, double edgeLength, double turn, int threads);

/// What was found of a surface.
struct QuadsOfShape
{
  std::size_t quads = 0;
  double meltedBefore = 0; ///< share of the area, with the least number
  double melted = 0;       ///< the same, with quads

  /// What to tell; empty where the number has not grown.
  std::string text(std::size_t least) const;
};

/// sizedArea: as targetEdgeLength takes it.
QuadsOfShape quadsOfShape(
  const PreparedSurface& surface, double sizedArea, const RemeshOptions& options);

/// Where the number may grow: sets it, so that it grows no more. surface: prepared. key: of the surface, in the store;
/// null: no store. Returns what to tell.
std::string settleQuads(const PreparedSurface& surface, double sizedArea, ResultStore* store,
  ResultKey key, RemeshOptions& options);

} // namespace quadrille
