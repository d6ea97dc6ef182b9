// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The ranks of a parallel run that work together on one execution of a filter. Without a controller there is one rank.
///
/// All functions of Ranks from gather() on are collective: every rank calls them in the same order, also one that has
/// no data or has failed.
#pragma once

#include "Ranks/Bytes.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <string>
#include <vector>

class vtkDataObject;
class vtkInformationVector;
class vtkMultiProcessController;

namespace quadrille
{

/// The ranks that work on a request together, or null: those of an MPI session in which all ask alike, each for its own
/// piece.
vtkMultiProcessController* controllerOf(vtkInformationVector* outputs);

/// Whether mpiexec or srun has started this process. ParaView's pvpython and pvserver are sessions of MPI with one rank
/// also without.
bool isLaunchedByMpi();

/// Bytes that this rank has sent to others and received from them.
struct Traffic
{
  std::uint64_t sent = 0;
  std::uint64_t received = 0;
};

class Ranks
{
public:
  /// controller: null for a rank alone.
  explicit Ranks(vtkMultiProcessController* controller) : controller_(controller) {}
  Ranks(const Ranks&) = delete; // what was counted stays in one place
  Ranks& operator=(const Ranks&) = delete;

  int rank() const;
  int size() const;
  bool isRoot() const { return rank() == 0; }
  /// Whether the session is one of MPI, with any number of ranks: then nothing may depend on that number.
  bool isParallel() const { return controller_ != nullptr; }
  const Traffic& traffic() const { return traffic_; }

  /// The bytes of each rank.
  std::vector<std::string> gather(const std::string& bytes) const;
  /// Throws InvalidInput with the first text that is not empty, on all ranks.
  void agree(const std::string& error) const;
  /// Does a step that may fail on some ranks: where it does, all ranks throw what the first of them has thrown. The
  /// text then begins with `context` and names the rank where there are several. Cancelled on one rank is Cancelled on
  /// all.
  void together(const std::string& context, const std::function<void()>& step) const;
  /// The sums over all ranks.
  void sum(std::vector<vtkIdType>& numbers) const;
  /// bytes[r] goes to rank r; returns what each rank has sent to this one. In pairs of ranks, so that none holds more
  /// than what it sends and receives.
  std::vector<std::string> exchange(std::vector<std::string> bytes) const;
  /// The bytes of each rank on `owner`; on others nothing.
  std::vector<std::string> gatherTo(int owner, std::string bytes) const;
  /// What `owner` has for this rank: bytes[r] for rank r. On other ranks `bytes` is not read.
  std::string scatter(int owner, std::vector<std::string> bytes) const;
  /// The data objects of all ranks, by rank, on `owner`; nothing on others. Null objects are left out. Throws
  /// InvalidInput on all ranks where one cannot send.
  std::vector<vtkSmartPointer<vtkDataObject>> collect(
    const std::vector<vtkSmartPointer<vtkDataObject>>& mine, int owner) const;
  /// The same on all ranks; for small data.
  std::vector<vtkSmartPointer<vtkDataObject>> collectEverywhere(
    const std::vector<vtkSmartPointer<vtkDataObject>>& mine) const;

private:
  void send(const std::string& bytes, int rank) const;
  void receive(std::string& bytes, int rank) const;
  void count(std::size_t sent, std::size_t received) const;

  vtkMultiProcessController* controller_;
  mutable Traffic traffic_;
};

/// A stop that one rank is asked for while the ranks work on their own: the others hear of it. From the constructor to
/// join() nothing else may be sent between the ranks.
class SharedStop
{
public:
  /// controller: null for a rank alone.
  explicit SharedStop(vtkMultiProcessController* controller) : controller_(controller) {}

  /// Tells the others, once.
  void tell();
  /// Whether another rank has told. Looks, does not wait.
  bool isTold();
  /// Waits until all ranks have come here. goOn is called every few milliseconds; where it returns false the others are
  /// told to stop. Collective.
  void join(const std::function<bool()>& goOn);

private:
  bool takeMessage(int tag);

  vtkMultiProcessController* controller_;
  bool hasTold_ = false;
  int heard_ = 0; ///< ranks that have told
};

} // namespace quadrille
