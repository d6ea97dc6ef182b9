// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/CutGraph.h"

#include "Base/PlaceText.h"
#include "Base/Refuse.h"
#include "Mesh/BreadthFirst.h"
#include "Mesh/Topology.h"

#include <string>

namespace quadrille
{
namespace
{

void checkEdges(const Mesh& mesh, const CrossField& field)
{
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Index g = mesh.twin[h];
    refuseIf(mesh.isConstrained(h) != (field.alignment[h] >= 0), "cross field: half-edge ", h,
      " is constrained but not aligned, or the other way round");
    if (g == kInvalidIndex)
    {
      continue;
    }
    refuseIf(((field.matching[h] + field.matching[g]) & 3) != 0, "cross field: half-edge ", h,
      " and its twin have matchings that are not inverse to each other");
    refuseIf(mesh.isFeature(h) &&
        ((field.alignment[g] + 2 - field.alignment[h] - field.matching[h]) & 3) != 0,
      "cross field: half-edge ", h, " has a matching that contradicts its alignments");
  }
}

/// Round an interior vertex the directions turn by `turns` and by the matchings: a full circle.
void checkVertices(const Mesh& mesh, const CrossField& field)
{
  std::vector<int> sum(mesh.vertexCount(), 0);
  std::vector<bool> interior(mesh.vertexCount(), true);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    sum[mesh.target(h)] += field.matching[h];
    if (mesh.isBoundary(h))
    {
      interior[mesh.origin[h]] = interior[mesh.target(h)] = false;
    }
  }
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    if (interior[v] && ((sum[v] + field.turns[v]) & 3) != 0)
    {
      throw InvalidInput("cross field: the matchings round the vertex near " +
        placeText(mesh.position[v]) + " contradict its " + std::to_string(field.turns[v]) +
        " quarter turns");
    }
  }
}

void checkField(const Mesh& mesh, const CrossField& field)
{
  refuseIf(field.matching.size() != mesh.origin.size() ||
      field.alignment.size() != mesh.origin.size() || field.angle.size() != mesh.faceCount() ||
      field.turns.size() != mesh.position.size(),
    "cross field: it does not have the size of the mesh");
  checkEdges(mesh, field);
  checkVertices(mesh, field);
}

class Cutter
{
public:
  Cutter(const Mesh& mesh, const CrossField& field, CutGraph& graph)
    : mesh_(mesh), field_(field), graph_(graph), cut_(mesh.origin.size(), false)
  {
  }

  void run()
  {
    comb();
    prune();
    numberWedges();
    traceSegments();
  }

private:
  int combedRotation(Index h) const
  {
    return (graph_.comb[Mesh::face(mesh_.twin[h])] + field_.matching[h] -
             graph_.comb[Mesh::face(h)]) &
      3;
  }

  /// Breadth-first trees over the dual edges; what they do not cross is cut.
  void comb()
  {
    graph_.comb.assign(mesh_.faceCount(), 0);
    graph_.component.assign(mesh_.faceCount(), kInvalidIndex);
    std::vector<bool> crossed(mesh_.origin.size(), false);
    const auto begin = [&](Index seed) { graph_.component[seed] = graph_.components++; };
    const auto enter = [&](Index h)
    {
      const Index g = mesh_.twin[h], f = Mesh::face(h);
      graph_.component[Mesh::face(g)] = graph_.component[f];
      graph_.comb[Mesh::face(g)] =
        static_cast<std::uint8_t>((graph_.comb[f] - field_.matching[h]) & 3);
      crossed[h] = crossed[g] = true;
      return true;
    };
    visitFaces(mesh_.twin, begin, enter);
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      cut_[h] = !mesh_.isBoundary(h) && !crossed[h];
    }
  }

  /// Closes the ends of the cut that do not end in a singularity or on the boundary.
  void prune()
  {
    outgoing_ = outgoingHalfEdges(mesh_);
    degree_.assign(mesh_.vertexCount(), 0);
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      degree_[mesh_.origin[h]] += cut_[h] ? 1 : 0;
    }
    for (Index start = 0; start < mesh_.vertexCount(); ++start)
    {
      for (Index v = start; degree_[v] == 1 && !mesh_.isBoundary(outgoing_[v]);)
      {
        const Index h = cutHalfEdgeFrom(v);
        if (combedRotation(h) != 0)
        {
          break;
        }
        cut_[h] = cut_[mesh_.twin[h]] = false;
        --degree_[v];
        v = mesh_.target(h);
        --degree_[v];
      }
    }
  }

  Index cutHalfEdgeFrom(Index v) const
  {
    Index h = outgoing_[v];
    while (!cut_[h])
    {
      h = mesh_.rotateCounterclockwise(h);
    }
    return h;
  }

  void numberWedges()
  {
    graph_.wedge.assign(mesh_.origin.size(), kInvalidIndex);
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      if (graph_.wedge[h] == kInvalidIndex)
      {
        fillWedge(h, graph_.wedges++);
      }
    }
  }

  void fillWedge(Index start, Index id)
  {
    Index h = start;
    do // counterclockwise up to a cut or round the vertex
    {
      graph_.wedge[h] = id;
      h = cut_[Mesh::previous(h)] ? kInvalidIndex : mesh_.rotateCounterclockwise(h);
    } while (h != kInvalidIndex && h != start);
    if (h == start)
    {
      return;
    }
    for (h = start; !cut_[h] && !mesh_.isBoundary(h);)
    {
      h = mesh_.rotateClockwise(h);
      graph_.wedge[h] = id;
    }
  }

  /// A vertex that a segment passes through: what lies left of the cut there stays left of it.
  bool isPassed(Index v) const
  {
    return degree_[v] == 2 && (field_.turns[v] & 3) == 0 && !mesh_.isBoundary(outgoing_[v]);
  }

  void traceSegments()
  {
    graph_.segment.assign(mesh_.origin.size(), kInvalidIndex);
    std::vector<bool> seen(mesh_.origin.size(), false);
    for (const bool wholeLoops : { false, true })
    {
      for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
      {
        if (cut_[h] && !seen[h] && (wholeLoops || !isPassed(mesh_.origin[h])))
        {
          traceSegment(h, seen);
        }
      }
    }
  }

  void traceSegment(Index h, std::vector<bool>& seen)
  {
    const Index id = static_cast<Index>(graph_.rotation.size());
    graph_.rotation.push_back(static_cast<std::uint8_t>(combedRotation(h)));
    while (!seen[h])
    {
      seen[h] = seen[mesh_.twin[h]] = true;
      graph_.segment[h] = id;
      graph_.path.push_back(h);
      if (!isPassed(mesh_.target(h)))
      {
        break;
      }
      h = Mesh::next(h);
      while (!cut_[h])
      {
        h = mesh_.rotateClockwise(h);
      }
    }
  }

  const Mesh& mesh_;
  const CrossField& field_;
  CutGraph& graph_;
  std::vector<bool> cut_;
  std::vector<Index> outgoing_;
  std::vector<int> degree_; ///< cut edges at a vertex
};

} // namespace

CutGraph cutAlongField(const Mesh& mesh, const CrossField& field)
{
  checkField(mesh, field);
  CutGraph graph;
  Cutter(mesh, field, graph).run();
  return graph;
}

} // namespace quadrille
