// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads of surfaces that are too large to be held with all that a run makes of them. The surface is cut into compact
/// pieces of about a million triangles, each is prepared and thinned by itself (SurfacePiece.h), so that what is held
/// of it then are its log and its triangles' numbers; the thinned pieces together are remeshed, and the points of the
/// quads go back to the pieces. Pieces are independent, so that each thread has one, at all stages.
#pragma once

#include "Mesh/Surface.h"
#include "Pipeline/Pipeline.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

/// Triangles wherever they lie: a mapped file, arrays of VTK. Functions are called from several threads.
class TriangleSource
{
public:
  TriangleSource() = default;
  TriangleSource(const TriangleSource&) = delete;
  TriangleSource& operator=(const TriangleSource&) = delete;
  virtual ~TriangleSource() = default;

  virtual std::size_t pointCount() const = 0;    ///< at most 2^32 - 2
  virtual std::size_t triangleCount() const = 0; ///< the same
  /// The corners of the triangles [begin, end): 3 (end - begin) ids of points.
  virtual void corners(std::size_t begin, std::size_t end, Index* ids) const = 0;
  /// The places of these points.
  virtual void positions(const Index* ids, std::size_t count, Vector3* places) const = 0;
};

constexpr std::size_t kTrianglesOfPiece = 1000000;

struct PiecesOptions
{
  std::size_t trianglesOfPiece = kTrianglesOfPiece; ///< about, >= 1000
};

/// How a surface was thinned out before its quads were made, and where these lie on it.
struct MadeThinning
{
  /// Where the points of the quads lie on the triangles of the source. A point whose triangle is none of the source's,
  /// as where a handle was closed, has kInvalidIndex there and the place that it has on the joined surface. Both are
  /// empty of a preview.
  std::vector<SourceLocation> pointSource; ///< #points of the quads
  std::vector<SourceLocation> quadSource;  ///< #quads; the same of their centres
  std::size_t pieces = 0;
  std::size_t joinedTriangles = 0;
  /// Of a surface in one piece: of each thinned triangle a polygon of the input on the same side of features.
  std::vector<Index> polygonBeside;

  /// "the surface was thinned out to 20000 triangles ..."
  std::string text() const;
};

struct PiecesResult : MadeThinning
{
  /// Of the joined surface; points and sources of the quads: see above. Its surface has the thinned triangles. Stages
  /// are cut, thin, join, those of remesh(), and carry; within thin there are thin:repair, thin:order,
  /// thin:connectivity and thin:phase1, whose seconds are sums over the pieces, of which as many run side by side as
  /// there are threads.
  RemeshResult remeshed;
};

/// Where the points lie, and in what polygon the centre of quad q; a place that is missing is that of a point near it
/// along edges. mesh: the quads that were made.
std::vector<SourceLocation> sourcesOfPoints(const MadeThinning& made, const QuadMesh& mesh);
Index sourceOfQuad(const MadeThinning& made, const QuadMesh& mesh,
  const std::vector<SourceLocation>& sourcesOfPoints, std::size_t q);

/// Tells of handles that were cut before the surface was thinned out: they come first.
void tellClosedHandles(const std::vector<SmallDetail>& closed, RemeshResult& result);

/// Makes the quads of a surface that is thinned out first, in one piece (ThinnedSurface.h): stages are repair, order,
/// connectivity, thin, those of remesh() from refine on, and carry. Of a surface that is shifted, scaled or mirrored it
/// makes the same quads, as remesh() does; else as remeshInPieces(). input: all that is asked of it counts, but for
/// guides (see Documentation/Design/Pieces.md), vertices that are held and parts of the boundary that are images of
/// each other or straight: these throw InvalidInput. What is drawn is drawn on the surface itself, and the vertices of
/// target valences stay.
PiecesResult remeshThinned(SurfaceInput input, const RemeshOptions& options);

/// Makes the quads. options: as for remesh(), on the surface as it is: guides, valences, sizes and curves that an input
/// can name are not taken. Throws InvalidInput as remesh() does, naming points and triangles of the source; cancel and
/// other failures are statuses of `remeshed`. The result does not depend on the number of threads. Its map, with its
/// certificate, is that of the joined surface.
PiecesResult remeshInPieces(
  const TriangleSource& source, const RemeshOptions& options, const PiecesOptions& pieces = {});

} // namespace quadrille
