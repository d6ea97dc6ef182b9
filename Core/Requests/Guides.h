// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a user asks of single places: directions of the quads' edges (guides) and valences of vertices
/// (index constraints) [Ebke et al. 2016, Section 4]. Nothing here takes memory where nothing is asked.
#pragma once

#include "Mesh/Requests.h"

#include <cstddef>
#include <string>
#include <vector>

namespace quadrille
{

struct Mesh;
struct SurfaceInput;
struct PreparedSurface;

/// Throws InvalidInput, naming the polygon or point, for arrays of wrong size, directions that are not finite, weights
/// outside (0, 1] where there is a direction, and valences other than 0 and 2 to 8.
void checkRequests(const SurfaceInput& input);

/// Fills polygonGuides, valenceRequests and unusedValences of a surface that has its final corners. Throws InvalidInput
/// where points that became one vertex ask for different valences, and for a valence below 3 on the boundary.
/// The same for any number of threads, as below.
void collectRequests(const SurfaceInput& input, PreparedSurface& surface, int threads);

/// Finds the faces that the surface's strokes guide, once the surface has its final faces, and again where these have
/// changed. edgeLength: of the quads.
void placeStrokes(PreparedSurface& surface, double edgeLength, int threads);

/// Guides of the faces of the mesh, ascending by face: of polygons and of strokes.
struct SurfaceGuides
{
  std::vector<FaceGuide> faces;
  std::size_t dropped = 0; ///< faces whose direction is normal to them; they are free
};
SurfaceGuides surfaceGuides(const PreparedSurface& surface, int threads);

/// Vertices that have to be irregular and stay where they are when quads are smoothed, ascending.
std::vector<Index> heldIndexVertices(const PreparedSurface& surface);

/// All that have to stay on every level: those that have to be irregular, the held ones on features, and ends of seams
/// and straight parts; ascending. A vertex that is to be regular needs not stay for that.
std::vector<Index> keptVertices(const PreparedSurface& surface);

/// Valences asked of the vertices of a level, given by their ids on the finest one; 0 where free. With regularElsewhere
/// all others off the level's features and boundary are to be regular. Empty when none is asked.
std::vector<int> levelValences(
  const PreparedSurface& surface, const Mesh& level, const std::vector<Index>& fineVertex);

/// What became of requests that the surface cannot take; empty when all are honoured.
std::vector<std::string> requestNotices(
  const PreparedSurface& surface, const SurfaceGuides& guides);

} // namespace quadrille
