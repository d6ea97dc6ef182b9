// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/HierarchyChecks.h"

#include "Base/Error.h"
#include "Base/Refuse.h"

#include <cmath>
#include <cstddef>
#include <string>

namespace quadrille
{

void checkPhase2(const Mesh& fine, const HierarchyOptions& options)
{
  for (std::size_t i = 0; i < options.guides.size(); ++i)
  {
    const Index f = options.guides[i].face;
    refuseIf(f >= fine.faceCount() || (i > 0 && options.guides[i - 1].face >= f), "Guide ", i,
      " is of face ", f, ", but guides must ascend by face, and the mesh has ", fine.faceCount(),
      " faces.");
  }
  for (const Index v : options.keepVertices)
  {
    refuseIf(v >= fine.vertexCount(), "Vertex ", v, " is to be kept, but the mesh has only ",
      fine.vertexCount(), " vertices.");
  }
  refuseIf(options.coarseVertices == 0 && options.cost != DecimationCost::Gaussian &&
      options.cost != DecimationCost::GaussianMemory,
    "A coarse level without a number of vertices needs a cost that measures the "
    "change of curvature.");
}

void checkOptions(const Mesh& fine, const HierarchyOptions& options)
{
  if (!(options.targetEdgeLength > 0) || !std::isfinite(options.targetEdgeLength))
  {
    throw InvalidInput(
      "The target edge length of a decimation must be positive and finite, but is " +
      std::to_string(options.targetEdgeLength) + ".");
  }
  checkPhase2(fine, options);
}

} // namespace quadrille
