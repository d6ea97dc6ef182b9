// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleAlgorithm.h"

#include "Assembly/JoinParts.h"
#include "Base/DisjointSets.h"
#include "Base/Error.h"
#include "Blocks/BlockRun.h"
#include "Blocks/Blocks.h"
#include "Blocks/Shared.h"
#include "Common/Stamps.h"
#include "Convert/Pieces.h"
#include "Convert/Surfaces.h"
#include "Ranks/Ranks.h"
#include "Ranks/Spread.h"

#include "vtkBoundingBox.h"
#include "vtkDataObject.h"
#include "vtkDataSet.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace
{

/// Place and name: a block that moved or was renamed is another one.
std::string keyOf(const quadrille::Block& block)
{
  std::string key;
  for (const unsigned index : block.path)
  {
    key += std::to_string(index) + "/";
  }
  return key + block.name;
}

} // namespace

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::ReadInputs(Run& run, vtkInformationVector** inputs)
{
  run.stamps.emplace_back(nullptr, this->GetMTime());
  run.input = vtkDataObject::GetData(inputs[0]);
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    run.trees.push_back(quadrille::blockTree(vtkDataObject::GetData(inputs[port])));
    // Only a port whose data is shared by all blocks takes several connections.
    for (int i = 1; i < inputs[port]->GetNumberOfInformationObjects(); ++i)
    {
      for (auto& [path, node] :
        quadrille::blockTree(vtkDataObject::GetData(inputs[port]->GetInformationObject(i))))
      {
        quadrille::BlockPath ofConnection{ std::numeric_limits<unsigned>::max(),
          static_cast<unsigned>(i) };
        ofConnection.insert(ofConnection.end(), path.begin(), path.end());
        run.trees.back()[ofConnection] = node;
      }
    }
    if (this->GetPortRole(port) != PortRole::Shared)
    {
      continue;
    }
    for (const auto& [path, node] : run.trees.back())
    {
      for (vtkDataObject* piece : node.pieces)
      {
        quadrille::addStampsOfContents(piece, run.stamps);
      }
    }
    run.stamps.emplace_back(nullptr, run.trees.back().size());
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::ListBlocks(Run& run)
{
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    quadrille::BlockTree& tree = run.trees[static_cast<std::size_t>(port)];
    std::vector<vtkSmartPointer<vtkDataObject>> shared;
    if (this->GetPortRole(port) == PortRole::Shared)
    {
      for (const auto& [path, node] : tree)
      {
        shared.insert(shared.end(), node.pieces.begin(), node.pieces.end());
      }
      shared = run.ranks.collectEverywhere(shared);
    }
    else
    {
      quadrille::mergeTrees(tree, run.ranks);
    }
    run.shared.emplace_back(quadrille::joinShared(shared, run.notices));
  }
  quadrille::Packer packer;
  for (const auto& [path, node] : run.trees[0])
  {
    if (node.isBlock)
    {
      Work& work = run.works.emplace_back();
      work.block.path = path;
      work.block.name = quadrille::blockName(run.trees[0], path);
      work.key = keyOf(work.block);
      std::uint64_t cells = 0;
      for (vtkDataObject* piece : node.pieces)
      {
        cells += quadrille::cellCount(piece);
      }
      packer.count(cells);
    }
  }
  for (const std::string& bytes : run.ranks.gather(packer.bytes()))
  {
    quadrille::Unpacker unpacker(bytes);
    for (Work& work : run.works)
    {
      work.cells += unpacker.count();
    }
  }
  // An empty leaf of composite data is normal; a plain data set without cells is told by the filter.
  run.works.erase(std::remove_if(run.works.begin(), run.works.end(),
                    [](const Work& work) { return work.cells == 0 && !work.block.path.empty(); }),
    run.works.end());
  if (run.works.empty())
  {
    throw quadrille::InvalidInput("there is no cell in the input");
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::TakeStates(Run& run)
{
  std::map<std::string, std::unique_ptr<quadrille::BlockState>> states;
  quadrille::Packer packer;
  for (Work& work : run.works)
  {
    auto& state = states[work.key] = std::move(this->States[work.key]);
    if (!state)
    {
      state = std::make_unique<quadrille::BlockState>();
    }
    work.block.state = state.get();
    work.stamps = run.stamps;
    work.stamps.emplace_back(nullptr, static_cast<vtkMTimeType>(work.block.ownTarget));
    for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
    {
      if (this->GetPortRole(port) == PortRole::Shared)
      {
        continue; // among those of the run
      }
      for (vtkDataObject* piece : run.pieces(work, port))
      {
        quadrille::addStamps(piece, work.stamps);
      }
    }
  }
  this->States = std::move(states);
  // What is executed together depends on the inputs of all.
  std::map<std::size_t, std::vector<quadrille::Stamp>> groupStamps;
  for (const Work& work : run.works)
  {
    // Those of the filter and of what all share stand at the beginning of each, and once of a group.
    auto& stamps = groupStamps[work.group];
    const std::size_t shared = stamps.empty() ? 0 : run.stamps.size();
    stamps.insert(
      stamps.end(), work.stamps.begin() + static_cast<std::ptrdiff_t>(shared), work.stamps.end());
  }
  for (Work& work : run.works)
  {
    work.stamps = groupStamps[work.group];
    const quadrille::BlockState& state = *work.block.state;
    packer.count(!state.lastResult.empty());
    packer.count(this->KeepsResult() && work.stamps == state.lastStamps &&
      (!state.isSpread || state.ghostLevels == run.ghostLevels));
    // Where another port asks for what failed, the report says already why there is nothing.
    packer.count(work.stamps == state.failedStamps);
  }
  // A block stays where its result and its memory are; the others go to the rank with the least to do, large ones
  // first.
  std::vector<std::size_t> load(static_cast<std::size_t>(run.ranks.size()), 0);
  for (Work& work : run.works)
  {
    work.owner = -1;
  }
  std::vector<bool> hasResult(run.works.size(), true), hasFailed(run.works.size(), true);
  const std::vector<std::string> all = run.ranks.gather(packer.bytes());
  for (std::size_t rank = 0; rank < all.size(); ++rank)
  {
    quadrille::Unpacker unpacker(all[rank]);
    for (std::size_t w = 0; w < run.works.size(); ++w)
    {
      Work& work = run.works[w];
      if (unpacker.count() != 0 && work.owner < 0)
      {
        work.owner = static_cast<int>(rank);
        load[rank] += work.cells;
      }
      hasResult[w] = unpacker.count() != 0 && hasResult[w];
      hasFailed[w] = unpacker.count() != 0 && hasFailed[w];
      work.isChanged = !hasResult[w] && !hasFailed[w];
    }
  }
  // All of a group go to the rank of the first one that has a rank.
  std::map<std::size_t, std::vector<Work*>> groups;
  for (Work& work : run.works)
  {
    groups[work.group].push_back(&work);
  }
  std::vector<std::pair<std::size_t, const std::vector<Work*>*>> free; // cells, works
  for (const auto& [group, works] : groups)
  {
    std::size_t cells = 0;
    int owner = -1;
    for (const Work* work : works)
    {
      cells += work->cells;
      owner = owner < 0 ? work->owner : owner;
    }
    for (Work* work : works)
    {
      work->owner = owner;
    }
    if (owner < 0)
    {
      free.emplace_back(cells, &works);
    }
  }
  std::stable_sort(
    free.begin(), free.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [cells, works] : free)
  {
    const auto least = std::min_element(load.begin(), load.end());
    for (Work* work : *works)
    {
      work->owner = static_cast<int>(least - load.begin());
    }
    *least += cells;
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::GroupBlocks(Run& run)
{
  for (std::size_t i = 0; i < run.works.size(); ++i)
  {
    run.works[i].group = i;
  }
  if (!this->JoinsBlocks() || run.works.size() < 2)
  {
    return;
  }
  quadrille::Packer packer;
  for (const Work& work : run.works)
  {
    vtkBoundingBox box;
    for (vtkDataObject* piece : run.pieces(work, 0))
    {
      auto* set = vtkDataSet::SafeDownCast(piece);
      if (set && set->GetNumberOfPoints() > 0)
      {
        box.AddBounds(set->GetBounds());
      }
    }
    double bounds[6];
    box.IsValid() ? box.GetBounds(bounds) : vtkMath::UninitializeBounds(bounds);
    for (const double bound : bounds)
    {
      packer.number(bound);
    }
  }
  vtkBoundingBox whole;
  std::vector<vtkBoundingBox> boxes(run.works.size());
  for (const std::string& bytes : run.ranks.gather(packer.bytes()))
  {
    quadrille::Unpacker unpacker(bytes);
    for (vtkBoundingBox& box : boxes)
    {
      double bounds[6];
      for (double& bound : bounds)
      {
        bound = unpacker.number();
      }
      box.AddBounds(bounds); // ignores what is uninitialized
      whole.AddBox(box);
    }
  }
  const double margin =
    whole.IsValid() ? quadrille::kRoundingOfSingle * whole.GetDiagonalLength() : 0;
  quadrille::DisjointSets groups(run.works.size(), 1);
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    vtkBoundingBox box = boxes[i];
    box.Inflate(margin);
    for (std::size_t k = 0; k < i; ++k)
    {
      if (box.IsValid() && boxes[k].IsValid() && box.Intersects(boxes[k]))
      {
        groups.join(static_cast<quadrille::Index>(i), static_cast<quadrille::Index>(k));
      }
    }
  }
  for (std::size_t i = 0; i < run.works.size(); ++i)
  {
    run.works[i].group = groups.find(static_cast<quadrille::Index>(i));
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::GatherInputs(Run& run)
{
  for (Work& work : run.works)
  {
    work.notices = run.notices;
    work.block.inputs.resize(static_cast<std::size_t>(this->GetNumberOfInputPorts()));
    for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
    {
      if (this->GetPortRole(port) != PortRole::Shared)
      {
        this->GatherPort(run, work, port);
      }
    }
  }
}

//------------------------------------------------------------------------------
bool vtkQuadrilleAlgorithm::IsPutInOrder(const Run& run) const
{
  return this->RankIndependent == Always ||
    (this->RankIndependent == UnderMPI && run.ranks.isParallel() && quadrille::isLaunchedByMpi());
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::GatherPort(Run& run, Work& work, int port)
{
  const bool isSurface = this->GetPortRole(port) == PortRole::Surface;
  const auto given = run.pieces(work, port);
  const bool isJoined = run.ranks.size() > 1 || given.size() > 1 || this->IsPutInOrder(run);
  std::vector<vtkSmartPointer<vtkDataObject>> pieces;
  quadrille::SurfaceCounts counts;
  std::string error;
  try
  {
    for (const vtkSmartPointer<vtkDataObject>& piece : given)
    {
      if (isSurface && (quadrille::cellCount(piece) > 0 || !isJoined))
      {
        pieces.emplace_back(quadrille::surfaceOf(piece, isJoined, counts));
      }
      else if (!isSurface)
      {
        pieces.push_back(piece);
      }
    }
  }
  catch (const std::exception& failure)
  {
    error = failure.what();
    pieces.clear();
  }
  quadrille::Packer packer;
  packer.text(error);
  packer.count(counts.volumeCells);
  packer.count(counts.ghostCells);
  counts = {};
  for (const std::string& bytes : run.ranks.gather(packer.bytes()))
  {
    quadrille::Unpacker unpacker(bytes);
    const std::string text = unpacker.text();
    work.error = work.error.empty() ? text : work.error;
    counts.volumeCells += unpacker.count();
    counts.ghostCells += unpacker.count();
  }
  if (isSurface && port == 0 && work.error.empty() && this->StaysSpread(run, work, pieces))
  {
    for (const std::string& notice : counts.notices())
    {
      work.notices.push_back(notice);
    }
    return;
  }
  pieces = run.ranks.collect(pieces, work.owner);
  if (!run.owns(work) || !work.error.empty())
  {
    return;
  }
  for (const std::string& notice : counts.notices())
  {
    work.notices.push_back(notice);
  }
  try
  {
    if (!isSurface)
    {
      work.block.inputs[port] = quadrille::onlyPiece(pieces);
    }
    else if (!this->IsPutInOrder(run) && pieces.size() == 1)
    {
      work.block.inputs[port] = quadrille::withoutMarks(vtkPolyData::SafeDownCast(pieces[0]));
    }
    else
    {
      std::vector<vtkSmartPointer<vtkPolyData>> surfaces;
      for (vtkDataObject* piece : pieces)
      {
        surfaces.emplace_back(vtkPolyData::SafeDownCast(piece));
      }
      work.block.inputs[port] = quadrille::joinPieces(surfaces, work.notices);
    }
    if (this->GetPortRole(port) == PortRole::Mesh && !work.block.input(port))
    {
      work.error = "the input is no mesh of a filter of Quadrille";
    }
  }
  catch (const std::exception& failure)
  {
    work.error = failure.what();
  }
}
