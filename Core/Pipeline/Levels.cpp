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
    2 * bytesOf(hierarchy.intermediate.mesh) + levels->bytesAside();
}

Levels::Levels(RunSurface& surface, ResultStore* store) : surface_(surface), store_(store) {}

bool Levels::recall(ResultKey wanted)
{
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

void Levels::decimate(const HierarchyOptions& options, ResultKey key)
{
  letGo(); // before the new ones take their memory
  auto made = std::make_shared<StoredLevels>();
  made->surface = surface_.pointer();
  made->surfaceKey = surface_.key();
  made->levels = std::make_unique<Redecimation>(surface_->mesh, surface_->hash, options);
  releaseFreedMemory();
  held_ = std::move(made);
  heldKey_ = key;
  recordPhase1(1);
}

/// What phase 1 took the last time, where it ran so often.
void Levels::recordPhase1(int runs)
{
  if (runs > 0)
  {
    decimations_ += runs;
    const Hierarchy& hierarchy = held_->levels->hierarchy();
    stages_.add("phase1", hierarchy.secondsPhase1, surface_->mesh.faceCount(),
      hierarchy.intermediate.mesh.faceCount());
  }
}

void Levels::obtain(const HierarchyOptions& options)
{
  stages_ = {};
  const ResultKey key = KeyMaker(surface_.key()).add(options.targetEdgeLength).key();
  if (!recall(key))
  {
    decimate(options, key);
  }
}

const Level& Levels::makeIntermediate(const HierarchyOptions& options)
{
  obtain(options);
  const int before = held_->levels->decimations();
  const Level& level = held_->levels->intermediateOfPhase1(options);
  const int runs = held_->levels->decimations() - before;
  held_->made = runs > 0 ? 0 : held_->made;
  recordPhase1(runs);
  return level;
}

const Hierarchy& Levels::make(const HierarchyOptions& options)
{
  obtain(options);
  if (held_->made != phase2Key(options))
  {
    held_->made = 0; // what is stopped on the way is not made
    const int before = held_->levels->decimations();
    const Hierarchy& hierarchy = held_->levels->update(options);
    held_->made = phase2Key(options);
    recordPhase1(held_->levels->decimations() - before);
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
