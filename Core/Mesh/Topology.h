// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Connectivity queries on Mesh that are shared by all stages.
#pragma once

#include "Base/DisjointSets.h"
#include "Base/Lists.h"
#include "Base/Progress.h"
#include "Mesh/Mesh.h"

#include <array>
#include <string>
#include <vector>

namespace quadrille
{

/// Pairs half-edges of a manifold, oriented triangle list: #H twins. Linear time (bucket per vertex).
/// Throws InvalidInput naming the edge when more than two faces share one or orientation disagrees.
std::vector<Index> pairHalfEdges(
  const std::vector<Index>& origin, Index vertexCount, int threads = 1);

/// One half-edge that leaves each vertex (#V): for a boundary vertex the boundary half-edge itself
/// (so that rotating counterclockwise visits the whole fan), kInvalidIndex for an isolated vertex. Else the lowest one.
std::vector<Index> outgoingHalfEdges(const Mesh& mesh, int threads = 1);

/// One half-edge, the lower one, of each edge that is a feature or on the boundary; ascending.
std::vector<Index> constrainedEdges(const Mesh& mesh, int threads = 1);

/// Of some edges, given by one half-edge each, those that end at each vertex (#V), in the order in which they are
/// given.
Grouped<> edgesAtVertices(const Mesh& mesh, const std::vector<Index>& edges);

/// Flags (#V) of the ends of half-edges for which the predicate holds.
template <typename Predicate>
std::vector<std::uint8_t> endsWhere(const Mesh& mesh, const Predicate& predicate)
{
  std::vector<std::uint8_t> flags(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    if (predicate(h))
    {
      flags[mesh.origin[h]] = flags[mesh.target(h)] = 1;
    }
  }
  return flags;
}

/// Flags (#V) of the ends of edges that are features or on the boundary.
std::vector<std::uint8_t> constrainedVertices(const Mesh& mesh);

/// Flags (#V) of the ends of boundary edges.
std::vector<std::uint8_t> boundaryVertices(const Mesh& mesh);

/// Quarter turns of a map round each vertex (#V) where none is irregular: 4, on a boundary 2.
std::vector<int> regularTurns(const Mesh& mesh);

/// The boundary half-edge that follows a boundary half-edge on its loop.
Index nextOnBoundary(const Mesh& mesh, Index h);

/// Faces that hang together across the edges that the predicate lets through, given by their higher half-edges.
template <typename Predicate>
DisjointSets joinedFaces(const Mesh& mesh, int threads, const Predicate& isOpen)
{
  DisjointSets faces(mesh.faceCount(), threads);
  parallelForEach(mesh.faceCount(), kLightChunk, threads,
    [&](Index f)
    {
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        if (mesh.twin[h] < h && isOpen(h))
        {
          faces.join(f, Mesh::face(mesh.twin[h]));
        }
      }
    });
  return faces;
}

/// Set id per element (count of them), numbered by lowest element; the number of sets comes back in setCount.
std::vector<Index> numberSets(DisjointSets& sets, Index count, Index& setCount);

/// Component id per face, numbered by lowest face id; the count comes back in componentCount.
std::vector<Index> faceComponents(const Mesh& mesh, Index& componentCount, int threads = 1);

/// The boundary half-edges, ascending.
std::vector<Index> boundaryHalfEdges(const Mesh& mesh, int threads = 1);

/// Loops of the boundary; halfEdges: boundaryHalfEdges of the mesh.
Index countBoundaryLoops(const Mesh& mesh, const std::vector<Index>& halfEdges);

struct TopologySummary
{
  Index vertices = 0;
  Index edges = 0;
  Index faces = 0;
  Index components = 0;
  Index boundaryLoops = 0;
  long long eulerCharacteristic = 0;
};
/// Parallel; the same for any number of threads.
TopologySummary summarizeTopology(const Mesh& mesh, int threads = 1);

/// Empty when the mesh is consistent (twins symmetric, vertices manifold, flags symmetric,
/// finite positions, no isolated vertices); else what is wrong with which element.
std::string validate(const Mesh& mesh);

} // namespace quadrille
