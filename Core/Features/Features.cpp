// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/Features.h"

#include "Base/Angles.h"
#include "Base/DisjointSets.h"
#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Features/Creases.h"
#include "Features/FaceNormals.h"
#include "Features/FeatureFilter.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace quadrille
{

namespace
{

/// A plane counts from this part of the area on: facets of a coarse sampling, which may lie in one plane, are smaller.
constexpr double kPlane = 0.005;
/// The part of the area in such planes from which on a surface is designed: printed parts have 0.24 to 0.95, scans 0 to
/// 0.04.
constexpr double kDesigned = 0.1;

void markSharpEdges(Mesh& mesh, const FaceNormals& normals, double angle, int threads)
{
  const double limit = std::cos(angle);
  std::uint8_t* const flags = mesh.flags.edit();
  parallelFor(mesh.faceCount(), kMediumChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<Vector3> known(end - begin); // faces next to each other are mostly in one chunk
      for (std::size_t f = begin; f < end; ++f)
      {
        known[f - begin] = normals.of(static_cast<Index>(f));
      }
      for (Index h = static_cast<Index>(3 * begin); h < 3 * end; ++h)
      {
        const Index twin = mesh.twin[h];
        if (mesh.isBoundary(h) || twin < h)
        {
          continue; // an edge is marked from its lower half-edge
        }
        const Index beyond = Mesh::face(twin);
        const double cosine = known[Mesh::face(h) - begin].dot(
          beyond < end ? known[beyond - begin] : normals.of(beyond));
        if (cosine < limit)
        {
          flags[h] |= kFeatureEdge;
          flags[twin] |= kFeatureEdge;
        }
      }
    });
}

/// One half-edge of each edge between two faces in one plane.
std::vector<Index> edgesInPlanes(const Mesh& mesh, const FaceNormals& normals, int threads)
{
  const double least = std::cos(kOnePlane);
  return parallelGather<Index>(mesh.faceCount(), kMediumChunk, threads,
    [&](Index f, std::vector<Index>& found)
    {
      const Vector3 normal = normals.of(f);
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        if (!mesh.isBoundary(h) && h < mesh.twin[h] &&
          normal.dot(normals.of(Mesh::face(mesh.twin[h]))) > least)
        {
          found.push_back(h);
        }
      }
    });
}

/// Whether a good part of the area lies in large planes: a tessellation of designed bodies has such, and the noise of a
/// scan leaves none.
bool isDesigned(const Mesh& mesh, const FaceNormals& normals, int threads)
{
  DisjointSets planes(mesh.faceCount(), threads);
  std::vector<std::uint8_t> isJoined(mesh.faceCount(), 0);
  for (const Index h : edgesInPlanes(mesh, normals, threads))
  {
    planes.join(Mesh::face(h), Mesh::face(mesh.twin[h]));
    isJoined[Mesh::face(h)] = isJoined[Mesh::face(mesh.twin[h])] = 1;
  }
  std::vector<double> areas(mesh.faceCount(), 0.0); // of planes of several triangles, by roots
  double all = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    const double area = mesh.doubleAreaNormal(f).norm();
    areas[planes.find(f)] += isJoined[f] != 0 ? area : 0;
    all += area;
  }
  const double inPlanes = std::accumulate(areas.begin(), areas.end(), 0.0,
    [&](double sum, double area) { return sum + (area > kPlane * all ? area : 0); });
  return inPlanes > kDesigned * all;
}

} // namespace

std::vector<Vector3> normalsBeside(
  const Mesh& mesh, const std::vector<Index>& halfEdges, int threads, double precision)
{
  const FaceNormals normals(mesh, precision, threads);
  std::vector<Vector3> result;
  result.reserve(halfEdges.size());
  for (const Index h : halfEdges)
  {
    result.push_back(normals.of(Mesh::face(h)));
  }
  return result;
}

FacetReport markCreases(Mesh& mesh, double angle, int threads, double precision)
{
  const FaceNormals normals(mesh, precision, threads);
  markSharpEdges(mesh, normals, angle, threads);
  const auto angleOf = [&](Index h)
  {
    const double cosine = normals.of(Mesh::face(h)).dot(normals.of(Mesh::face(mesh.twin[h])));
    return std::acos(std::clamp(cosine, -1.0, 1.0));
  };
  FacetReport report;
  report.isDesigned = hasDetectedFeature(mesh) && isDesigned(mesh, normals, threads);
  const std::vector<Index> facets =
    report.isDesigned ? std::vector<Index>{} : edgesOfFacets(mesh, angle, angleOf, threads);
  if (facets.empty())
  {
    return report;
  }
  const Index h = facets.front();
  report.edges = facets.size();
  report.place = 0.5 * (mesh.position[mesh.origin[h]] + mesh.position[mesh.target(h)]);
  unmarkFeatures(mesh, facets);
  return report;
}

void markFeaturesByPatch(PreparedSurface& surface, const std::vector<std::int64_t>& patchIds)
{
  Mesh& mesh = surface.mesh;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    const Index g = mesh.twin[h];
    if (mesh.isBoundary(h) || h > g ||
      patchIds[surface.sourcePolygon[Mesh::face(h)]] ==
        patchIds[surface.sourcePolygon[Mesh::face(g)]])
    {
      continue;
    }
    for (const Index side : { h, g })
    {
      mesh.flags.edit()[side] |= kFeatureEdge | kRequestedFeature;
    }
  }
}

void makeFlagsSymmetric(Mesh& mesh)
{
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    if (!mesh.isBoundary(h))
    {
      mesh.flags.edit()[mesh.twin[h]] |= mesh.flags[h];
    }
  }
}

} // namespace quadrille
