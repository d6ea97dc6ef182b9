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
ResultKey phase2Key(ResultKey surface, const HierarchyOptions& options)
{
  return KeyMaker(surface).add(options.keepVertices, options.coarseVertices, options.cost).key();
}

ResultKey guidesKey(ResultKey phase2, const HierarchyOptions& options)
{
  KeyMaker key(phase2);
  for (const FaceGuide& guide : options.guides)
  {
    key.add(guide.face, guide.guide.weight, guide.guide.direction);
  }
  return key.key();
}

bool isPlain(const PlannedSurface& surface, const HierarchyOptions& options)
{
  return isLocalChange(surface->mesh, surface.sizesBefore, options.keepVertices.size());
}

} // namespace

std::size_t StoredLevels::bytes() const
{
  const Hierarchy& hierarchy = levels->hierarchy();
  return hierarchy.log.recordBytes() + hierarchy.cache.bytes + bytesOf(hierarchy.coarse.mesh) +
    2 * bytesOf(hierarchy.intermediate.mesh) + levels->bytesAside();
}

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

void Levels::decimate(
  const PlannedSurface& surface, const Mesh& mesh, const HierarchyOptions& options, ResultKey key)
{
  letGo(); // before the new ones take their memory
  ++decimations_;
  auto made = std::make_shared<StoredLevels>(); // what is stopped on the way is not held
  made->levels = std::make_unique<Redecimation>(mesh, surface->hash, options);
  held_ = std::move(made);
  heldKey_ = key;
  releaseFreedMemory();
  const Hierarchy& hierarchy = held_->levels->hierarchy();
  stages_.add(
    "phase1", hierarchy.secondsPhase1, mesh.faceCount(), hierarchy.intermediate.mesh.faceCount());
}

/// Phase 1, of the surface without the sizes of the plan, and without what the plan keeps; with them, where they are
/// not few.
void Levels::obtain(const PlannedSurface& surface, const HierarchyOptions& options)
{
  stages_ = {};
  const bool plain = isPlain(surface, options);
  const ResultKey key = plain
    ? KeyMaker(surface.keyWithoutSizes).add(options.targetEdgeLength).key()
    : KeyMaker(surface.key).add(options.targetEdgeLength, options.keepVertices).key();
  if (recall(key))
  {
    return;
  }
  HierarchyOptions phase1 = options;
  Mesh mesh = surface->mesh;
  if (plain)
  {
    phase1.keepVertices.clear();
    mesh.sizing = surface.sizesBefore;
  }
  decimate(surface, mesh, phase1, key);
}

const Level& Levels::makeIntermediate(
  const PlannedSurface& surface, const HierarchyOptions& options)
{
  obtain(surface, options);
  return held_->levels->intermediateOfPhase1();
}

const Hierarchy& Levels::make(const PlannedSurface& surface, const HierarchyOptions& options)
{
  obtain(surface, options);
  const ResultKey wanted = phase2Key(surface.key, options);
  if (held_->made != wanted)
  {
    held_->made = held_->guided = 0; // what is stopped on the way is not made
    held_->levels->setSizes(surface->mesh.sizing);
    const Hierarchy& hierarchy = held_->levels->update(options);
    held_->made = wanted;
    stages_.add("phase2", hierarchy.secondsPhase2, hierarchy.intermediate.mesh.faceCount(),
      hierarchy.coarse.mesh.faceCount());
  }
  const ResultKey guided = guidesKey(wanted, options);
  if (held_->guided != guided)
  {
    held_->guided = 0; // the same
    held_->levels->setGuides(options);
    const Hierarchy& levels = held_->levels->hierarchy();
    held_->levels->setCoarseGuides(gatherGuides(levels.intermediate, levels.coarse, levels.log));
    held_->guided = guided;
  }
  return hierarchy();
}

Hierarchy Levels::take()
{
  if (store_ != nullptr)
  {
    Hierarchy copy = hierarchy();
    letGo();
    return copy;
  }
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
}

} // namespace quadrille
