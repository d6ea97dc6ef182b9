// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/UvMesh.h"

#include "Integers/StarKernel.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace quadrille
{

namespace
{

constexpr int kWeightBits = 32;

/// numerator / denominator in units of 2^-32, rounded down; 0 <= numerator <= denominator.
std::int64_t ratio(Int128 numerator, Int128 denominator)
{
  if (denominator <= 0)
  {
    return 0; // only in a map that repeats what was done to another one, where nothing is undone
  }
  // Scaled down first: 2^32 times a determinant would not fit 128 bits.
  while (denominator > (Int128{ 1 } << 90))
  {
    numerator >>= 1;
    denominator >>= 1;
  }
  return static_cast<std::int64_t>(numerator * (Int128{ 1 } << kWeightBits) / denominator);
}

std::int64_t scaled(std::int64_t x, std::int64_t weight)
{
  const Int128 half = Int128{ 1 } << (kWeightBits - 1);
  return static_cast<std::int64_t>((Int128{ x } * weight + half) >> kWeightBits);
}

FixedVec2 scaled(FixedVec2 p, std::int64_t weight)
{
  return { scaled(p.u, weight), scaled(p.v, weight) };
}

} // namespace

UvMesh UvMesh::from(
  const Mesh& mesh, const CrossField& field, const std::vector<FixedVec2>& seamlessUv)
{
  UvMesh result;
  result.origin = mesh.origin;
  result.twin = mesh.twin;
  result.rotation.assign(mesh.halfEdgeCount(), 0);
  result.flags.assign(mesh.halfEdgeCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    result.rotation[h] = mesh.isBoundary(h) ? std::int8_t{ 0 } : field.matching[h];
    result.flags[h] = static_cast<std::uint8_t>(mesh.isConstrained(h) ? kUvConstrained : 0);
  }
  result.uv = seamlessUv;
  result.outgoing = outgoingHalfEdges(mesh);
  result.alive.assign(mesh.faceCount(), 1);
  return result;
}

Transition UvMesh::transition(Index h) const
{
  Transition result;
  result.rotation = rotation[h];
  result.translation = uv[Mesh::next(twin[h])] - rotate(uv[h], rotation[h]);
  return result;
}

std::vector<Index> UvMesh::starFrom(Index first) const
{
  std::vector<Index> result;
  Index h = first;
  do
  {
    result.push_back(h);
    h = twin[Mesh::previous(h)];
  } while (h != kInvalidIndex && h != first);
  return result;
}

std::array<Int128, 2> UvEditor::flippedDeterminants(Index h) const
{
  const Index g = mesh_.twin[h];
  const Index hp = Mesh::previous(h), gp = Mesh::previous(g);
  const Transition toOther = mesh_.transition(h);
  const FixedVec2 d = toOther.inverse().apply(mesh_.uv[gp]);
  const FixedVec2 c = toOther.apply(mesh_.uv[hp]);
  return { determinant(mesh_.uv[h], d, mesh_.uv[hp]), determinant(mesh_.uv[g], c, mesh_.uv[gp]) };
}

bool UvEditor::canFlip(Index h) const
{
  if (mesh_.isFixed(h) || Mesh::face(h) == Mesh::face(mesh_.twin[h]))
  {
    return false;
  }
  const auto determinants = flippedDeterminants(h);
  return determinants[0] > 0 && determinants[1] > 0;
}

void UvEditor::save(Index slot)
{
  states_.push_back(
    { slot, mesh_.origin[slot], mesh_.twin[slot], mesh_.rotation[slot], mesh_.flags[slot] });
}

void UvEditor::saveFace(Index f)
{
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    save(h);
  }
}

/// Saves the partner of an edge that is about to move.
void UvEditor::saveMoved(Index slot)
{
  if (mesh_.twin[slot] != kInvalidIndex)
  {
    save(mesh_.twin[slot]);
  }
}

void UvEditor::begin(UvRecord::Kind kind, Index slot)
{
  UvRecord record;
  record.kind = kind;
  record.slot = slot;
  record.firstState = states_.size();
  records_.push_back(record);
}

void UvEditor::finish()
{
  records_.back().stateCount = states_.size() - records_.back().firstState;
}

void UvEditor::moveOutgoing(Index vertex, Index from, Index to)
{
  if (mesh_.outgoing[vertex] == from)
  {
    mesh_.outgoing[vertex] = to;
  }
}

std::vector<Index> UvEditor::slotsSince(std::size_t record) const
{
  std::vector<Index> slots;
  if (record < records_.size())
  {
    for (std::size_t i = records_[record].firstState; i < states_.size(); ++i)
    {
      slots.push_back(states_[i].slot);
    }
  }
  return slots;
}

void UvEditor::bury(Index f)
{
  mesh_.alive[f] = 0;
}

void UvEditor::relocate(const std::array<Relocation, 2>& moves, std::size_t count)
{
  std::array<Index, 2> partner{};
  std::array<int, 2> rotations{};
  std::array<std::uint8_t, 2> flag{};
  for (std::size_t i = 0; i < count; ++i)
  {
    partner[i] = mesh_.twin[moves[i].from];
    rotations[i] = mesh_.rotation[moves[i].from] + moves[i].rotation;
    flag[i] = mesh_.flags[moves[i].from];
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    // The two edges may be glued to each other.
    const std::size_t other = 1 - i;
    const bool both = count == 2 && partner[i] == moves[other].from;
    const int rotation = both ? rotations[i] - moves[other].rotation : rotations[i];
    const Index to = moves[i].to;
    const Index newPartner = both ? moves[other].to : partner[i];
    mesh_.twin[to] = newPartner;
    mesh_.flags[to] = flag[i];
    mesh_.rotation[to] = newPartner == kInvalidIndex ? 0 : static_cast<std::int8_t>(rotation & 3);
    if (!both && newPartner != kInvalidIndex)
    {
      mesh_.twin[newPartner] = to;
      mesh_.rotation[newPartner] = static_cast<std::int8_t>(-rotation & 3);
    }
  }
}

void UvEditor::flip(Index h)
{
  const Index hn = Mesh::next(h), hp = Mesh::previous(h);
  const Index g = mesh_.twin[h], gn = Mesh::next(g), gp = Mesh::previous(g);
  const Transition toOther = mesh_.transition(h);
  const FixedVec2 d = toOther.inverse().apply(mesh_.uv[gp]);
  const FixedVec2 c = toOther.apply(mesh_.uv[hp]);
  const std::int8_t forward = mesh_.rotation[h], backward = mesh_.rotation[g];

  begin(UvRecord::Kind::Flip, h);
  saveFace(Mesh::face(h));
  saveFace(Mesh::face(g));
  saveMoved(hn);
  saveMoved(gn);
  relocate({ Relocation{ gn, h, forward }, Relocation{ hn, g, backward } }, 2);
  mesh_.twin[hn] = gn;
  mesh_.twin[gn] = hn;
  mesh_.rotation[hn] = forward;
  mesh_.rotation[gn] = backward;
  mesh_.flags[hn] = mesh_.flags[gn] = 0;
  moveOutgoing(mesh_.origin[h], gn, h);
  moveOutgoing(mesh_.origin[g], hn, g);
  mesh_.origin[hn] = mesh_.origin[gp];
  mesh_.origin[gn] = mesh_.origin[hp];
  mesh_.uv[hn] = d;
  mesh_.uv[gn] = c;
  finish();
}

void UvEditor::repeat(const std::vector<UvRecord>& records)
{
  for (const UvRecord& record : records)
  {
    switch (record.kind)
    {
      case UvRecord::Kind::Flip:
        flip(record.slot);
        break;
      case UvRecord::Kind::RemoveInside:
        removeInside(record.slot);
        break;
      case UvRecord::Kind::RemoveOnLine:
        removeOnLine(record.slot);
        break;
    }
  }
}

void UvEditor::undoFlip(const UvRecord& record)
{
  const Index h = record.slot;
  const Index hn = Mesh::next(h), gn = mesh_.twin[hn], g = Mesh::previous(gn);
  const Transition toOther = mesh_.transition(hn);
  const FixedVec2 b = toOther.inverse().apply(mesh_.uv[g]);
  const FixedVec2 a = toOther.apply(mesh_.uv[h]);
  restore(record);
  mesh_.uv[hn] = b;
  mesh_.uv[gn] = a;
}

void UvEditor::removeInside(Index h)
{
  const Index hn = Mesh::next(h), hp = Mesh::previous(h);
  const Index hB = mesh_.twin[hp], nB = Mesh::next(hB), pB = Mesh::previous(hB);
  const Index hC = mesh_.twin[pB], nC = Mesh::next(hC), pC = Mesh::previous(hC);
  assert(mesh_.twin[pC] == h);
  const FixedVec2 v = mesh_.uv[h], x0 = mesh_.uv[hn], x1 = mesh_.uv[hp];
  const FixedVec2 x2 = mesh_.transition(hB).apply(mesh_.uv[pB]);

  begin(UvRecord::Kind::RemoveInside, h);
  UvRecord& record = records_.back();
  record.vertex = mesh_.origin[h];
  const Int128 whole = determinant(x2, x0, x1);
  record.weights = { 0, ratio(determinant(x2, v, x1), whole),
    ratio(determinant(x2, x0, v), whole) };
  saveFace(Mesh::face(h));
  saveFace(Mesh::face(hB));
  saveFace(Mesh::face(hC));
  saveMoved(nB);
  saveMoved(nC);
  moveOutgoing(mesh_.origin[hn], pC, hn);
  moveOutgoing(mesh_.origin[hp], nB, hp);
  moveOutgoing(mesh_.origin[pB], nC, h);
  moveOutgoing(mesh_.origin[pB], pB, h);
  mesh_.outgoing[record.vertex] = kInvalidIndex;
  relocate({ Relocation{ nB, hp, mesh_.rotation[hp] }, Relocation{ nC, h, mesh_.rotation[h] } }, 2);
  mesh_.origin[h] = mesh_.origin[pB];
  mesh_.uv[h] = x2;
  bury(Mesh::face(hB));
  bury(Mesh::face(hC));
  finish();
}

void UvEditor::undoRemoveInside(const UvRecord& record)
{
  const Index h = record.slot, hn = Mesh::next(h), hp = Mesh::previous(h);
  const FixedVec2 x2 = mesh_.uv[h], x0 = mesh_.uv[hn], x1 = mesh_.uv[hp];
  const FixedVec2 v = x2 + scaled(x0 - x2, record.weights[1]) + scaled(x1 - x2, record.weights[2]);
  restore(record);
  mesh_.uv[h] = v;
  reviveSide(h, v, x2);
  const Index pC = mesh_.twin[h];
  mesh_.uv[pC] = rotate(x0, mesh_.rotation[h]);
  mesh_.uv[Mesh::next(pC)] = rotate(v, mesh_.rotation[h]);
  mesh_.uv[Mesh::previous(pC)] = rotate(x2, mesh_.rotation[h]);
}

/// The face left of previous(h) = (y -> v), that is (v, y, r), gets the chart of h's face but for a rotation.
void UvEditor::reviveSide(Index h, FixedVec2 v, FixedVec2 r)
{
  const Index hp = Mesh::previous(h), hB = mesh_.twin[hp];
  const int rotation = mesh_.rotation[hp];
  mesh_.uv[hB] = rotate(v, rotation);
  mesh_.uv[Mesh::next(hB)] = rotate(mesh_.uv[hp], rotation);
  mesh_.uv[Mesh::previous(hB)] = rotate(r, rotation);
  mesh_.alive[Mesh::face(hB)] = 1;
}

void UvEditor::saveSide(Index h)
{
  const Index hB = mesh_.twin[Mesh::previous(h)];
  saveFace(Mesh::face(h));
  saveFace(Mesh::face(hB));
  saveMoved(Mesh::next(hB));
}

/// Joins the faces (v, p, y) of h and (v, y, r) to (r, p, y).
void UvEditor::mergeSide(Index h)
{
  const Index hp = Mesh::previous(h);
  const Index hB = mesh_.twin[hp], nB = Mesh::next(hB), pB = Mesh::previous(hB);
  const FixedVec2 r = mesh_.transition(hB).apply(mesh_.uv[pB]);
  moveOutgoing(mesh_.origin[pB], pB, h);
  moveOutgoing(mesh_.origin[hp], nB, hp);
  mesh_.origin[h] = mesh_.origin[pB];
  mesh_.uv[h] = r;
  relocate({ Relocation{ nB, hp, mesh_.rotation[hp] }, Relocation{} }, 1);
  bury(Mesh::face(hB));
}

void UvEditor::removeOnLine(Index h)
{
  const Index pB = Mesh::previous(mesh_.twin[Mesh::previous(h)]);
  const Index other = mesh_.twin[pB];
  begin(UvRecord::Kind::RemoveOnLine, h);
  const Index v = mesh_.origin[h];
  const FixedVec2 toP = mesh_.vector(h), toV = mesh_.vector(pB);
  const std::int64_t lengthP = std::abs(toP.u) + std::abs(toP.v);
  const std::int64_t lengthV = std::abs(toV.u) + std::abs(toV.v);
  UvRecord& record = records_.back();
  record.vertex = v;
  record.otherSlot = other;
  record.weights[0] = ratio(lengthV, Int128{ lengthV } + lengthP);
  saveSide(h);
  int across = 0;
  if (other != kInvalidIndex)
  {
    saveSide(other);
    across = mesh_.rotation[h] + mesh_.rotation[Mesh::next(mesh_.twin[h])];
  }
  mesh_.outgoing[v] = kInvalidIndex;
  mergeSide(h);
  if (other != kInvalidIndex)
  {
    mergeSide(other);
    mesh_.twin[h] = other;
    mesh_.twin[other] = h;
    mesh_.rotation[h] = static_cast<std::int8_t>(across & 3);
    mesh_.rotation[other] = static_cast<std::int8_t>(-across & 3);
  }
  finish();
}

void UvEditor::undoRemoveOnLine(const UvRecord& record)
{
  const Index h = record.slot, other = record.otherSlot;
  const FixedVec2 r = mesh_.uv[h], p = mesh_.uv[Mesh::next(h)];
  const FixedVec2 v = r + scaled(p - r, record.weights[0]);
  FixedVec2 otherV, otherR;
  if (other != kInvalidIndex)
  {
    otherV = mesh_.transition(h).apply(v);
    otherR = mesh_.uv[other];
  }
  restore(record);
  mesh_.uv[h] = v;
  reviveSide(h, v, r);
  if (other != kInvalidIndex)
  {
    mesh_.uv[other] = otherV;
    reviveSide(other, otherV, otherR);
  }
}

void UvEditor::restore(const UvRecord& record)
{
  // Backwards: a slot that was saved twice gets its first state.
  for (std::size_t i = record.firstState + record.stateCount; i-- > record.firstState;)
  {
    const SlotState& state = states_[i];
    mesh_.origin[state.slot] = state.origin;
    mesh_.twin[state.slot] = state.twin;
    mesh_.rotation[state.slot] = state.rotation;
    mesh_.flags[state.slot] = state.flags;
    mesh_.alive[Mesh::face(state.slot)] = 1;
  }
}

/// h: of an edge that was flipped back. returned: the vertex that has come back last.
void UvEditor::keepPositive(Index h, const std::vector<std::uint8_t>& held, Index returned)
{
  const Index g = mesh_.twin[h];
  if (mesh_.faceDeterminant(Mesh::face(h)) > 0 && mesh_.faceDeterminant(Mesh::face(g)) > 0)
  {
    return;
  }
  std::array<Index, 4> corners{ h, g, Mesh::previous(h), Mesh::previous(g) };
  std::stable_partition(
    corners.begin(), corners.end(), [&](Index c) { return mesh_.origin[c] == returned; });
  for (const Index c : corners)
  {
    if (held[mesh_.origin[c]] == 0 && moveIntoKernel(mesh_, c))
    {
      return;
    }
  }
}

void UvEditor::undoTo(std::size_t count, const std::vector<std::uint8_t>& held)
{
  Index returned = kInvalidIndex;
  while (records_.size() > count)
  {
    const UvRecord record = records_.back();
    returned = record.vertex != kInvalidIndex ? record.vertex : returned;
    switch (record.kind)
    {
      case UvRecord::Kind::Flip:
        undoFlip(record);
        keepPositive(record.slot, held, returned);
        break;
      case UvRecord::Kind::RemoveInside:
        undoRemoveInside(record);
        break;
      case UvRecord::Kind::RemoveOnLine:
        undoRemoveOnLine(record);
        break;
    }
    records_.pop_back();
    states_.resize(record.firstState);
  }
}

} // namespace quadrille
