// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/MapCheck.h"

#include "Base/Lists.h"

#include <algorithm>

namespace quadrille
{
namespace
{

/// The quadrant [0, 90), [90, 180), ... degrees of a vector; -1 for the zero vector.
int quadrantOf(FixedVec2 d)
{
  return d == FixedVec2{} ? -1 : quadrantOfNonzero(d);
}

/// The sector that begins at constrained half-edge `start`: its corners, counterclockwise.
template <typename Visit>
void forSector(const Mesh& mesh, Index start, Visit visit)
{
  Index h = start;
  do
  {
    visit(h);
    h = mesh.rotateCounterclockwise(h);
  } while (h != kInvalidIndex && h != start && !mesh.isConstrained(h));
}

void checkSectors(const Mesh& mesh, const CrossField& field,
  const std::vector<std::int8_t>& entered, std::vector<std::uint8_t>& wrong)
{
  for (Index start = 0; start < mesh.halfEdgeCount(); ++start)
  {
    if (field.sectorTurns[start] > 0)
    {
      int turns = 0;
      forSector(mesh, start, [&](Index h) { turns += entered[h]; });
      if (turns != field.sectorTurns[start])
      {
        wrong[mesh.origin[start]] = 1;
      }
    }
  }
}

bool runsAlongItsAxis(const std::vector<FixedVec2>& uv, Index h, int axis)
{
  const FixedVec2 d = rotate(uv[Mesh::next(h)] - uv[h], -axis);
  return d.u > 0 && d.v == 0;
}

std::vector<Index> flagged(const std::vector<std::uint8_t>& flags)
{
  return idsWhere(flags.size(), [&](Index i) { return flags[i]; });
}

} // namespace

int quadrantsEntered(const FixedVec2* p, int i, int orientationSign)
{
  const int from = quadrantOf(p[(i + 1) % 3] - p[i]);
  const int to = quadrantOf(p[(i + 2) % 3] - p[i]);
  if (from < 0 || to < 0)
  {
    return 0;
  }
  // A positive triangle turns by less than half a circle, so the difference modulo 4 is the number.
  return orientationSign >= 0 ? (to - from) & 3 : -((from - to) & 3);
}

std::string MapDefects::text() const
{
  std::string result = std::to_string(notPositive.size()) + " triangles not positive";
  if (!wrongTurns.empty())
  {
    result += ", wrong turns at " + std::to_string(wrongTurns.size()) + " vertices";
  }
  if (!reversed.empty())
  {
    result += ", " + std::to_string(reversed.size()) + " reversed feature or boundary edges";
  }
  return result;
}

MapDefects findDefects(const Mesh& mesh, const CrossField& field, const std::vector<FixedVec2>& uv)
{
  MapDefects defects;
  std::vector<std::int8_t> entered(mesh.origin.size());
  std::vector<int> turns(mesh.vertexCount(), 0);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const FixedVec2* p = &uv[3 * f];
    const int sign = orientation(p[0], p[1], p[2]);
    if (sign <= 0)
    {
      defects.notPositive.push_back(f);
    }
    for (int i = 0; i < 3; ++i)
    {
      const Index h = 3 * f + i;
      entered[h] = static_cast<std::int8_t>(quadrantsEntered(p, i, sign));
      turns[mesh.origin[h]] += entered[h];
      if (field.alignment[h] >= 0 && !runsAlongItsAxis(uv, h, field.alignment[h]))
      {
        defects.reversed.push_back(h);
      }
    }
  }
  std::vector<std::uint8_t> wrong(mesh.vertexCount(), 0);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    wrong[v] = turns[v] != field.turns[v];
  }
  checkSectors(mesh, field, entered, wrong);
  defects.wrongTurns = flagged(wrong);
  return defects;
}

std::vector<Index> findNotPositive(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  return idsWhere(mesh.faceCount(),
    [&](Index f) { return orientation(uv[3 * f], uv[3 * f + 1], uv[3 * f + 2]) <= 0; });
}

std::vector<Index> crowdedVertices(const Mesh& mesh, const CrossField& field)
{
  std::vector<int> triangles(mesh.vertexCount(), 0);
  for (const Index v : mesh.origin)
  {
    ++triangles[v];
  }
  std::vector<std::uint8_t> crowded(mesh.vertexCount(), 0);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    crowded[v] = triangles[v] > 0 && field.turns[v] >= 2 * triangles[v];
  }
  for (Index start = 0; start < mesh.halfEdgeCount(); ++start)
  {
    int corners = 0;
    if (field.sectorTurns[start] > 0)
    {
      forSector(mesh, start, [&](Index) { ++corners; });
      crowded[mesh.origin[start]] |= field.sectorTurns[start] >= 2 * corners;
    }
  }
  return flagged(crowded);
}

std::vector<Index> cornerVertices(const Mesh& mesh, const std::vector<Index>& faces)
{
  std::vector<Index> vertices;
  for (const Index f : faces)
  {
    vertices.insert(vertices.end(), mesh.origin.begin() + 3 * f, mesh.origin.begin() + 3 * f + 3);
  }
  sortUnique(vertices);
  return vertices;
}

FailedFaces failedFacesOf(const Mesh& mesh, const MapDefects& defects)
{
  FailedFaces failed;
  failed.faces = defects.notPositive;
  for (const Index h : defects.reversed)
  {
    const Index face = Mesh::face(h);
    failed.either.push_back({ face, mesh.isBoundary(h) ? face : Mesh::face(mesh.twin[h]) });
  }
  if (failed.empty())
  {
    failed.faces = idsWhere(mesh.faceCount(),
      [&](Index f)
      {
        const Index* corner = &mesh.origin[3 * f];
        return std::any_of(
          corner, corner + 3, [&](Index v) { return contains(defects.wrongTurns, v); });
      });
  }
  sortUnique(failed.faces);
  return failed;
}

std::vector<Index> verticesOf(const Mesh& mesh, const MapDefects& defects)
{
  std::vector<Index> result = cornerVertices(mesh, defects.notPositive);
  append(result, defects.wrongTurns);
  for (const Index h : defects.reversed)
  {
    result.push_back(mesh.origin[h]);
    result.push_back(mesh.target(h));
  }
  sortUnique(result);
  return result;
}

} // namespace quadrille
