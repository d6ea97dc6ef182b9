// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a spread surface cost: seconds, bytes and memory of each rank.
#pragma once

#include "Ranks/Ranks.h"

#include <chrono>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

class vtkDataObject;

namespace quadrille
{

/// Of one rank.
struct SpreadFigures
{
  std::size_t faces = 0;         ///< of its pieces
  std::size_t levelFaces = 0;    ///< of its thinned pieces
  std::size_t borderPoints = 0;  ///< on boundaries of its pieces
  std::size_t sharedPoints = 0;  ///< of these, shared with other pieces
  std::size_t quads = 0;         ///< its own, without ghosts
  std::size_t gathered = 0;      ///< bytes of its thinned pieces
  std::size_t redistributed = 0; ///< bytes of the cells that it sent to other ranks
  Traffic traffic;               ///< in all
  double peakMemory = 0;         ///< bytes of the process so far; 0: not known
  std::vector<std::pair<std::string, double>> seconds; ///< by stage

  void pack(Packer& packer) const;
  static SpreadFigures unpack(Unpacker& unpacker);
};

/// Adds the time of its life to a stage.
class SpreadTimer
{
public:
  SpreadTimer(SpreadFigures& figures, const char* stage);
  ~SpreadTimer();
  SpreadTimer(const SpreadTimer&) = delete;
  SpreadTimer& operator=(const SpreadTimer&) = delete;

private:
  SpreadFigures& figures_;
  std::string stage_;
  std::chrono::steady_clock::time_point begin_;
};

/// Bytes that the process has held at most so far; 0 where the system does not tell.
double peakMemory();

/// Field array SpreadFigures, a tuple a rank, with a name for each component: faces, level_faces, border_points,
/// shared_points, quads, gathered_bytes, redistributed_bytes, sent_bytes, received_bytes, peak_bytes, and seconds of
/// the stages.
void addSpreadFigures(vtkDataObject* data, const std::vector<SpreadFigures>& figures);
/// "spread prepare: 0.52 s" of the slowest rank, one stage a line, and the bytes and the memory of the rank that has
/// most.
std::string spreadText(const std::vector<SpreadFigures>& figures);

} // namespace quadrille
