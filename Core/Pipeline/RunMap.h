// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What attempts make and results show: a map of the coarse level and of the surface, and its quads.
#pragma once

#include "Base/FixedPoint.h"
#include "Extraction/Extraction.h"
#include "Hierarchy/Hierarchy.h"
#include "Mesh/Requests.h"
#include "Pipeline/FinalQuality.h"
#include "Transfer/Transfer.h"

#include <vector>

namespace quadrille
{

struct RunMap
{
  Level coarse;
  std::vector<FixedVec2> coarseUv; ///< #H of coarse.mesh; also where the map has failed, for a look
  std::vector<int> coarseTurns;    ///< #V of coarse.mesh
  Certificate coarseCertificate;
  /// What became of the surface's curves, in their order.
  std::vector<CurveOutcome> curves;
  /// Ends, corners and bends of features and boundaries, ascending by vertex of the surface.
  std::vector<SectorRequest> onFeatures;

  // Where the map was carried to the surface, which for a preview it is not.
  std::vector<FixedVec2> uv; ///< #H of the surface
  std::vector<int> turns;    ///< #V of the surface
  Certificate certificate;
  TransferResult transfer; ///< but for uv

  /// A point inside of each face between features that was filled with quads without a map.
  std::vector<Vector3> withoutMap;
};

struct RunQuads
{
  QuadMesh quads;
  ExtractionCounts extraction;     ///< what the map on the surface made necessary
  FinalQualityReport finalQuality; ///< zero unless asked for
};

} // namespace quadrille
