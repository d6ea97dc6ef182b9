// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// From a soup of triangles to an oriented manifold, by CGAL's Polygon Mesh Processing: points merged, faces turned to
/// agree, holes filled, self-intersections found and told.
#pragma once

#include "Base/Lists.h"
#include "Base/Progress.h"
#include "Repair/Soup.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace quadrille
{

struct SoupRepairOptions
{
  /// Holes whose boundary is shorter than this are filled, in units of the points, >= 0; 0: none.
  double fillBelow = 0;
  /// Self-intersections of what comes out are looked for; costs about as much as all else.
  bool findSelfIntersections = true;
  /// Asked between the steps, between holes and at each intersection that is found; else CGAL's functions run to their
  /// end.
  ProgressCallback progress;
};

/// Where something is, and how much of it.
struct SoupPlace
{
  Vector3 at = Vector3::Zero(); ///< centre of a face that takes part, or of a boundary
  std::size_t faces = 0;        ///< that take part, or edges of the boundary
  double length = 0;            ///< of a boundary
};

/// All counts; zero everywhere for a clean closed surface.
struct SoupReport
{
  std::size_t mergedPoints = 0;     ///< at the place of another one
  std::size_t degenerateFaces = 0;  ///< without three different corners, removed
  std::size_t zeroAreaFaces = 0;    ///< three different corners on a line; they stay
  std::size_t duplicateFaces = 0;   ///< of the same corners as another one, removed
  std::size_t isolatedPoints = 0;   ///< of no face, removed
  std::size_t reorientedFaces = 0;  ///< turned round to agree with their neighbours
  std::size_t nonManifoldEdges = 0; ///< edges of more than two faces
  /// Copies of points that part what no manifold has: at edges and points that are not manifold, and along a cut where
  /// a component has one side only.
  std::size_t copiedPoints = 0;
  std::size_t components = 0;
  std::size_t filledHoles = 0;
  std::size_t unfilledHoles = 0;  ///< short enough, but CGAL found no triangulation; they stay
  std::size_t openBoundaries = 0; ///< boundary loops that are left
  /// Pairs of faces that cross or touch without being neighbours. Those with corners at one place, as where sheets were
  /// parted, do not count.
  std::size_t intersectingPairs = 0;
  std::size_t intersectingFaces = 0;    ///< that take part
  std::size_t intersectionPlaces = 0;   ///< connected regions of such faces
  std::vector<SoupPlace> intersections; ///< kMostTold at most, most faces first
  std::vector<SoupPlace>
    boundaries; ///< the same of boundary loops that are left, the longest first

  /// One sentence for each kind of finding, with counts and places.
  std::vector<std::string> sentences() const;
  /// A surface of so many faces is none that could be remeshed with sense, but wrapped: bodies of
  /// several faces most of which cross others, or shards of a surface, most of which stand alone.
  /// Faces that do both are no part of a surface that a wrap could find.
  bool isHopeless(std::size_t faces) const;
};

struct RepairedSoup
{
  TriangleList surface;
  std::vector<std::uint8_t> isFilling; ///< #triangles; 1: made to fill a hole
  std::vector<std::uint8_t>
    isIntersecting; ///< #triangles; 1: crosses another one; empty where that was not looked for
  SoupReport report;
};

/// Points keep their coordinates; those of fillings come on top. Throws InvalidInput for a soup without a triangle that
/// has three different corners and for options out of range; Cancelled where the callback asks to stop.
RepairedSoup repairSoup(const Soup& soup, const SoupRepairOptions& options);

} // namespace quadrille
