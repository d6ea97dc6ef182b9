// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/Repair.h"

#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Mesh/Sizing.h"
#include "Mesh/SpaceFillingOrder.h"
#include "Mesh/SurfaceEdit.h"
#include "Mesh/Topology.h"
#include "Prepare/DegenerateFaces.h"
#include "Prepare/DuplicateFaces.h"
#include "Prepare/MergePoints.h"
#include "Prepare/Sheets.h"
#include "Requests/Guides.h"

#include <algorithm>

namespace quadrille
{

namespace
{

/// A closed component needs at least the faces of a tetrahedron.
constexpr Index kFewestClosedFaces = 4;

void requireSize(const char* name, std::size_t size, std::size_t polygons)
{
  refuseIf(size != 0 && size != polygons, name, " has ", size, " values for ", polygons,
    " polygons: give one value a polygon, or none.");
}

void checkOffsets(const SurfaceInput& input)
{
  const std::vector<Index>& offsets = input.polygonOffsets;
  refuseIf(offsets.front() != 0 || offsets.back() != input.polygonPoints.size(),
    "the polygon offsets run from ", offsets.front(), " to ", offsets.back(), " but there are ",
    input.polygonPoints.size(), " corners.");
  for (std::size_t i = 0; i + 1 < offsets.size(); ++i)
  {
    pollNowAndThen(i);
    refuseIf(offsets[i] > offsets[i + 1], "polygon ", i, " ends before it begins: its offsets are ",
      offsets[i], " and ", offsets[i + 1], ".");
  }
}

void checkIds(const SurfaceInput& input, int threads)
{
  parallelForEach(input.polygonOffsets.size() - 1, kLightChunk, threads,
    [&](std::size_t polygon)
    {
      for (Index i = input.polygonOffsets[polygon]; i < input.polygonOffsets[polygon + 1]; ++i)
      {
        requirePoint(polygon, input.polygonPoints[i], input.points.size());
      }
    });
}

void checkCoordinates(const SurfaceInput& input, int threads)
{
  parallelForEach(input.points.size(), kLightChunk, threads,
    [&](std::size_t i) { requireCoordinates(i, input.points[i]); });
}

std::size_t removeFacesWithRepeatedCorner(Mesh& mesh)
{
  std::size_t removed = 0;
  Index* origin = mesh.origin.edit();
  for (Index h = 0; h < mesh.halfEdgeCount(); h += 3)
  {
    pollNowAndThen(h);
    Index* v = origin + h;
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
    {
      v[0] = v[1] = v[2] = kInvalidIndex;
      ++removed;
    }
  }
  return removed;
}

/// Closed components with fewer faces than a tetrahedron; counts the components on the way.
void removeTinyComponents(PreparedSurface& surface)
{
  const Mesh& mesh = surface.mesh;
  const std::vector<Index> component = faceComponents(mesh, surface.components);
  std::vector<Index> faces(surface.components, 0);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    const bool open =
      mesh.isBoundary(3 * f) || mesh.isBoundary(3 * f + 1) || mesh.isBoundary(3 * f + 2);
    Index& n = faces[component[f]];
    n = std::min(kFewestClosedFaces, n + (open ? kFewestClosedFaces : 1));
  }
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    if (faces[component[f]] < kFewestClosedFaces)
    {
      removeFace(surface, f);
    }
  }
  const Index tiny = static_cast<Index>(
    std::count_if(faces.begin(), faces.end(), [](Index n) { return n < kFewestClosedFaces; }));
  surface.repair.removedComponents += tiny;
  surface.components -= tiny;
}

} // namespace

void checkArrays(const SurfaceInput& input)
{
  requireSize("the feature edge array", input.featureEdges.size(), input.polygonOffsets.size() - 1);
  requireSize("the array of detected features", input.detectedFeatures.size(),
    input.polygonOffsets.size() - 1);
  requireSize("the patch id array", input.patchIds.size(), input.polygonOffsets.size() - 1);
  checkRequests(input);
  checkSizing(input);
}

void checkInput(const SurfaceInput& input, int threads)
{
  refuseIf(input.points.empty() || input.polygonOffsets.size() < 2 || input.polygonPoints.empty(),
    "connect a surface with polygons: this one is empty, it has ", input.points.size(),
    " points and no polygon with corners.");
  refuseIf(input.points.size() >= kInvalidIndex || input.polygonPoints.size() >= kInvalidIndex,
    "the surface has more than 4294967294 points or corners: reduce it first.");
  checkOffsets(input);
  checkArrays(input);
  checkIds(input, threads);
  checkCoordinates(input, threads);
}

void repairSurface(PreparedSurface& surface, EdgeRuns runs, int threads)
{
  Mesh& mesh = surface.mesh;
  RepairReport& repair = surface.repair;
  if (const std::size_t merged = mergeOpenEdges(mesh, runs))
  {
    repair.mergedPoints += merged;
    repair.degenerateFaces += removeFacesWithRepeatedCorner(mesh);
    orderSurface(surface, threads);
    runs = EdgeRuns(mesh.origin, mesh.vertexCount(), threads);
  }
  poll();
  if (const std::size_t duplicates = removeDuplicateFaces(surface, runs))
  {
    repair.duplicateFaces += duplicates;
    orderSurface(surface, threads);
    runs = EdgeRuns(mesh.origin, mesh.vertexCount(), threads);
  }
  poll();
  pairIntoSheets(surface, runs);
  poll();
  const std::size_t manyFans = splitVertexFans(mesh);
  poll();
  const std::size_t degenerate = removeDegenerateFaces(surface, threads);
  repair.nonManifoldVertices += manyFans;
  repair.degenerateFaces += degenerate;
  if (degenerate > 0)
  {
    splitVertexFans(mesh);
  }
  if (manyFans > 0 || degenerate > 0)
  {
    orderSurface(surface, threads);
  }
  poll();
  removeTinyComponents(surface);
  if (repair.removedComponents > 0)
  {
    orderSurface(surface, threads);
  }
  poll();
  if (repair.nonManifoldEdges > 0 && splitDoubleEdges(surface))
  {
    orderSurface(surface, threads);
  }
}

} // namespace quadrille
