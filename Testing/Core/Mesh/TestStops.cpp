// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
// Every pass over a whole mesh looks out for a stop.
#include "Base/Error.h"
#include "Base/Progress.h"
#include "Features/FeatureFilter.h"
#include "Features/Features.h"
#include "Mesh/EdgeRuns.h"
#include "Mesh/SpaceFillingOrder.h"
#include "Mesh/Topology.h"
#include "Mesh/Triangulate.h"
#include "MeshInput.h"
#include "Prepare/DuplicateFaces.h"
#include "Prepare/Refine.h"
#include "Prepare/Repair.h"
#include "Prepare/Sheets.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <functional>
#include <thread>
#include <utility>
#include <vector>

using namespace quadrille;
using namespace quadrille::test;

TEST(Stops, EveryPassOverTheMeshCanBeStopped)
{
  PreparedSurface surface;
  surface.mesh = gridPlane(6, 5);
  surface.area = 30;
  surface.sourcePolygon.resize(surface.mesh.faceCount());
  surface.sourcePoints.resize(surface.mesh.faceCount());
  Mesh& mesh = surface.mesh;
  const SurfaceInput input = toInput(mesh);
  const EdgeRuns runs(mesh.origin, mesh.vertexCount(), 1);
  Index components = 0;
  PreparedSurface triangulated;
  const std::vector<std::pair<const char*, std::function<void()>>> passes = {
    { "checking", [&] { checkInput(input, 1); } },
    { "triangulating", [&] { triangulate(input, triangulated); } },
    { "edges", [&] { EdgeRuns(mesh.origin, mesh.vertexCount(), 1); } },
    { "runs", [&] { runs.forEach([](const EdgeRuns::Entry*, const EdgeRuns::Entry*) {}); } },
    { "ordering", [&] { orderSurface(surface, 1); } },
    { "duplicates", [&] { removeDuplicateFaces(surface, runs); } },
    { "sheets", [&] { pairIntoSheets(surface, runs); } },
    { "fans", [&] { splitVertexFans(mesh); } },
    { "components", [&] { faceComponents(mesh, components); } },
    { "outgoing", [&] { outgoingHalfEdges(mesh); } },
    { "topology", [&] { summarizeTopology(mesh); } },
    { "flags", [&] { makeFlagsSymmetric(mesh); } },
    { "filter", [&] { removeUnresolvedFeatures(mesh, 1); } },
    { "long edges", [&] { splitLongEdges(surface, 10, 1000, {}); } },
    { "enclosed faces", [&] { splitEnclosedFaces(surface); } },
    { "chords", [&] { splitChords(surface); } },
  };
  for (const auto& [name, pass] : passes)
  {
    PollScope scope([](double, const std::string&) { return false; });
    std::this_thread::sleep_for(PollScope::kInterval);
    EXPECT_THROW(pass(), Cancelled) << name;
  }
}
