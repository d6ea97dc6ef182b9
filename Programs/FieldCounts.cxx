// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "FieldCounts.h"

#include "Convert/PolyData.h"
#include "CrossField/CrossField.h"
#include "Features/FeatureFilter.h"
#include "MeshFiles.h"
#include "Pipeline/Pipeline.h"
#include "Prepare/Prepare.h"
#include "Prepare/Refine.h"

#include <vtkPolyData.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <vector>

namespace quadrille
{
namespace
{

/// The flow that makes the turns takes minutes beyond that.
constexpr Index kMostCountedFaces = 500000;

std::size_t countIrregular(const Mesh& mesh, const std::vector<int>& turns)
{
  std::vector<int> regular(mesh.vertexCount(), 4);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isBoundary(h))
    {
      regular[mesh.origin[h]] = 2;
    }
  }
  std::size_t count = 0;
  for (Index v = 0; v < turns.size(); ++v)
  {
    count += turns[v] != regular[v] ? 1 : 0;
  }
  return count;
}

} // namespace

void printFieldCountsHeader()
{
  std::printf("mesh,quads,faces,coarse_vertices,irregular_surface,irregular_coarse,ratio,ok\n");
}

void printFieldCounts(const std::string& path, double quads, int threads)
{
  const vtkSmartPointer<vtkPolyData> input = readMeshFile(path);
  RemeshOptions options;
  options.quads = static_cast<std::size_t>(quads);
  options.threads = threads;

  PrepareOptions prepareOptions;
  prepareOptions.featureAngle = options.featureAngle;
  prepareOptions.threads = threads;
  PreparedSurface surface = prepareSurface(convertSurface(input, "").input, prepareOptions);
  CrossFieldOptions fieldOptions;
  fieldOptions.targetEdgeLength = std::sqrt(surface.area / quads);
  removeUnresolvedFeatures(surface.mesh, fieldOptions.targetEdgeLength);
  refineSurface(surface, fieldOptions.targetEdgeLength, {});
  if (surface.mesh.faceCount() > kMostCountedFaces)
  {
    throw InvalidInput(path + ": " + std::to_string(surface.mesh.faceCount()) +
      " faces after refinement, more than " + std::to_string(kMostCountedFaces) +
      " are too many for a field on all of them");
  }
  const CrossField field = computeCrossField(surface.mesh, fieldOptions);
  const std::size_t onSurface = countIrregular(surface.mesh, field.turns);

  const RemeshResult result = remesh(convertSurface(input, "").input, options);
  const std::size_t onCoarse = countIrregular(result.coarse.mesh, result.coarseTurns);
  const double ratio =
    onSurface > 0 ? static_cast<double>(onCoarse) / static_cast<double>(onSurface) : 1;
  std::printf("%s,%.0f,%u,%u,%zu,%zu,%.3f,%d\n", std::filesystem::path(path).stem().c_str(), quads,
    surface.mesh.faceCount(), result.coarse.mesh.vertexCount(), onSurface, onCoarse,
    onSurface == 0 && onCoarse > 0 ? HUGE_VAL : ratio, result.status.ok() ? 1 : 0);
  std::fflush(stdout);
}

} // namespace quadrille
