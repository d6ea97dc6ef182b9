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

/// The half-edge on the boundary that leaves the vertex at `corner`, or that of the corner where there is none.
Index beginOfStar(const UvMesh& mesh, Index corner)
{
  Index h = corner;
  while (mesh.twin[h] != kInvalidIndex)
  {
    h = Mesh::next(mesh.twin[h]);
    if (h == corner)
    {
      break;
    }
  }
  return h;
}

} // namespace

bool moveIntoKernel(UvMesh& mesh, Index corner)
{
  const Index v = mesh.origin[corner];
  const std::vector<Index> star = mesh.starFrom(beginOfStar(mesh, corner));
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
