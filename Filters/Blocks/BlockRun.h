// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// One execution of a filter: the blocks of its input on the ranks, and what happens to each of them.
#pragma once

#include "Blocks/Blocks.h"
#include "Common/Stamps.h"
#include "Ranks/Ranks.h"
#include "Ranks/Spread.h"

#include <vtkSmartPointer.h>

#include <cstddef>
#include <exception>
#include <memory>
#include <string>
#include <vector>

class vtkDataObject;
class vtkMultiProcessController;

namespace quadrille
{

/// What happens to one block in an execution; the same on all ranks where nothing else is said.
struct BlockWork
{
  Block block; ///< inputs and outputs on the owner only
  std::string key;
  int owner = 0;
  std::size_t group = 0; ///< the first work that this one may have to be executed together with
  std::size_t cells = 0; ///< of all ranks
  bool isChanged = true;
  std::vector<Stamp> stamps;             ///< of this rank's pieces
  std::string error;                     ///< why the inputs could not be had
  std::vector<std::string> notices;      ///< on the inputs
  std::unique_ptr<SpreadSurface> spread; ///< where the surface stays spread
  std::exception_ptr failure;            ///< of what came before the filter's own work
  bool isMade = false;                   ///< by the filter's own work, on the owner
  bool isSpread = false;                 ///< the result is
};

/// One execution: the structure of the input and its blocks.
struct BlockRun
{
  explicit BlockRun(vtkMultiProcessController* controller) : ranks(controller), stop(controller) {}

  Ranks ranks;
  SharedStop stop;
  int ghostLevels = 0;                                ///< that the outputs are asked for
  std::vector<BlockTree> trees;                       ///< by input port, with this rank's pieces
  std::vector<vtkSmartPointer<vtkDataObject>> shared; ///< by input port
  std::vector<std::string> notices;                   ///< on shared inputs
  std::vector<Stamp> stamps;                          ///< of what all blocks share
  vtkDataObject* input = nullptr;
  std::vector<BlockWork> works;
  bool anew = false; ///< a block is executed

  bool owns(const BlockWork& work) const { return work.owner == ranks.rank(); }
  /// This rank's pieces for a block.
  std::vector<vtkSmartPointer<vtkDataObject>> pieces(const BlockWork& work, int port) const
  {
    const auto node = trees[static_cast<std::size_t>(port)].find(work.block.path);
    return node == trees[static_cast<std::size_t>(port)].end()
      ? std::vector<vtkSmartPointer<vtkDataObject>>{}
      : node->second.pieces;
  }
};

} // namespace quadrille
