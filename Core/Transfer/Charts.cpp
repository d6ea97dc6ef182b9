// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/Charts.h"

#include "Base/ChartRotation.h"
#include "Base/Progress.h"
#include "Mesh/BreadthFirst.h"

namespace quadrille
{

namespace
{

/// Whether both images of the edge of h are the same.
bool isContinuous(const Mesh& mesh, const std::vector<FixedVec2>& uv, Index h)
{
  const Index g = mesh.twin[h];
  return uv[h] == uv[Mesh::next(g)] && uv[Mesh::next(h)] == uv[g];
}

/// Brings the face across h into the chart of the face of h; false where no transition does.
bool carryAcross(const Mesh& mesh, std::vector<FixedVec2>& uv, Index h)
{
  const Index g = mesh.twin[h];
  const FixedVec2 from = uv[Mesh::next(g)]; // image of the origin of h in the other chart
  const std::optional<int> rotation = rotationBetween(uv[g] - from, uv[Mesh::next(h)] - uv[h]);
  if (!rotation)
  {
    return false;
  }
  const FixedVec2 to = uv[h];
  const Index first = g - g % 3;
  for (Index i = first; i < first + 3; ++i)
  {
    uv[i] = to + rotate(uv[i] - from, *rotation);
  }
  return true;
}

std::size_t countSeams(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  std::size_t seams = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    const Index g = mesh.twin[h];
    seams += g != kInvalidIndex && h < g && !isContinuous(mesh, uv, h) ? 1U : 0U;
  }
  return seams;
}

} // namespace

ChartCounts mergeCharts(const Mesh& mesh, std::vector<FixedVec2>& uv)
{
  std::size_t charts = 0;
  visitFaces(
    mesh.twin, [&](Index) { ++charts; }, [&](Index h) { return carryAcross(mesh, uv, h); });
  return { charts, countSeams(mesh, uv) };
}

} // namespace quadrille
