// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "ReplayCounts.h"

#include "Convert/PolyData.h"
#include "MeshFiles.h"
#include "Pipeline/Pipeline.h"

#include <vtkPolyData.h>

#include <cstdio>
#include <filesystem>

namespace quadrille
{

void printReplayHeader()
{
  std::printf("mesh,quads,faces,coarse_not_positive,inverted_stars,moved_to_kernel,without_kernel,"
              "replay_not_positive,mended_patches,not_positive,ok\n");
}

void printReplay(const std::string& path, double quads, int threads)
{
  const vtkSmartPointer<vtkPolyData> input = readMeshFile(path);
  RemeshOptions options;
  options.quads = static_cast<std::size_t>(quads);
  options.threads = threads;
  const RemeshResult result = remesh(convertSurface(input, "").input, options);
  const TransferResult& replay = result.transfer;
  std::printf("%s,%.0f,%u,%zu,%zu,%zu,%zu,%zu,%zu,%zu,%d\n",
    std::filesystem::path(path).stem().c_str(), quads, result.surface.mesh.faceCount(),
    result.coarseCertificate.notPositive, replay.invertedStars, replay.movedToKernel,
    replay.withoutKernel, replay.replayNotPositive, replay.mendedPatches, replay.notPositive,
    result.status.ok() ? 1 : 0);
  std::fflush(stdout);
}

} // namespace quadrille
