// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Details/FillHoles.h"

#include "Base/Progress.h"
#include "Mesh/ContentHash.h"
#include "Mesh/SpaceFillingOrder.h"
#include "Mesh/SurfaceEdit.h"
#include "Mesh/Topology.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace quadrille
{

namespace
{

double triangleArea(const Vector3& a, const Vector3& b, const Vector3& c)
{
  return (b - a).cross(c - a).norm() / 2;
}

/// The boundary half-edges of a loop; none where the vertices are no loop of the boundary.
std::vector<Index> boundaryRun(
  const Mesh& mesh, const std::vector<Index>& outgoing, const HandleLoop& loop)
{
  std::vector<Index> run;
  for (std::size_t i = 0; i < loop.vertices.size(); ++i)
  {
    const Index h = outgoing[loop.vertices[i]];
    if (!mesh.isBoundary(h) || mesh.target(h) != loop.vertices[(i + 1) % loop.vertices.size()])
    {
      return {};
    }
    run.push_back(h);
  }
  return run;
}

/// Whether every triangle of the fan has an area; adds them up.
bool hasRoom(const Mesh& mesh, const std::vector<Index>& run, const Vector3& middle, double& area)
{
  double length = 0;
  for (const Index h : run)
  {
    length += mesh.edgeVector(h).norm();
  }
  area = 0;
  return run.size() >= 3 &&
    std::all_of(run.begin(), run.end(),
      [&](Index h)
      {
        const double triangle =
          triangleArea(mesh.position[mesh.origin[h]], mesh.position[mesh.target(h)], middle);
        area += triangle;
        return 2 * triangle > kRoundingOfSingle * length * mesh.edgeVector(h).norm();
      });
}

} // namespace

std::vector<std::size_t> fillHoles(PreparedSurface& surface, const std::vector<HandleLoop>& loops)
{
  std::vector<std::size_t> filled;
  if (loops.empty())
  {
    return filled;
  }
  Mesh& mesh = surface.mesh;
  const std::vector<Index> outgoing = outgoingHalfEdges(mesh);
  for (std::size_t i = 0; i < loops.size(); ++i)
  {
    pollNowAndThen(i);
    const std::vector<Index> run = boundaryRun(mesh, outgoing, loops[i]);
    Vector3 middle = Vector3::Zero();
    for (const Index h : run)
    {
      middle += mesh.position[mesh.origin[h]] / static_cast<double>(run.size());
    }
    double area = 0;
    if (hasRoom(mesh, run, middle, area))
    {
      fillWithFan(surface, run, middle);
      surface.area += area;
      filled.push_back(i);
    }
  }
  if (!filled.empty())
  {
    surface.repair.filledHoles += filled.size();
    orderSurface(surface, 1);
    surface.hash = contentHash(mesh, 1);
  }
  return filled;
}

} // namespace quadrille
