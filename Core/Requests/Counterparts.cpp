// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/Counterparts.h"

#include "Base/Angles.h"
#include "Base/Lists.h"
#include "Base/Progress.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace quadrille
{

namespace
{

constexpr int kSquares = 8;
/// Of the side: so near to a corner a vertex has to be.
constexpr double kNearCorner = 0.5;

/// Of the face round a vertex, within a distance of it.
struct Surroundings
{
  std::vector<Index> inside, bounding; ///< vertices
  Vector3 normal = Vector3::Zero();    ///< at the vertex, not of length 1
};

Surroundings surroundingsOf(const Mesh& mesh, Index vertex, double distance)
{
  const std::vector<std::uint8_t> isBounding = constrainedVertices(mesh);
  const Grouped<> leaving(mesh.vertexCount(),
    [&mesh](const auto& visit)
    {
      for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
      {
        visit(mesh.origin[h], h);
      }
    });
  Surroundings found;
  std::vector<std::uint8_t> isKnown(mesh.vertexCount(), 0);
  std::vector<Index> next{ vertex };
  isKnown[vertex] = 1;
  for (std::size_t i = 0; i < next.size(); ++i)
  {
    const Index v = next[i];
    (isBounding[v] != 0 ? found.bounding : found.inside).push_back(v);
    for (auto h = leaving.begin(v); h != leaving.end(v) && isBounding[v] == 0; ++h)
    {
      const Index to = mesh.target(*h);
      const bool isNear = (mesh.position[to] - mesh.position[vertex]).norm() <= distance;
      if (isNear && isKnown[to] == 0)
      {
        isKnown[to] = 1;
        next.push_back(to);
      }
      if (v == vertex)
      {
        found.normal += mesh.edgeVector(*h).cross(-mesh.edgeVector(Mesh::previous(*h)));
      }
    }
  }
  return found;
}

} // namespace

std::vector<ValenceRequest> counterparts(
  const PreparedSurface& surface, const ValenceRequest& asked, double side)
{
  const Mesh& mesh = surface.mesh;
  const Surroundings around =
    surroundingsOf(mesh, asked.vertex, (std::sqrt(2.0) + kNearCorner) * side);
  if (around.inside.empty())
  {
    return {}; // on a feature or the boundary
  }
  const Vector3 middle = mesh.position[asked.vertex];
  const Vector3 u = around.normal.unitOrthogonal();
  const Vector3 v = around.normal.cross(u).stableNormalized();
  const auto nearest = [&](const std::vector<Index>& vertices, const Vector3& place)
  {
    return *std::min_element(vertices.begin(), vertices.end(),
      [&](Index a, Index b)
      { return (mesh.position[a] - place).norm() < (mesh.position[b] - place).norm(); });
  };
  std::vector<ValenceRequest> best;
  double farthest = 0;
  for (int k = 0; k < kSquares; ++k)
  {
    const double angle = 2 * kPi * k / kSquares;
    const Vector3 a = side * (std::cos(angle) * u + std::sin(angle) * v);
    const Vector3 b = side * (std::cos(angle) * v - std::sin(angle) * u);
    const int opposite = 2 * kRegularValence - asked.valence;
    const std::array<std::pair<Vector3, int>, 3> corners{ { { middle + a, opposite },
      { middle + a + b, asked.valence }, { middle + b, opposite } } };
    std::vector<ValenceRequest> square;
    double room = kInfinity;
    for (const auto& [place, valence] : corners)
    {
      const Index at = nearest(around.inside, place);
      const bool isTaken =
        std::any_of(surface.valenceRequests.begin(), surface.valenceRequests.end(),
          [&](const ValenceRequest& other) { return other.vertex == at; });
      const bool isUsed = std::any_of(square.begin(), square.end(),
        [&](const ValenceRequest& other) { return other.vertex == at; });
      if (isTaken || isUsed || (mesh.position[at] - place).norm() > kNearCorner * side)
      {
        room = 0;
        break;
      }
      square.push_back({ at, valence, kInvalidIndex, true });
      for (const Index other : around.bounding)
      {
        room = std::min(room, (mesh.position[other] - mesh.position[at]).norm());
      }
    }
    if (room > farthest)
    {
      farthest = room;
      best = std::move(square);
    }
  }
  return best;
}

} // namespace quadrille
