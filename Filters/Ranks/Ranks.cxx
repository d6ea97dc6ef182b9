// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/Ranks.h"

#include "Base/Error.h"
#include "Common/Report.h"

#include <vtkCharArray.h>
#include <vtkCommunicator.h>
#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#ifdef QUADRILLE_HAS_MPI
#include <vtkMPIController.h>
#endif

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <new>
#include <stdexcept>
#include <thread>
#include <utility>

namespace quadrille
{

namespace
{

/// Of our messages.
enum MessageTag : int
{
  kTag = 46120,
  kStopTag, ///< asks the others to stop
  kDoneTag, ///< says that a rank has come to the end of its own work
  kGoTag    ///< says that all have
};

/// Between two looks for messages: far below what a user notices, far above what a look costs.
constexpr std::chrono::milliseconds kLook{ 2 };

/// What a step has thrown, as something that can be sent. 0: nothing.
enum FailureKind : std::uint64_t
{
  kNone = 0,
  kCancelled,
  kInvalidInput,
  kStageFailure,
  kNoMemory,
  kOther
};

struct Failure
{
  std::uint64_t kind = kNone;
  std::uint64_t code = 0; ///< StatusCode of a StageFailure
  std::string text;

  [[noreturn]] void raise(const std::string& context) const
  {
    if (kind == kCancelled)
    {
      throw Cancelled();
    }
    if (kind == kInvalidInput)
    {
      throw InvalidInput(context + text);
    }
    if (kind == kStageFailure)
    {
      throw StageFailure(static_cast<StatusCode>(code), context + text);
    }
    if (kind == kNoMemory)
    {
      throw OutOfMemory(context + text);
    }
    throw std::runtime_error(context + text);
  }
};

Failure failureOf(const std::function<void()>& step)
{
  try
  {
    step();
    return {};
  }
  catch (const Cancelled&)
  {
    return { kCancelled, 0, "" };
  }
  catch (const InvalidInput& error)
  {
    return { kInvalidInput, 0, error.what() };
  }
  catch (const StageFailure& error)
  {
    return { kStageFailure, static_cast<std::uint64_t>(error.code), error.what() };
  }
  catch (const OutOfMemory& error)
  {
    return { kNoMemory, 0, error.what() };
  }
  catch (const std::bad_alloc&)
  {
    return { kNoMemory, 0, "out of memory; use more ranks, ask for fewer quads or free memory" };
  }
  catch (const std::exception& error)
  {
    return { kOther, 0, error.what() };
  }
}

std::string marshal(const std::vector<vtkSmartPointer<vtkDataObject>>& objects)
{
  Packer packer;
  for (vtkDataObject* object : objects)
  {
    if (object)
    {
      vtkNew<vtkCharArray> buffer;
      if (!vtkCommunicator::MarshalDataObject(object, buffer))
      {
        throw InvalidInput("data cannot be sent to another rank");
      }
      const auto size = static_cast<std::size_t>(buffer->GetNumberOfTuples());
      packer.text(std::string(buffer->GetPointer(0), size));
    }
  }
  return packer.bytes();
}

void unmarshal(
  const std::string& bytes, std::size_t count, std::vector<vtkSmartPointer<vtkDataObject>>& objects)
{
  Unpacker unpacker(bytes);
  for (std::size_t i = 0; i < count; ++i)
  {
    const std::string one = unpacker.text();
    vtkNew<vtkCharArray> buffer;
    buffer->SetNumberOfValues(static_cast<vtkIdType>(one.size()));
    std::memcpy(buffer->GetPointer(0), one.data(), one.size());
    objects.push_back(vtkCommunicator::UnMarshalDataObject(buffer));
  }
}

std::size_t countOf(const std::vector<vtkSmartPointer<vtkDataObject>>& objects)
{
  std::size_t count = 0;
  for (vtkDataObject* object : objects)
  {
    count += object != nullptr;
  }
  return count;
}

} // namespace

vtkMultiProcessController* controllerOf(vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  const auto key = vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES();
  const int pieces = info && info->Has(key) ? info->Get(key) : 1;
  vtkMultiProcessController* all = vtkMultiProcessController::GetGlobalController();
  const bool isParallel =
    all && all->IsA("vtkMPIController") && all->GetNumberOfProcesses() == pieces;
  return isParallel ? all : nullptr;
}

bool isLaunchedByMpi()
{
  // Open MPI, MPICH and its kin, Slurm.
  const char* const names[] = { "OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS" };
  return std::any_of(std::begin(names), std::end(names),
    [](const char* name) { return std::getenv(name) != nullptr; });
}

int Ranks::rank() const
{
  return controller_ ? controller_->GetLocalProcessId() : 0;
}

int Ranks::size() const
{
  return controller_ ? controller_->GetNumberOfProcesses() : 1;
}

std::vector<std::string> Ranks::gather(const std::string& bytes) const
{
  if (size() == 1)
  {
    return { bytes };
  }
  const auto ranks = static_cast<std::size_t>(size());
  std::vector<vtkIdType> lengths(ranks), offsets(ranks, 0);
  const auto length = static_cast<vtkIdType>(bytes.size());
  controller_->AllGather(&length, lengths.data(), 1);
  for (std::size_t r = 1; r < ranks; ++r)
  {
    offsets[r] = offsets[r - 1] + lengths[r - 1];
  }
  std::string all(static_cast<std::size_t>(offsets.back() + lengths.back()), '\0');
  count(bytes.size() * (ranks - 1), all.size() - bytes.size());
  controller_->AllGatherV(bytes.data(), all.data(), length, lengths.data(), offsets.data());
  std::vector<std::string> result;
  for (std::size_t r = 0; r < ranks; ++r)
  {
    result.push_back(
      all.substr(static_cast<std::size_t>(offsets[r]), static_cast<std::size_t>(lengths[r])));
  }
  return result;
}

void Ranks::agree(const std::string& error) const
{
  for (const std::string& text : gather(error))
  {
    if (!text.empty())
    {
      throw InvalidInput(text);
    }
  }
}

void Ranks::together(const std::string& context, const std::function<void()>& step) const
{
  Failure failure = failureOf(step);
  Packer packer;
  packer.count(failure.kind);
  packer.count(failure.code);
  packer.text(failure.text);
  const std::vector<std::string> all = gather(packer.bytes());
  Failure first;
  std::string where = context.empty() ? "" : context + ": ";
  for (std::size_t r = 0; r < all.size(); ++r)
  {
    Unpacker unpacker(all[r]);
    failure.kind = unpacker.count();
    failure.code = unpacker.count();
    failure.text = unpacker.text();
    // A stop on request weighs more than a fault, which is met again the next time.
    if (failure.kind == kCancelled || (failure.kind != kNone && first.kind == kNone))
    {
      where = (size() > 1 ? "rank " + std::to_string(r) + ": " : "") +
        (context.empty() ? "" : context + ": ");
      first = failure;
    }
    if (first.kind == kCancelled)
    {
      break;
    }
  }
  if (first.kind != kNone)
  {
    first.raise(where);
  }
}

void Ranks::count(std::size_t sent, std::size_t received) const
{
  traffic_.sent += sent;
  traffic_.received += received;
}

void Ranks::send(const std::string& bytes, int rank) const
{
  if (!bytes.empty())
  {
    controller_->Send(bytes.data(), static_cast<vtkIdType>(bytes.size()), rank, kTag);
    count(bytes.size(), 0);
  }
}

void Ranks::receive(std::string& bytes, int rank) const
{
  if (!bytes.empty())
  {
    controller_->Receive(bytes.data(), static_cast<vtkIdType>(bytes.size()), rank, kTag);
    count(0, bytes.size());
  }
}

void Ranks::sum(std::vector<vtkIdType>& numbers) const
{
  if (size() > 1)
  {
    const std::vector<vtkIdType> mine = numbers;
    controller_->AllReduce(
      mine.data(), numbers.data(), static_cast<vtkIdType>(mine.size()), vtkCommunicator::SUM_OP);
    count(mine.size() * sizeof(vtkIdType), mine.size() * sizeof(vtkIdType));
  }
}

std::vector<std::string> Ranks::exchange(std::vector<std::string> bytes) const
{
  const auto ranks = static_cast<std::size_t>(size());
  bytes.resize(ranks);
  if (ranks == 1)
  {
    return bytes;
  }
  const auto me = static_cast<std::size_t>(rank());
  std::vector<vtkIdType> lengths(ranks), all(ranks * ranks);
  for (std::size_t r = 0; r < ranks; ++r)
  {
    lengths[r] = static_cast<vtkIdType>(bytes[r].size());
  }
  controller_->AllGather(lengths.data(), all.data(), static_cast<vtkIdType>(ranks));
  count((ranks - 1) * ranks * sizeof(vtkIdType), (ranks - 1) * ranks * sizeof(vtkIdType));
  std::vector<std::string> received(ranks);
  // All that can fail is done before anything is sent, so that nobody waits for what never comes.
  together("what other ranks send",
    [&]
    {
      for (std::size_t r = 0; r < ranks; ++r)
      {
        if (r != me)
        {
          received[r].resize(static_cast<std::size_t>(all[r * ranks + me]));
        }
      }
    });
  received[me] = std::move(bytes[me]);
  // In each round every rank has one partner, and of two partners the lower one sends first.
  for (std::size_t round = 0; round < ranks; ++round)
  {
    const std::size_t partner = (round + ranks - me) % ranks;
    if (me < partner)
    {
      send(bytes[partner], static_cast<int>(partner));
      receive(received[partner], static_cast<int>(partner));
    }
    else if (partner < me)
    {
      receive(received[partner], static_cast<int>(partner));
      send(bytes[partner], static_cast<int>(partner));
    }
    std::string().swap(bytes[partner]);
  }
  return received;
}

std::vector<std::string> Ranks::gatherTo(int owner, std::string bytes) const
{
  std::vector<std::string> all(static_cast<std::size_t>(size()));
  all[static_cast<std::size_t>(owner)] = std::move(bytes);
  all = exchange(std::move(all));
  return rank() == owner ? std::move(all) : std::vector<std::string>{};
}

std::string Ranks::scatter(int owner, std::vector<std::string> bytes) const
{
  if (rank() != owner)
  {
    bytes.clear();
  }
  return std::move(exchange(std::move(bytes))[static_cast<std::size_t>(owner)]);
}

//------------------------------------------------------------------------------
void SharedStop::tell()
{
  if (hasTold_ || !controller_)
  {
    return;
  }
  hasTold_ = true;
  for (int r = 0; r < controller_->GetNumberOfProcesses(); ++r)
  {
    if (r != controller_->GetLocalProcessId())
    {
      const char message = 1;
      controller_->Send(&message, 1, r, kStopTag);
    }
  }
}

bool SharedStop::isTold()
{
  while (takeMessage(kStopTag))
  {
    ++heard_;
  }
  return heard_ > 0;
}

bool SharedStop::takeMessage(int tag)
{
#ifdef QUADRILLE_HAS_MPI
  auto* mpi = vtkMPIController::SafeDownCast(controller_);
  int isThere = 0, source = -1;
  if (mpi && mpi->Iprobe(vtkMultiProcessController::ANY_SOURCE, tag, &isThere, &source) &&
    isThere != 0)
  {
    char message = 0;
    controller_->Receive(&message, 1, source, tag);
    return true;
  }
#else
  (void)tag;
#endif
  return false;
}

void SharedStop::join(const std::function<bool()>& goOn)
{
  const int ranks = controller_ ? controller_->GetNumberOfProcesses() : 1;
  if (ranks == 1)
  {
    return;
  }
#ifdef QUADRILLE_HAS_MPI
  const auto waitFor = [&](int tag, int messages)
  {
    for (int received = 0; received < messages;)
    {
      if (takeMessage(tag))
      {
        ++received;
        continue;
      }
      if (!goOn())
      {
        tell();
      }
      std::this_thread::sleep_for(kLook);
    }
  };
  const char message = 1;
  if (controller_->GetLocalProcessId() == 0)
  {
    waitFor(kDoneTag, ranks - 1);
    for (int r = 1; r < ranks; ++r)
    {
      controller_->Send(&message, 1, r, kGoTag);
    }
  }
  else
  {
    controller_->Send(&message, 1, 0, kDoneTag);
    waitFor(kGoTag, 1);
  }
#else
  (void)goOn;
#endif
  // No message may be left over for the next execution.
  std::vector<int> told(static_cast<std::size_t>(ranks), 0);
  const int mine = hasTold_ ? 1 : 0;
  controller_->AllGather(&mine, told.data(), 1);
  int expected = -mine;
  for (const int one : told)
  {
    expected += one;
  }
  while (heard_ < expected)
  {
    char received = 0;
    controller_->Receive(&received, 1, vtkMultiProcessController::ANY_SOURCE, kStopTag);
    ++heard_;
  }
}

std::vector<vtkSmartPointer<vtkDataObject>> Ranks::collect(
  const std::vector<vtkSmartPointer<vtkDataObject>>& mine, int owner) const
{
  if (size() == 1)
  {
    std::vector<vtkSmartPointer<vtkDataObject>> objects;
    for (const vtkSmartPointer<vtkDataObject>& object : mine)
    {
      if (object)
      {
        objects.push_back(object);
      }
    }
    return objects;
  }
  // All that can fail is done before it is told who sends how much, so that nobody waits for what never comes.
  std::string bytes, error;
  try
  {
    bytes = rank() == owner ? "" : marshal(mine);
  }
  catch (const std::exception& failure)
  {
    error = failure.what();
  }
  agree(error);
  Packer header;
  header.count(countOf(mine));
  header.count(bytes.size());
  const std::vector<std::string> headers = gather(header.bytes());
  if (rank() != owner)
  {
    if (!bytes.empty())
    {
      controller_->Send(bytes.data(), static_cast<vtkIdType>(bytes.size()), owner, kTag);
    }
    return {};
  }
  std::vector<vtkSmartPointer<vtkDataObject>> objects;
  for (int r = 0; r < size(); ++r)
  {
    Unpacker counts(headers[static_cast<std::size_t>(r)]);
    const std::size_t count = counts.count();
    std::string received(counts.count(), '\0');
    if (r == owner)
    {
      objects.insert(objects.end(), mine.begin(), mine.end());
    }
    else if (!received.empty())
    {
      controller_->Receive(received.data(), static_cast<vtkIdType>(received.size()), r, kTag);
      unmarshal(received, count, objects);
    }
  }
  return objects;
}

std::vector<vtkSmartPointer<vtkDataObject>> Ranks::collectEverywhere(
  const std::vector<vtkSmartPointer<vtkDataObject>>& mine) const
{
  if (size() == 1)
  {
    return collect(mine, 0);
  }
  std::string bytes, error;
  try
  {
    Packer packer;
    packer.count(countOf(mine));
    bytes = packer.bytes() + marshal(mine);
  }
  catch (const std::exception& failure)
  {
    error = failure.what();
  }
  agree(error);
  std::vector<vtkSmartPointer<vtkDataObject>> objects;
  for (const std::string& received : gather(bytes))
  {
    const std::string head = received.substr(0, sizeof(std::uint64_t));
    unmarshal(received.substr(sizeof(std::uint64_t)), Unpacker(head).count(), objects);
  }
  return objects;
}

} // namespace quadrille
