// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleRanks.h"

#include "Base/Error.h"

#include <vtkCharArray.h>
#include <vtkCommunicator.h>
#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <stdexcept>

namespace quadrille
{

namespace
{

constexpr int kTag = 46120; // of our messages

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

void Packer::number(double value)
{
  bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

void Packer::count(std::uint64_t value)
{
  bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

void Packer::text(const std::string& value)
{
  count(value.size());
  bytes_.append(value);
}

void Unpacker::take(void* target, std::size_t size)
{
  if (bytes_.size() - at_ < size)
  {
    throw std::logic_error("a message between ranks is too short");
  }
  std::memcpy(target, bytes_.data() + at_, size);
  at_ += size;
}

double Unpacker::number()
{
  double value = 0;
  take(&value, sizeof(value));
  return value;
}

std::uint64_t Unpacker::count()
{
  std::uint64_t value = 0;
  take(&value, sizeof(value));
  return value;
}

std::string Unpacker::text()
{
  std::string value(count(), '\0');
  take(value.data(), value.size());
  return value;
}

} // namespace quadrille
