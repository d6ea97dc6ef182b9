// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Puts what is asked for at points and along paths into the triangulation of a surface: vertices where points are,
/// edges where paths run. Splits change no shape; new vertices have their sources as those of refinement have.
#pragma once

#include "Mesh/Surface.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

/// Where the edges of a face are below this, in s, its points take the nearest of its vertices, which is not farther
/// away than kTakenVertex: quads do not tell, and the surface, with its levels, stays as it is.
constexpr double kFineForPlaces = 0.35;
constexpr double kTakenVertex = 0.21;

struct InsertionOptions
{
  double edgeLength = 0; ///< s: of the quads, in units of the mesh; > 0
  int threads = 0;       ///< 0: all; the result does not depend on it
};

/// Makes the features: each of their points becomes a vertex, and a path of edges, straight across faces, runs from one
/// to the next, see pathOnMesh. Where the mesh is so fine that quads do not tell, points and paths take the vertices
/// that are there. Returns the paths. A piece between two points on different components is left out, and told in
/// notices, with the places.
///
/// toCurves: of each line how near its begin and its end, in units of the mesh, may lie to a feature or boundary
/// without being on it; empty: as near as they are. What is drawn beyond such a curve and stays so near to where it
/// passes it is cut off, and what ends before it is led to it: a line that ends beside a curve would leave quads there
/// that are as narrow as what is between the two.
std::vector<std::vector<Vector3>> insertFeatures(PreparedSurface& surface,
  const std::vector<FeatureRequest>& features, const InsertionOptions& options,
  std::vector<std::string>& notices, const std::vector<std::array<double, 2>>& toCurves = {});

/// Of features and boundaries of a mesh the place nearest to a point, at most so far away; none: there is none.
std::optional<Vector3> nearestOnCurves(const Mesh& mesh, const Vector3& p, double within);

/// Makes the sizes of vertices within the radii of the requests, with as many vertices there as it takes. orders: #V,
/// those of the sizes that there are, or empty.
void insertSizes(PreparedSurface& surface, const std::vector<SizeRequest>& sizes,
  std::vector<int> orders, const InsertionOptions& options);

struct InsertedValences
{
  bool splitConstraint = false;     ///< whether an edge on features or the boundary was split
  std::vector<std::string> notices; ///< valences that are left out, with their places, and why
};

/// Adds valence requests of vertices at the places, which become vertices; ascending by vertex. Of two that ask for
/// different valences of one vertex the later one is left out, and a valence below 3 on the boundary.
InsertedValences insertValences(PreparedSurface& surface, const std::vector<ValencePlace>& valences,
  const InsertionOptions& options);

} // namespace quadrille
