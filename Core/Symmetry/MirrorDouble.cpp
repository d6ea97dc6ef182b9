// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/MirrorDouble.h"

#include "Base/PlaceText.h"
#include "Prepare/Frame.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille
{

namespace
{

/// Elements of the half, then those of them that have an image of their own.
std::vector<Index> imagesOf(const std::vector<std::uint8_t>& inPlane)
{
  const std::size_t count = inPlane.size();
  std::vector<Index> image(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    image[i] = static_cast<Index>(inPlane[i] != 0 ? i : image.size());
    if (inPlane[i] == 0)
    {
      image.push_back(static_cast<Index>(i));
    }
  }
  return image;
}

std::vector<Vector3> doublePositions(
  const std::vector<Vector3>& half, const std::vector<Index>& image, const MirrorPlane& plane)
{
  std::vector<Vector3> positions(image.size());
  for (std::size_t i = 0; i < half.size(); ++i)
  {
    const bool inPlane = image[i] == i;
    positions[i] = inPlane ? plane.foot(half[i]) : half[i];
    positions[image[i]] = inPlane ? positions[i] : plane.image(half[i]);
  }
  return positions;
}

std::vector<std::uint8_t> gluedHalfEdges(
  const Mesh& half, const MirrorPlane& plane, double tolerance)
{
  std::vector<std::uint8_t> glued(half.halfEdgeCount(), 0);
  const auto inPlane = [&](Index v)
  { return std::abs(plane.height(half.position[v])) <= tolerance; };
  for (Index h = 0; h < half.halfEdgeCount(); ++h)
  {
    glued[h] = half.isBoundary(h) && inPlane(half.origin[h]) && inPlane(half.target(h)) ? 1 : 0;
  }
  return glued;
}

/// What belongs to corners: swapped, where it is the weights of a face.
std::array<double, 3> imageWeights(const std::array<double, 3>& weights)
{
  return { weights[0], weights[2], weights[1] };
}

} // namespace

Index DoubledMesh::imageOfCorner(Index h) const
{
  return 3 * halfFaces + reversedCorner(h);
}

DoubledMesh doubleMesh(const Mesh& half, const MirrorPlane& plane, double tolerance)
{
  DoubledMesh doubled;
  doubled.halfVertices = half.vertexCount();
  doubled.halfFaces = half.faceCount();
  doubled.isGlued = gluedHalfEdges(half, plane, tolerance);
  std::vector<std::uint8_t> inPlane(half.vertexCount(), 0);
  for (Index h = 0; h < half.halfEdgeCount(); ++h)
  {
    if (doubled.isGlued[h] != 0)
    {
      inPlane[half.origin[h]] = inPlane[half.target(h)] = 1;
    }
  }
  doubled.image = imagesOf(inPlane);

  Mesh& mesh = doubled.mesh;
  const Index count = half.halfEdgeCount();
  mesh.position = doublePositions(half.position, doubled.image, plane);
  mesh.origin.resize(2 * std::size_t{ count });
  mesh.twin.resize(mesh.origin.size());
  mesh.flags.resize(mesh.origin.size());
  for (Index h = 0; h < count; ++h)
  {
    const Index edge = count + reversedEdge(h);
    const Index twin = half.twin[h];
    const bool glued = doubled.isGlued[h] != 0;
    mesh.origin.edit()[h] = half.origin[h];
    mesh.origin.edit()[doubled.imageOfCorner(h)] = doubled.image[half.origin[h]];
    mesh.twin.edit()[h] = glued ? edge : twin;
    mesh.twin.edit()[edge] = glued ? h : twin == kInvalidIndex ? twin : count + reversedEdge(twin);
    mesh.flags.edit()[h] = mesh.flags.edit()[edge] = half.flags[h];
  }
  if (!half.sizing.empty())
  {
    mesh.sizing.resize(mesh.position.size());
    for (Index v = 0; v < doubled.halfVertices; ++v)
    {
      mesh.sizing.edit()[v] = mesh.sizing.edit()[doubled.image[v]] = half.sizing[v];
    }
  }
  return doubled;
}

std::vector<FixedVec2> doubleMap(const DoubledMesh& doubled, std::vector<FixedVec2> uv)
{
  const Index count = 3 * doubled.halfFaces;
  uv.resize(2 * std::size_t{ count });
  for (Index h = 0; h < count; ++h)
  {
    const FixedVec2 p = uv[h];
    uv[doubled.imageOfCorner(h)] = { p.v, p.u };
  }
  return uv;
}

std::vector<int> doubleTurns(const DoubledMesh& doubled, const std::vector<int>& turns)
{
  std::vector<int> both(doubled.image.size());
  for (Index v = 0; v < doubled.halfVertices; ++v)
  {
    const Index image = doubled.image[v];
    both[v] = both[image] = image == v ? 2 * turns[v] : turns[v];
  }
  return both;
}

Index countEdges(QuadMesh& quads)
{
  Index crowded = kInvalidIndex;
  std::vector<std::pair<Index, Index>> edges;
  edges.reserve(4 * quads.quads.size());
  for (const std::array<Index, 4>& quad : quads.quads)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      edges.push_back(std::minmax(quad[i], quad[(i + 1) % 4]));
    }
  }
  std::sort(edges.begin(), edges.end());
  quads.valence.assign(quads.points.size(), 0);
  quads.onBoundary.assign(quads.points.size(), 0);
  for (std::size_t i = 0, next = 0; i < edges.size(); i = next)
  {
    for (next = i; next < edges.size() && edges[next] == edges[i];)
    {
      ++next;
    }
    for (const Index p : { edges[i].first, edges[i].second })
    {
      ++quads.valence[p];
      quads.onBoundary[p] = next == i + 1 ? 1 : quads.onBoundary[p];
    }
    crowded = next > i + 2 ? edges[i].first : crowded;
  }
  return crowded;
}

DoubledQuads doubleQuads(const QuadMesh& half, const DoubledMesh& doubled, const MirrorPlane& plane)
{
  DoubledQuads result;
  result.halfPoints = static_cast<Index>(half.points.size());
  result.halfQuads = static_cast<Index>(half.quads.size());
  std::vector<std::uint8_t> inPlane(half.points.size(), 0);
  for (const QuadLine& line : half.lines)
  {
    if (line.boundary && doubled.isGlued[line.halfEdge] != 0)
    {
      inPlane[line.a] = inPlane[line.b] = 1;
    }
  }
  result.image = imagesOf(inPlane);
  const std::vector<Index>& image = result.image;

  QuadMesh& quads = result.quads;
  quads = half;
  quads.points = doublePositions(half.points, image, plane);
  quads.sourceFace.resize(image.size());
  quads.sourceWeights.resize(image.size());
  for (std::size_t p = half.points.size(); p < image.size(); ++p)
  {
    quads.sourceFace[p] = doubled.halfFaces + half.sourceFace[image[p]];
    quads.sourceWeights[p] = imageWeights(half.sourceWeights[image[p]]);
  }
  for (std::size_t q = 0; q < half.quads.size(); ++q)
  {
    const std::array<Index, 4>& quad = half.quads[q];
    quads.quads.push_back({ image[quad[0]], image[quad[3]], image[quad[2]], image[quad[1]] });
    quads.quadSourceFace.push_back(doubled.halfFaces + half.quadSourceFace[q]);
    quads.quadSourceWeights.push_back(imageWeights(half.quadSourceWeights[q]));
  }
  quads.lines.clear();
  std::vector<QuadLine> images;
  for (QuadLine line : half.lines)
  {
    const bool glued = line.boundary && doubled.isGlued[line.halfEdge] != 0;
    if (glued && !doubled.mesh.isFeature(line.halfEdge))
    {
      continue;
    }
    line.boundary = line.boundary && !glued;
    quads.lines.push_back(line);
    if (!glued)
    {
      images.push_back({ image[line.b], image[line.a],
        3 * doubled.halfFaces + reversedEdge(line.halfEdge), line.boundary });
    }
  }
  quads.lines.insert(quads.lines.end(), images.begin(), images.end());
  const Index crowded = countEdges(quads);
  if (crowded != kInvalidIndex)
  {
    result.status = { StatusCode::NotConverged,
      "the half in front of the mirror plane is one quad wide from plane to plane near " +
        placeText(quads.points[crowded]) +
        ", so that with its image it would be two quads round: it needs more quads" };
  }
  return result;
}

} // namespace quadrille
