// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The blocks of a filter's input: a plain data set is one block, composite data has one for each of its surfaces.
#pragma once

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

class vtkDataObject;
class vtkFieldData;
class vtkInformation;
class vtkPolyData;
class vtkTable;

namespace quadrille
{

/// Ids of the children from the root of composite data down to a block; empty for a plain data set.
using BlockPath = std::vector<unsigned>;

class Packer;
class Ranks;
class Unpacker;

/// What the last execution of one block has to say.
struct BlockReport
{
  int outcome = 0; ///< a vtkQuadrilleAlgorithm::OutcomeType
  std::string outcomeText;
  bool isSoFar =
    false; ///< stopped with the best so far, which is the result; the next execution makes it anew
  std::string result;     ///< what was made, in a sentence
  bool hasDefect = false; ///< the sentence begins with what is wrong with it
  bool mayPass =
    false; ///< a failure that may pass by itself, as for lack of memory: the next execution tries again
  bool showsFailure =
    false; ///< the problem port has something of a failure that does not pass by itself
  std::string stageTimes;
  std::string certificate;
  std::vector<std::string> notices;
  std::vector<std::string> reusedStages;
  std::map<std::string, double> numbers; ///< by the name of the filter's getter

  void pack(Packer& packer) const;
  static BlockReport unpack(Unpacker& unpacker);
};

/// What a filter keeps of a block for its next execution, beside the result.
struct BlockMemory
{
  virtual ~BlockMemory() = default;
};

/// A result and all that it depends on.
struct EarlierResult
{
  std::string settings; ///< vtkQuadrilleAlgorithm::GetSettings()
  std::vector<std::pair<const void*, vtkMTimeType>> stamps; ///< of the inputs
  double areaShare = 1;
  double wholeDiagonal = 0;
  BlockReport report;
  std::vector<vtkSmartPointer<vtkDataObject>> result; ///< by port

  bool isFor(const EarlierResult& other) const
  {
    return settings == other.settings && stamps == other.stamps && areaShare == other.areaShare &&
      wholeDiagonal == other.wholeDiagonal;
  }
  std::size_t bytes() const;
};

/// What lasts of a block from one execution to the next.
struct BlockState
{
  BlockReport report;
  std::shared_ptr<BlockMemory> memory; ///< also of a run in the background
  std::vector<vtkSmartPointer<vtkDataObject>>
    lastResult; ///< by port; shares its arrays with the outputs
  /// Times of the filter and the block's inputs at its last success; empty where there was none.
  std::vector<std::pair<const void*, vtkMTimeType>> lastStamps;
  /// The same of its last execution where that failed and would fail again.
  std::vector<std::pair<const void*, vtkMTimeType>> failedStamps;
  /// Of the last execution, where that failed: what the filter's problem port gives in place of the last result's.
  vtkSmartPointer<vtkDataObject> problems;
  double lastAreaShare = 1;
  double lastWholeDiagonal = 0;
  /// Whether the result is spread: each rank has its own part of it, with so many rings of ghost cells.
  bool isSpread = false;
  int ghostLevels = 0;
  /// Results of earlier settings, the last used one at the end, so that going back to them is a look-up. Bounded in
  /// number and bytes: at most an eighth of the machine's memory.
  std::vector<EarlierResult> earlier;

  /// The one with the settings, stamps and shares of `wanted`, which becomes the last used one; null where there is
  /// none.
  const EarlierResult* findEarlier(const EarlierResult& wanted);
  void keepEarlier(EarlierResult result);
  std::size_t bytesOfEarlier() const;

  /// The memory as the filter's own type, made where there is none.
  template <class Memory>
  Memory& memoryAs()
  {
    if (!memory)
    {
      memory = std::make_shared<Memory>();
    }
    return static_cast<Memory&>(*memory);
  }
};

/// One surface of the input on its way through a filter.
struct Block
{
  BlockPath path;
  std::string
    name; ///< for messages: "" for a plain data set, else the names from the root down, with '/' between them
  std::vector<vtkSmartPointer<vtkDataObject>> inputs; ///< by port; null where there is nothing
  std::vector<vtkSmartPointer<vtkDataObject>>
    outputs; ///< by port; empty objects that the filter fills
  BlockState* state = nullptr;
  EarlierResult wanted; ///< what its result depends on, where it is made by itself
  /// Its part of the area of all blocks; 1 where it is the only one.
  double areaShare = 1;
  /// Diagonal of the box round all blocks; 0 where it is the only one.
  double wholeDiagonal = 0;
  /// Its own part of the target, see vtkQuadrilleAlgorithm::ReadOwnTarget; 0 where it has none.
  double ownTarget = 0;

  vtkPolyData* input(int port = 0) const;
  vtkTable* inputTable(int port) const;
  vtkPolyData* output(int port = 0) const;
  vtkTable* outputTable(int port) const;
};

/// A node of composite data; the root has the empty path.
struct BlockNode
{
  std::string
    type; ///< class name of composite data; "" for a data set, and for a leaf that is empty
  std::string name;     ///< "" where it has none
  bool isBlock = false; ///< a data set, or data that is one surface in several partitions
  std::vector<vtkSmartPointer<vtkDataObject>> pieces; ///< of a block
  vtkSmartPointer<vtkFieldData> fieldData;            ///< of composite data on this rank, or null
  vtkSmartPointer<vtkInformation> metaData; ///< what its parent says of it on this rank, or null
};

/// The structure of an input, in the order of a walk from the root down.
using BlockTree = std::map<BlockPath, BlockNode>;

/// Empty leaves have no pieces. Throws InvalidInput for composite data of a kind that is not known.
BlockTree blockTree(vtkDataObject* data);

/// Gives all ranks the nodes of all; pieces stay where they are. Collective.
void mergeTrees(BlockTree& tree, const Ranks& ranks);

/// "Car/Wheel", or "block 1/block 3" where there are no names; "" for the root.
std::string blockName(const BlockTree& tree, const BlockPath& path);

/// Class name of what an output is for an input like this: composite data of the same kind, or "" for a plain data set.
std::string compositeTypeFor(vtkDataObject* input);

/// Empties `output` and gives it the structure of `tree` with these blocks; other leaves stay empty. Field data of
/// composite data and what it says of its children come along. input: what the tree is of.
void writeBlocks(const BlockTree& tree,
  const std::map<BlockPath, vtkSmartPointer<vtkDataObject>>& blocks, vtkDataObject* input,
  vtkDataObject* output);

} // namespace quadrille
