// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/LockedVertices.h"

#include "Mesh/Topology.h"

#include <algorithm>

namespace quadrille
{

namespace
{

/// Isolines farther apart than this in the seamless map are not expected to coincide after quantization.
constexpr std::int64_t kFarApart = 2 * kOne;

enum Lock : std::uint8_t
{
  kLockedU = 1,
  kLockedV = 2
};

/// Flags the first vertex of every set (of those with a vertex that counts) that has no flag yet.
void flagOnePerSet(
  DisjointSets& sets, const std::vector<std::uint8_t>& counts, std::vector<std::uint8_t>& flags)
{
  const Index vertices = static_cast<Index>(flags.size());
  std::vector<std::uint8_t> served(vertices, 0);
  for (Index v = 0; v < vertices; ++v)
  {
    served[sets.find(v)] |= flags[v];
  }
  for (Index v = 0; v < vertices; ++v)
  {
    if (counts[v] && sets.find(v) == v && !served[v])
    {
      flags[v] = 1;
    }
  }
}

void keepWhatTopologyNeeds(const Mesh& mesh, LockedVertices& locked)
{
  DisjointSets curves(mesh.vertexCount(), 1), components(mesh.vertexCount(), 1);
  const std::vector<std::uint8_t> onCurve = constrainedVertices(mesh);
  std::vector<std::uint8_t> used(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    used[mesh.origin[h]] = 1;
    components.join(mesh.origin[h], mesh.target(h));
    if (mesh.isConstrained(h))
    {
      curves.join(mesh.origin[h], mesh.target(h));
    }
  }
  flagOnePerSet(curves, onCurve, locked.keep);
  // A component needs a whole point to count from, be it on a curve.
  std::vector<std::uint8_t> anchored = locked.integer;
  flagOnePerSet(components, used, anchored);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    locked.integer[v] |= anchored[v];
    locked.keep[v] |= anchored[v];
  }
}

/// #H: which coordinates of the corner are locked, in the chart of its face.
std::vector<std::uint8_t> cornerLocks(
  const Mesh& mesh, const UvMesh& map, const std::vector<std::uint8_t>& integer)
{
  std::vector<std::uint8_t> locks(mesh.halfEdgeCount(), 0);
  std::vector<std::uint8_t> done(mesh.vertexCount(), 0);
  for (Index first = 0; first < mesh.halfEdgeCount(); ++first)
  {
    const Index v = mesh.origin[first];
    if (integer[v])
    {
      locks[first] = kLockedU | kLockedV;
    }
    else if (mesh.isConstrained(first) && !done[v])
    {
      done[v] = 1;
      bool alongU = map.vector(first).v == 0;
      // For a boundary vertex this is its first corner, so the fan is complete.
      forEachFrom(mesh, first,
        [&](Index h)
        {
          locks[h] = alongU ? kLockedV : kLockedU;
          alongU = alongU == (map.rotation[Mesh::previous(h)] % 2 == 0);
        });
    }
  }
  return locks;
}

std::int64_t spread(std::int64_t a, std::int64_t b, std::int64_t c)
{
  return std::max({ a, b, c }) - std::min({ a, b, c });
}

/// Whether the integers alone can make face f degenerate.
bool canBeCrushed(const UvMesh& map, const std::vector<std::uint8_t>& locks, Index f)
{
  const std::uint8_t common = locks[3 * f] & locks[3 * f + 1] & locks[3 * f + 2];
  const FixedVec2 a = map.uv[3 * f], b = map.uv[3 * f + 1], c = map.uv[3 * f + 2];
  return ((common & kLockedU) != 0 && spread(a.u, b.u, c.u) < kFarApart) ||
    ((common & kLockedV) != 0 && spread(a.v, b.v, c.v) < kFarApart);
}

void keepSurrounded(const Mesh& mesh, std::vector<std::uint8_t>& keep)
{
  std::vector<std::uint8_t> open(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    open[mesh.origin[h]] |= mesh.isConstrained(h) || !keep[mesh.target(h)] ? 1 : 0;
    open[mesh.target(h)] |= mesh.isConstrained(h) || !keep[mesh.origin[h]] ? 1 : 0;
  }
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    keep[v] |= open[v] ? 0 : 1;
  }
}

} // namespace

LockedVertices lockedVertices(const Mesh& mesh, const UvMesh& map,
  const std::vector<std::uint8_t>& needed, const std::vector<Index>& extra)
{
  LockedVertices locked{ needed, needed };
  keepWhatTopologyNeeds(mesh, locked);
  const std::vector<std::uint8_t> locks = cornerLocks(mesh, map, locked.integer);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    if (canBeCrushed(map, locks, f))
    {
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        locked.keep[mesh.origin[h]] = 1;
      }
    }
  }
  for (const Index v : extra)
  {
    locked.keep.at(v) = 1;
  }
  keepSurrounded(mesh, locked.keep);
  return locked;
}

} // namespace quadrille
