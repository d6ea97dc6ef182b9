// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/StarKernel.h"

#include "Base/RingKernel.h"

#include <algorithm>
#include <optional>

namespace quadrille
{

namespace
{

/// Half-edges that leave the vertex, counterclockwise, from that on the boundary if there is one.
std::vector<Index> starAt(const UvMesh& mesh, Index corner)
{
  Index first = corner;
  while (mesh.twin[first] != kInvalidIndex)
  {
    first = Mesh::next(mesh.twin[first]);
    if (first == corner)
    {
      break;
    }
  }
  std::vector<Index> star;
  for (Index h = first; h != kInvalidIndex && (star.empty() || h != first);
       h = mesh.twin[Mesh::previous(h)])
  {
    star.push_back(h);
  }
  return star;
}

} // namespace

bool moveIntoKernel(UvMesh& mesh, Index corner)
{
  const Index v = mesh.origin[corner];
  const std::vector<Index> star = starAt(mesh, corner);
  const bool closed = mesh.twin[star.front()] != kInvalidIndex;
  if (star.size() >= kMaximumRing ||
    std::any_of(star.begin(), star.end(),
      [&](Index h) { return mesh.target(h) == v || mesh.origin[Mesh::previous(h)] == v; }))
  {
    return false;
  }
  // All in the chart of the first face.
  const FixedVec2 from = mesh.uv[star.front()];
  std::vector<FixedVec2> ring;
  std::vector<int> turns{ 0 }; // from the chart of each face
  std::vector<FixedVec2> along;
  for (const Index h : star)
  {
    ring.push_back(from + rotate(mesh.vector(h), turns.back()));
    if (mesh.isFixed(h))
    {
      along.push_back(ring.back());
    }
    turns.push_back(turns.back() - mesh.rotation[Mesh::previous(h)]);
  }
  if (!closed)
  {
    ring.push_back(from - rotate(mesh.vector(Mesh::previous(star.back())), turns[star.size() - 1]));
    along.push_back(ring.back());
  }
  const int count = static_cast<int>(ring.size());
  std::optional<FixedVec2> to;
  if (along.empty())
  {
    to = kernelPoint(ring.data(), count, closed);
  }
  else if (along.size() == 2)
  {
    to = kernelPointOnSegment(ring.data(), count, closed, along.front(), along.back());
  }
  for (std::size_t i = 0; to && i < star.size(); ++i)
  {
    mesh.uv[star[i]] = mesh.uv[star[i]] + rotate(*to - from, -turns[i]);
  }
  return to.has_value();
}

} // namespace quadrille
