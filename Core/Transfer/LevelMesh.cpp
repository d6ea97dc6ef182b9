// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/LevelMesh.h"

#include "Base/ChartRotation.h"
#include "Base/Lists.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace quadrille
{
namespace
{

/// Of the patch; none where the mesh has it elsewhere.
Index idIn(const std::vector<std::pair<Index, Index>>& list, Index id)
{
  const auto at = std::lower_bound(list.begin(), list.end(), std::make_pair(id, Index{ 0 }));
  return at != list.end() && at->first == id ? at->second : kInvalidIndex;
}

} // namespace

LevelMesh::LevelMesh(const Mesh& mesh, const std::vector<Index>& patch,
  const std::vector<PatchStar>& stars, const std::vector<int>& turns,
  const std::vector<FixedVec2>& uv)
  : fineFace_(patch), patchFaces_(static_cast<Index>(patch.size()))
{
  Ids ids = takeStars(mesh, patch, stars, turns, uv);
  corner_.resize(3 * fineFace_.size());
  twin_.assign(corner_.size(), kInvalidIndex);
  constrained_.resize(corner_.size());
  gone_.assign(fineFace_.size(), 0);
  Ids faces;
  for (Index f = 0; f < fineFace_.size(); ++f)
  {
    faces.emplace_back(fineFace_[f], f);
  }
  std::sort(faces.begin(), faces.end());
  takeFaces(mesh, turns, uv, faces, ids);
  for (const PatchStar& star : stars)
  {
    const Index v = idIn(ids, mesh.origin[star.begin->corner]);
    for (const PatchCorner* c = star.begin;
         c != star.end && vertex_[v].freedom != PatchFreedom::Fixed; ++c)
    {
      const Index f = idIn(faces, Mesh::face(c->corner));
      Corner& corner = corner_[3 * f + c->corner % 3];
      corner.rotation = c->rotation;
      corner.offset = uv[c->corner] - rotate(vertex_[v].place, c->rotation);
    }
  }
  closeFans();
}

/// The vertices of the patch, and the faces that touch it.
LevelMesh::Ids LevelMesh::takeStars(const Mesh& mesh, const std::vector<Index>& patch,
  const std::vector<PatchStar>& stars, const std::vector<int>& turns,
  const std::vector<FixedVec2>& uv)
{
  // Vertices that stay have no chart of their own: their place is the origin, and each corner has its image.
  Ids ids;
  std::vector<Index> around;
  for (const PatchStar& star : stars)
  {
    const Index v = mesh.origin[star.begin->corner];
    ids.emplace_back(v, static_cast<Index>(vertex_.size()));
    Vertex vertex;
    vertex.freedom = star.freedom;
    vertex.goesLast = star.goesLast;
    vertex.position = mesh.position[v];
    vertex.turns = turns[v];
    vertex.place = star.freedom == PatchFreedom::Fixed ? FixedVec2{} : uv[star.begin->corner];
    vertex_.push_back(vertex);
    inner_ += star.freedom == PatchFreedom::Fixed ? 0U : 1U;
    for (const PatchCorner* c = star.begin; c != star.end; ++c)
    {
      around.push_back(Mesh::face(c->corner));
    }
  }
  sortUnique(around);
  std::set_difference(
    around.begin(), around.end(), patch.begin(), patch.end(), std::back_inserter(fineFace_));
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// Corners and edges, with the other vertices of faces that touch the patch.
void LevelMesh::takeFaces(const Mesh& mesh, const std::vector<int>& turns,
  const std::vector<FixedVec2>& uv, const Ids& faces, Ids& ids)
{
  for (Index f = 0; f < fineFace_.size(); ++f)
  {
    for (Index k = 0; k < 3; ++k)
    {
      const Index fine = 3 * fineFace_[f] + k, h = 3 * f + k;
      Index v = idIn(ids, mesh.origin[fine]);
      if (v == kInvalidIndex)
      {
        v = static_cast<Index>(vertex_.size());
        const auto at =
          std::lower_bound(ids.begin(), ids.end(), std::make_pair(mesh.origin[fine], Index{ 0 }));
        ids.insert(at, { mesh.origin[fine], v });
        Vertex vertex;
        vertex.position = mesh.position[mesh.origin[fine]];
        vertex.turns = turns[mesh.origin[fine]];
        vertex_.push_back(vertex);
      }
      corner_[h] = { v, 0, uv[fine] };
      vertex_[v].corner = h;
      constrained_[h] = mesh.isConstrained(fine) ? 1 : 0;
      if (mesh.twin[fine] != kInvalidIndex)
      {
        const Index g = idIn(faces, Mesh::face(mesh.twin[fine]));
        twin_[h] = g == kInvalidIndex ? g : 3 * g + mesh.twin[fine] % 3;
      }
    }
  }
}

void LevelMesh::closeFans()
{
  isClosedFan_.resize(vertex_.size());
  for (Index v = 0; v < vertex_.size(); ++v)
  {
    Index h = vertex_[v].corner;
    const Index first = h;
    do
    {
      h = twin_[Mesh::previous(h)];
    } while (h != kInvalidIndex && h != first);
    isClosedFan_[v] = h == first ? 1 : 0;
    vertex_[v].isIrregular = vertex_[v].turns != (isClosedFan_[v] != 0 ? 4 : 2);
  }
}

std::vector<Index> LevelMesh::cornersAround(Index v) const
{
  Index first = vertex_[v].corner;
  if (!isClosed(v))
  {
    for (Index h = first; h != kInvalidIndex;
         h = twin_[h] == kInvalidIndex ? kInvalidIndex : Mesh::next(twin_[h]))
    {
      first = h;
    }
  }
  std::vector<Index> corners;
  Index h = first;
  do
  {
    corners.push_back(h);
    h = twin_[Mesh::previous(h)];
  } while (h != kInvalidIndex && h != first);
  return corners;
}

std::vector<Index> LevelMesh::neighbours(Index v) const
{
  std::vector<Index> found;
  for (const Index c : cornersAround(v))
  {
    found.push_back(target(c));
    found.push_back(origin(Mesh::previous(c)));
  }
  sortUnique(found);
  return found;
}

double LevelMesh::shortestEdge(Index v) const
{
  double shortest = std::numeric_limits<double>::infinity();
  Index h = vertex_[v].corner;
  const Index first = h;
  do
  {
    shortest =
      std::min(shortest, (vertex_[target(h)].position - vertex_[v].position).squaredNorm());
    h = twin_[Mesh::previous(h)];
  } while (h != kInvalidIndex && h != first);
  return shortest;
}

void LevelMesh::collapse(Index h)
{
  Collapse record;
  const Index v = origin(h), to = target(h), g = twin_[h];
  record.vertex = v;
  record.target = to;
  const auto setEdge = [&](Index e, Index other, std::uint8_t constrained)
  {
    record.edges.push_back({ e, twin_[e], constrained_[e] });
    twin_[e] = other;
    constrained_[e] = constrained;
  };
  const auto setCorner = [&](Index w, Index c)
  {
    record.cornerOf.emplace_back(w, vertex_[w].corner);
    vertex_[w].corner = c;
  };
  // In the own chart of v the other end is at rotation x + offset.
  const Corner& mine = corner_[h];
  const Corner& other = corner_[Mesh::next(h)];
  const int rotation = (other.rotation - mine.rotation) & 3;
  const FixedVec2 offset = toOwn(h, other.offset);
  const std::vector<Index> corners = cornersAround(v);
  record.left = Mesh::face(h);
  record.right = g == kInvalidIndex ? kInvalidIndex : Mesh::face(g);
  for (const Index c : corners)
  {
    if (Mesh::face(c) != record.left && Mesh::face(c) != record.right)
    {
      record.corners.emplace_back(c, corner_[c]);
      const Corner before = corner_[c];
      corner_[c] = { to, (before.rotation + rotation) & 3,
        rotate(offset, before.rotation) + before.offset };
      setCorner(to, c);
    }
  }
  const auto joinAcross = [&](Index goneEdge, Index otherEdge)
  {
    const Index a = twin_[goneEdge], b = twin_[otherEdge];
    const std::uint8_t constrained = constrained_[goneEdge] | constrained_[otherEdge];
    if (a != kInvalidIndex)
    {
      setEdge(a, b, constrained);
      setCorner(corner_[a].vertex, a);
      setCorner(corner_[Mesh::next(a)].vertex, Mesh::next(a));
    }
    if (b != kInvalidIndex)
    {
      setEdge(b, a, constrained);
      setCorner(corner_[b].vertex, b);
      setCorner(corner_[Mesh::next(b)].vertex, Mesh::next(b));
    }
  };
  joinAcross(Mesh::next(h), Mesh::previous(h));
  gone_[record.left] = 1;
  if (g != kInvalidIndex)
  {
    joinAcross(Mesh::next(g), Mesh::previous(g));
    gone_[record.right] = 1;
  }
  setCorner(v, kInvalidIndex);
  collapses_.push_back(std::move(record));
  --inner_;
}

Index LevelMesh::undo()
{
  const Collapse record = std::move(collapses_.back());
  collapses_.pop_back();
  for (auto e = record.edges.rbegin(); e != record.edges.rend(); ++e)
  {
    twin_[e->h] = e->twin;
    constrained_[e->h] = e->constrained;
  }
  for (auto c = record.cornerOf.rbegin(); c != record.cornerOf.rend(); ++c)
  {
    vertex_[c->first].corner = c->second;
  }
  for (const auto& [c, before] : record.corners)
  {
    corner_[c] = before;
  }
  gone_[record.left] = 0;
  if (record.right != kInvalidIndex)
  {
    gone_[record.right] = 0;
  }
  ++inner_;
  return record.vertex;
}

} // namespace quadrille
