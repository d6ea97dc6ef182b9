// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/MendedPatch.h"

#include "Base/ChartRotation.h"
#include "GridMap/MapCheck.h"

#include <algorithm>
#include <optional>

namespace quadrille
{
namespace
{

/// Defects that a wrong winding of positive triangles counts for.
constexpr std::size_t kLostTurn = 16;

/// All corners of the vertex of `corner`, counterclockwise, for a boundary vertex from its boundary half-edge on.
void collectCorners(const Mesh& mesh, Index corner, std::vector<Index>& corners, bool& interior)
{
  Index first = corner;
  interior = true;
  for (Index h = mesh.rotateClockwise(corner); h != corner; h = mesh.rotateClockwise(h))
  {
    if (h == kInvalidIndex)
    {
      interior = false;
      break;
    }
    first = h;
  }
  if (interior)
  {
    first = corner;
  }
  corners.clear();
  Index h = first;
  do
  {
    corners.push_back(h);
    h = mesh.rotateCounterclockwise(h);
  } while (h != first && h != kInvalidIndex);
}

} // namespace

void MendedPatch::release()
{
  for (const Index f : faces_)
  {
    inPatch_[f] = 0;
  }
}

void MendedPatch::beginAt(Index seed, std::size_t maximumFaces)
{
  faces_.assign(1, seed);
  inPatch_[seed] = 1;
  std::vector<Index> corners;
  bool interior = false;
  for (std::size_t i = 0; i < faces_.size() && faces_.size() < maximumFaces; ++i)
  {
    for (Index h = 3 * faces_[i]; h < 3 * faces_[i] + 3; ++h)
    {
      collectCorners(mesh_, h, corners, interior);
      for (const Index c : corners)
      {
        if (inPatch_[c / 3] == 0 && !defects_.isPositive(c / 3))
        {
          inPatch_[c / 3] = 1;
          faces_.push_back(c / 3);
        }
      }
    }
  }
}

void MendedPatch::grow(std::size_t maximumFaces)
{
  const std::size_t size = faces_.size();
  for (std::size_t i = 0; i < size && faces_.size() <= maximumFaces; ++i)
  {
    for (Index h = 3 * faces_[i]; h < 3 * faces_[i] + 3; ++h)
    {
      addFacesAround(h);
    }
  }
  std::sort(faces_.begin(), faces_.end());
}

void MendedPatch::addFacesAround(Index corner)
{
  std::vector<Index> corners;
  bool interior = false;
  collectCorners(mesh_, corner, corners, interior);
  for (const Index c : corners)
  {
    if (inPatch_[c / 3] == 0)
    {
      inPatch_[c / 3] = 1;
      faces_.push_back(c / 3);
    }
  }
}

std::size_t MendedPatch::countDefects() const
{
  std::size_t count = static_cast<std::size_t>(
    std::count_if(faces_.begin(), faces_.end(), [&](Index f) { return !defects_.isPositive(f); }));
  for (const PatchVertex& vertex : vertices_)
  {
    int turns = 0;
    bool positive = true;
    for (std::size_t i = 0; i < vertex.fanCount; ++i)
    {
      const Index c = fans_[vertex.firstFan + i].corner;
      const int sign = defects_.isPositive(Mesh::face(c)) ? 1 : -1;
      positive = positive && sign > 0;
      turns += quadrantsEntered(&uv_[3 * Mesh::face(c)], static_cast<int>(c % 3), sign);
    }
    const Index v = mesh_.origin[fans_[vertex.firstFan].corner];
    if (vertex.fanCount > 1 && turns != expectedTurns_[v])
    {
      count += positive ? kLostTurn : 1;
    }
  }
  return count;
}

std::vector<FixedVec2> MendedPatch::corners() const
{
  std::vector<FixedVec2> corners;
  for (const Index f : faces_)
  {
    corners.insert(corners.end(), { uv_[3 * f], uv_[3 * f + 1], uv_[3 * f + 2] });
  }
  return corners;
}

void MendedPatch::restore(const std::vector<FixedVec2>& corners)
{
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    uv_[3 * faces_[i / 3] + i % 3] = corners[i];
  }
}

void MendedPatch::collectFans()
{
  vertices_.clear();
  fans_.clear();
  unknowns_ = 0;
  for (const Index f : faces_)
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      if (seenVertex_[mesh_.origin[h]] == 0)
      {
        seenVertex_[mesh_.origin[h]] = 1;
        addFan(h);
      }
    }
  }
  for (const Index f : faces_)
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      seenVertex_[mesh_.origin[h]] = 0;
    }
  }
}

void MendedPatch::addFan(Index corner)
{
  std::vector<PatchCorner> fan;
  PatchVertex vertex;
  const bool closes = walkFan(corner, fan, vertex.interior);
  vertex.freedom = freedomOf(fan, vertex.interior, closes);
  vertex.firstFan = fans_.size();
  vertex.fanCount = fan.size();
  vertex.firstUnknown = unknowns_;
  if (vertex.freedom == PatchFreedom::Plane)
  {
    unknowns_ += 2;
  }
  else if (vertex.freedom != PatchFreedom::Fixed)
  {
    unknowns_ += 1;
  }
  fans_.insert(fans_.end(), fan.begin(), fan.end());
  vertices_.push_back(vertex);
}

/// False when the vertex must stay for what its transitions are: irregular, or one that has no unique rotation.
bool MendedPatch::walkFan(Index corner, std::vector<PatchCorner>& fan, bool& interior) const
{
  std::vector<Index> corners;
  collectCorners(mesh_, corner, corners, interior);
  bool closes = true;
  int rotation = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    fan.push_back({ corners[i], rotation & 3 });
    const Index c = corners[i];
    if (i + 1 == corners.size() && !interior)
    {
      break;
    }
    const Index n = corners[i + 1 == corners.size() ? 0 : i + 1];
    const std::optional<int> further =
      rotationBetween(uv_[Mesh::previous(c)] - uv_[c], uv_[Mesh::next(n)] - uv_[n]);
    closes = closes && further;
    rotation += further.value_or(0);
  }
  return closes && (!interior || (rotation & 3) == 0);
}

PatchFreedom MendedPatch::freedomOf(
  const std::vector<PatchCorner>& fan, bool interior, bool closes) const
{
  if (!closes ||
    std::any_of(
      fan.begin(), fan.end(), [&](const PatchCorner& c) { return inPatch_[c.corner / 3] == 0; }))
  {
    return PatchFreedom::Fixed;
  }
  // Irregular vertices lie on whole points, also those of curves that look as if the curve passed.
  if (expectedTurns_[mesh_.origin[fan.front().corner]] != (interior ? 4 : 2))
  {
    return PatchFreedom::Fixed;
  }
  int constrained = 0;
  bool alongU = true;
  bool alongV = true;
  const auto addEdge = [&](FixedVec2 edge, int rotation)
  {
    const FixedVec2 inFirst = rotate(edge, 4 - rotation);
    ++constrained;
    alongU = alongU && inFirst.v == 0;
    alongV = alongV && inFirst.u == 0;
  };
  for (const PatchCorner& c : fan)
  {
    if (mesh_.isConstrained(c.corner))
    {
      addEdge(uv_[Mesh::next(c.corner)] - uv_[c.corner], c.rotation);
    }
  }
  if (!interior)
  {
    const Index last = fan.back().corner;
    addEdge(uv_[Mesh::previous(last)] - uv_[last], fan.back().rotation);
  }
  if (constrained == 0)
  {
    return PatchFreedom::Plane;
  }
  if (constrained != 2 || alongU == alongV)
  {
    return PatchFreedom::Fixed;
  }
  return alongU ? PatchFreedom::AlongU : PatchFreedom::AlongV;
}

void MendedPatch::applyDisplacements(const Eigen::VectorXd& y)
{
  if (!y.allFinite() || y.lpNorm<Eigen::Infinity>() > 1e5)
  {
    return; // uv stays as it is, which is no improvement
  }
  for (const PatchVertex& vertex : vertices_)
  {
    if (vertex.freedom == PatchFreedom::Fixed)
    {
      continue;
    }
    int next = vertex.firstUnknown;
    FixedVec2 d;
    if (vertex.freedom != PatchFreedom::AlongV)
    {
      d.u = toFixed(y[next++]);
    }
    if (vertex.freedom != PatchFreedom::AlongU)
    {
      d.v = toFixed(y[next]);
    }
    for (std::size_t i = 0; i < vertex.fanCount; ++i)
    {
      const PatchCorner& c = fans_[vertex.firstFan + i];
      uv_[c.corner] = uv_[c.corner] + rotate(d, c.rotation);
    }
  }
}

} // namespace quadrille
