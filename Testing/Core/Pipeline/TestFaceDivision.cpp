// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What is filled with quads where it has no map: here a surface that no feature cuts.
#include "Pipeline/FaceDivision.h"

#include "Prepare/Prepare.h"
#include "Quads/QuadTopology.h"

#include "MeshInput.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <string>

namespace quadrille
{
namespace
{

/// As a whole, with quads of this edge length.
QuadMesh filled(const Mesh& mesh, double edgeLength)
{
  CutFaces cut;
  cut.faces = prepareSurface(test::toInput(mesh), {});
  cut.isShared.assign(cut.faces.mesh.halfEdgeCount(), 0);
  cut.count = 1;
  const FilledPart made = fillCutFaces(cut, nullptr, nullptr, edgeLength, {});
  EXPECT_TRUE(made.failedAt.empty());
  for (Index h = 0; h < cut.faces.mesh.halfEdgeCount(); ++h)
  {
    EXPECT_FALSE(cut.faces.mesh.isFeature(h));
  }
  return made.quads;
}

} // namespace

TEST(FaceDivision, ClosedSurfacesWithoutCurvesAreFilled)
{
  const Mesh sphere = test::sphere(3), torus = test::torus(40, 20);
  for (const double edgeLength : { 0.15, 0.4, 1.0, 5.0 })
  {
    for (const Mesh* mesh : { &sphere, &torus })
    {
      SCOPED_TRACE(std::to_string(edgeLength) + (mesh == &sphere ? ", sphere" : ", torus"));
      const QuadMesh quads = filled(*mesh, edgeLength);
      const QuadTopology topology = analyzeQuads(quads.quads, quads.points.size());
      EXPECT_TRUE(topology.manifold()) << topology.text();
      EXPECT_EQ(topology.boundaryEdges, 0U);
      EXPECT_EQ(topology.components, 1U);
      EXPECT_EQ(topology.eulerCharacteristic, mesh == &sphere ? 2 : 0);
      EXPECT_TRUE(quads.lines.empty()); // where it was slit, nothing is left
    }
  }
}

} // namespace quadrille
