// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Levels.h"

#include "Base/Memory.h"
#include "Transfer/SurfaceStretch.h"

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
  return key.add(static_cast<std::uint64_t>(options.cost)).add(std::uint64_t{ 1 }).key();
}

/// Of phase 1 without anything that is to be kept.
ResultKey keyOfPlain(ResultKey surface, double edgeLength)
{
  return KeyMaker(surface).add(edgeLength).key();
}

/// Of levels that have followed.
ResultKey keyOfFollowed(ResultKey surface, double edgeLength)
{
  return KeyMaker(keyOfPlain(surface, edgeLength)).add(std::uint64_t{ 1 }).key();
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
  if (!found || !found->levels)
  {
    return false;
  }
  letGo();
  held_ = std::move(found);
  heldKey_ = wanted;
  recalled_ = recalled_ || decimations_ == 0;
  return true;
}

void Levels::decimate(const Mesh& mesh, const HierarchyOptions& options, ResultKey key)
{
  letGo(); // before the new ones take their memory
  ++decimations_;
  auto made = std::make_shared<StoredLevels>();
  made->levels = std::make_unique<Redecimation>(mesh, surface_->hash, options);
  releaseFreedMemory();
  held_ = std::move(made);
  heldKey_ = key;
  const Hierarchy& hierarchy = held_->levels->hierarchy();
  stages_.add("phase1", hierarchy.secondsPhase1, surface_->mesh.faceCount(),
    hierarchy.intermediate.mesh.faceCount());
}

/// Phase 1, of the surface without the sizes of the plan, and without what the plan keeps; with them, where they are
/// not few.
void Levels::obtain(const HierarchyOptions& options)
{
  stages_ = {};
  HierarchyOptions phase1 = options;
  if (hasFollowed_ && (!isPlain(options) || plainKey(options) != heldKey_))
  {
    letGo();
  }
  if (!isPlain(options))
  {
    const ResultKey key =
      KeyMaker(surface_.key()).add(options.targetEdgeLength).add(options.keepVertices).key();
    if (!recall(key))
    {
      decimate(surface_->mesh, phase1, key);
    }
    return;
  }
  const ResultKey key = plainKey(options);
  if (!recall(key))
  {
    phase1.keepVertices.clear();
    decimate(surface_.meshWithSizesBefore(), phase1, key);
  }
}

bool Levels::isPlain(const HierarchyOptions& options) const
{
  return isLocalChange(surface_->mesh, surface_.sizesBefore(), options.keepVertices.size());
}

ResultKey Levels::plainKey(const HierarchyOptions& options) const
{
  return (hasFollowed_ ? keyOfFollowed : keyOfPlain)(
    surface_.keyWithoutSizes(), options.targetEdgeLength);
}

std::unique_ptr<Redecimation> Levels::giveToFollow(const HierarchyOptions& options)
{
  if (!held_ || !isPlain(options) || heldKey_ != plainKey(options))
  {
    return nullptr;
  }
  std::unique_ptr<Redecimation> levels = std::move(held_->levels);
  held_.reset(); // the store may have the rest, which counts as not there
  return levels;
}

void Levels::follow(std::unique_ptr<Redecimation> levels, const HierarchyOptions& options)
{
  auto stored = std::make_shared<StoredLevels>();
  stored->levels = std::move(levels);
  hasFollowed_ = true;
  held_ = std::move(stored);
  heldKey_ = plainKey(options);
}

std::shared_ptr<StoredLevels> Levels::findFollowed(
  ResultStore& store, ResultKey surfaceKey, double edgeLength)
{
  std::shared_ptr<StoredLevels> found =
    store.find<StoredLevels>(keyOfFollowed(surfaceKey, edgeLength));
  return found && found->levels ? found : nullptr;
}

void Levels::follow(std::shared_ptr<StoredLevels> found, const HierarchyOptions& options)
{
  hasFollowed_ = true;
  recalled_ = true;
  held_ = std::move(found);
  heldKey_ = plainKey(options);
}

const Level& Levels::makeIntermediate(const HierarchyOptions& options)
{
  obtain(options);
  return held_->levels->intermediateOfPhase1();
}

const Hierarchy& Levels::make(const HierarchyOptions& options)
{
  obtain(options);
  const ResultKey wanted = KeyMaker(surface_.key()).add(phase2Key(options)).key();
  if (held_->made != wanted)
  {
    held_->made = 0; // what is stopped on the way is not made
    held_->levels->setSizes(surface_->mesh.sizing);
    const Hierarchy& hierarchy = held_->levels->update(options);
    if (!hierarchy.coarse.guides.empty())
    {
      held_->levels->replaceCoarseGuides(
        gatherGuides(hierarchy.intermediate, hierarchy.coarse, hierarchy.log));
    }
    held_->made = wanted;
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
  else if (held_)
  {
    held_.reset();
    releaseFreedMemory(); // the log is a tenth of all
  }
  held_.reset();
  hasFollowed_ = false;
}

} // namespace quadrille
