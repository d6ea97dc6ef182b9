// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleAlgorithm.h"

#include "Assembly/JoinParts.h"
#include "Base/DisjointSets.h"
#include "Base/Refuse.h"
#include "Blocks/Blocks.h"
#include "Blocks/Shared.h"
#include "Common/Report.h"
#include "Common/Stamps.h"
#include "Common/VtkVersions.h"
#include "Convert/Pieces.h"
#include "Convert/Surfaces.h"
#include "GridMap/GridMap.h"
#include "Pipeline/Pipeline.h"
#include "Ranks/Ranks.h"
#include "Ranks/Spread.h"
#include "vtkQuadrilleExecutive.h"

#include "vtkBoundingBox.h"
#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkDataObjectTypes.h"
#include "vtkDataSet.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <limits>
#include <new>
#include <set>
#include <sstream>

using Executive = vtkStreamingDemandDrivenPipeline;

namespace
{

/// Letters in a line of ResultText, as many as ParaView's panel shows.
constexpr std::size_t kPanelWidth = 60;

/// Which part of the output is asked for; a serial run asks for piece 0 of 1.
int requestedPiece(vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  return info->Has(Executive::UPDATE_PIECE_NUMBER()) ? info->Get(Executive::UPDATE_PIECE_NUMBER())
                                                     : 0;
}

int requestedGhostLevels(vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  const auto key = Executive::UPDATE_NUMBER_OF_GHOST_LEVELS();
  return info->Has(key) ? std::max(0, info->Get(key)) : 0;
}

int requestedPieces(vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  return info->Has(Executive::UPDATE_NUMBER_OF_PIECES())
    ? info->Get(Executive::UPDATE_NUMBER_OF_PIECES())
    : 1;
}

void initializeOutputs(vtkInformationVector* outputs)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    if (vtkDataObject* output = vtkDataObject::GetData(outputs, port))
    {
      output->Initialize();
    }
  }
}

/// Keeps the executive from adding a dump of the request to the reason that the filter itself has told, then goes.
class IgnoreOnce : public vtkCommand
{
public:
  static IgnoreOnce* New() { return new IgnoreOnce; }
  void Execute(vtkObject* caller, unsigned long, void*) override { caller->RemoveObserver(this); }
};

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

/// A text of several blocks: each line begins with the block's name.
void addLines(std::string& text, const std::string& block, const std::string& lines)
{
  for (const std::string& line : quadrille::splitLines(lines))
  {
    text += (text.empty() ? "" : "\n") + (block.empty() ? "" : block + ": ") + line;
  }
}

std::string joinLines(const std::vector<std::string>& lines)
{
  std::string text;
  for (const std::string& line : lines)
  {
    addLines(text, "", line);
  }
  return text;
}

} // namespace

/// What happens to one block in an execution; the same on all ranks where nothing else is said.
struct vtkQuadrilleAlgorithm::Work
{
  quadrille::Block block; ///< inputs and outputs on the owner only
  std::string key;
  int owner = 0;
  std::size_t group = 0; ///< the first work that this one may have to be executed together with
  std::size_t cells = 0; ///< of all ranks
  bool isChanged = true;
  std::vector<quadrille::Stamp> stamps;             ///< of this rank's pieces
  std::string error;                                ///< why the inputs could not be had
  std::vector<std::string> notices;                 ///< on the inputs
  std::unique_ptr<quadrille::SpreadSurface> spread; ///< where the surface stays spread
  std::exception_ptr failure;                       ///< of what came before the filter's own work
  bool isMade = false;                              ///< by the filter's own work, on the owner
  bool isSpread = false;                            ///< the result is
};

/// One execution: the structure of the input and its blocks.
struct vtkQuadrilleAlgorithm::Run
{
  explicit Run(vtkMultiProcessController* controller) : ranks(controller), stop(controller) {}

  quadrille::Ranks ranks;
  quadrille::SharedStop stop;
  int ghostLevels = 0;                                ///< that the outputs are asked for
  std::vector<quadrille::BlockTree> trees;            ///< by input port, with this rank's pieces
  std::vector<vtkSmartPointer<vtkDataObject>> shared; ///< by input port
  std::vector<std::string> notices;                   ///< on shared inputs
  std::vector<quadrille::Stamp> stamps;               ///< of what all blocks share
  vtkDataObject* input = nullptr;
  std::vector<Work> works;
  bool anew = false; ///< a block is executed

  bool owns(const Work& work) const { return work.owner == ranks.rank(); }
  /// This rank's pieces for a block.
  std::vector<vtkSmartPointer<vtkDataObject>> pieces(const Work& work, int port) const
  {
    const auto node = trees[static_cast<std::size_t>(port)].find(work.block.path);
    return node == trees[static_cast<std::size_t>(port)].end()
      ? std::vector<vtkSmartPointer<vtkDataObject>>{}
      : node->second.pieces;
  }
};

//------------------------------------------------------------------------------
vtkQuadrilleAlgorithm::vtkQuadrilleAlgorithm() = default;
vtkQuadrilleAlgorithm::~vtkQuadrilleAlgorithm() = default;

//------------------------------------------------------------------------------
vtkExecutive* vtkQuadrilleAlgorithm::CreateDefaultExecutive()
{
  return vtkQuadrilleExecutive::New();
}

//------------------------------------------------------------------------------
vtkQuadrilleAlgorithm::PortRole vtkQuadrilleAlgorithm::GetPortRole(int port) const
{
  return port == 0 ? PortRole::Surface : PortRole::Shared;
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::FillInputPortInformation(int port, vtkInformation* info)
{
  // Composite data first: the executive then leaves the walk through its blocks to the filter.
  const PortRole role = this->GetPortRole(port);
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(),
    role == PortRole::Surface ? "vtkDataSet"
      : role == PortRole::Log ? "vtkTable"
                              : "vtkPolyData");
  if (role == PortRole::Shared || role == PortRole::OptionalMesh)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkDataObject"); // RequestDataObject chooses
  return 1;
}

//------------------------------------------------------------------------------
vtkTypeBool vtkQuadrilleAlgorithm::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const vtkTypeBool done = request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT())
    ? this->RequestDataObject(inputs, outputs)
    : this->Superclass::ProcessRequest(request, inputs, outputs);
  if (!done)
  {
    this->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, vtkNew<IgnoreOnce>());
  }
  return done;
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::RequestDataObject(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  std::string composite;
  try
  {
    composite = quadrille::compositeTypeFor(vtkDataObject::GetData(inputs[0]));
  }
  catch (const quadrille::InvalidInput& error)
  {
    return this->ReportFailure(error.what());
  }
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    const std::string type = composite.empty() ? this->GetBlockType(port) : composite;
    vtkInformation* info = outputs->GetInformationObject(port);
    vtkDataObject* output = vtkDataObject::GetData(info);
    if (!output || type != output->GetClassName())
    {
      const auto made = vtk::TakeSmartPointer(vtkDataObjectTypes::NewDataObject(type.c_str()));
      info->Set(vtkDataObject::DATA_OBJECT(), made);
      this->GetOutputPortInformation(port)->Set(
        vtkDataObject::DATA_EXTENT_TYPE(), made->GetExtentType());
    }
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  // Ranks that work together each ask for their own part, all alike, so that filters upstream can work together, too.
  // Else the whole is asked for once.
  const quadrille::Ranks ranks(quadrille::controllerOf(outputs));
  const bool isAlone = !ranks.isParallel() && requestedPiece(outputs) == 0;
  const int piece = ranks.isParallel() ? ranks.rank() : requestedPiece(outputs);
  const int pieces = isAlone ? 1 : requestedPieces(outputs);
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < inputs[port]->GetNumberOfInformationObjects(); ++i)
    {
      vtkInformation* info = inputs[port]->GetInformationObject(i);
      info->Set(Executive::UPDATE_PIECE_NUMBER(), piece);
      info->Set(Executive::UPDATE_NUMBER_OF_PIECES(), pieces);
      info->Set(Executive::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
    }
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->ResetOutcome();
  Run run(quadrille::controllerOf(outputs));
  run.ghostLevels = requestedGhostLevels(outputs);
  if (!run.ranks.isParallel() && requestedPiece(outputs) > 0)
  {
    initializeOutputs(outputs);
    this->States.clear();
    this->Outcome = Succeeded;
    return 1;
  }
  this->IsRoot = run.ranks.isRoot();
  const quadrille::PollScope scope(
    [this](double, const std::string&) { return this->ShowProgressAndGoOn(); });
  try
  {
    return this->RunBlocks(run, inputs, outputs);
  }
  catch (const quadrille::InvalidInput& error)
  {
    this->Outcome = BadInput;
    return this->ReportFailure(error.what());
  }
  catch (const std::exception& error)
  {
    this->Outcome = NoValidResult;
    return this->ReportFailure(std::string("internal error: ") + error.what());
  }
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::RunBlocks(
  Run& run, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  std::string error;
  try
  {
    this->ReadInputs(run, inputs);
  }
  catch (const std::exception& failure)
  {
    error = failure.what();
  }
  auto* executive = vtkQuadrilleExecutive::SafeDownCast(this->GetExecutive());
  if (executive && executive->GetUpstreamFailed())
  {
    error = "a filter that makes the input failed on rank " + std::to_string(run.ranks.rank());
  }
  run.ranks.agree(error);
  this->ListBlocks(run);
  this->ReadOwnTargets(run);
  this->GroupBlocks(run);
  this->TakeStates(run);
  run.anew = std::any_of(
    run.works.begin(), run.works.end(), [](const Work& work) { return work.isChanged; });
  if (run.anew)
  {
    this->GatherInputs(run);
    this->MeasureBlocks(run);
    this->JoinSpread(run);
    this->ShareOut(run);
  }
  std::set<std::size_t> changed; // what is executed together is changed together
  for (const Work& work : run.works)
  {
    if (work.isChanged)
    {
      changed.insert(work.group);
    }
  }
  std::map<std::size_t, std::vector<Work*>> mine; // by group
  for (Work& work : run.works)
  {
    work.isChanged = changed.count(work.group) != 0;
    if (run.owns(work))
    {
      mine[work.group].push_back(&work);
    }
  }
  this->Stop = run.anew ? &run.stop : nullptr;
  double begin = 0;
  for (const auto& [group, works] : mine)
  {
    this->BlockBegin = begin / static_cast<double>(mine.size());
    this->BlockEnd = ++begin / static_cast<double>(mine.size());
    this->RunWorks(works);
  }
  if (run.anew)
  {
    this->WaitForAll(run);
    this->SpreadResults(run);
  }
  this->ExchangeReports(run);
  return this->Conclude(run, outputs);
}

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
        quadrille::addStamps(piece, run.stamps);
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
double vtkQuadrilleAlgorithm::ReadOwnTarget(const std::string&, vtkFieldData*) const
{
  return 0;
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::CheckBlockNames(const std::vector<std::string>&) const {}

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
std::string vtkQuadrilleAlgorithm::GetSettings() const
{
  std::ostringstream text;
  text.precision(17);
  this->AddSettings(text);
  return text.str();
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::AddSettings(std::ostream& os) const
{
  os << "RankIndependent " << this->RankIndependent << '\n';
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

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::GetSpreadMode() const
{
  return static_cast<int>(quadrille::SpreadMode::Never);
}

//------------------------------------------------------------------------------
std::string vtkQuadrilleAlgorithm::ReasonNotToSpread(
  const std::vector<vtkSmartPointer<vtkPolyData>>& /*pieces*/) const
{
  return {};
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::PlanSpread(const quadrille::Block& /*block*/,
  const quadrille::SpreadSize& /*size*/, quadrille::SpreadPlan& /*plan*/) const
{
}

//------------------------------------------------------------------------------
bool vtkQuadrilleAlgorithm::StaysSpread(
  Run& run, Work& work, const std::vector<vtkSmartPointer<vtkDataObject>>& pieces)
{
  const auto mode = static_cast<quadrille::SpreadMode>(this->GetSpreadMode());
  const bool isLarge = run.ranks.size() > 1 && work.cells > quadrille::kSpreadFaces;
  if (mode == quadrille::SpreadMode::Never ||
    (mode == quadrille::SpreadMode::Automatic && !isLarge))
  {
    return false;
  }
  std::vector<vtkSmartPointer<vtkPolyData>> surfaces;
  for (vtkDataObject* piece : pieces)
  {
    surfaces.emplace_back(vtkPolyData::SafeDownCast(piece));
  }
  const bool isTogether = std::count_if(run.works.begin(), run.works.end(),
                            [&](const Work& other) { return other.group == work.group; }) > 1;
  std::string reason = isTogether ? "it may be made together with blocks that it meets" : "";
  for (const std::string& text : run.ranks.gather(this->ReasonNotToSpread(surfaces)))
  {
    reason = reason.empty() ? text : reason;
  }
  if (reason.empty())
  {
    work.spread = std::make_unique<quadrille::SpreadSurface>(run.ranks, work.owner, surfaces);
    if (work.spread->size().cells == 0)
    {
      work.spread.reset(); // the filter says what is missing
    }
    return work.spread != nullptr;
  }
  if (mode == quadrille::SpreadMode::Always)
  {
    work.error = "the surface cannot stay spread over the ranks: " + reason +
      "; set Spread Surfaces to Never, which brings all of it to one rank";
  }
  else
  {
    work.notices.push_back("the surface was brought to one rank and not left spread, as " + reason);
  }
  return false;
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::JoinSpread(Run& run)
{
  for (Work& work : run.works)
  {
    if (!work.spread)
    {
      continue;
    }
    try
    {
      quadrille::SpreadPlan plan;
      this->PlanSpread(work.block, work.spread->size(), plan);
      plan.piece.threads = this->NumberOfThreads;
      plan.piece.progress = this->MakeProgress(0, 0.02);
      work.block.inputs[0] = work.spread->join(plan, work.notices);
    }
    catch (const quadrille::Cancelled&)
    {
      // Whether time was over on any rank: it may not yet be so on the one that tells it.
      for (const std::string& isOver : run.ranks.gather(this->TimeIsOver ? "1" : ""))
      {
        this->TimeIsOver = this->TimeIsOver || !isOver.empty();
      }
      work.failure = std::current_exception();
    }
    catch (const std::exception&)
    {
      work.failure = std::current_exception(); // on all ranks alike
    }
    if (work.failure)
    {
      work.spread.reset();
    }
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::WaitForAll(Run& run)
{
  // Observers of progress may ask to stop on a rank that waits, too.
  auto last = std::chrono::steady_clock::now();
  run.stop.join(
    [&]
    {
      const auto now = std::chrono::steady_clock::now();
      if (now - last > quadrille::PollScope::kInterval)
      {
        last = now;
        this->UpdateProgress(this->FarthestProgress);
      }
      return !quadrille::isAskedToStop(this);
    });
  this->Stop = nullptr;
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::SpreadResults(Run& run)
{
  for (Work& work : run.works)
  {
    if (!work.spread)
    {
      continue;
    }
    const char made = work.isMade ? (work.block.state->report.isSoFar ? 's' : 'm') : '-';
    const std::string told =
      run.ranks.gather(std::string(1, made))[static_cast<std::size_t>(work.owner)];
    if (told == "-")
    {
      continue;
    }
    // What is left to do after a stop that has kept something must not be stopped.
    this->IsBlockSoFar = told == "s";
    try
    {
      this->SpreadResult(run, work);
    }
    catch (const std::exception&)
    {
      if (run.owns(work))
      {
        this->FailBlockBy(*work.block.state, std::current_exception());
      }
    }
    this->IsBlockSoFar = false;
    work.spread.reset();
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::SpreadResult(Run& run, Work& work)
{
  std::vector<vtkSmartPointer<vtkDataObject>>& outputs = work.block.outputs;
  if (!run.owns(work))
  {
    outputs.clear();
    for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
    {
      outputs.push_back(
        vtk::TakeSmartPointer(vtkDataObjectTypes::NewDataObject(this->GetBlockType(port))));
    }
  }
  std::vector<vtkPolyData*> others;
  for (std::size_t port = 1; port < outputs.size(); ++port)
  {
    if (auto* data = vtkPolyData::SafeDownCast(outputs[port]))
    {
      others.push_back(data);
    }
  }
  const vtkSmartPointer<vtkPolyData> quads =
    work.spread->spread(vtkPolyData::SafeDownCast(outputs[0]), others, run.ghostLevels);
  const std::vector<quadrille::SpreadFigures> figures = work.spread->figures();
  quadrille::addSpreadFigures(quads, figures);
  outputs[0] = quads;
  quadrille::BlockState& state = *work.block.state;
  state.lastResult = outputs;
  state.isSpread = true;
  work.isSpread = true;
  state.ghostLevels = run.ghostLevels;
  if (run.owns(work))
  {
    state.report.stageTimes += "\n" + quadrille::spreadText(figures);
  }
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

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::ShareOut(Run& run)
{
  for (std::size_t port = 0; port < run.shared.size(); ++port)
  {
    auto* shared = vtkPolyData::SafeDownCast(run.shared[port]);
    if (!shared)
    {
      continue;
    }
    if (run.works.size() == 1)
    {
      run.works[0].block.inputs[port] = shared;
      continue;
    }
    const std::size_t items = quadrille::sharedItems(shared);
    quadrille::Packer packer;
    for (const Work& work : run.works)
    {
      packer.count(run.owns(work));
      if (run.owns(work))
      {
        for (const double distance : quadrille::itemDistances(shared, work.block.input()))
        {
          packer.number(distance);
        }
      }
    }
    // Of several surfaces at the same distance the first one.
    std::vector<double> least(items, std::numeric_limits<double>::infinity());
    std::vector<std::size_t> nearest(items, 0);
    const std::vector<std::string> all = run.ranks.gather(packer.bytes());
    std::vector<quadrille::Unpacker> unpackers(all.begin(), all.end());
    for (std::size_t w = 0; w < run.works.size(); ++w)
    {
      run.works[w].isChanged = true; // it may have got what another one had
      for (quadrille::Unpacker& unpacker : unpackers)
      {
        const bool isThere = unpacker.count() != 0;
        for (std::size_t i = 0; isThere && i < items; ++i)
        {
          const double distance = unpacker.number();
          if (distance < least[i])
          {
            least[i] = distance;
            nearest[i] = w;
          }
        }
      }
    }
    for (std::size_t w = 0; w < run.works.size(); ++w)
    {
      std::vector<bool> isChosen(items, false);
      for (std::size_t i = 0; i < items; ++i)
      {
        isChosen[i] = nearest[i] == w;
      }
      if (run.owns(run.works[w]))
      {
        run.works[w].block.inputs[port] = quadrille::selectItems(shared, isChosen);
      }
    }
  }
}

//------------------------------------------------------------------------------
std::vector<vtkQuadrilleAlgorithm::Together> vtkQuadrilleAlgorithm::FindTogether(
  const std::vector<quadrille::Block*>& blocks)
{
  std::vector<Together> all;
  for (std::size_t i = 0; i < blocks.size(); ++i)
  {
    all.push_back({ { i }, {} });
  }
  return all;
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::ExecuteTogether(const std::vector<quadrille::Block*>& blocks)
{
  for (quadrille::Block* block : blocks)
  {
    this->Execute(*block);
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
  const double margin = whole.IsValid() ? quadrille::kSamePlace * whole.GetDiagonalLength() : 0;
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
void vtkQuadrilleAlgorithm::RunWorks(const std::vector<Work*>& works)
{
  const auto all = [&works](const auto& holds)
  { return std::all_of(works.begin(), works.end(), holds); };
  if (all([](const Work* work) { return !work->isChanged; }))
  {
    for (Work* work : works)
    {
      if (work->block.state->report.outcome == Succeeded)
      {
        work->block.state->report.reusedStages = { "all" };
      }
    }
    return;
  }
  if (all([this](Work* work) { return this->TakeEarlier(*work, false); }))
  {
    all([this](Work* work) { return this->TakeEarlier(*work, true); });
    return;
  }
  std::vector<Work*> whole;
  for (Work* work : works)
  {
    work->block.state->report = {};
    work->block.state->report.notices = work->notices;
    // What cannot be had, and what has no faces, is not executed together with others.
    vtkPolyData* surface =
      this->GetPortRole(0) == PortRole::Surface ? work->block.input() : nullptr;
    if (work->error.empty() && !work->failure && surface &&
      surface->GetNumberOfPolys() + surface->GetNumberOfStrips() > 0)
    {
      whole.push_back(work);
    }
    else
    {
      this->RunTogether({ work }, {});
    }
  }
  std::vector<quadrille::Block*> blocks;
  for (Work* work : whole)
  {
    blocks.push_back(&work->block);
  }
  const double begin = this->BlockBegin, end = this->BlockEnd;
  double done = 0;
  for (const Together& together : this->FindTogether(blocks))
  {
    std::vector<Work*> members;
    for (const std::size_t i : together.blocks)
    {
      members.push_back(whole[i]);
    }
    const auto count = static_cast<double>(whole.size());
    this->BlockBegin = begin + (end - begin) * done / count;
    done += static_cast<double>(members.size());
    this->BlockEnd = begin + (end - begin) * done / count;
    this->RunTogether(members, together.notices);
  }
}

//------------------------------------------------------------------------------
bool vtkQuadrilleAlgorithm::TakeEarlier(Work& work, bool andUse)
{
  if (!this->KeepsResult() || !work.error.empty() || work.failure || work.spread)
  {
    return false;
  }
  quadrille::BlockState& state = *work.block.state;
  const quadrille::EarlierResult* earlier = state.findEarlier(this->ResultFor(work));
  if (!earlier || !this->AllowsEarlier(earlier->report))
  {
    return false;
  }
  if (andUse)
  {
    state.lastResult = earlier->result;
    state.isSpread = false;
    state.report = earlier->report;
    state.report.reusedStages = { "all" };
  }
  return true;
}

//------------------------------------------------------------------------------
quadrille::EarlierResult vtkQuadrilleAlgorithm::ResultFor(const Work& work) const
{
  return { this->GetSettings(), { work.stamps.begin() + 1, work.stamps.end() },
    work.block.areaShare, work.block.wholeDiagonal, {}, {} }; // the first stamp is the filter's
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::RunTogether(
  const std::vector<Work*>& works, const std::vector<std::string>& notices)
{
  Work& first = *works.front();
  this->Report = &first.block.state->report;
  this->IsBlockSoFar = false;
  try
  {
    if (!first.error.empty())
    {
      throw quadrille::InvalidInput(first.error);
    }
    if (first.failure)
    {
      std::rethrow_exception(first.failure);
    }
    for (const std::string& notice : notices)
    {
      this->AddNotice(notice);
    }
    std::vector<quadrille::Block*> blocks;
    for (Work* work : works)
    {
      this->PrepareOutputs(work->block);
      blocks.push_back(&work->block);
    }
    works.size() == 1 ? this->ExecuteBlock(first.block) : this->ExecuteTogether(blocks);
    for (Work* work : works)
    {
      this->ConcludeBlock(*work);
    }
  }
  catch (const std::exception&)
  {
    this->FailBlockBy(*first.block.state, std::current_exception());
    const quadrille::BlockReport& report = first.block.state->report;
    for (Work* work : works)
    {
      if (work != &first && (report.outcome == Aborted || report.outcome == TimedOut))
      {
        this->FailBlockAsStopped(*work->block.state);
      }
      else if (work != &first)
      {
        this->FailBlock(*work->block.state, static_cast<OutcomeType>(report.outcome),
          "is made together with '" + first.block.name + "', which failed");
        work->block.state->report.mayPass = report.mayPass;
      }
    }
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::FailBlockBy(
  quadrille::BlockState& state, const std::exception_ptr& failure)
{
  try
  {
    std::rethrow_exception(failure);
  }
  catch (const quadrille::InvalidInput& error)
  {
    this->FailBlock(state, BadInput, error.what());
  }
  catch (const quadrille::Cancelled&)
  {
    this->FailBlockAsStopped(state);
  }
  catch (const quadrille::StageFailure& error)
  {
    if (error.code == quadrille::StatusCode::Cancelled)
    {
      this->FailBlockAsStopped(state);
      return;
    }
    const bool tooLarge = error.code == quadrille::StatusCode::TooLarge;
    this->FailBlock(state, tooLarge ? TooLarge : NoValidResult, error.what());
  }
  catch (const quadrille::OutOfMemory& error)
  {
    this->FailBlock(state, NoValidResult, error.what());
    state.report.mayPass = true;
  }
  catch (const std::bad_alloc&)
  {
    this->FailBlock(state, NoValidResult, "out of memory; ask for fewer quads or free memory");
    state.report.mayPass = true;
  }
  catch (const std::exception& error)
  {
    this->FailBlock(state, NoValidResult, std::string("internal error: ") + error.what());
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::PrepareOutputs(quadrille::Block& block)
{
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    block.outputs.push_back(
      vtk::TakeSmartPointer(vtkDataObjectTypes::NewDataObject(this->GetBlockType(port))));
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::ExecuteBlock(quadrille::Block& block)
{
  // Composite data may have blocks of points and lines, and grids that finer ones replace: no error, but told.
  vtkPolyData* surface =
    this->GetPortRole(0) == PortRole::Surface && !block.path.empty() ? block.input() : nullptr;
  if (surface && surface->GetNumberOfPolys() + surface->GetNumberOfStrips() == 0)
  {
    this->AddNotice("has no faces and is left empty");
  }
  else
  {
    this->Execute(block);
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::ConcludeBlock(Work& work)
{
  quadrille::BlockState& state = *work.block.state;
  state.report.outcome = Succeeded;
  work.isMade = true;
  if (!work.spread)
  {
    state.lastResult = work.block.outputs;
    state.isSpread = false;
  }
  if (this->IsBlockSoFar)
  {
    state.report.isSoFar = true;
    state.report.outcome = this->TimeIsOver ? TimedOut : Aborted;
    state.report.outcomeText = this->StopText() + "; these are the best quads so far";
  }
  else if (this->KeepsResult() && !work.spread)
  {
    quadrille::EarlierResult made = this->ResultFor(work);
    made.report = state.report;
    made.result = state.lastResult;
    state.keepEarlier(std::move(made));
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::FailBlock(
  quadrille::BlockState& state, OutcomeType outcome, const std::string& text)
{
  state.report.outcome = outcome;
  state.report.outcomeText = text;
  const bool hasResult = !state.lastResult.empty();
  if (hasResult || outcome == Aborted)
  {
    state.report.outcomeText +=
      hasResult ? "; the previous result is kept" : "; there is no result";
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::FailBlockAsStopped(quadrille::BlockState& state)
{
  this->IsBlockSoFar = false; // what comes after the stop has been stopped, too
  this->FailBlock(state, this->TimeIsOver ? TimedOut : Aborted, this->StopText());
}

//------------------------------------------------------------------------------
std::string vtkQuadrilleAlgorithm::StopText() const
{
  if (!this->TimeIsOver)
  {
    return "stopped on request";
  }
  std::ostringstream text;
  text << "stopped after the time limit of " << this->TimeLimit << " s";
  return text.str();
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::ExchangeReports(Run& run)
{
  quadrille::Packer packer;
  for (const Work& work : run.works)
  {
    packer.count(run.owns(work));
    if (run.owns(work))
    {
      work.block.state->report.pack(packer);
    }
  }
  for (const std::string& bytes : run.ranks.gather(packer.bytes()))
  {
    quadrille::Unpacker unpacker(bytes);
    for (Work& work : run.works)
    {
      if (unpacker.count() != 0)
      {
        work.block.state->report = quadrille::BlockReport::unpack(unpacker);
      }
    }
  }
  for (Work& work : run.works)
  {
    quadrille::BlockState& state = *work.block.state;
    const bool hasSucceeded = state.report.outcome == Succeeded;
    const bool isMade = work.isChanged && (hasSucceeded || state.report.isSoFar);
    if (isMade && state.isSpread && !work.isSpread)
    {
      // The result is in one place again, with the owner; the others let their parts go.
      state.isSpread = false;
      state.lastResult.clear();
    }
    const bool failsAgain =
      !hasSucceeded && state.report.outcome != Aborted && !state.report.mayPass;
    state.lastStamps = hasSucceeded ? work.stamps : std::vector<quadrille::Stamp>{};
    state.failedStamps = failsAgain ? work.stamps : std::vector<quadrille::Stamp>{};
    if (work.isChanged)
    {
      state.lastAreaShare = work.block.areaShare;
      state.lastWholeDiagonal = work.block.wholeDiagonal;
    }
  }
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::Conclude(const Run& run, vtkInformationVector* outputs)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    std::map<quadrille::BlockPath, vtkSmartPointer<vtkDataObject>> results;
    for (const Work& work : run.works)
    {
      if (!run.owns(work) && !work.block.state->isSpread)
      {
        continue;
      }
      // A copy, so that what is done to an output later does not change the result that is kept.
      auto& result = results[work.block.path];
      result = vtk::TakeSmartPointer(vtkDataObjectTypes::NewDataObject(this->GetBlockType(port)));
      if (!work.block.state->lastResult.empty())
      {
        result->ShallowCopy(work.block.state->lastResult[static_cast<std::size_t>(port)]);
      }
    }
    quadrille::writeBlocks(run.trees[0], results, run.input, vtkDataObject::GetData(outputs, port));
  }
  std::vector<std::pair<std::string, quadrille::BlockReport>> reports;
  for (const Work& work : run.works)
  {
    reports.emplace_back(run.works.size() > 1 ? work.block.name : "", work.block.state->report);
  }
  this->SetReports(reports);
  if (this->Outcome == Aborted)
  {
    // No error: it is what the user asked for. Returning 0 leaves the filter out of date.
    // The flags have done their duty; left standing they would make the executive empty the outputs.
    quadrille::forgetStop(this);
    if (this->IsRoot)
    {
      vtkWarningMacro(<< this->OutcomeText);
    }
    return 0;
  }
  if (run.ranks.size() > 1 && quadrille::isAskedToStop(this))
  {
    quadrille::forgetStop(this); // it came when all was done, and on this rank only
  }
  this->UpdateProgress(1.0);
  if (this->Outcome == Succeeded)
  {
    return 1;
  }
  const auto hasResult = [](const quadrille::BlockReport& report)
  { return report.outcome == Succeeded || report.isSoFar; };
  if (run.anew && std::all_of(this->Reports.begin(), this->Reports.end(), hasResult))
  {
    if (this->IsRoot)
    {
      vtkWarningMacro(<< this->OutcomeText);
    }
  }
  else if (run.anew)
  {
    this->ReportFailure(this->OutcomeText);
  }
  // The results of the other blocks are valid and have to be seen.
  return std::any_of(this->Reports.begin(), this->Reports.end(), hasResult);
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::ReportFailure(const std::string& text)
{
  this->OutcomeText = text;
  if (this->ResultText.empty())
  {
    this->ResultText = quadrille::wrapLines("Failed: " + text, kPanelWidth);
  }
  if (this->IsRoot)
  {
    vtkErrorMacro(<< text);
  }
  return 0;
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::SetReports(
  const std::vector<std::pair<std::string, quadrille::BlockReport>>& reports)
{
  this->Outcome = Succeeded;
  for (const auto& [name, report] : reports)
  {
    // A stop on request weighs most, as the filter is then left out of date; else the first failure counts.
    if (this->Outcome == Succeeded || report.outcome == Aborted)
    {
      this->Outcome = report.outcome;
    }
    addLines(this->OutcomeText, name, report.outcomeText);
    addLines(this->StageTimesText, name, report.stageTimes);
    addLines(this->CertificateText, name, report.certificate);
    addLines(this->NoticesText, name, joinLines(report.notices));
    const std::string made = report.result.empty() ? "Done" : report.result;
    addLines(this->ResultText, name,
      report.isSoFar                  ? made + "; " + report.outcomeText
        : report.outcome == Succeeded ? made
                                      : "Failed: " + report.outcomeText);
    this->IsSoFar = this->IsSoFar || report.isSoFar;
    for (const std::string& notice : report.notices)
    {
      addLines(this->ResultText, name, "Note: " + notice);
    }
    addLines(this->ReusedText, name, joinLines(report.reusedStages));
    this->Reports.push_back(report);
  }
  this->ResultText = quadrille::wrapLines(this->ResultText, kPanelWidth);
}

//------------------------------------------------------------------------------
std::function<bool(double, const std::string&)> vtkQuadrilleAlgorithm::MakeProgress(
  double begin, double end)
{
  return [this, begin, end](double fraction, const std::string& text)
  {
    // A stage that is tried again starts from its beginning; the bar must not run backwards.
    const double ofBlock = begin + (end - begin) * std::clamp(fraction, 0.0, 1.0);
    const double progress = this->BlockBegin + (this->BlockEnd - this->BlockBegin) * ofBlock;
    this->FarthestProgress = std::max(this->FarthestProgress, progress);
    this->SetProgressText(text.c_str());
    return this->ShowProgressAndGoOn();
  };
}

//------------------------------------------------------------------------------
bool vtkQuadrilleAlgorithm::ShowProgressAndGoOn()
{
  this->UpdateProgress(this->FarthestProgress);
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - this->Started;
  // What is left to do after a stop that has kept something must not make another kind of stop of it.
  if (!this->IsBlockSoFar)
  {
    this->TimeIsOver = this->TimeLimit > 0 && spent.count() > this->TimeLimit;
  }
  bool isAsked = quadrille::isAskedToStop(this);
  if (this->Stop && isAsked)
  {
    this->Stop->tell();
  }
  isAsked = isAsked || (this->Stop && this->Stop->isTold());
  return this->IsBlockSoFar || (!this->TimeIsOver && !isAsked);
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::SetStageRecords(const std::vector<quadrille::StageRecord>& stages)
{
  this->Report->stageTimes = quadrille::stageTimesText(stages);
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::SetCertificate(const quadrille::Certificate& certificate)
{
  this->Report->certificate = certificate.text();
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::AddNotice(const std::string& text)
{
  this->Report->notices.push_back(text);
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::SayOf(quadrille::Block& block)
{
  this->Report = &block.state->report;
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::AddWarning(const std::string& text)
{
  this->AddNotice(text);
  vtkWarningMacro(<< text);
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::SetResult(const std::string& text)
{
  this->Report->result = text;
}

//------------------------------------------------------------------------------
const std::vector<std::string>& vtkQuadrilleAlgorithm::GetBlockNotices() const
{
  return this->Report->notices;
}

//------------------------------------------------------------------------------
double vtkQuadrilleAlgorithm::SumOverBlocks(const char* number) const
{
  double sum = 0;
  for (const quadrille::BlockReport& report : this->Reports)
  {
    const auto value = report.numbers.find(number);
    sum += value == report.numbers.end() ? 0 : value->second;
  }
  return sum;
}

//------------------------------------------------------------------------------
double vtkQuadrilleAlgorithm::LeastOverBlocks(const char* number) const
{
  double least = 0;
  for (const quadrille::BlockReport& report : this->Reports)
  {
    const auto value = report.numbers.find(number);
    if (value != report.numbers.end() && value->second > 0)
    {
      least = least > 0 ? std::min(least, value->second) : value->second;
    }
  }
  return least;
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::VisitStates(
  const std::function<void(quadrille::BlockState&)>& visit) const
{
  for (const auto& [key, state] : this->States)
  {
    visit(*state);
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::ResetOutcome()
{
  this->Outcome = NotRun;
  this->TimeIsOver = false;
  this->IsSoFar = false;
  this->IsBlockSoFar = false;
  this->FarthestProgress = 0;
  this->Started = std::chrono::steady_clock::now();
  this->Reports.clear();
  this->OutcomeText.clear();
  this->StageTimesText.clear();
  this->CertificateText.clear();
  this->NoticesText.clear();
  this->ResultText.clear();
  this->ReusedText.clear();
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "TimeLimit: " << this->TimeLimit << "\n";
  os << indent << "RankIndependent: " << this->RankIndependent << "\n";
  os << indent << "Outcome: " << this->Outcome << "\n";
  os << indent << "OutcomeText: " << this->OutcomeText << "\n";
  os << indent << "StageTimesText: " << this->StageTimesText << "\n";
  os << indent << "CertificateText: " << this->CertificateText << "\n";
  os << indent << "NoticesText: " << this->NoticesText << "\n";
  os << indent << "ResultText: " << this->ResultText << "\n";
}
