// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What is asked of faces that are cut out of a surface, and what of the rest.
#include "Pipeline/FaceDivision.h"
#include "Pipeline/RequestsAtCut.h"
#include "Prepare/Prepare.h"
#include "Requests/HeldVertices.h"

#include "MeshInput.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iomanip>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

/// A plate of 8 by 4 whose left half is cut out, along a feature.
class RequestsAtCut : public ::testing::Test
{
protected:
  RequestsAtCut()
  {
    const Mesh mesh = test::gridPlane(8, 4);
    SurfaceInput input = test::toInput(mesh);
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      unsigned bits = 0;
      for (Index i = 0; i < 3; ++i)
      {
        const Index h = 3 * f + i;
        const bool isOnLine =
          mesh.position[mesh.origin[h]].x() == 4 && mesh.position[mesh.target(h)].x() == 4;
        bits |= isOnLine ? 1U << i : 0U;
      }
      input.featureEdges.push_back(static_cast<std::uint8_t>(bits));
    }
    surface_ = prepareSurface(input, {});
  }

  Index vertexAt(double x, double y) const { return vertexOf(surface_.mesh, Vector3(x, y, 0)); }
  static Index vertexOf(const Mesh& mesh, const Vector3& place)
  {
    for (Index v = 0; v < mesh.vertexCount(); ++v)
    {
      if ((mesh.position[v] - place).norm() < 1e-6)
      {
        return v;
      }
    }
    return kInvalidIndex;
  }

  CutFaces cut() const
  {
    SizedSurface whole;
    whole.edgeLength = 1;
    whole.targetQuads = 32;
    FailedFaces left;
    for (Index f = 0; f < surface_.mesh.faceCount(); ++f)
    {
      if (surface_.mesh.middleOfFace(f).x() < 4)
      {
        left.faces.push_back(f);
      }
    }
    whole.surface = std::make_shared<const PreparedSurface>(surface_);
    return cutFaces(whole, left, 1);
  }
  static const PreparedSurface& restOf(const CutFaces& cut) { return *cut.rest->sized.surface; }

  PreparedSurface surface_;
};

TEST_F(RequestsAtCut, ValencesOnTheCutAreThoseOfTheFaces)
{
  surface_.valenceRequests = { { vertexAt(1, 1), 5 }, { vertexAt(4, 2), 3 },
    { vertexAt(6, 2), 5 } };
  std::sort(surface_.valenceRequests.begin(), surface_.valenceRequests.end(),
    [](const ValenceRequest& a, const ValenceRequest& b) { return a.vertex < b.vertex; });
  const CutFaces made = cut();
  ASSERT_EQ(made.faces.valenceRequests.size(), 2U);
  EXPECT_LT(made.faces.valenceRequests[0].vertex, made.faces.valenceRequests[1].vertex);
  for (const ValenceRequest& request : made.faces.valenceRequests)
  {
    const Vector3 place = made.faces.mesh.position[request.vertex];
    EXPECT_EQ(request.valence, place.x() > 3.9 ? 3 : 5);
    EXPECT_LT(place.x(), 4.1);
  }
  ASSERT_EQ(restOf(made).valenceRequests.size(), 1U);
  const ValenceRequest& kept = restOf(made).valenceRequests.front();
  EXPECT_LT((restOf(made).mesh.position[kept.vertex] - Vector3(6, 2, 0)).norm(), 1e-6);
  // The surface is a quarter of the user's, whose numbers are told.
  const std::string text = filledText(made, 32, 128);
  EXPECT_NE(text.find("2 valences there"), std::string::npos) << text;
  EXPECT_EQ(text.find("ask for more than 128 quads: "), 0U) << text;
  std::ostringstream share;
  share << "with " << std::setprecision(3) << 25 * made.share << " % of the area";
  EXPECT_NE(text.find(share.str()), std::string::npos) << text;
}

TEST_F(RequestsAtCut, WhatIsHeldOnTheCutHasTheSectorsOfTheRest)
{
  const HeldSector left{ Vector3(-1, 0, 0), 1 }, right{ Vector3(1, 0, 0), 3 };
  surface_.sectorRequests = { { vertexAt(4, 2), { left, right } } };
  const CutFaces made = cut();
  ASSERT_EQ(restOf(made).sectorRequests.size(), 1U);
  const SectorRequest& held = restOf(made).sectorRequests.front();
  EXPECT_LT((restOf(made).mesh.position[held.vertex] - Vector3(4, 2, 0)).norm(), 1e-6);
  ASSERT_EQ(held.sectors.size(), 1U);
  EXPECT_EQ(held.sectors.front().turns, 3);
  EXPECT_GT(held.sectors.front().middle.x(), 0.9);
}

/// The rest may have had the vertex several times, where faces that were cut out meet in it.
TEST_F(RequestsAtCut, FansOfOneVertexAreHeldTogether)
{
  const Index v = vertexAt(4, 2);
  Index corner = 0;
  while (surface_.mesh.origin[corner] != v)
  {
    ++corner;
  }
  const Index point = surface_.inputPointAt(corner);
  const Vector3 place = surface_.mesh.position[v];
  SurfaceInput input;
  input.held = { { point, place, { { Vector3(1, 0, 0), 3 } } },
    { point, place, { { Vector3(-1, 0, 0), 1 } } } };
  EXPECT_EQ(placeHeldVertices(input, surface_).front().sectors.size(), 1U);
  surface_.withoutMap = { Vector3(1, 1, 0) };
  const std::vector<SectorRequest> held = placeHeldVertices(input, surface_);
  ASSERT_EQ(held.size(), 1U);
  EXPECT_EQ(held.front().vertex, v);
  ASSERT_EQ(held.front().sectors.size(), 2U);
  EXPECT_EQ(held.front().sectors.back().turns, 1);
}

TEST_F(RequestsAtCut, CurvesThroughTheFacesAreTheirs)
{
  const auto line = [](const std::vector<Vector3>& points) {
    return CurveRequest{ CurveKind::Connection, points };
  };
  surface_.curves = { line({ { 7, 1, 0 }, { 2, 1, 0 } }), line({ { 4, 0, 0 }, { 4, 4, 0 } }),
    line({ { 6, 1, 0 }, { 6, 3, 0 } }) };
  const CutFaces made = cut();
  EXPECT_EQ(made.curves, std::vector<Index>{ 0 });
  EXPECT_EQ(made.rest->curves, std::vector<Index>({ 1, 2 }));
  EXPECT_EQ(restOf(made).curves.size(), 2U);
}

TEST_F(RequestsAtCut, PlacesInsideLeadToTheFaces)
{
  const CutFaces made = cut();
  ASSERT_EQ(made.inside.size(), 1U);
  EXPECT_LT(made.inside.front().x(), 4);
  surface_.withoutMap = made.inside;
  const FailedFaces again = facesAt(surface_.withoutMap, surface_.mesh);
  ASSERT_EQ(again.faces.size(), 1U);
  EXPECT_LT(surface_.mesh.middleOfFace(again.faces.front()).x(), 4);
  EXPECT_TRUE(restOf(cut()).withoutMap.empty());
}

} // namespace
} // namespace quadrille
