// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/FaceSpread.h"

#include <queue>
#include <tuple>

namespace quadrille
{

std::vector<Index> spreadOverFaces(const Mesh& mesh, const std::vector<SpreadStart>& starts,
  const std::function<bool(Index)>& mayCross)
{
  using Front = std::tuple<double, Index, Index>; // distance, face, start
  std::priority_queue<Front, std::vector<Front>, std::greater<Front>> queue;
  std::vector<Index> reached(mesh.faceCount(), kInvalidIndex);
  const auto offer = [&](Index face, Index start)
  {
    const double distance = (mesh.middleOfFace(face) - starts[start].from).norm();
    if (reached[face] == kInvalidIndex && distance <= starts[start].reach)
    {
      queue.push({ distance, face, start });
    }
  };
  for (Index i = 0; i < starts.size(); ++i)
  {
    offer(starts[i].face, i);
  }
  while (!queue.empty())
  {
    const auto [distance, face, start] = queue.top();
    queue.pop();
    if (reached[face] != kInvalidIndex)
    {
      continue;
    }
    reached[face] = start;
    for (Index h = 3 * face; h < 3 * face + 3; ++h)
    {
      if (!mesh.isBoundary(h) && mayCross(h))
      {
        offer(Mesh::face(mesh.twin[h]), start);
      }
    }
  }
  return reached;
}

} // namespace quadrille
