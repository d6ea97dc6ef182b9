// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a run will cost, before it starts.
#pragma once

#include "Base/Error.h"
#include "Pipeline/Options.h"

#include <cstddef>
#include <string>

namespace quadrille
{

struct RunEstimate
{
  double seconds = 0; ///< on a machine like the one of Documentation/Performance.md
  double bytes = 0;   ///< peak memory beside the caller's copy of the surface
};

/// From sizes alone: triangles of the input, quads asked for. threads: 0 means all. The rates are those that
/// quadrille-bench measured on scans; surfaces whose features make the run try again take longer.
RunEstimate estimateRun(std::size_t triangles, double quads, int threads);

/// The same for a surface that is cut into pieces of so many triangles (RemeshInPieces.h).
RunEstimate estimateInPieces(
  std::size_t triangles, std::size_t trianglesOfPiece, double quads, int threads);

/// What a run of so many triangles takes when its stages are remembered, where so many bytes are held already.
double bytesToRemember(const RunEstimate& run, std::size_t triangles, std::size_t held);

/// Bytes that the machine can give to a process now without swapping; infinity where it cannot be found out.
double freeMemory();

/// Not ok, with what the user can do, where the run needs more memory than the options allow or the machine has free.
Status memoryStatus(
  const RunEstimate& estimate, std::size_t triangles, const RemeshOptions& options);

/// "about 7 s and 640 MB".
std::string estimateText(const RunEstimate& estimate);

/// "640 MB", "12.3 GB".
std::string bytesText(double bytes);

} // namespace quadrille
