// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Levels.h"

#include "Base/Memory.h"

#include <utility>

namespace quadrille
{
namespace
{

/// Of what phase 2 depends on.
ResultKey phase2Key(const HierarchyOptions& options)
{
  KeyMaker key;
  key.add(options.keepVertices).add(std::uint64_t{ options.coarseVertices });
  for (const FaceGuide& guide : options.guides)
  {
    key.add(std::uint64_t{ guide.face }).add(double{ guide.guide.weight });
    for (int i = 0; i < 3; ++i)
    {
      key.add(guide.guide.direction[i]);
    }
  }
  return key.add(std::uint64_t{ 1 }).key();
}

} // namespace

std::size_t StoredLevels::bytes() const
{
  const Hierarchy& hierarchy = levels->hierarchy();
  return hierarchy.log.recordBytes() + hierarchy.cache.bytes + bytesOf(hierarchy.coarse.mesh) +
    2 * bytesOf(hierarchy.intermediate.mesh) + bytesOf(phase1.kept);
}

Levels::Levels(RunSurface& surface, ResultStore* store, bool anyKept)
  : surface_(surface), store_(store), anyKept_(anyKept)
{
}

ResultKey Levels::key(const Phase1& phase1) const
{
  return KeyMaker(surface_.key()).add(phase1.edgeLength).add(phase1.kept).key();
}

bool Levels::recall(const Phase1& phase1)
{
  const ResultKey wanted = key(phase1);
  if (held_ && heldKey_ == wanted)
  {
    return true;
  }
  std::shared_ptr<StoredLevels> found =
    store_ != nullptr ? store_->find<StoredLevels>(wanted) : nullptr;
  if (!found || found->surface != surface_.pointer())
  {
    return false;
  }
  letGo();
  held_ = std::move(found);
  heldKey_ = wanted;
  recalled_ = recalled_ || decimations_ == 0;
  return true;
}

/// The last used levels of this surface that the options allow.
bool Levels::recallAny(const HierarchyOptions& options)
{
  if (!anyKept_ || store_ == nullptr)
  {
    return false;
  }
  if (held_ && held_->surfaceKey == surface_.key() && held_->levels->allows(options))
  {
    return true;
  }
  for (const std::shared_ptr<StoredLevels>& other : store_->all<StoredLevels>())
  {
    if (other->surface == surface_.pointer() && other->surfaceKey == surface_.key() &&
      other->levels->allows(options))
    {
      return recall(other->phase1);
    }
  }
  return false;
}

void Levels::decimate(HierarchyOptions options, const Phase1& phase1)
{
  letGo(); // before the new ones take their memory
  ++decimations_;
  options.keepVertices = phase1.kept;
  auto made = std::make_shared<StoredLevels>();
  made->surface = surface_.pointer();
  made->surfaceKey = surface_.key();
  made->phase1 = phase1;
  made->levels = std::make_unique<Redecimation>(surface_->mesh, surface_->hash, options);
  releaseFreedMemory();
  held_ = std::move(made);
  heldKey_ = key(phase1);
  const Hierarchy& hierarchy = held_->levels->hierarchy();
  stages_.add("phase1", hierarchy.secondsPhase1, surface_->mesh.faceCount(),
    hierarchy.intermediate.mesh.faceCount());
}

void Levels::obtain(const HierarchyOptions& options, const Phase1& phase1)
{
  if (!recall(phase1))
  {
    decimate(options, phase1);
  }
}

const Hierarchy& Levels::make(const HierarchyOptions& options, const Phase1* before)
{
  stages_ = {};
  const Phase1 own{ options.targetEdgeLength, options.keepVertices };
  const bool known = before != nullptr && before->edgeLength == own.edgeLength;
  if (!recallAny(options))
  {
    obtain(options, known ? *before : own);
    if (!held_->levels->allows(options))
    {
      obtain(options, own);
    }
  }
  phase1_ = held_->phase1;
  if (held_->made != phase2Key(options))
  {
    held_->made = 0; // what is stopped on the way is not made
    const Hierarchy& hierarchy = held_->levels->update(options);
    held_->made = phase2Key(options);
    stages_.add("phase2", hierarchy.secondsPhase2, hierarchy.intermediate.mesh.faceCount(),
      hierarchy.coarse.mesh.faceCount());
  }
  return hierarchy();
}

Hierarchy Levels::take()
{
  Hierarchy taken = held_->levels->take();
  held_.reset();
  return taken;
}

void Levels::letGo()
{
  if (held_ && store_ != nullptr)
  {
    const std::size_t bytes = held_->bytes();
    store_->put(heldKey_, std::move(held_), bytes);
  }
  held_.reset();
}

} // namespace quadrille
