// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: GPL-3.0-or-later
// GPL as it includes headers of CGAL that are.
#include "Repair/SoupRepair.h"

#include "Base/DisjointSets.h"
#include "Base/Refuse.h"
#include "Repair/CgalMesh.h"

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <boost/iterator/function_output_iterator.hpp>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

namespace quadrille
{

namespace
{

namespace pmp = CGAL::Polygon_mesh_processing;
using cgal::SurfaceMesh;
using Halfedge = SurfaceMesh::Halfedge_index;
using Face = SurfaceMesh::Face_index;

struct SoupArrays
{
  std::vector<cgal::Point> points;
  std::vector<cgal::Corners> corners;
};

bool hasRepeatedCorner(const cgal::Corners& c)
{
  return c[0] == c[1] || c[1] == c[2] || c[2] == c[0];
}

/// Points at the same place become one; what has then no three corners, or stands there twice, goes.
void mergeSoup(SoupArrays& soup, SoupReport& report)
{
  report.isolatedPoints += pmp::remove_isolated_points_in_polygon_soup(soup.points, soup.corners);
  report.mergedPoints += pmp::merge_duplicate_points_in_polygon_soup(soup.points, soup.corners);
  const auto end = std::remove_if(soup.corners.begin(), soup.corners.end(), hasRepeatedCorner);
  report.degenerateFaces += static_cast<std::size_t>(std::distance(end, soup.corners.end()));
  soup.corners.erase(end, soup.corners.end());
  report.duplicateFaces += pmp::merge_duplicate_polygons_in_polygon_soup(soup.points, soup.corners,
    CGAL::parameters::erase_all_duplicates(false).require_same_orientation(false));
  pmp::remove_isolated_points_in_polygon_soup(soup.points, soup.corners);
}

/// Counts what the orientation does; copied by CGAL, so the counts stand elsewhere.
struct CountingVisitor : pmp::Default_orientation_visitor
{
  SoupReport* counts = nullptr;
  std::set<std::pair<std::size_t, std::size_t>>* edges = nullptr;

  /// Called for each face at the edge.
  void non_manifold_edge(std::size_t a, std::size_t b, std::size_t)
  {
    edges->emplace(std::min(a, b), std::max(a, b));
  }
  void polygon_orientation_reversed(std::size_t) { ++counts->reorientedFaces; }
};

/// Faces of a component agree; what is not manifold is parted by copies of points.
void orientSoup(SoupArrays& soup, SoupReport& report)
{
  const std::size_t before = soup.points.size();
  CountingVisitor visitor;
  visitor.counts = &report;
  std::set<std::pair<std::size_t, std::size_t>> edges;
  visitor.edges = &edges;
  pmp::orient_polygon_soup(soup.points, soup.corners, CGAL::parameters::visitor(visitor));
  report.nonManifoldEdges += edges.size();
  report.copiedPoints += soup.points.size() - before;
}

double lengthOf(const SurfaceMesh& mesh, Halfedge border)
{
  double length = 0;
  for (const Halfedge h : CGAL::halfedges_around_face(border, mesh))
  {
    length +=
      (cgal::vectorOf(mesh.point(mesh.target(h))) - cgal::vectorOf(mesh.point(mesh.source(h))))
        .norm();
  }
  return length;
}

SoupPlace boundaryPlace(const SurfaceMesh& mesh, Halfedge border)
{
  SoupPlace place;
  for (const Halfedge h : CGAL::halfedges_around_face(border, mesh))
  {
    place.at += cgal::vectorOf(mesh.point(mesh.target(h)));
    ++place.faces;
  }
  place.at /= static_cast<double>(place.faces);
  place.length = lengthOf(mesh, border);
  return place;
}

std::vector<Halfedge> boundaryLoops(const SurfaceMesh& mesh)
{
  std::vector<Halfedge> loops;
  pmp::extract_boundary_cycles(mesh, std::back_inserter(loops));
  return loops;
}

/// Whether there are faces in the hole then.
bool fillHole(SurfaceMesh& mesh, Halfedge border, bool withoutCubicSearch)
{
  std::vector<Face> faces;
  const auto options = CGAL::parameters::do_not_use_cubic_algorithm(withoutCubicSearch);
#if CGAL_VERSION_NR >= 1050600000 // 5.6, which takes the iterators among its named parameters
  pmp::triangulate_refine_and_fair_hole(
    mesh, border, options.face_output_iterator(std::back_inserter(faces)));
#else
  std::vector<SurfaceMesh::Vertex_index> vertices;
  pmp::triangulate_refine_and_fair_hole(
    mesh, border, std::back_inserter(faces), std::back_inserter(vertices), options);
#endif
  return !faces.empty();
}

void fillHoles(SurfaceMesh& mesh, const SoupRepairOptions& options, SoupReport& counts)
{
  // The cubic search of CGAL, for boundaries that the Delaunay one cannot fill, takes minutes above this.
  constexpr std::size_t kMostCubicEdges = 300;
  const std::vector<Halfedge> loops = boundaryLoops(mesh);
  for (std::size_t i = 0; i < loops.size(); ++i)
  {
    const SoupPlace place = boundaryPlace(mesh, loops[i]);
    if (place.length >= options.fillBelow)
    {
      continue;
    }
    report(options.progress, 0.3 + 0.3 * static_cast<double>(i) / static_cast<double>(loops.size()),
      "Filling hole " + std::to_string(i + 1) + " of " + std::to_string(loops.size()));
    const bool filled = fillHole(mesh, loops[i], place.faces > kMostCubicEdges);
    ++(filled ? counts.filledHoles : counts.unfilledHoles);
  }
}

void tellBoundaries(const SurfaceMesh& mesh, SoupReport& report)
{
  for (const Halfedge border : boundaryLoops(mesh))
  {
    report.boundaries.push_back(boundaryPlace(mesh, border));
  }
  report.openBoundaries = report.boundaries.size();
  std::stable_sort(report.boundaries.begin(), report.boundaries.end(),
    [](const SoupPlace& a, const SoupPlace& b) { return a.length > b.length; });
  report.boundaries.resize(std::min(report.boundaries.size(), kMostTold));
}

/// Faces of which no three corners lie on a line; CGAL's test of crossing needs that.
std::vector<Face> properFaces(const SurfaceMesh& mesh, SoupReport& report)
{
  std::vector<Face> faces;
  for (const Face f : mesh.faces())
  {
    const Halfedge h = mesh.halfedge(f);
    if (CGAL::collinear(mesh.point(mesh.source(h)), mesh.point(mesh.target(h)),
          mesh.point(mesh.target(mesh.next(h)))))
    {
      ++report.zeroAreaFaces;
    }
    else
    {
      faces.push_back(f);
    }
  }
  return faces;
}

/// Whether two faces have corners at one place, as where sheets were parted: there they touch.
bool haveCommonPlace(const SurfaceMesh& mesh, Face a, Face b)
{
  for (const SurfaceMesh::Vertex_index v : mesh.vertices_around_face(mesh.halfedge(a)))
  {
    for (const SurfaceMesh::Vertex_index w : mesh.vertices_around_face(mesh.halfedge(b)))
    {
      if (v != w && mesh.point(v) == mesh.point(w))
      {
        return true;
      }
    }
  }
  return false;
}

Vector3 centreOf(const TriangleList& surface, std::size_t face)
{
  const std::array<Index, 3>& c = surface.corners[face];
  return (surface.points[c[0]] + surface.points[c[1]] + surface.points[c[2]]) / 3;
}

/// Faces that cross others, in connected regions.
void tellIntersections(
  const std::vector<std::pair<Face, Face>>& pairs, const SurfaceMesh& mesh, RepairedSoup& result)
{
  std::vector<std::uint8_t>& isIntersecting = result.isIntersecting;
  isIntersecting.assign(result.surface.corners.size(), 0);
  DisjointSets regions(isIntersecting.size(), 1);
  for (const auto& [a, b] : pairs)
  {
    isIntersecting[a] = isIntersecting[b] = 1;
    regions.join(a, b);
  }
  for (const SurfaceMesh::Edge_index e : mesh.edges())
  {
    const Face a = mesh.face(mesh.halfedge(e, 0)), b = mesh.face(mesh.halfedge(e, 1));
    if (a.is_valid() && b.is_valid() && isIntersecting[a] && isIntersecting[b])
    {
      regions.join(a, b);
    }
  }
  std::map<Index, std::size_t> faces;
  for (std::size_t f = 0; f < isIntersecting.size(); ++f)
  {
    if (isIntersecting[f])
    {
      ++faces[regions.find(static_cast<Index>(f))];
      ++result.report.intersectingFaces;
    }
  }
  for (const auto& [face, count] : faces)
  {
    result.report.intersections.push_back({ centreOf(result.surface, face), count, 0 });
  }
  auto& places = result.report.intersections;
  result.report.intersectingPairs = pairs.size();
  result.report.intersectionPlaces = places.size();
  std::stable_sort(places.begin(), places.end(),
    [](const SoupPlace& a, const SoupPlace& b) { return a.faces > b.faces; });
  places.resize(std::min(places.size(), kMostTold));
}

std::size_t countComponents(const SurfaceMesh& mesh)
{
  DisjointSets components(mesh.number_of_faces(), 1);
  for (const SurfaceMesh::Edge_index e : mesh.edges())
  {
    const Face a = mesh.face(mesh.halfedge(e, 0)), b = mesh.face(mesh.halfedge(e, 1));
    if (a.is_valid() && b.is_valid())
    {
      components.join(a, b);
    }
  }
  return components.countSets();
}

} // namespace

RepairedSoup repairSoup(const Soup& soup, const SoupRepairOptions& options)
{
  refuseIf(!(options.fillBelow >= 0),
    "the length below which holes are filled must be 0 or more, not ", options.fillBelow);
  RepairedSoup result;
  SoupReport& counts = result.report;
  counts.degenerateFaces = soup.degenerate;
  SoupArrays arrays{ cgal::pointsOf(soup.triangles), cgal::cornersOf(soup.triangles) };
  report(options.progress, 0, "Merging points");
  mergeSoup(arrays, counts);
  refuseIf(
    arrays.corners.empty(), "no face has three different corners: there is nothing to repair");
  report(options.progress, 0.1, "Orienting faces");
  orientSoup(arrays, counts);
  SurfaceMesh mesh;
  pmp::polygon_soup_to_polygon_mesh(arrays.points, arrays.corners, mesh);
  arrays = {};
  const std::size_t givenFaces = mesh.number_of_faces();
  if (options.fillBelow > 0)
  {
    fillHoles(mesh, options, counts);
    mesh.collect_garbage(); // ids follow each other again
  }
  tellBoundaries(mesh, counts);
  counts.components = countComponents(mesh);
  result.surface = cgal::trianglesOf(mesh);
  result.isFilling.assign(result.surface.corners.size(), 0);
  std::fill(result.isFilling.begin() + static_cast<std::ptrdiff_t>(givenFaces),
    result.isFilling.end(), std::uint8_t{ 1 });
  const std::vector<Face> faces = properFaces(mesh, counts);
  if (options.findSelfIntersections)
  {
    report(options.progress, 0.6, "Looking for self-intersections");
    std::vector<std::pair<Face, Face>> pairs;
    pmp::self_intersections<CGAL::Sequential_tag>(faces, mesh,
      boost::make_function_output_iterator(
        [&](const std::pair<Face, Face>& pair)
        {
          poll();
          if (!haveCommonPlace(mesh, pair.first, pair.second))
          {
            pairs.push_back(pair);
          }
        }));
    tellIntersections(pairs, mesh, result);
  }
  report(options.progress, 1, "Repaired");
  return result;
}

} // namespace quadrille
