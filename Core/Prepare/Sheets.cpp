// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/Sheets.h"

#include "Base/Angles.h"
#include "Base/InvalidPolygon.h"
#include "Base/LargeArray.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Mesh/SurfaceEdit.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace quadrille
{

namespace
{

/// Which faces belong together, and whether a face has to be reversed to agree with its set's root.
class OrientedSets
{
public:
  explicit OrientedSets(Index faces) : parent_(faces), reversed_(faces, 0)
  {
    for (Index f = 0; f < faces; ++f)
    {
      parent_[f] = f;
    }
  }

  struct Root
  {
    Index face;
    bool reversed;
  };

  Root find(Index f)
  {
    bool reversed = false;
    Index root = f;
    while (parent_[root] != root)
    {
      reversed ^= reversed_[root] != 0;
      root = parent_[root];
    }
    // Second walk: point all of them at the root.
    bool rest = reversed;
    while (parent_[f] != root && f != root)
    {
      const bool step = reversed_[f] != 0;
      const Index up = parent_[f];
      parent_[f] = root;
      reversed_[f] = rest;
      rest ^= step;
      f = up;
    }
    return { root, reversed };
  }

  /// Joins the sets so that exactly one of f and g is reversed (differ) or both or none. False when they
  /// are in one set already and disagree.
  bool join(Index f, Index g, bool differ)
  {
    const Root a = find(f);
    const Root b = find(g);
    const bool differs = a.reversed ^ b.reversed ^ differ;
    if (a.face == b.face)
    {
      return !differs;
    }
    // The lower face stays root; find() keeps the paths short.
    const Index root = std::min(a.face, b.face);
    const Index child = std::max(a.face, b.face);
    parent_[child] = root;
    reversed_[child] = differs;
    return true;
  }

  bool canJoin(Index f, Index g, bool differ)
  {
    const Root a = find(f);
    const Root b = find(g);
    return a.face != b.face || (a.reversed ^ b.reversed) == differ;
  }

  Index size() const { return static_cast<Index>(parent_.size()); }

private:
  std::vector<Index> parent_;
  std::vector<std::uint8_t> reversed_;
};

/// Per face: has it to be reversed so that its set keeps the orientation of most of its faces?
std::vector<std::uint8_t> facesToReverse(OrientedSets& sets)
{
  std::vector<std::array<Index, 2>> votes(sets.size(), { 0, 0 });
  for (Index f = 0; f < sets.size(); ++f)
  {
    pollNowAndThen(f);
    const OrientedSets::Root root = sets.find(f);
    ++votes[root.face][root.reversed ? 1 : 0];
  }
  std::vector<std::uint8_t> reverse(sets.size(), 0);
  for (Index f = 0; f < sets.size(); ++f)
  {
    pollNowAndThen(f);
    const OrientedSets::Root root = sets.find(f);
    const bool reverseRoot = votes[root.face][1] > votes[root.face][0];
    reverse[f] = root.reversed ^ reverseRoot;
  }
  return reverse;
}

/// A half-edge at an edge of many faces.
struct Spoke
{
  Index halfEdge;
  bool forward;     ///< runs from the edge's lower to its higher vertex once faces are reversed
  double angle = 0; ///< of the face around the edge, counterclockwise seen against its direction
};

struct ManyFacedEdge
{
  Index begin; ///< into ManyFacedEdges::halfEdges
  Index end;
};

struct ManyFacedEdges
{
  std::vector<Index> halfEdges;
  std::vector<ManyFacedEdge> edges;
};

void glueHalfEdges(Index* twin, Index h, Index g)
{
  twin[h] = g;
  twin[g] = h;
}

std::vector<Spoke> spokesOf(
  const Mesh& mesh, const std::vector<std::uint8_t>& reverse, const Index* begin, const Index* end)
{
  const Index low = std::min(mesh.origin[*begin], mesh.target(*begin));
  const Index high = std::max(mesh.origin[*begin], mesh.target(*begin));
  const Vector3 axis = (mesh.position[high] - mesh.position[low]).normalized();
  const Vector3 x =
    axis.allFinite() && !axis.isZero() ? Vector3(axis.unitOrthogonal()) : Vector3(Vector3::UnitX());
  const Vector3 y = axis.cross(x);
  std::vector<Spoke> spokes;
  for (const Index* h = begin; h != end; ++h)
  {
    const Vector3 inward = mesh.position[mesh.origin[Mesh::previous(*h)]] - mesh.position[low];
    const bool forward = (mesh.origin[*h] == low) ^ (reverse[Mesh::face(*h)] != 0);
    spokes.push_back({ *h, forward, std::atan2(inward.dot(y), inward.dot(x)) });
  }
  // Faces that coincide: the one that ends a solid comes before the one that begins the next.
  std::stable_sort(spokes.begin(), spokes.end(),
    [](const Spoke& a, const Spoke& b)
    { return a.angle != b.angle ? a.angle < b.angle : a.forward && !b.forward; });
  return spokes;
}

/// True when solids meet at the edge: going round, outside and inside take turns.
bool alternates(const std::vector<Spoke>& spokes)
{
  for (std::size_t i = 0; i < spokes.size(); ++i)
  {
    if (spokes[i].forward == spokes[(i + 1) % spokes.size()].forward)
    {
      return false;
    }
  }
  return true;
}

bool tryPair(Index* twin, OrientedSets& sets, const Mesh& mesh, Index h, Index g)
{
  const bool sameDirection = mesh.origin[h] == mesh.origin[g];
  if (Mesh::face(h) == Mesh::face(g) || twin[h] != kInvalidIndex || twin[g] != kInvalidIndex ||
    !sets.canJoin(Mesh::face(h), Mesh::face(g), sameDirection))
  {
    return false;
  }
  sets.join(Mesh::face(h), Mesh::face(g), sameDirection);
  glueHalfEdges(twin, h, g);
  return true;
}

/// A forward face has its solid clockwise of it, a backward one counterclockwise: each backward face
/// pairs with the forward one that follows.
void pairAcrossSolids(
  Index* twin, OrientedSets& sets, const Mesh& mesh, const std::vector<Spoke>& spokes)
{
  for (std::size_t i = 0; i < spokes.size(); ++i)
  {
    const Spoke& following = spokes[(i + 1) % spokes.size()];
    if (!spokes[i].forward && following.forward)
    {
      tryPair(twin, sets, mesh, spokes[i].halfEdge, following.halfEdge);
    }
  }
}

void pairFlattestFirst(
  Index* twin, OrientedSets& sets, const Mesh& mesh, const std::vector<Spoke>& spokes)
{
  struct Candidate
  {
    double cost;
    std::size_t a, b;
  };
  std::vector<Candidate> candidates;
  for (std::size_t a = 0; a < spokes.size(); ++a)
  {
    for (std::size_t b = a + 1; b < spokes.size(); ++b)
    {
      double between = spokes[b].angle - spokes[a].angle;
      between = std::min(between, 2 * kPi - between);
      // Pairs that would reverse a patch come after all that need not.
      const double disagreement = spokes[a].forward == spokes[b].forward ? 2 * kPi : 0;
      candidates.push_back({ kPi - between + disagreement, a, b });
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
    [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  for (const Candidate& c : candidates)
  {
    tryPair(twin, sets, mesh, spokes[c.a].halfEdge, spokes[c.b].halfEdge);
  }
}

/// Pairs across edges of two faces and lists the edges of more. True when all of them agree in
/// orientation.
bool pairPlainEdges(Mesh& mesh, const EdgeRuns& runs, ManyFacedEdges& manyFaced)
{
  bool oriented = true;
  fillLarge(mesh.twin, mesh.origin.size(), kInvalidIndex);
  Index* twin = mesh.twin.edit();
  runs.forEach(
    [&](const EdgeRuns::Entry* begin, const EdgeRuns::Entry* end)
    {
      if (end - begin == 2)
      {
        glueHalfEdges(twin, begin[0].halfEdge, begin[1].halfEdge);
        oriented &= mesh.origin[begin[0].halfEdge] != mesh.origin[begin[1].halfEdge];
      }
      else if (end - begin > 2)
      {
        const Index first = static_cast<Index>(manyFaced.halfEdges.size());
        for (const EdgeRuns::Entry* entry = begin; entry != end; ++entry)
        {
          manyFaced.halfEdges.push_back(entry->halfEdge);
        }
        manyFaced.edges.push_back({ first, static_cast<Index>(manyFaced.halfEdges.size()) });
      }
    });
  return oriented;
}

OrientedSets joinAcrossPlainEdges(const PreparedSurface& surface)
{
  const Mesh& mesh = surface.mesh;
  OrientedSets sets(mesh.faceCount());
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    const Index g = mesh.twin[h];
    if (g != kInvalidIndex && h < g &&
      !sets.join(Mesh::face(h), Mesh::face(g), mesh.origin[h] == mesh.origin[g]))
    {
      const Index polygon = surface.sourcePolygon[Mesh::face(h)];
      throw InvalidPolygon(
        "cut the surface open, or remove the polygons that close its twisted loop: "
        "it is not orientable (like a Moebius strip), as polygon " +
          std::to_string(polygon) + " near " + placeText(mesh.position[mesh.origin[h]]) +
          " cannot agree with all its neighbours about which side is outside.",
        polygon);
    }
  }
  return sets;
}

/// Swaps corners 1 and 2 of the faces that are to be reversed: half-edges 0 and 2 change places, and all
/// three change direction.
std::size_t reverseOrientation(PreparedSurface& surface, const std::vector<std::uint8_t>& reverse)
{
  Mesh& mesh = surface.mesh;
  const auto moved = [&reverse](Index h)
  { return h == kInvalidIndex || reverse[h / 3] == 0 ? h : h - h % 3 + (2 - h % 3); };
  std::size_t count = 0;
  Index* origin = mesh.origin.edit();
  Index* twin = mesh.twin.edit();
  std::uint8_t* flags = mesh.flags.edit();
  std::array<Index, 3>* sourcePoints = surface.sourcePoints.edit();
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    if (reverse[f] != 0)
    {
      ++count;
      std::swap(origin[3 * f + 1], origin[3 * f + 2]);
      std::swap(sourcePoints[f][1], sourcePoints[f][2]);
      std::swap(flags[3 * f], flags[3 * f + 2]);
      std::swap(twin[3 * f], twin[3 * f + 2]);
    }
  }
  for (std::size_t h = 0; h < mesh.twin.size(); ++h)
  {
    pollNowAndThen(h);
    twin[h] = moved(twin[h]);
  }
  return count;
}

/// Faces that `outgoing` does not reach by turning counterclockwise mean a second fan.
std::vector<std::uint8_t> verticesOfManyFans(const Mesh& mesh)
{
  std::vector<Index> degree(mesh.vertexCount(), 0);
  std::vector<Index> outgoing(mesh.vertexCount(), kInvalidIndex);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    const Index v = mesh.origin[h];
    if (v != kInvalidIndex)
    {
      ++degree[v];
      outgoing[v] = outgoing[v] == kInvalidIndex || mesh.isBoundary(h) ? h : outgoing[v];
    }
  }
  std::vector<std::uint8_t> many(mesh.vertexCount(), 0);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    pollNowAndThen(v);
    if (degree[v] == 0)
    {
      continue;
    }
    forEachInFan(mesh, outgoing[v], [&](Index) { --degree[v]; });
    many[v] = degree[v] != 0;
  }
  return many;
}

/// Of edges between the same two vertices all but the first, at most one a face.
std::vector<Index> surplusEdges(const Mesh& mesh)
{
  std::vector<Index> edges;
  std::vector<std::uint8_t> taken(mesh.faceCount(), 0);
  const auto take = [&](Index h)
  {
    const Index g = mesh.twin[h];
    if (taken[Mesh::face(h)] == 0 && (g == kInvalidIndex || taken[Mesh::face(g)] == 0))
    {
      taken[Mesh::face(h)] = 1;
      taken[Mesh::face(g == kInvalidIndex ? h : g)] = 1;
      edges.push_back(h);
    }
  };
  EdgeRuns(mesh.origin, mesh.vertexCount(), 1)
    .forEach(
      [&](const EdgeRuns::Entry* begin, const EdgeRuns::Entry* end)
      {
        const Index first = begin->halfEdge;
        for (const EdgeRuns::Entry* entry = begin + 1; entry != end; ++entry)
        {
          const Index h = entry->halfEdge;
          if (mesh.twin[h] != first && (mesh.isBoundary(h) || h < mesh.twin[h]))
          {
            take(h);
          }
        }
      });
  return edges;
}

} // namespace

void pairIntoSheets(PreparedSurface& surface, const EdgeRuns& runs)
{
  Mesh& mesh = surface.mesh;
  ManyFacedEdges manyFaced;
  const bool oriented = pairPlainEdges(mesh, runs, manyFaced);
  surface.repair.nonManifoldEdges += manyFaced.edges.size();
  if (oriented && manyFaced.edges.empty())
  {
    return;
  }
  OrientedSets sets = joinAcrossPlainEdges(surface);
  Index* twin = mesh.twin.edit();
  const std::vector<std::uint8_t> reversedForSpokes = facesToReverse(sets);
  for (const ManyFacedEdge& edge : manyFaced.edges)
  {
    const std::vector<Spoke> spokes = spokesOf(mesh, reversedForSpokes,
      manyFaced.halfEdges.data() + edge.begin, manyFaced.halfEdges.data() + edge.end);
    if (alternates(spokes))
    {
      pairAcrossSolids(twin, sets, mesh, spokes);
    }
    pairFlattestFirst(twin, sets, mesh, spokes);
  }
  surface.repair.reorientedFaces += reverseOrientation(surface, facesToReverse(sets));
}

std::size_t splitVertexFans(Mesh& mesh)
{
  const std::vector<std::uint8_t> many = verticesOfManyFans(mesh);
  const std::size_t count = static_cast<std::size_t>(std::count(many.begin(), many.end(), 1));
  if (count == 0)
  {
    return 0;
  }
  std::vector<Index> halfEdges;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    if (mesh.origin[h] != kInvalidIndex && many[mesh.origin[h]] != 0)
    {
      halfEdges.push_back(h);
    }
  }
  // The first fan of a vertex keeps it; renamed corners are out of the range of `many`.
  std::vector<std::uint8_t> keepsVertex(many.size(), 0);
  std::vector<std::uint8_t> visited(mesh.halfEdgeCount(), 0);
  for (const Index h : halfEdges)
  {
    if (visited[h] != 0)
    {
      continue;
    }
    Index v = mesh.origin[h];
    if (std::exchange(keepsVertex[v], std::uint8_t{ 1 }) != 0)
    {
      mesh.position.push_back(Vector3(mesh.position[v]));
      v = mesh.vertexCount() - 1;
    }
    forEachInFan(mesh, h,
      [&](Index g)
      {
        visited[g] = 1;
        mesh.origin.edit()[g] = v;
      });
  }
  return count;
}

bool splitDoubleEdges(PreparedSurface& surface)
{
  bool split = false;
  // A split moves other half-edges of its faces, so each pass splits one edge a face.
  for (std::vector<Index> edges = surplusEdges(surface.mesh); !edges.empty();
       edges = surplusEdges(surface.mesh))
  {
    for (const Index h : edges)
    {
      splitEdge(surface, h);
    }
    split = true;
  }
  return split;
}

} // namespace quadrille
