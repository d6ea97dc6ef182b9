// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Features.h"

#include "Base/LargeArray.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Mesh/Creases.h"
#include "Mesh/FeatureFilter.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{

namespace
{

constexpr std::size_t kFeatureChunk = 65536;

/// Coordinates often come as float, even where they are double now: below this height over the size of the surface a
/// face's normal can be off by degrees.
constexpr double kReliableHeight = 1e-6;
/// The same over the precision of the coordinates, where that is worse.
constexpr double kReliableSteps = 16;

constexpr int kMostSliversInARow = 16;

struct FaceNormals
{
  std::vector<Vector3> normal;        ///< #F, unit
  std::vector<std::uint8_t> reliable; ///< #F
};

double sizeOf(const Mesh& mesh)
{
  Vector3 low = mesh.position.front();
  Vector3 high = low;
  for (const Vector3& p : mesh.position)
  {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

FaceNormals computeNormals(const Mesh& mesh, double precision, int threads)
{
  const double height = std::max(kReliableHeight * sizeOf(mesh), kReliableSteps * precision);
  FaceNormals normals;
  normals.reliable.resize(mesh.faceCount());
  growLarge(normals.normal, mesh.faceCount());
  parallelFor(mesh.faceCount(), kFeatureChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const Index h = static_cast<Index>(3 * i);
        const Vector3 a = mesh.edgeVector(h), b = mesh.edgeVector(h + 1),
                      c = mesh.edgeVector(h + 2);
        const Vector3 n = a.cross(b);
        const double doubleArea = n.norm();
        const double longest =
          std::sqrt(std::max({ a.squaredNorm(), b.squaredNorm(), c.squaredNorm() }));
        normals.normal[i] = n / doubleArea;
        normals.reliable[i] = doubleArea > height * longest;
      }
    });
  return normals;
}

/// Half-edges of a face, longest first.
std::array<Index, 3> byLength(const Mesh& mesh, Index f)
{
  std::array<Index, 3> edges{ 3 * f, 3 * f + 1, 3 * f + 2 };
  std::stable_sort(edges.begin(), edges.end(),
    [&mesh](Index a, Index b)
    { return mesh.edgeVector(a).squaredNorm() > mesh.edgeVector(b).squaredNorm(); });
  return edges;
}

/// The face whose normal stands for that of a sliver f: beyond the longest edges of slivers, and never back.
Index beyondSlivers(const Mesh& mesh, const FaceNormals& normals, Index f)
{
  Index previous = kInvalidIndex;
  Index current = f;
  for (int step = 0; step < kMostSliversInARow && normals.reliable[current] == 0; ++step)
  {
    const std::array<Index, 3> edges = byLength(mesh, current);
    const auto leadsOn = [&](Index h)
    { return !mesh.isBoundary(h) && Mesh::face(mesh.twin[h]) != previous; };
    const auto way = std::find_if(edges.begin(), edges.end(), leadsOn);
    if (way == edges.end())
    {
      break;
    }
    previous = current;
    current = Mesh::face(mesh.twin[*way]);
  }
  return current;
}

const Vector3& normalOf(const Mesh& mesh, const FaceNormals& normals, Index f)
{
  return normals.normal[normals.reliable[f] != 0 ? f : beyondSlivers(mesh, normals, f)];
}

void markSharpEdges(Mesh& mesh, const FaceNormals& normals, double angle, int threads)
{
  const double limit = std::cos(angle);
  parallelFor(mesh.faceCount(), kFeatureChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (Index h = static_cast<Index>(3 * begin); h < 3 * end; ++h)
      {
        const Index twin = mesh.twin[h];
        if (mesh.isBoundary(h) || twin < h)
        {
          continue; // an edge is marked from its lower half-edge
        }
        const Vector3& here = normalOf(mesh, normals, Mesh::face(h));
        if (here.dot(normalOf(mesh, normals, Mesh::face(twin))) < limit)
        {
          mesh.flags[h] |= kFeatureEdge;
          mesh.flags[twin] |= kFeatureEdge;
        }
      }
    });
}

} // namespace

void markFeaturesByAngle(Mesh& mesh, double angle, int threads, double precision)
{
  markSharpEdges(mesh, computeNormals(mesh, precision, threads), angle, threads);
}

std::vector<Vector3> normalsBeside(
  const Mesh& mesh, const std::vector<Index>& halfEdges, int threads, double precision)
{
  const FaceNormals normals = computeNormals(mesh, precision, threads);
  std::vector<Vector3> result;
  result.reserve(halfEdges.size());
  for (const Index h : halfEdges)
  {
    result.push_back(normalOf(mesh, normals, Mesh::face(h)));
  }
  return result;
}

FacetReport markCreases(Mesh& mesh, double angle, int threads, double precision)
{
  const FaceNormals normals = computeNormals(mesh, precision, threads);
  markSharpEdges(mesh, normals, angle, threads);
  const auto angleOf = [&](Index h)
  {
    const double cosine =
      normalOf(mesh, normals, Mesh::face(h)).dot(normalOf(mesh, normals, Mesh::face(mesh.twin[h])));
    return std::acos(std::clamp(cosine, -1.0, 1.0));
  };
  const std::vector<Index> facets = edgesOfFacets(mesh, angle, angleOf, threads);
  FacetReport report;
  report.edges = facets.size();
  if (!facets.empty())
  {
    const Index h = facets.front();
    report.place = 0.5 * (mesh.position[mesh.origin[h]] + mesh.position[mesh.target(h)]);
  }
  unmarkFeatures(mesh, facets);
  return report;
}

void markFeaturesByPatch(PreparedSurface& surface, const std::vector<std::int64_t>& patchIds)
{
  Mesh& mesh = surface.mesh;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    if (!mesh.isBoundary(h) &&
      patchIds[surface.sourcePolygon[Mesh::face(h)]] !=
        patchIds[surface.sourcePolygon[Mesh::face(mesh.twin[h])]])
    {
      mesh.flags[h] |= kFeatureEdge | kRequestedFeature;
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
      mesh.flags[mesh.twin[h]] |= mesh.flags[h];
    }
  }
}

} // namespace quadrille
