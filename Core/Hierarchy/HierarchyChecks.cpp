// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/HierarchyChecks.h"

#include "Base/Error.h"

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
    if (f >= fine.faceCount() || (i > 0 && options.guides[i - 1].face >= f))
    {
      throw InvalidInput("Guide " + std::to_string(i) + " is of face " + std::to_string(f) +
        ", but guides must ascend by face, and the mesh has " + std::to_string(fine.faceCount()) +
        " faces.");
    }
  }
  for (const Index v : options.keepVertices)
  {
    if (v >= fine.vertexCount())
    {
      throw InvalidInput("Vertex " + std::to_string(v) + " is to be kept, but the mesh has only " +
        std::to_string(fine.vertexCount()) + " vertices.");
    }
  }
  if (options.coarseVertices == 0 && options.cost != DecimationCost::Gaussian &&
    options.cost != DecimationCost::GaussianMemory)
  {
    throw InvalidInput("A coarse level without a number of vertices needs a cost that measures the "
                       "change of curvature.");
  }
}

void checkOptions(const Mesh& fine, const HierarchyOptions& options)
{
  if (!(options.targetEdgeLength > 0) || !std::isfinite(options.targetEdgeLength))
  {
    throw InvalidInput(
      "The target edge length of a decimation must be positive and finite, but is " +
      std::to_string(options.targetEdgeLength) + ".");
  }
  if (options.order == DecimationOrder::Stochastic && options.draws.candidates < 1)
  {
    throw InvalidInput("A draw of vertices needs at least one candidate, but is to have " +
      std::to_string(options.draws.candidates) + ".");
  }
  checkPhase2(fine, options);
}

} // namespace quadrille
