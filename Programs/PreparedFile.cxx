// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "PreparedFile.h"

#include "Convert/PolyData.h"
#include "Features/FeatureFilter.h"
#include "MeshFiles.h"
#include "Prepare/Prepare.h"
#include "Prepare/Refine.h"

#include <vtkPolyData.h>

#include <cmath>

namespace quadrille
{

PreparedSurface prepareMeshFile(const std::string& path, double quads, double& edgeLength)
{
  const vtkSmartPointer<vtkPolyData> input = readMeshFile(path);
  PreparedSurface surface = prepareSurface(convertSurface(input, "").input, {});
  edgeLength = std::sqrt(surface.area / quads);
  removeUnresolvedFeatures(surface.mesh, edgeLength);
  refineSurface(surface, edgeLength, {});
  return surface;
}

} // namespace quadrille
