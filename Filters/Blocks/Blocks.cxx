// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Blocks/Blocks.h"

#include "Pipeline/ResultStore.h"

#include "Base/Refuse.h"
#include "Common/VtkVersions.h"
#include "Ranks/Ranks.h"

#include <vtkDataAssembly.h>
#include <vtkDataObject.h>
#include <vtkDataObjectTypes.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSet.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPolyData.h>
#include <vtkTable.h>
#include <vtkUniformGrid.h>
#include <vtkUniformGridAMR.h>

namespace quadrille
{

namespace
{

template <class Data>
Data* at(const std::vector<vtkSmartPointer<vtkDataObject>>& data, int port)
{
  return Data::SafeDownCast(data.at(static_cast<std::size_t>(port)));
}

BlockPath childOf(const BlockPath& path, unsigned index)
{
  BlockPath child = path;
  child.push_back(index);
  return child;
}

template <class Composite>
vtkInformation* metaDataOf(Composite* data, unsigned index)
{
  return data->HasMetaData(index) ? data->GetMetaData(index) : nullptr;
}

std::string nameIn(vtkInformation* metaData)
{
  const char* name = metaData && metaData->Has(vtkCompositeDataSet::NAME())
    ? metaData->Get(vtkCompositeDataSet::NAME())
    : nullptr;
  return name ? name : "";
}

void addNodes(BlockTree& tree, const BlockPath& path, const std::string& name, vtkDataObject* data);

/// A child with what its parent says of it.
void addChild(BlockTree& tree, const BlockPath& path, vtkInformation* metaData, vtkDataObject* data)
{
  addNodes(tree, path, nameIn(metaData), data);
  tree[path].metaData = metaData;
}

/// A multiblock for each level of an adaptive mesh, as quads are no grids.
void addLevels(BlockTree& tree, const BlockPath& path, vtkUniformGridAMR* data)
{
  for (unsigned level = 0; level < data->GetNumberOfLevels(); ++level)
  {
    const BlockPath levelPath = childOf(path, level);
    tree[levelPath].type = "vtkMultiBlockDataSet";
    tree[levelPath].name = "Level " + std::to_string(level);
    for (unsigned i = 0; i < gridCount(data, level); ++i)
    {
      addNodes(tree, childOf(levelPath, i), "Grid " + std::to_string(i), gridOf(data, level, i));
    }
  }
}

void addNodes(BlockTree& tree, const BlockPath& path, const std::string& name, vtkDataObject* data)
{
  BlockNode& node = tree[path];
  node.name = name;
  if (!data)
  {
    return;
  }
  node.type = compositeTypeFor(data);
  node.isBlock = node.type.empty() || data->IsA("vtkPartitionedDataSet");
  node.fieldData = node.type.empty() ? nullptr : data->GetFieldData();
  if (auto* levels = vtkUniformGridAMR::SafeDownCast(data)) // by VTK 9.6 on a collection, too
  {
    addLevels(tree, path, levels);
  }
  else if (auto* partitions = vtkPartitionedDataSet::SafeDownCast(data))
  {
    for (unsigned i = 0; i < partitions->GetNumberOfPartitions(); ++i)
    {
      if (vtkDataObject* piece = partitions->GetPartitionAsDataObject(i))
      {
        node.pieces.emplace_back(piece);
      }
    }
  }
  else if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(data))
  {
    for (unsigned i = 0; i < blocks->GetNumberOfBlocks(); ++i)
    {
      addChild(tree, childOf(path, i), metaDataOf(blocks, i), blocks->GetBlock(i));
    }
  }
  else if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(data))
  {
    for (unsigned i = 0; i < collection->GetNumberOfPartitionedDataSets(); ++i)
    {
      addChild(
        tree, childOf(path, i), metaDataOf(collection, i), collection->GetPartitionedDataSet(i));
    }
  }
  else
  {
    node.pieces.emplace_back(data);
  }
}

/// What is told of a node, with its name, which another rank may have told.
void setMetaData(vtkInformation* metaData, const BlockNode& node)
{
  if (node.metaData)
  {
    metaData->Append(node.metaData);
  }
  if (!node.name.empty())
  {
    metaData->Set(vtkCompositeDataSet::NAME(), node.name.c_str());
  }
}

void setChild(vtkDataObject* parent, unsigned index, vtkDataObject* child, const BlockNode& node)
{
  if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(parent))
  {
    blocks->SetBlock(index, child);
    setMetaData(blocks->GetMetaData(index), node);
  }
  else if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(parent))
  {
    collection->SetPartitionedDataSet(index, vtkPartitionedDataSet::SafeDownCast(child));
    setMetaData(collection->GetMetaData(index), node);
  }
}

/// The object of a node: composite data that its children are put into, or the block itself.
vtkSmartPointer<vtkDataObject> nodeObject(
  const BlockNode& node, const vtkSmartPointer<vtkDataObject>& block)
{
  if (node.type.empty())
  {
    return block;
  }
  const auto object = vtk::TakeSmartPointer(vtkDataObjectTypes::NewDataObject(node.type.c_str()));
  if (node.isBlock && block)
  {
    vtkPartitionedDataSet::SafeDownCast(object)->SetPartition(0, block);
  }
  if (node.fieldData)
  {
    object->GetFieldData()->PassData(node.fieldData);
  }
  return object;
}

} // namespace

vtkPolyData* Block::input(int port) const
{
  return at<vtkPolyData>(inputs, port);
}

vtkTable* Block::inputTable(int port) const
{
  return at<vtkTable>(inputs, port);
}

vtkPolyData* Block::output(int port) const
{
  return at<vtkPolyData>(outputs, port);
}

vtkTable* Block::outputTable(int port) const
{
  return at<vtkTable>(outputs, port);
}

BlockTree blockTree(vtkDataObject* data)
{
  BlockTree tree;
  addNodes(tree, {}, "", data);
  return tree;
}

void BlockReport::pack(Packer& packer) const
{
  const auto packLines = [&packer](const std::vector<std::string>& lines)
  {
    packer.count(lines.size());
    for (const std::string& line : lines)
    {
      packer.text(line);
    }
  };
  packer.count(static_cast<std::uint64_t>(outcome));
  packer.text(outcomeText);
  packer.count(mayPass);
  packer.count(isSoFar);
  packer.count(hasDefect);
  packer.count(showsFailure);
  packer.text(result);
  packer.text(stageTimes);
  packer.text(certificate);
  packLines(notices);
  packLines(reusedStages);
  packer.count(numbers.size());
  for (const auto& [name, value] : numbers)
  {
    packer.text(name);
    packer.number(value);
  }
}

BlockReport BlockReport::unpack(Unpacker& unpacker)
{
  BlockReport report;
  report.outcome = static_cast<int>(unpacker.count());
  report.outcomeText = unpacker.text();
  report.mayPass = unpacker.count() != 0;
  report.isSoFar = unpacker.count() != 0;
  report.hasDefect = unpacker.count() != 0;
  report.showsFailure = unpacker.count() != 0;
  report.result = unpacker.text();
  report.stageTimes = unpacker.text();
  report.certificate = unpacker.text();
  for (std::vector<std::string>* lines : { &report.notices, &report.reusedStages })
  {
    lines->resize(unpacker.count());
    for (std::string& line : *lines)
    {
      line = unpacker.text();
    }
  }
  for (std::uint64_t left = unpacker.count(); left > 0; --left)
  {
    const std::string name = unpacker.text();
    report.numbers[name] = unpacker.number();
  }
  return report;
}

void mergeTrees(BlockTree& tree, const Ranks& ranks)
{
  Packer packer;
  packer.count(tree.size());
  for (const auto& [path, node] : tree)
  {
    packer.count(path.size());
    for (const unsigned index : path)
    {
      packer.count(index);
    }
    packer.text(node.type);
    packer.text(node.name);
    packer.count(node.isBlock);
  }
  for (const std::string& bytes : ranks.gather(packer.bytes()))
  {
    Unpacker unpacker(bytes);
    for (std::uint64_t left = unpacker.count(); left > 0; --left)
    {
      BlockPath path(unpacker.count());
      for (unsigned& index : path)
      {
        index = static_cast<unsigned>(unpacker.count());
      }
      BlockNode& node = tree[path];
      const std::string type = unpacker.text();
      const std::string name = unpacker.text();
      node.type = node.type.empty() ? type : node.type;
      node.name = node.name.empty() ? name : node.name;
      node.isBlock = unpacker.count() != 0 || node.isBlock;
    }
  }
}

std::string blockName(const BlockTree& tree, const BlockPath& path)
{
  std::string text;
  for (std::size_t depth = 1; depth <= path.size(); ++depth)
  {
    const auto end = path.begin() + static_cast<std::ptrdiff_t>(depth);
    const auto node = tree.find(BlockPath(path.begin(), end));
    const bool hasName = node != tree.end() && !node->second.name.empty();
    text += (text.empty() ? "" : "/") +
      (hasName ? node->second.name : "block " + std::to_string(path[depth - 1]));
  }
  return text;
}

std::string compositeTypeFor(vtkDataObject* input)
{
  if (!input || !input->IsA("vtkCompositeDataSet"))
  {
    return "";
  }
  if (input->IsA("vtkUniformGridAMR")) // first, as by VTK 9.6 on it is a collection, too
  {
    return "vtkMultiBlockDataSet";
  }
  // Kinds of multiblock and partitioned data have classes of their own, which quads can be in.
  for (const char* type : { "vtkMultiPieceDataSet", "vtkPartitionedDataSet",
         "vtkPartitionedDataSetCollection", "vtkMultiBlockDataSet" })
  {
    if (input->IsA(type))
    {
      return type;
    }
  }
  refuse("the input is a ", input->GetClassName(), ", which is not supported");
}

void writeBlocks(const BlockTree& tree,
  const std::map<BlockPath, vtkSmartPointer<vtkDataObject>>& blocks, vtkDataObject* input,
  vtkDataObject* output)
{
  output->Initialize();
  std::map<BlockPath, vtkSmartPointer<vtkDataObject>> made;
  for (const auto& [path, node] : tree)
  {
    const auto block = blocks.find(path);
    const vtkSmartPointer<vtkDataObject> object =
      nodeObject(node, block == blocks.end() ? nullptr : block->second);
    if (!path.empty())
    {
      const BlockPath parent(path.begin(), path.end() - 1);
      setChild(made[parent], path.back(), object, node);
    }
    else if (object)
    {
      output->ShallowCopy(object);
    }
    made[path] =
      path.empty() && !node.type.empty() ? vtkSmartPointer<vtkDataObject>(output) : object;
  }
  auto* source = vtkPartitionedDataSetCollection::SafeDownCast(input);
  auto* target = vtkPartitionedDataSetCollection::SafeDownCast(output);
  if (source && target && source->GetDataAssembly())
  {
    vtkNew<vtkDataAssembly> assembly;
    assembly->DeepCopy(source->GetDataAssembly());
    target->SetDataAssembly(assembly);
  }
}

std::size_t EarlierResult::bytes() const
{
  std::size_t kibibytes = 0;
  for (vtkDataObject* data : result)
  {
    kibibytes += data ? data->GetActualMemorySize() : 0;
  }
  return 1024 * kibibytes;
}

const EarlierResult* BlockState::findEarlier(const EarlierResult& wanted)
{
  const auto found = std::find_if(
    earlier.begin(), earlier.end(), [&](const EarlierResult& r) { return r.isFor(wanted); });
  if (found == earlier.end())
  {
    return nullptr;
  }
  std::rotate(found, found + 1, earlier.end());
  return &earlier.back();
}

void BlockState::keepEarlier(EarlierResult result)
{
  constexpr std::size_t most = 32;
  constexpr std::size_t shareOfMachine = 8;
  earlier.erase(std::remove_if(earlier.begin(), earlier.end(),
                  [&](const EarlierResult& r) { return r.isFor(result); }),
    earlier.end());
  earlier.push_back(std::move(result));
  const std::size_t bound = ResultStore::bytesOfMachine() / shareOfMachine;
  while (earlier.size() > most || (earlier.size() > 1 && this->bytesOfEarlier() > bound))
  {
    earlier.erase(earlier.begin());
  }
}

std::size_t BlockState::bytesOfEarlier() const
{
  std::size_t bytes = 0;
  for (const EarlierResult& result : earlier)
  {
    bytes += result.bytes();
  }
  return bytes;
}

} // namespace quadrille
