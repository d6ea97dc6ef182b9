// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/MergePoints.h"

#include "Base/DisjointSets.h"
#include "Base/Lists.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace quadrille
{

namespace
{

/// An open edge by the places of its ends: a place is the lowest open vertex there.
struct OpenEdge
{
  std::array<Index, 2> place;  ///< sorted
  std::array<Index, 2> vertex; ///< in the order of the places

  bool operator<(const OpenEdge& other) const
  {
    return std::tie(place, vertex) < std::tie(other.place, other.vertex);
  }
};

std::vector<Index> openHalfEdges(const EdgeRuns& runs)
{
  std::vector<Index> halfEdges;
  runs.forEach(
    [&](const EdgeRuns::Entry* begin, const EdgeRuns::Entry* end)
    {
      if (end - begin == 1)
      {
        halfEdges.push_back(begin->halfEdge);
      }
    });
  return halfEdges;
}

/// #V; for ends of the half-edges the lowest of them at the same coordinates, else the vertex itself.
std::vector<Index> placesOf(const Mesh& mesh, const std::vector<Index>& halfEdges)
{
  std::vector<Index> ends;
  for (const Index h : halfEdges)
  {
    ends.push_back(mesh.origin[h]);
    ends.push_back(mesh.target(h));
  }
  sortUnique(ends);
  const auto coordinates = [&mesh](Index v)
  { return std::tie(mesh.position[v].x(), mesh.position[v].y(), mesh.position[v].z()); };
  std::stable_sort(
    ends.begin(), ends.end(), [&](Index a, Index b) { return coordinates(a) < coordinates(b); });

  std::vector<Index> place(mesh.vertexCount());
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    place[v] = v;
  }
  for (std::size_t i = 1; i < ends.size(); ++i)
  {
    if (coordinates(ends[i - 1]) == coordinates(ends[i]))
    {
      place[ends[i]] = place[ends[i - 1]];
    }
  }
  return place;
}

std::vector<OpenEdge> sortedByPlace(
  const Mesh& mesh, const std::vector<Index>& halfEdges, const std::vector<Index>& place)
{
  std::vector<OpenEdge> edges;
  edges.reserve(halfEdges.size());
  for (const Index h : halfEdges)
  {
    Index a = mesh.origin[h], b = mesh.target(h);
    if (place[a] > place[b])
    {
      std::swap(a, b);
    }
    edges.push_back({ { place[a], place[b] }, { a, b } });
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

} // namespace

std::size_t mergeOpenEdges(Mesh& mesh, const EdgeRuns& runs)
{
  const std::vector<Index> halfEdges = openHalfEdges(runs);
  if (halfEdges.empty())
  {
    return 0;
  }
  const std::vector<OpenEdge> edges = sortedByPlace(mesh, halfEdges, placesOf(mesh, halfEdges));
  DisjointSets classes(mesh.vertexCount(), 1);
  std::size_t merged = 0;
  for (std::size_t i = 1; i < edges.size(); ++i)
  {
    if (edges[i - 1].place == edges[i].place)
    {
      merged += classes.join(edges[i - 1].vertex[0], edges[i].vertex[0]) ? 1 : 0;
      merged += classes.join(edges[i - 1].vertex[1], edges[i].vertex[1]) ? 1 : 0;
    }
  }
  for (Index& v : mesh.origin.editAll())
  {
    v = classes.find(v);
  }
  return merged;
}

} // namespace quadrille
