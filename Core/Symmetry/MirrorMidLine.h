// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A mirror plane's curve as the mid-line of quads: each of them is its own image, with two corners in front and two
/// behind. The half in front gets a map with the curve on an isoline and straight, and that boundary then moves by half
/// a quad. So the map of the half and its image is an integer-grid map, with the curve at half numbers, and the quads
/// are those of this map.
#pragma once

#include "Base/Error.h"
#include "Base/FixedPoint.h"
#include "Extraction/Extraction.h"
#include "Features/GivenUpFeatures.h"
#include "Mesh/Surface.h"
#include "Symmetry/MirrorCut.h"
#include "Symmetry/MirrorDouble.h"

#include <string>
#include <vector>

namespace quadrille
{

/// Asks of the half that the plane's curve is straight in its map. tolerance: within which places are in the plane.
/// Throws InvalidInput, with the place, where features meet in the plane: there is no point of the quads.
void askMidLine(MirrorHalf& half, const MirrorPlane& plane, double tolerance);

/// Half-edges, one of each edge, of the features of a surface that lie in the plane between its two sides. Ascending.
std::vector<Index> featuresInPlane(const Mesh& mesh, const MirrorPlane& plane, double tolerance);

/// The length of the half's boundary in the plane, each edge over the size asked for there.
double midLineLength(const MirrorHalf& half, const MirrorPlane& plane, double tolerance);

struct MidLineOptions
{
  double maximumBytes = 0; ///< that may be taken
  int threads = 0;
  ProgressCallback progress;
};

/// The half's map (#H, changed in place) with its boundary in the plane half a quad inside. Rows of quads beside it are
/// evened out; irregular vertices and what lies beyond those rows stay. onFeatures: vertices that must not move
/// beside the irregular ones. Not ok where there is no room, with a place.
Status insetPlane(const PreparedSurface& half, const DoubledMesh& doubled,
  const std::vector<int>& turns, const std::vector<Index>& onFeatures,
  const MidLineOptions& options, std::vector<FixedVec2>& uv);

/// The quads of the doubled map as doubleQuads() has them: those of the half, their images, and then those that are
/// their own images. extracted: of the doubled mesh; its points in front count, those behind become their images. Not
/// ok where there is a pair of points in front and behind that belongs to two quads across the plane.
DoubledQuads foldQuads(
  const QuadMesh& extracted, const DoubledMesh& doubled, const MirrorPlane& plane);

} // namespace quadrille
