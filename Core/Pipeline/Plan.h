// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// All that one attempt may do otherwise than another: a value, so that an attempt that leads nowhere leaves nothing
/// behind.
#pragma once

#include "Base/TryCount.h"
#include "Base/Types.h"
#include "Mesh/Requests.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

/// What levels are made for.
struct LevelPlan
{
  std::vector<Index>
    keptVertices; ///< that no level may lack, ascending; those of index constraints among them
  Index coarseVertices = 1000; ///< budget, see HierarchyOptions
  double edgeLength = 1;       ///< over that of the quads
};

/// A place near which features were given up.
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

  /// Those of the next round, too, which need not find out again what the coarse map needs.
  LevelPlan levels;

  // Of the surface, see withPlan.
  std::shared_ptr<const std::vector<float>> sizes;           ///< #V; null: those of the surface
  std::shared_ptr<const std::vector<Index>> featuresGivenUp; ///< half-edges; null: none
  std::shared_ptr<const std::vector<ValenceRequest>> counterparts; ///< more of them; null: none
  int featureDrops = 0;             ///< how often features were given up
  std::vector<FeatureDrop> dropped; ///< where

  // Of the map.
  double quads = 0; ///< that it is scaled to

  std::vector<std::string> notices; ///< what the user should know of the choices
};

} // namespace quadrille
