// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The ranks of a parallel run that work together on one execution of a filter. Without a controller there is one rank.
///
/// All functions but the first four are collective: every rank calls them in the same order, also one that has no data
/// or has failed.
#pragma once

#include <vtkSmartPointer.h>

#include <cstdint>
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

class Ranks
{
public:
  /// controller: null for a rank alone.
  explicit Ranks(vtkMultiProcessController* controller) : controller_(controller) {}

  int rank() const;
  int size() const;
  bool isRoot() const { return rank() == 0; }
  /// Whether the session is one of MPI, with any number of ranks: then nothing may depend on that number.
  bool isParallel() const { return controller_ != nullptr; }

  /// The bytes of each rank.
  std::vector<std::string> gather(const std::string& bytes) const;
  /// Throws InvalidInput with the first text that is not empty, on all ranks.
  void agree(const std::string& error) const;
  /// The data objects of all ranks, by rank, on `owner`; nothing on others. Null objects are left out. Throws
  /// InvalidInput on all ranks where one cannot send.
  std::vector<vtkSmartPointer<vtkDataObject>> collect(
    const std::vector<vtkSmartPointer<vtkDataObject>>& mine, int owner) const;
  /// The same on all ranks; for small data.
  std::vector<vtkSmartPointer<vtkDataObject>> collectEverywhere(
    const std::vector<vtkSmartPointer<vtkDataObject>>& mine) const;

private:
  vtkMultiProcessController* controller_;
};

/// Numbers and texts as bytes, between ranks of one machine type.
class Packer
{
public:
  void number(double value);
  void count(std::uint64_t value);
  void text(const std::string& value);
  const std::string& bytes() const { return bytes_; }

private:
  std::string bytes_;
};

/// The inverse, in the same order.
class Unpacker
{
public:
  explicit Unpacker(const std::string& bytes) : bytes_(bytes) {}
  double number();
  std::uint64_t count();
  std::string text();

private:
  void take(void* target, std::size_t size);

  const std::string& bytes_;
  std::size_t at_ = 0;
};

} // namespace quadrille
