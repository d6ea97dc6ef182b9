// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Details/LoopNeighbourhood.h"

#include "Base/DisjointSets.h"
#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace quadrille
{
namespace
{

/// A part of more than so much of the surface is not worth it.
constexpr std::size_t kLeastShare = 4;

class Neighbourhood
{
public:
  Neighbourhood(const Mesh& mesh, int threads)
    : mesh_(mesh), threads_(threads), outgoing_(outgoingHalfEdges(mesh, threads)),
      inside_(mesh.faceCount(), 0)
  {
  }

  /// Whether the part stays small and off the boundary.
  bool grow(const std::vector<Index>& roots, double radius)
  {
    std::vector<Index> reachedFrom(mesh_.vertexCount(), kInvalidIndex);
    for (Index i = 0; i < roots.size(); ++i)
    {
      std::vector<Index> stack{ roots[i] };
      reachedFrom[roots[i]] = i;
      while (!stack.empty())
      {
        const Index v = stack.back();
        stack.pop_back();
        if (!takeStar(v))
        {
          return false;
        }
        forEachInFan(mesh_, outgoing_[v],
          [&](Index h)
          {
            const Index w = mesh_.target(h);
            if (reachedFrom[w] != i &&
              (mesh_.position[w] - mesh_.position[roots[i]]).norm() <= radius)
            {
              reachedFrom[w] = i;
              stack.push_back(w);
            }
          });
      }
    }
    return closePinches();
  }

  LoopNeighbourhood make()
  {
    std::sort(faces_.begin(), faces_.end());
    LoopNeighbourhood part;
    part.face = faces_;
    for (const Index f : faces_)
    {
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        part.vertex.push_back(mesh_.origin[h]);
      }
    }
    sortUnique(part.vertex);
    for (const Index v : part.vertex)
    {
      part.mesh.position.push_back(mesh_.position[v]);
    }
    for (const Index f : faces_)
    {
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        part.mesh.origin.push_back(indexIn(part.vertex, mesh_.origin[h]));
      }
    }
    for (const std::vector<std::vector<Index>>& loops : loopsOfPieces())
    {
      putSphere(loops, part);
    }
    part.mesh.flags.assign(part.mesh.origin.size(), 0);
    part.mesh.twin = pairHalfEdges(part.mesh.origin, part.mesh.vertexCount());
    return part;
  }

private:
  using Triangle = std::array<Index, 3>;

  /// Takes all faces at a vertex; false at the boundary and where they become too many.
  bool takeStar(Index v)
  {
    if (mesh_.isBoundary(outgoing_[v]))
    {
      return false;
    }
    forEachInFan(mesh_, outgoing_[v],
      [&](Index h)
      {
        const Index f = Mesh::face(h);
        if (inside_[f] == 0)
        {
          inside_[f] = 1;
          faces_.push_back(f);
        }
      });
    return faces_.size() * kLeastShare < mesh_.faceCount();
  }

  bool isInside(Index h) const { return inside_[Mesh::face(h)] != 0; }
  /// Whether the half-edge of a face of the part has no face of the part beyond it.
  bool isRim(Index h) const { return mesh_.isBoundary(h) || !isInside(mesh_.twin[h]); }

  /// Takes the stars of vertices at which the rim of the part meets itself.
  bool closePinches()
  {
    for (std::size_t i = 0; i < faces_.size(); ++i)
    {
      pollNowAndThen(i);
      for (Index h = 3 * faces_[i]; h < 3 * faces_[i] + 3; ++h)
      {
        if (!isRim(h))
        {
          continue;
        }
        if (mesh_.isBoundary(h))
        {
          return false;
        }
        int leaving = 0;
        forEachInFan(mesh_, outgoing_[mesh_.origin[h]],
          [&](Index g) { leaving += isInside(g) && isRim(g) ? 1 : 0; });
        // Faces that come are looked at later, as are those that they make a pinch of: they are rims of one of them.
        if (leaving > 1 && !takeStar(mesh_.origin[h]))
        {
          return false;
        }
      }
    }
    return true;
  }

  /// The loops that the part has in common with the rest: vertices in the order of the part's half-edges, and one of
  /// these.
  struct Loop
  {
    std::vector<Index> vertices;
    Index halfEdge;
  };
  std::vector<Loop> rimLoops() const
  {
    std::vector<Loop> loops;
    std::vector<Index> seen; // half-edges of loops so far
    for (const Index f : faces_)
    {
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        if (!isRim(h) || std::binary_search(seen.begin(), seen.end(), h))
        {
          continue;
        }
        Loop loop{ {}, h };
        Index e = h;
        do
        {
          loop.vertices.push_back(mesh_.origin[e]);
          seen.push_back(e);
          e = Mesh::next(e);
          while (!isRim(e))
          {
            e = Mesh::next(mesh_.twin[e]);
          }
        } while (e != h);
        std::sort(seen.begin(), seen.end());
        loops.push_back(std::move(loop));
      }
    }
    return loops;
  }

  /// The loops by the pieces of the rest.
  std::vector<std::vector<std::vector<Index>>> loopsOfPieces() const
  {
    std::vector<Loop> loops = rimLoops();
    std::map<Index, std::vector<std::vector<Index>>> loopsOf;
    if (loops.size() > 1)
    {
      DisjointSets pieces = piecesOfRest();
      for (Loop& loop : loops)
      {
        loopsOf[pieces.find(Mesh::face(mesh_.twin[loop.halfEdge]))].push_back(
          std::move(loop.vertices));
      }
    }
    else if (!loops.empty())
    {
      loopsOf[0].push_back(std::move(loops.front().vertices));
    }
    std::vector<std::vector<std::vector<Index>>> result;
    result.reserve(loopsOf.size());
    for (auto& [piece, ofPiece] : loopsOf)
    {
      result.push_back(std::move(ofPiece));
    }
    return result;
  }

  /// Faces outside that hang together.
  DisjointSets piecesOfRest() const
  {
    return joinedFaces(
      mesh_, threads_, [this](Index h) { return !isInside(h) && !isInside(mesh_.twin[h]); });
  }

  /// A fan for each loop; from one to the next a face of each, with a hole in its middle that is that of the other.
  void putSphere(const std::vector<std::vector<Index>>& loops, LoopNeighbourhood& part) const
  {
    Triangle joint{};
    for (std::size_t i = 0; i < loops.size(); ++i)
    {
      const std::vector<Index>& loop = loops[i];
      const Index middle = addVertex(part);
      for (std::size_t k = 0; k < loop.size(); ++k)
      {
        const Triangle face{ indexIn(part.vertex, loop[(k + 1) % loop.size()]),
          indexIn(part.vertex, loop[k]), middle };
        if (k == 0 && i > 0)
        {
          addFrame(face, { joint[0], joint[2], joint[1] }, part);
        }
        else if (k == 1 && i + 1 < loops.size())
        {
          joint = { addVertex(part), addVertex(part), addVertex(part) };
          addFrame(face, joint, part);
        }
        else
        {
          part.mesh.origin.append(face.begin(), face.end());
        }
      }
    }
  }

  static Index addVertex(LoopNeighbourhood& part)
  {
    part.mesh.position.push_back(Vector3::Zero()); // no path comes here
    return part.mesh.vertexCount() - 1;
  }

  /// What is left of a triangle with a hole.
  static void addFrame(const Triangle& outer, const Triangle& hole, LoopNeighbourhood& part)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const std::size_t next = (k + 1) % 3;
      const std::array<Index, 6> corners{ outer[k], outer[next], hole[next], outer[k], hole[next],
        hole[k] };
      part.mesh.origin.append(corners.begin(), corners.end());
    }
  }

  const Mesh& mesh_;
  int threads_;
  std::vector<Index> outgoing_;
  std::vector<std::uint8_t> inside_; ///< #F
  std::vector<Index> faces_;         ///< inside
};

} // namespace

std::optional<LoopNeighbourhood> loopNeighbourhood(
  const Mesh& mesh, const std::vector<Index>& roots, double radius, int threads)
{
  if (!mesh.sizing.empty())
  {
    return std::nullopt;
  }
  Neighbourhood part(mesh, threads);
  if (!part.grow(roots, radius))
  {
    return std::nullopt;
  }
  return part.make();
}

} // namespace quadrille
