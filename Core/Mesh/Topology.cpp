// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Topology.h"

#include "Base/Error.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Mesh/EdgeRuns.h"

#include <atomic>
#include <memory>
#include <utility>

namespace quadrille
{

namespace
{

/// See outgoingHalfEdges.
std::vector<Index> outgoingByThreads(const Mesh& mesh, int threads)
{
  const std::size_t vertices = mesh.vertexCount();
  std::unique_ptr<std::atomic<Index>[]> first(new std::atomic<Index>[vertices]);
  parallelForEach(vertices, kLightChunk, threads,
    [&](std::size_t v) { first[v].store(kInvalidIndex, std::memory_order_relaxed); });
  parallelForEach(mesh.halfEdgeCount(), kLightChunk, threads,
    [&](Index h)
    {
      std::atomic<Index>& lowest = first[mesh.origin[h]];
      Index known = lowest.load(std::memory_order_relaxed);
      while (h < known && !lowest.compare_exchange_weak(known, h, std::memory_order_relaxed))
      {
      }
    });
  std::vector<Index> outgoing(vertices);
  parallelForEach(vertices, kLightChunk, threads,
    [&](std::size_t v) { outgoing[v] = first[v].load(std::memory_order_relaxed); });
  for (const Index h : boundaryHalfEdges(mesh, threads))
  {
    outgoing[mesh.origin[h]] = h; // in their order, as on one thread
  }
  return outgoing;
}

std::string edgeName(Index a, Index b)
{
  return "(" + std::to_string(a) + ", " + std::to_string(b) + ")";
}

bool isManifold(
  const std::vector<Index>& origin, const EdgeRuns::Entry* begin, const EdgeRuns::Entry* end)
{
  return end - begin == 1 ||
    (end - begin == 2 && origin[begin->halfEdge] != origin[begin[1].halfEdge]);
}

[[noreturn]] void refuseRun(
  const std::vector<Index>& origin, const EdgeRuns::Entry* begin, const EdgeRuns::Entry* end)
{
  const Index h = begin->halfEdge;
  const Index target = origin[Mesh::next(h)];
  if (end - begin > 2)
  {
    throw InvalidInput("edge " + edgeName(origin[h], target) + " has " +
      std::to_string(end - begin) + " faces, among them face " + std::to_string(h / 3));
  }
  throw InvalidInput("faces " + std::to_string(h / 3) + " and " +
    std::to_string(begin[1].halfEdge / 3) + " run along edge " + edgeName(origin[h], target) +
    " in the same direction");
}

std::string checkSizes(const Mesh& mesh)
{
  if (mesh.origin.size() % 3 != 0)
  {
    return "the number of half-edges, " + std::to_string(mesh.origin.size()) +
      ", is no multiple of 3";
  }
  if (mesh.twin.size() != mesh.origin.size() || mesh.flags.size() != mesh.origin.size())
  {
    return "origin, twin and flags have " + std::to_string(mesh.origin.size()) + ", " +
      std::to_string(mesh.twin.size()) + " and " + std::to_string(mesh.flags.size()) + " entries";
  }
  return {};
}

std::string checkVertices(const Mesh& mesh)
{
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    pollNowAndThen(v);
    if (!mesh.position[v].allFinite())
    {
      return "vertex " + std::to_string(v) + " has a position that is not finite";
    }
  }
  return {};
}

/// What is wrong with a half-edge; null when nothing is.
const char* findFault(const Mesh& mesh, Index h)
{
  if (mesh.origin[h] >= mesh.vertexCount() || mesh.target(h) >= mesh.vertexCount())
  {
    return "names a vertex out of range";
  }
  if (mesh.origin[h] == mesh.target(h))
  {
    return "begins and ends at the same vertex";
  }
  const Index g = mesh.twin[h];
  if (g == kInvalidIndex)
  {
    return nullptr;
  }
  if (g >= mesh.halfEdgeCount() || mesh.twin[g] != h || Mesh::face(g) == Mesh::face(h))
  {
    return "has a twin that is not its twin";
  }
  if (mesh.origin[g] != mesh.target(h) || mesh.target(g) != mesh.origin[h])
  {
    return "and its twin do not join the same vertices";
  }
  return mesh.flags[g] == mesh.flags[h] ? nullptr : "and its twin have different flags";
}

std::string checkHalfEdges(const Mesh& mesh)
{
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    if (const char* const fault = findFault(mesh, h))
    {
      return "half-edge " + std::to_string(h) + " " + fault + " (vertex " +
        std::to_string(mesh.origin[h]) + ", twin " + std::to_string(mesh.twin[h]) + ")";
    }
  }
  return {};
}

/// Half-edges around `first`'s origin reach its neighbours once each; their number, or 0 when a
/// neighbour comes twice.
Index countFan(const Mesh& mesh, Index first, std::vector<Index>& lastSeenFrom)
{
  const Index v = mesh.origin[first];
  Index count = 0;
  Index h = first;
  do
  {
    ++count;
    if (std::exchange(lastSeenFrom[mesh.target(h)], v) == v)
    {
      return 0;
    }
    const Index incoming = Mesh::previous(h);
    if (mesh.isBoundary(incoming) && std::exchange(lastSeenFrom[mesh.origin[incoming]], v) == v)
    {
      return 0;
    }
    h = mesh.twin[incoming];
  } while (h != kInvalidIndex && h != first);
  return count;
}

std::string checkFans(const Mesh& mesh)
{
  const std::vector<Index> outgoing = outgoingHalfEdges(mesh);
  std::vector<Index> degree(mesh.vertexCount(), 0);
  for (const Index v : mesh.origin)
  {
    ++degree[v];
  }
  std::vector<Index> lastSeenFrom(mesh.vertexCount(), kInvalidIndex);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    pollNowAndThen(v);
    if (outgoing[v] == kInvalidIndex)
    {
      return "vertex " + std::to_string(v) + " is isolated";
    }
    const Index fan = countFan(mesh, outgoing[v], lastSeenFrom);
    if (fan == 0)
    {
      return "vertex " + std::to_string(v) + " is joined to a neighbour by two edges";
    }
    if (fan != degree[v])
    {
      return "vertex " + std::to_string(v) + " is not manifold: its " + std::to_string(degree[v]) +
        " faces are no single fan";
    }
  }
  return {};
}

bool acrossAll(Index)
{
  return true;
}

} // namespace

std::vector<Index> pairHalfEdges(const std::vector<Index>& origin, Index vertexCount, int threads)
{
  std::vector<Index> twin(origin.size(), kInvalidIndex);
  const EdgeRuns runs(origin, vertexCount, threads);
  const std::size_t refused = firstRefused(runs.bucketCount(), kMediumChunk, threads,
    [&](std::size_t v)
    {
      bool good = true;
      runs.forEachIn(v,
        [&](const EdgeRuns::Entry* begin, const EdgeRuns::Entry* end)
        {
          good = good && isManifold(origin, begin, end);
          if (good && end - begin == 2)
          {
            twin[begin->halfEdge] = begin[1].halfEdge;
            twin[begin[1].halfEdge] = begin->halfEdge;
          }
        });
      return good;
    });
  if (refused < runs.bucketCount())
  {
    runs.forEachIn(refused,
      [&](const EdgeRuns::Entry* begin, const EdgeRuns::Entry* end)
      {
        if (!isManifold(origin, begin, end))
        {
          refuseRun(origin, begin, end);
        }
      });
  }
  return twin;
}

std::vector<Index> outgoingHalfEdges(const Mesh& mesh, int threads)
{
  if (resolveThreads(threads) > 1 && mesh.halfEdgeCount() > kLightChunk)
  {
    return outgoingByThreads(mesh, threads);
  }
  std::vector<Index> outgoing(mesh.vertexCount(), kInvalidIndex);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    Index& first = outgoing[mesh.origin[h]];
    if (first == kInvalidIndex || mesh.isBoundary(h))
    {
      first = h;
    }
  }
  return outgoing;
}

std::vector<Index> constrainedEdges(const Mesh& mesh, int threads)
{
  // The twin of a boundary half-edge is above all others.
  return parallelSelect(mesh.halfEdgeCount(), kLightChunk, threads,
    [&](Index h) { return mesh.isConstrained(h) && h < mesh.twin[h]; });
}

Grouped<> edgesAtVertices(const Mesh& mesh, const std::vector<Index>& edges)
{
  return { mesh.vertexCount(),
    [&](const auto& visit)
    {
      for (std::size_t i = 0; i < edges.size(); ++i)
      {
        pollNowAndThen(i);
        visit(mesh.origin[edges[i]], edges[i]);
        visit(mesh.target(edges[i]), edges[i]);
      }
    } };
}

std::vector<std::uint8_t> constrainedVertices(const Mesh& mesh)
{
  return endsWhere(mesh, [&](Index h) { return mesh.isConstrained(h); });
}

std::vector<std::uint8_t> boundaryVertices(const Mesh& mesh)
{
  return endsWhere(mesh, [&](Index h) { return mesh.isBoundary(h); });
}

std::vector<Index> boundaryHalfEdges(const Mesh& mesh, int threads)
{
  return parallelSelect(
    mesh.halfEdgeCount(), kLightChunk, threads, [&](Index h) { return mesh.isBoundary(h); });
}

Index countBoundaryLoops(const Mesh& mesh, const std::vector<Index>& boundary)
{
  Index loops = 0;
  std::vector<bool> visited(boundary.empty() ? 0 : mesh.halfEdgeCount(), false);
  for (std::size_t i = 0; i < boundary.size(); ++i)
  {
    pollNowAndThen(i);
    loops += visited[boundary[i]] ? 0 : 1;
    for (Index e = boundary[i]; !visited[e]; e = nextOnBoundary(mesh, e))
    {
      visited[e] = true;
    }
  }
  return loops;
}

std::vector<int> regularTurns(const Mesh& mesh)
{
  std::vector<int> turns(mesh.vertexCount(), 4);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    if (mesh.isBoundary(h))
    {
      turns[mesh.origin[h]] = 2;
    }
  }
  return turns;
}

Index nextOnBoundary(const Mesh& mesh, Index h)
{
  Index e = Mesh::next(h);
  while (!mesh.isBoundary(e))
  {
    e = Mesh::next(mesh.twin[e]);
  }
  return e;
}

std::vector<Index> faceComponents(const Mesh& mesh, Index& componentCount, int threads)
{
  DisjointSets faces = joinedFaces(mesh, threads, acrossAll);
  return numberSets(faces, mesh.faceCount(), componentCount);
}

std::vector<Index> numberSets(DisjointSets& sets, Index count, Index& setCount)
{
  std::vector<Index> number(count);
  setCount = 0;
  for (Index i = 0; i < count; ++i)
  {
    pollNowAndThen(i);
    const Index root = sets.find(i);
    number[i] = root == i ? setCount++ : number[root];
  }
  return number;
}

TopologySummary summarizeTopology(const Mesh& mesh, int threads)
{
  TopologySummary summary;
  summary.vertices = mesh.vertexCount();
  summary.faces = mesh.faceCount();
  summary.components = static_cast<Index>(joinedFaces(mesh, threads, acrossAll).countSets());
  const std::vector<Index> boundary = boundaryHalfEdges(mesh, threads);
  summary.boundaryLoops = countBoundaryLoops(mesh, boundary);
  summary.edges = static_cast<Index>((std::size_t{ mesh.halfEdgeCount() } + boundary.size()) / 2);
  summary.eulerCharacteristic = static_cast<long long>(summary.vertices) -
    static_cast<long long>(summary.edges) + static_cast<long long>(summary.faces);
  return summary;
}

std::string validate(const Mesh& mesh)
{
  for (const auto check : { checkSizes, checkVertices, checkHalfEdges, checkFans })
  {
    std::string error = check(mesh);
    if (!error.empty())
    {
      return error;
    }
  }
  return {};
}

} // namespace quadrille
