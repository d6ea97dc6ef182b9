// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The sizes that are wanted on a surface: Mesh::sizing times s, the edge length that all quads have without it. Where
/// sizes differ, the map's stages work in the metric in which every quad is one: lengths over the size where they are.
/// A change of the size is a conformal change of the metric, so it has a curvature, and the cross field gets the
/// irregular vertices that let the number of quads side by side grow.
#pragma once

#include "Mesh/Mesh.h"

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

struct SurfaceInput;
struct PreparedSurface;

/// Sizes may differ by this much from one place to another, per distance: neighbouring quads by about a quarter. As in
/// mesh generators, the larger of two sizes gives way [Persson 2006].
constexpr double kSizeGrowth = 0.25;

/// The size at a vertex as a multiple of s; 1 where nothing is asked.
inline double sizeAt(const Mesh& mesh, Index v)
{
  return mesh.sizing.empty() ? 1.0 : double{ mesh.sizing[v] };
}

/// The size along an edge: lengths over it are those of a discrete conformal map [Springborn et al. 2008].
inline double sizeOfEdge(const Mesh& mesh, Index h)
{
  return mesh.sizing.empty()
    ? 1.0
    : std::sqrt(double{ mesh.sizing[mesh.origin[h]] } * double{ mesh.sizing[mesh.target(h)] });
}

/// Length of an edge over its size.
inline double sizedLength(const Mesh& mesh, Index h)
{
  return mesh.sizing.empty() ? mesh.edgeVector(h).norm()
                             : mesh.edgeVector(h).norm() / sizeOfEdge(mesh, h);
}

/// A triangle laid out in the plane with sized lengths: corner 0 at the origin, corner 1 at (width, 0), corner 2 at
/// `apex`.
struct SizedTriangle
{
  double width = 0;
  Vector2 apex = Vector2::Zero();
};
/// Of a face whose sizes differ so much that its sized lengths make no triangle, or hardly one, the face itself over
/// the mean of its sizes.
SizedTriangle sizedTriangle(const Mesh& mesh, Index f);

/// The integral of 1 / size^2 over a face, the size being linear on it: its area in quads of edge length 1.
double sizedArea(const Mesh& mesh, Index f);
/// The same of all faces; the surface's area where nothing is asked.
double sizedArea(const Mesh& mesh);

/// Throws InvalidInput, naming the point, for sizes that are not positive and finite, and for an array of wrong size.
void checkSizing(const SurfaceInput& input);

/// Fills Mesh::sizing of a surface that has its final corners. Of points that became one vertex the smallest size
/// counts.
void collectSizing(const SurfaceInput& input, PreparedSurface& surface);

/// What limiting the growth of sizes has changed.
struct SizingReport
{
  std::size_t changed = 0;      ///< vertices
  double most = 1;              ///< largest factor by which a size was lessened
  Index vertex = kInvalidIndex; ///< where
};
/// Lessens sizes until none grows by more than kSizeGrowth along an edge of the mesh, per length in units of s =
/// edgeLength.
/// Throws InvalidInput unless edgeLength is positive and finite. Without sizes nothing happens.
SizingReport limitSizeGrowth(Mesh& mesh, double edgeLength);

/// Empty, or what the user should know.
std::string sizingNotice(const Mesh& mesh, const SizingReport& report);

} // namespace quadrille
