// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/VertexRestoration.h"

#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <unordered_map>

namespace quadrille
{
namespace
{

/// Offsets of the removals of a block, in its order, with one past the last at the end.
void findRemovals(const BlockRecords& block, std::vector<std::size_t>& offsets)
{
  offsets.assign(1, block.size());
  for (std::size_t end = block.size(); end > 0;)
  {
    const int faces = block[end - 1];
    end -= faces == 0 ? kFlipBytes : collapseBytes(faces);
    if (faces != 0)
    {
      offsets.push_back(end);
    }
  }
  std::reverse(offsets.begin(), offsets.end());
}

/// The end of the collapse that a removal begins with.
std::size_t collapseEnd(const BlockRecords& block, std::size_t begin, std::size_t end)
{
  while (block[end - 1] == 0)
  {
    end -= kFlipBytes;
  }
  assert(end - begin == collapseBytes(block[end - 1]));
  static_cast<void>(begin);
  return end;
}

/// What a removal says of its star.
struct StarOf
{
  StarOf(const BlockRecords& block, std::size_t begin, std::size_t end)
    : slots(block.data() + begin)
  {
    const std::uint8_t* last = block.data() + collapseEnd(block, begin, end);
    faces = last[-1];
    vertex = removedVertex(last);
  }
  Index face(int i) const { return loadLittleEndian(slots + 4 * static_cast<std::size_t>(i)) / 3; }

  const std::uint8_t* slots;
  int faces = 0;
  Index vertex = kInvalidIndex;
};

class Search
{
public:
  Search(const DecimationLog& log, const std::vector<Index>& vertices)
    : log_(log), touched_(log.fineFaces), wanted_(vertices.back() + 1)
  {
    for (const Index v : vertices)
    {
      wanted_[v] = true;
    }
  }

  std::vector<LoggedRemoval> run()
  {
    for (std::size_t block = 0; block < log_.blocks.size(); ++block)
    {
      poll();
      findRemovals(log_.blocks[block], offsets_);
      for (std::size_t i = 0; i + 1 < offsets_.size(); ++i)
      {
        if (depends(block, offsets_[i], offsets_[i + 1]))
        {
          found_.push_back({ block, offsets_[i], offsets_[i + 1] });
        }
      }
    }
    return std::move(found_);
  }

private:
  /// Whether a removal is asked for, or meets one that is; its star counts as touched then.
  bool depends(std::size_t block, std::size_t begin, std::size_t end)
  {
    const StarOf star(log_.blocks[block], begin, end);
    bool meets = star.vertex < wanted_.size() && wanted_[star.vertex];
    for (int i = 0; i < star.faces && !meets; ++i)
    {
      meets = touched_[star.face(i)];
    }
    for (int i = 0; i < star.faces && meets; ++i)
    {
      touched_[star.face(i)] = true;
    }
    return meets;
  }

  const DecimationLog& log_;
  std::vector<bool> touched_; ///< faces of the finest mesh
  std::vector<bool> wanted_;  ///< vertices up to the last one that is asked for
  std::vector<std::size_t> offsets_;
  std::vector<LoggedRemoval> found_;
};

/// The level while removals are undone, last first. What comes back stands behind what was there.
class Undoing
{
public:
  Undoing(const Level& level, const std::vector<float>& curveError)
    : levelFaces_(level.fineFace), origin_(level.mesh.origin), twin_(level.mesh.twin),
      flags_(level.mesh.flags), fineVertex_(level.fineVertex), fineFace_(level.fineFace),
      curveError_(curveError), touched_(level.mesh.vertexCount(), false)
  {
  }

  void undo(const std::uint8_t* begin, const std::uint8_t* end)
  {
    CollapseRecord record;
    readBackwards(
      begin, end, record, [this](Index h, Index g) { undoFlip(slot(h), slot(g)); },
      [&] { undoCollapse(record); });
  }

  RestoredLevel finish() const;

private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  /// Of a face that is alive.
  Index slot(Index fineSlot) const
  {
    const Index face = fineSlot / 3;
    const auto back = restoredFace_.find(face);
    if (back != restoredFace_.end())
    {
      return 3 * back->second + fineSlot % 3;
    }
    return 3 * indexIn(levelFaces_, face) + fineSlot % 3;
  }

  void link(Index h, Index g, std::uint8_t flag)
  {
    twin_[h] = g;
    flags_[h] = flag;
    if (g != kInvalidIndex)
    {
      twin_[g] = h;
      flags_[g] = flag;
    }
  }

  /// Turns the picture in DecimationLog.h from right to left.
  void undoFlip(Index h, Index g)
  {
    const Index nextH = Mesh::next(h), nextG = Mesh::next(g);
    const Index twinAd = twin_[h], twinBc = twin_[g];
    const std::uint8_t flagAd = flags_[h], flagBc = flags_[g];
    origin_[nextH] = origin_[g];
    origin_[nextG] = origin_[h];
    link(nextH, twinBc, flagBc);
    link(nextG, twinAd, flagAd);
    link(h, g, 0);
  }

  void undoCollapse(const CollapseRecord& record);
  Index reviveFace(Index fineSlot, Index vertex, Index second, Index third);
  void reviveFirst(const CollapseRecord& record, Index vertex, Index target);
  void reviveLast(const CollapseRecord& record, Index vertex, Index target);
  void markCurve(const CollapseRecord& record, Index vertex);

  const std::vector<Index>& levelFaces_;
  std::vector<Index> origin_, twin_;
  std::vector<std::uint8_t> flags_;
  std::vector<Index> fineVertex_, fineFace_;
  std::vector<float> curveError_;
  std::vector<bool> touched_; ///< #V
  std::unordered_map<Index, Index> restoredFace_;
};

/// Corner of the vertex in the face that comes back, whose corners follow from it counterclockwise.
Index Undoing::reviveFace(Index fineSlot, Index vertex, Index second, Index third)
{
  const Index f = static_cast<Index>(fineFace_.size());
  restoredFace_.emplace(fineSlot / 3, f);
  fineFace_.push_back(fineSlot / 3);
  origin_.resize(origin_.size() + 3, kInvalidIndex);
  twin_.resize(twin_.size() + 3, kInvalidIndex);
  flags_.resize(flags_.size() + 3, 0);
  const Index h = 3 * f + fineSlot % 3;
  origin_[h] = vertex;
  origin_[Mesh::next(h)] = second;
  origin_[Mesh::previous(h)] = third;
  return h;
}

/// The face between ring vertices 0 and 1: the edge of the survivor beside it gives its ring edge back.
void Undoing::reviveFirst(const CollapseRecord& record, Index vertex, Index target)
{
  const Index beside = slot(record.slot[1]);
  const Index outer = twin_[beside];
  const std::uint8_t flag = flags_[beside];
  const Index h = reviveFace(record.slot[0], vertex, target, origin_[Mesh::next(beside)]);
  link(Mesh::next(h), outer, flag);
  link(beside, Mesh::previous(h), 0);
}

/// The face between the last ring vertices.
void Undoing::reviveLast(const CollapseRecord& record, Index vertex, Index target)
{
  const Index beside = Mesh::previous(slot(record.slot[index(record.faces - 2)]));
  const Index outer = twin_[beside];
  const std::uint8_t flag = flags_[beside];
  const Index h = reviveFace(record.slot[index(record.faces - 1)], vertex, origin_[beside], target);
  link(Mesh::next(h), outer, flag);
  link(beside, h, 0);
}

/// The curve through a vertex that has come back: its edge to the target is as the other one.
void Undoing::markCurve(const CollapseRecord& record, Index vertex)
{
  Index first = kInvalidIndex,
        second = kInvalidIndex; // half-edges from the vertex, or to it at the boundary's end
  if (record.kind == CollapseKind::Interior)
  {
    const int other = record.ring[0] != 0 ? record.ring[0] : record.ring[1];
    first = slot(record.slot[0]);
    second = slot(record.slot[index(other)]);
    flags_[first] = flags_[second];
    flags_[twin_[first]] = flags_[second];
  }
  else
  {
    first = slot(record.slot[0]);
    second = Mesh::previous(slot(record.slot[index(record.faces - 1)]));
    const bool ontoFirst = record.kind == CollapseKind::BoundaryFirst;
    flags_[ontoFirst ? first : second] = flags_[ontoFirst ? second : first];
  }
  const auto far = [&](Index h)
  { return origin_[h] == vertex ? origin_[Mesh::next(h)] : origin_[h]; };
  curveError_[vertex] = std::max(curveError_[far(first)], curveError_[far(second)]);
}

void Undoing::undoCollapse(const CollapseRecord& record)
{
  const int first = record.firstSurvivor(), last = record.lastSurvivor();
  const Index target = origin_[slot(record.slot[index(first)])];
  const Index vertex = static_cast<Index>(fineVertex_.size());
  fineVertex_.push_back(record.vertex);
  curveError_.push_back(0);
  touched_.push_back(true);
  for (int i = first; i <= last; ++i)
  {
    origin_[slot(record.slot[index(i)])] = vertex;
  }
  if (first == 1)
  {
    reviveFirst(record, vertex, target);
  }
  if (last == record.faces - 2)
  {
    reviveLast(record, vertex, target);
  }
  if (record.kind == CollapseKind::Interior)
  {
    const Index h = slot(record.slot[0]);
    link(h, Mesh::previous(slot(record.slot[index(record.faces - 1)])), 0);
  }
  if (record.onCurve)
  {
    markCurve(record, vertex);
  }
  for (int i = 0; i < record.faces; ++i)
  {
    const Index h = slot(record.slot[index(i)]);
    touched_[origin_[Mesh::next(h)]] = touched_[origin_[Mesh::previous(h)]] = true;
  }
}

/// Positions in ascending order of the values.
std::vector<Index> ascending(const std::vector<Index>& values)
{
  std::vector<Index> order(values.size());
  std::iota(order.begin(), order.end(), Index{ 0 });
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return values[a] < values[b]; });
  return order;
}

std::vector<Index> inverse(const std::vector<Index>& order)
{
  std::vector<Index> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    place[order[i]] = static_cast<Index>(i);
  }
  return place;
}

RestoredLevel Undoing::finish() const
{
  const std::vector<Index> vertices = ascending(fineVertex_), faces = ascending(fineFace_);
  const std::vector<Index> newVertex = inverse(vertices), newFace = inverse(faces);
  RestoredLevel result;
  Level& level = result.level;
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    const Index v = vertices[i];
    level.fineVertex.push_back(fineVertex_[v]);
    result.curveError.push_back(curveError_[v]);
    if (touched_[v])
    {
      result.touched.push_back(static_cast<Index>(i));
    }
  }
  for (const Index f : faces)
  {
    level.fineFace.push_back(fineFace_[f]);
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      level.mesh.origin.push_back(newVertex[origin_[h]]);
      level.mesh.twin.push_back(
        twin_[h] == kInvalidIndex ? kInvalidIndex : 3 * newFace[twin_[h] / 3] + twin_[h] % 3);
      level.mesh.flags.push_back(flags_[h]);
    }
  }
  return result;
}

} // namespace

std::vector<LoggedRemoval> removalsFrom(
  const DecimationLog& log, const std::vector<Index>& vertices)
{
  return vertices.empty() ? std::vector<LoggedRemoval>{} : Search(log, vertices).run();
}

RestoredLevel undoRemovals(const Mesh& fine, const Level& level,
  const std::vector<float>& curveError, const DecimationLog& log,
  const std::vector<LoggedRemoval>& removals)
{
  Undoing undoing(level, curveError);
  for (auto removal = removals.rbegin(); removal != removals.rend(); ++removal)
  {
    const std::uint8_t* records = log.blocks[removal->block].data();
    undoing.undo(records + removal->begin, records + removal->end);
  }
  RestoredLevel restored = undoing.finish();
  for (const Index v : restored.level.fineVertex)
  {
    restored.level.mesh.position.push_back(fine.position[v]);
    if (!fine.sizing.empty())
    {
      restored.level.mesh.sizing.push_back(fine.sizing[v]);
    }
  }
  return restored;
}

std::vector<std::pair<std::size_t, BlockRecords>> takeOut(
  DecimationLog& log, const std::vector<LoggedRemoval>& removals)
{
  std::vector<std::pair<std::size_t, BlockRecords>> originals;
  for (auto removal = removals.begin(); removal != removals.end();)
  {
    const std::size_t id = removal->block;
    const BlockRecords& block = log.blocks[id];
    BlockRecords rest;
    std::size_t taken = 0;
    for (; removal != removals.end() && removal->block == id; ++removal)
    {
      rest.insert(rest.end(), block.begin() + static_cast<std::ptrdiff_t>(taken),
        block.begin() + static_cast<std::ptrdiff_t>(removal->begin));
      taken = removal->end;
      --log.collapses;
      const std::size_t flips = removal->end - collapseEnd(block, removal->begin, removal->end);
      log.flips -= flips / kFlipBytes;
    }
    rest.insert(rest.end(), block.begin() + static_cast<std::ptrdiff_t>(taken), block.end());
    originals.emplace_back(id, std::move(log.blocks[id]));
    log.blocks[id] = std::move(rest);
  }
  return originals;
}

} // namespace quadrille
