// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/PreviousMap.h"

#include "Base/Angles.h"
#include "Base/Refuse.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace quadrille
{
namespace
{

template <typename Array>
std::size_t bytesOf(const Array& values)
{
  return values.capacity() * sizeof(typename Array::value_type);
}

/// Half-edge 3f + i within the chain of corners that begins at `corner`.
Index follow(Index corner, Index i)
{
  return i == 0 ? corner : i == 1 ? Mesh::next(corner) : Mesh::previous(corner);
}

/// Direction of half-edge h against the first half-edge of its face, counterclockwise.
double directionInFace(const Mesh& mesh, Index h)
{
  const Index first = h - h % 3;
  const Vector3 axis = mesh.edgeVector(first);
  const Vector3 edge = mesh.edgeVector(h);
  const Vector3 normal = axis.cross(mesh.edgeVector(first + 1));
  return std::atan2(normal.dot(axis.cross(edge)) / std::max(normal.norm(), 1e-300), axis.dot(edge));
}

bool isPositive(const std::vector<FixedVec2>& uv, Index f)
{
  return determinant(uv[3 * f], uv[3 * f + 1], uv[3 * f + 2]) > 0;
}

} // namespace

std::size_t PreviousMap::bytes() const
{
  return bytesOf(mesh.position) + bytesOf(mesh.origin) + bytesOf(mesh.twin) + bytesOf(mesh.flags) +
    bytesOf(vertexIds) + bytesOf(field.angle) + bytesOf(field.matching) + bytesOf(field.alignment) +
    bytesOf(field.sectorTurns) + bytesOf(field.turns) + bytesOf(field.stretch) +
    bytesOf(field.guides) + bytesOf(seamlessUv) + bytesOf(uv);
}

MapCarrier::MapCarrier(const PreviousMap& previous) : previous_(previous)
{
  const Mesh& mesh = previous.mesh;
  refuseIf(previous.vertexIds.size() != mesh.vertexCount() ||
      previous.uv.size() != mesh.halfEdgeCount() ||
      previous.seamlessUv.size() != mesh.halfEdgeCount() ||
      previous.field.angle.size() != mesh.faceCount() ||
      previous.field.matching.size() != mesh.halfEdgeCount() ||
      previous.field.turns.size() != mesh.vertexCount(),
    "previous map: map, field and ids do not have the size of its mesh");
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    Index first = 3 * f;
    for (Index h = 3 * f + 1; h < 3 * f + 3; ++h)
    {
      first =
        previous.vertexIds[mesh.origin[h]] < previous.vertexIds[mesh.origin[first]] ? h : first;
    }
    Entry entry{ {}, first };
    for (Index i = 0; i < 3; ++i)
    {
      entry.ids[i] = previous.vertexIds[mesh.origin[follow(first, i)]];
    }
    entries_.push_back(entry);
  }
  std::sort(entries_.begin(), entries_.end(),
    [](const Entry& a, const Entry& b)
    {
      return std::tie(a.ids[0], a.ids[1], a.ids[2], a.halfEdge) <
        std::tie(b.ids[0], b.ids[1], b.ids[2], b.halfEdge);
    });
}

/// #F: the previous half-edge that is corner 3f, where a face has the same three corners at the same places.
std::vector<Index> MapCarrier::cornersOf(
  const Mesh& mesh, const std::vector<Index>& vertexIds) const
{
  std::vector<Index> corner(mesh.faceCount(), kInvalidIndex);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    Index ids[3];
    Index lowest = 0;
    for (Index i = 0; i < 3; ++i)
    {
      ids[i] = vertexIds[mesh.origin[3 * f + i]];
      lowest = ids[i] < ids[lowest] ? i : lowest;
    }
    std::rotate(ids, ids + lowest, ids + 3);
    const auto found = std::lower_bound(entries_.begin(), entries_.end(), ids,
      [](const Entry& entry, const Index* wanted)
      { return std::lexicographical_compare(entry.ids, entry.ids + 3, wanted, wanted + 3); });
    if (found == entries_.end() || !std::equal(ids, ids + 3, found->ids))
    {
      continue;
    }
    const Index first = follow(found->halfEdge, (3 - lowest) % 3);
    bool same = true;
    for (Index i = 0; i < 3; ++i)
    {
      same = same &&
        mesh.position[mesh.origin[3 * f + i]] ==
          previous_.mesh.position[previous_.mesh.origin[follow(first, i)]];
    }
    corner[f] = same ? first : kInvalidIndex;
  }
  return corner;
}

/// Whether the faces are those of the previous mesh, joined and constrained in the same way.
bool MapCarrier::isSameMesh(const Mesh& mesh, const std::vector<Index>& corner) const
{
  const auto image = [&](Index h) { return follow(corner[Mesh::face(h)], h % 3); };
  if (std::find(corner.begin(), corner.end(), kInvalidIndex) != corner.end())
  {
    return false;
  }
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Index twin = mesh.isBoundary(h) ? kInvalidIndex : image(mesh.twin[h]);
    if (previous_.mesh.twin[image(h)] != twin ||
      previous_.mesh.isConstrained(image(h)) != mesh.isConstrained(h))
    {
      return false;
    }
  }
  return true;
}

/// Whether rotations of the charts make the previous field's matchings, alignments and turns those of the new one.
/// rotation: #F, these; that of face 0 is given.
bool MapCarrier::joinCharts(const Mesh& mesh, const CrossField& field,
  const std::vector<Index>& corner, std::vector<int>& rotation) const
{
  const auto image = [&](Index h) { return follow(corner[Mesh::face(h)], h % 3); };
  const CrossField& before = previous_.field;
  std::vector<std::uint8_t> reached(mesh.faceCount(), 0);
  std::vector<int> rotated = rotation;
  std::vector<Index> queue{ 0 };
  reached[0] = 1;
  for (std::size_t i = 0; i < queue.size(); ++i)
  {
    const Index f = queue[i];
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      const Index x = image(h);
      if (mesh.isConstrained(h) &&
        (((before.alignment[x] + rotated[f] - field.alignment[h]) & 3) != 0 ||
          before.sectorTurns[x] != field.sectorTurns[h]))
      {
        return false;
      }
      if (mesh.isBoundary(h))
      {
        continue;
      }
      const Index g = Mesh::face(mesh.twin[h]);
      const int there = (field.matching[h] - before.matching[x] + rotated[f]) & 3;
      if (reached[g] == 0)
      {
        reached[g] = 1;
        rotated[g] = there;
        queue.push_back(g);
      }
      else if (((rotated[g] - there) & 3) != 0)
      {
        return false;
      }
    }
  }
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (field.turns[mesh.origin[h]] != before.turns[previous_.mesh.origin[image(h)]])
    {
      return false;
    }
  }
  rotation = std::move(rotated);
  return queue.size() == mesh.faceCount();
}

CarriedMap MapCarrier::carry(
  const Mesh& mesh, const CrossField& field, const std::vector<Index>& vertexIds) const
{
  CarriedMap result;
  const std::vector<Index> corner = cornersOf(mesh, vertexIds);
  std::vector<int> rotation(mesh.faceCount(), 0);
  std::vector<double> angle(mesh.faceCount(), 0); // of the previous chart against the new one
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    if (corner[f] != kInvalidIndex)
    {
      angle[f] = previous_.field.angle[Mesh::face(corner[f])] - field.angle[f] -
        directionInFace(previous_.mesh, corner[f]);
      rotation[f] = static_cast<int>(std::lround(angle[f] / kRightAngle));
    }
  }
  result.isMap =
    mesh.faceCount() > 0 && isSameMesh(mesh, corner) && joinCharts(mesh, field, corner, rotation);
  result.known.assign(mesh.faceCount(), 0);
  result.fieldRotation.assign(mesh.faceCount(), 0);
  result.seamlessUv.assign(mesh.halfEdgeCount(), {});
  result.uv.assign(mesh.halfEdgeCount(), {});
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    if (corner[f] == kInvalidIndex)
    {
      continue;
    }
    for (Index i = 0; i < 3; ++i)
    {
      const Index x = follow(corner[f], i);
      result.seamlessUv[3 * f + i] = rotate(previous_.seamlessUv[x], rotation[f]);
      result.uv[3 * f + i] = rotate(previous_.uv[x], rotation[f]);
    }
    const double off = std::remainder(angle[f] - rotation[f] * kRightAngle, 2 * kPi);
    const bool known = std::abs(off) < kRightAngle / 2 && isPositive(result.seamlessUv, f) &&
      isPositive(result.uv, f);
    result.known[f] = known ? 1 : 0;
    result.fieldRotation[f] = known ? off : 0;
    result.knownFaces += known ? 1 : 0;
  }
  return result;
}

} // namespace quadrille
