// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// All that one attempt may do otherwise than another: a value, so that an attempt that leads nowhere leaves nothing
/// behind.
#pragma once

#include "Base/TryCount.h"
#include "Base/Types.h"
#include "Features/FeatureNetwork.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

/// Where quads of the coarse map touch themselves though it is valid: round handles and thin parts that only one or two
/// quads fit round.
struct GridDefects
{
  std::size_t count = 0;
  std::vector<Vector3> places;
};

/// What was done to make quads fit round small handles and thin parts.
struct FinerGrid
{
  bool mayShrink = true; ///< whether sizes near the places of failures may help
  int shrinks = 0;       ///< how often they were tried
  /// The sizes and the area over them before the first time; null: those of the surface.
  std::shared_ptr<const std::vector<float>> sizesBefore;
  double areaBefore = 0;
  GridDefects firstDefects; ///< that led to the first time
  int doublings = 0;        ///< how often the number of quads was doubled
  std::size_t defects = 0;  ///< of the quads of the coarse map before the last change
  std::string notice;       ///< of the last change
};

/// What levels are made for.
struct LevelPlan
{
  std::vector<Index>
    keptVertices; ///< that no level may lack, ascending; those of index constraints among them
  Index coarseVertices = 1000; ///< budget, see HierarchyOptions
  double edgeLength = 1;       ///< over that of the quads
};

/// A place near which detected features were given up.
struct FeatureDrop
{
  Vector3 place;
  double radius;
};

struct Plan
{
  const char* step =
    "first"; ///< what made it of the one before, a name of the table in Recovery.cpp

  std::vector<Try> made; ///< all that has made it of the first one and still shows, in order
  std::string why;       ///< what was wrong with the attempt before, for the progress text

  LevelPlan levels;
  /// Of the next round: without what was kept for the sake of the map on the surface, but with all that the coarse map
  /// could not do without, so that another round need not find that out again.
  LevelPlan nextLevels;

  // Of the surface, see withPlan.
  std::shared_ptr<const std::vector<float>> sizes;           ///< #V; null: those of the surface
  std::shared_ptr<const std::vector<Index>> featuresGivenUp; ///< half-edges; null: none
  /// Borders of patches that other edges stand for; null: none.
  std::shared_ptr<const MovedFeatures> moved;
  int featureDrops = 0;             ///< how often detected features were given up
  std::vector<FeatureDrop> dropped; ///< where
  int borderDrops = 0;              ///< how often features that were asked for but yield were

  // Of the map.
  double quads = 0; ///< that it is scaled to
  FinerGrid finer;

  std::vector<std::string> notices; ///< what the user should know of the choices
  std::string borderNotice;         ///< of all borders of patches that are given up
};

} // namespace quadrille
