// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleAlgorithm.h"

#include "Base/Refuse.h"
#include "Blocks/BlockRun.h"
#include "Blocks/Blocks.h"
#include "Convert/Surfaces.h"
#include "Ranks/Ranks.h"

#include "vtkBoundingBox.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkMath.h"
#include "vtkPolyData.h"

#include <algorithm>

namespace
{

/// Parts of the sum of the areas, none below the least one: blocks that would be below get that, and the others share
/// the rest.
std::vector<double> sharesOf(const std::vector<double>& areas, double least)
{
  std::vector<double> shares(areas.size(), 1.0 / static_cast<double>(areas.size()));
  std::vector<bool> isRaised(areas.size(), false);
  for (bool isSettled = false; !isSettled;)
  {
    double rest = 1, area = 0;
    for (std::size_t i = 0; i < areas.size(); ++i)
    {
      (isRaised[i] ? rest : area) += isRaised[i] ? -least : areas[i];
    }
    isSettled = true;
    for (std::size_t i = 0; i < areas.size() && area > 0; ++i)
    {
      shares[i] = isRaised[i] ? least : rest * areas[i] / area;
      if (shares[i] < least)
      {
        isRaised[i] = true;
        isSettled = false;
      }
    }
  }
  return shares;
}

} // namespace

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::ReadOwnTargets(Run& run)
{
  std::vector<std::string> names;
  quadrille::Packer packer;
  for (const Work& work : run.works)
  {
    names.push_back(work.block.name);
    double target = 0;
    std::string error;
    try
    {
      const quadrille::BlockNode& node = run.trees[0].at(work.block.path);
      std::vector<vtkFieldData*> told{ node.fieldData };
      for (vtkDataObject* piece : node.pieces)
      {
        told.push_back(piece->GetFieldData());
      }
      // Pieces of one surface may each say it, or one for all; the name of a block counts where none does.
      for (vtkFieldData* fieldData : told)
      {
        if (!work.block.path.empty())
        {
          target = std::max(target, this->ReadOwnTarget(work.block.name, fieldData));
        }
      }
    }
    catch (const std::exception& failure)
    {
      error = failure.what();
    }
    packer.number(target);
    packer.text(error);
  }
  for (const std::string& bytes : run.ranks.gather(packer.bytes()))
  {
    quadrille::Unpacker unpacker(bytes);
    for (Work& work : run.works)
    {
      work.block.ownTarget = std::max(work.block.ownTarget, unpacker.number());
      const std::string error = unpacker.text();
      work.error = work.error.empty() ? error : work.error;
    }
  }
  this->CheckBlockNames(names);
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::MeasureBlocks(Run& run)
{
  if (run.works.size() < 2 || !this->HasCommonTarget())
  {
    return;
  }
  quadrille::Packer packer;
  for (const Work& work : run.works)
  {
    vtkPolyData* surface = run.owns(work) ? work.block.input() : nullptr;
    const bool isSpread = run.owns(work) && work.spread;
    packer.number(isSpread ? work.spread->size().area : surface ? quadrille::areaOf(surface) : 0);
    vtkBoundingBox box;
    double bounds[6];
    if (isSpread)
    {
      box.SetBounds(work.spread->size().bounds);
    }
    if (surface && surface->GetNumberOfPoints() > 0)
    {
      surface->GetBounds(bounds);
      box.SetBounds(bounds);
    }
    box.IsValid() ? box.GetBounds(bounds) : vtkMath::UninitializeBounds(bounds);
    for (const double bound : bounds)
    {
      packer.number(bound);
    }
  }
  std::vector<double> areas(run.works.size(), 0);
  vtkBoundingBox whole;
  for (const std::string& bytes : run.ranks.gather(packer.bytes()))
  {
    quadrille::Unpacker unpacker(bytes);
    for (double& area : areas)
    {
      area += unpacker.number();
      double bounds[6];
      for (double& bound : bounds)
      {
        bound = unpacker.number();
      }
      whole.AddBounds(bounds); // ignores what is uninitialized
    }
  }
  this->ShareTarget(run, areas);
  for (Work& work : run.works)
  {
    work.block.wholeDiagonal = whole.IsValid() ? whole.GetDiagonalLength() : 0;
    work.isChanged = work.isChanged || work.block.areaShare != work.block.state->lastAreaShare ||
      work.block.wholeDiagonal != work.block.state->lastWholeDiagonal;
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::ShareTarget(Run& run, const std::vector<double>& areas)
{
  // What blocks have of their own is taken off first.
  const double target = this->GetSharedTarget();
  double own = 0;
  std::vector<double> otherAreas;
  for (std::size_t i = 0; i < areas.size(); ++i)
  {
    own += run.works[i].block.ownTarget;
    if (!(run.works[i].block.ownTarget > 0))
    {
      otherAreas.push_back(areas[i]);
    }
  }
  const double rest = target > 0 ? target - own : 1;
  if (!otherAreas.empty() && !(rest > 0))
  {
    quadrille::refuse("the own numbers of quads of ", areas.size() - otherAreas.size(),
      " blocks add up to ", own, ", so that nothing of the ", target,
      " quads for all is left for the other ", otherAreas.size(),
      " blocks: ask for more quads, or give those numbers of their own, too");
  }
  const std::vector<double> shares =
    sharesOf(otherAreas, this->LeastAreaShare(otherAreas.size(), rest));
  std::size_t next = 0;
  for (Work& work : run.works)
  {
    const bool isOwn = work.block.ownTarget > 0;
    work.block.areaShare = isOwn ? 1 : shares[next++] * (target > 0 ? rest / target : 1);
  }
}
