// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Pure quad remeshing of triangle surfaces, for C++ programs: one function, its options and its result. All types are
/// of the standard library; the shared library behind it needs neither VTK nor Eigen of who uses it.
///
///     quadrille::TriangleMesh mesh; // points and triangles
///     quadrille::QuadOptions options;
///     options.quads = 2000;
///     const quadrille::QuadResult result = quadrille::makeQuads(mesh, options);
///
/// In CMake: find_package(Quadrille), target_link_libraries(program Quadrille::quadrille). Within a
/// major version names here stay, and so does the binary interface, which the soname libquadrille.so.MAJOR tells; a
/// minor version may add some. A new major version is another library, which can be installed beside the old one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#if defined(__GNUC__)
#define QUADRILLE_API __attribute__((visibility("default")))
#else
#define QUADRILLE_API
#endif

namespace quadrille
{

using PointId = std::uint32_t; ///< place in a list of points, triangles or quads

/// A triangle surface: open or closed, of any genus, with any number of components. Defects (points that coincide,
/// degenerate and duplicate triangles, edges of more than two, orientations that disagree) are repaired, and told.
struct TriangleMesh
{
  std::vector<std::array<double, 3>> points;     ///< #P; finite, in any unit
  std::vector<std::array<PointId, 3>> triangles; ///< #T; counterclockwise seen from outside
  /// Empty or #T: edges that have to become edges of quads; bit i: that from corner i to corner i+1.
  std::vector<std::uint8_t> featureEdges;
  /// Empty or #T: an edge between two values has to become edges of quads.
  std::vector<std::int64_t> patchIds;
  /// Empty or #T: a direction that edges of the quads should have in the triangle, of any length; zero: free.
  std::vector<std::array<double, 3>> guidingDirections;
  /// Empty or #P: the edge length that quads should have there over that of options, > 0.
  std::vector<float> sizing;
};

/// At most one of the three sizes is given. Where none is, 5000 quads are asked for, or up to 20000 where the shape of
/// the surface would melt with fewer; a notice tells how many then.
struct QuadOptions
{
  std::optional<std::size_t> quads;         ///< about so many, >= 1
  std::optional<double> edgeLength;         ///< in units of the points, > 0
  std::optional<double> relativeEdgeLength; ///< over the diagonal of the bounding box, > 0
  /// Edges where the normals of the two triangles differ by more than this, and that belong to a crease, become edges
  /// of quads; degrees in (0, 180]; none: no such edges are looked for.
  std::optional<double> featureAngle = 40;
  int smoothingSteps = 5;              ///< sweeps in which the points move over the surface, >= 0
  std::size_t maximumQuads = 10000000; ///< more are refused, >= 1
  int threads = 0;                     ///< 0: all; the result does not depend on it
  /// Called on the caller's thread, many times a second, with the part that is done, from 0 to 1, and what is being
  /// done. Returning false stops the run. It must not throw.
  std::function<bool(double fraction, const std::string& what)> progress;
};

/// A place on the triangle mesh that was given.
struct SurfacePlace
{
  PointId triangle = 0;
  std::array<PointId, 3>
    points{}; ///< the triangle's corners; of repaired ones those in their place
  std::array<double, 3> weights{}; ///< barycentric, of these points; they sum to 1
};

struct QuadResult
{
  std::vector<std::array<double, 3>> points;        ///< #Q; in units of the input
  std::vector<std::array<PointId, 4>> quads;        ///< counterclockwise seen from outside
  std::vector<SurfacePlace> pointPlaces;            ///< #Q: where the points lie
  std::vector<PointId> quadTriangles;               ///< one a quad: a triangle under its centre
  std::vector<std::array<PointId, 2>> featureEdges; ///< edges of quads on features, by their points
  double edgeLength = 0;                            ///< that was aimed at, in units of the input
  /// What the user should know, one sentence each: repairs, features that the quads do not follow, ...
  std::vector<std::string> notices;
  /// Empty, or why the run ended before it was done: `progress` asked for it when there were quads already. They are
  /// valid; another run may end with others.
  std::string stopped;
};

/// What makeQuads throws, beside std::bad_alloc.
class QUADRILLE_API QuadError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// The mesh or an option cannot be used; the message names the element and what is wrong with it.
class QUADRILLE_API InputError : public QuadError
{
public:
  using QuadError::QuadError;
};

/// There are no valid quads of this size; the message says why, where, and what can be done.
class QUADRILLE_API NoQuadsError : public QuadError
{
public:
  using QuadError::QuadError;
};

/// `progress` asked to stop before there were any quads.
class QUADRILLE_API StoppedError : public QuadError
{
public:
  using QuadError::QuadError;
};

/// Quads of the surface: the same bytes for the same input and options, whatever the number of threads. Several threads
/// may call it at once. Throws InputError, NoQuadsError or StoppedError.
QUADRILLE_API QuadResult makeQuads(const TriangleMesh& mesh, const QuadOptions& options = {});

/// The version of the library that is loaded, as MAJOR.MINOR.PATCH.
QUADRILLE_API const char* libraryVersion();

} // namespace quadrille
