// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a run tells of sharp edges that its quads do not follow.
#include "Pipeline/FaceDivision.h"
#include "Pipeline/Pipeline.h"
#include "Prepare/Prepare.h"

#include "Base/Angles.h"
#include "MeshInput.h"
#include "StaggeredTube.h"
#include "TestMeshes.h"

#include "Mesh/NearestTriangle.h"
#include "Mesh/Topology.h"
#include "Quads/QuadShape.h"
#include "Quads/QuadTopology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

/// A block with a groove of one voxel, a step of one and a bump of one voxel in its top: for s = 3 voxels the bump is
/// too small.
Mesh groovedBlock(double scale)
{
  Mesh mesh = test::voxelSurface({ 24, 16, 12 }, 1,
    [](int i, int j, int k) {
      return k < 11 || (i > 12 && j != 8) || (k == 11 && i == 4) || (k == 11 && i == 8 && j == 6);
    });
  for (Vector3& p : mesh.position.editAll())
  {
    p *= scale;
  }
  return mesh;
}

RemeshOptions quadsOfLength(double edgeLength)
{
  RemeshOptions options;
  options.edgeLength = edgeLength;
  options.threads = 1;
  return options;
}

double lengthOfFeatures(const Mesh& mesh)
{
  double length = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const bool isOne = mesh.isFeature(h) && !mesh.isBoundary(h) && h < mesh.twin[h];
    length += isOne ? mesh.edgeVector(h).norm() : 0;
  }
  return length;
}

double givenUpLength(const RemeshResult& result)
{
  double length = 0;
  for (const GivenUpCurve& curve : result.givenUpFeatures)
  {
    length += curve.length;
  }
  return length;
}

TEST(GivenUpFeatures, WithThoseThatStayTheyAreAllThereWere)
{
  PrepareOptions prepare;
  prepare.featureAngle = radians(40);
  const Mesh block = groovedBlock(1);
  const PreparedSurface before = prepareSurface(test::toInput(block), prepare);
  RemeshOptions options = quadsOfLength(3);
  options.featureAngle = radians(40);
  const RemeshResult result = remesh(test::toInput(block), options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  ASSERT_FALSE(result.givenUpFeatures.empty());
  // Lengths of the input, to the rounding of the frame's grid.
  EXPECT_NEAR(givenUpLength(result) + lengthOfFeatures(result.surface.mesh),
    lengthOfFeatures(before.mesh), 1e-4);
  EXPECT_TRUE(std::any_of(result.givenUpFeatures.begin(), result.givenUpFeatures.end(),
    [](const GivenUpCurve& curve) { return curve.reason == FeatureLoss::Unresolved; }));
  for (const GivenUpCurve& curve : result.givenUpFeatures)
  {
    EXPECT_NEAR(curve.lengthInQuads, curve.length / result.targetEdgeLength, 1e-6);
    EXPECT_TRUE((curve.place.array() >= -1e-4).all() && curve.place.x() < 24.0001 &&
      curve.place.y() < 16.0001 && curve.place.z() < 12.0001);
  }
}

TEST(GivenUpFeatures, ThreadsAndScaleChangeNothing)
{
  RemeshOptions options = quadsOfLength(3);
  const RemeshResult one = remesh(test::toInput(groovedBlock(1)), options);
  options.threads = 3;
  ResultStore store;
  for (int again = 0; again < 2; ++again) // the second time from the store
  {
    const RemeshResult other = remesh(test::toInput(groovedBlock(1)), options, store);
    ASSERT_EQ(one.givenUpFeatures.size(), other.givenUpFeatures.size());
    for (std::size_t i = 0; i < one.givenUpFeatures.size(); ++i)
    {
      EXPECT_EQ(one.givenUpFeatures[i].place, other.givenUpFeatures[i].place);
      EXPECT_EQ(one.givenUpFeatures[i].length, other.givenUpFeatures[i].length);
    }
    EXPECT_EQ(one.quads.points, other.quads.points);
  }
  // A power of two changes no bit but the exponent's.
  const RemeshResult large = remesh(test::toInput(groovedBlock(1024)), quadsOfLength(3 * 1024));
  ASSERT_EQ(one.givenUpFeatures.size(), large.givenUpFeatures.size());
  for (std::size_t i = 0; i < one.givenUpFeatures.size(); ++i)
  {
    EXPECT_EQ(1024 * one.givenUpFeatures[i].place, large.givenUpFeatures[i].place);
    EXPECT_EQ(1024 * one.givenUpFeatures[i].length, large.givenUpFeatures[i].length);
    EXPECT_EQ(one.givenUpFeatures[i].lengthInQuads, large.givenUpFeatures[i].lengthInQuads);
  }
}

/// Four patches that no map has with all their borders, see there: all stay, and faces are filled, whoever asked for
/// them.
TEST(GivenUpFeatures, FacesBetweenBordersAreFilled)
{
  const test::PatchedMesh tube = test::staggeredTube(0.02);
  const Mesh& mesh = tube.mesh;
  std::vector<std::uint8_t> borders(mesh.faceCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const bool isBorder =
      !mesh.isBoundary(h) && tube.patch[Mesh::face(h)] != tube.patch[Mesh::face(mesh.twin[h])];
    borders[Mesh::face(h)] |= static_cast<std::uint8_t>(isBorder ? 1U << h % 3 : 0U);
  }
  for (const bool isDesign : { false, true })
  {
    SurfaceInput input = test::toInput(mesh);
    RemeshOptions options;
    options.quads = 300;
    options.threads = 1;
    if (isDesign)
    {
      input.featureEdges = borders;
      input.isDesigned = true;
      options.featureAngle.reset();
    }
    else
    {
      input.patchIds = tube.patch;
    }
    const RemeshResult result = remesh(input, options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_TRUE(std::any_of(result.notices.begin(), result.notices.end(),
      [](const std::string& text)
      { return text.find("between sharp edges") != std::string::npos; }));
    EXPECT_EQ(result.tries.led[static_cast<std::size_t>(Try::FilledFaces)], 1U);
    EXPECT_TRUE(result.givenUpFeatures.empty());
    EXPECT_GT(result.certificate.withoutMap, 0U);
    EXPECT_EQ(result.certificate.withoutMap + result.certificate.triangles,
      result.surface.mesh.faceCount());
    EXPECT_EQ(result.uv.size(), result.surface.mesh.halfEdgeCount());
    EXPECT_EQ(validate(result.surface.mesh), "");
    const QuadTopology topology = analyzeQuads(result.quads.quads, result.quads.points.size());
    EXPECT_TRUE(topology.manifold()) << topology.text();
    EXPECT_EQ(topology.boundaryLoops, countBoundaryLoops(mesh, boundaryHalfEdges(mesh)));
    options.threads = 2;
    const RemeshResult again = remesh(input, options);
    EXPECT_EQ(again.quads.points, result.quads.points);
    EXPECT_EQ(again.quads.quads, result.quads.quads);
  }
}

/// A tube with so many edges of length 1 round it, and lids.
SurfaceInput closedTube(int edges, double length)
{
  const Mesh mesh = test::openCylinder(48, length < 1 ? 1 : 10, edges * 0.95 / (2 * kPi), length);
  SurfaceInput input = test::toInput(mesh);
  std::vector<std::uint8_t> isDone(mesh.halfEdgeCount(), 0);
  for (const Index first : boundaryHalfEdges(mesh))
  {
    std::vector<Index> lid;
    for (Index h = first; isDone[h] == 0; h = nextOnBoundary(mesh, h))
    {
      isDone[h] = 1;
      lid.push_back(mesh.origin[h]);
    }
    if (!lid.empty())
    {
      std::for_each(lid.rbegin(), lid.rend(), [&](Index v) { input.polygonPoints.push_back(v); });
      input.polygonOffsets.push_back(static_cast<Index>(input.polygonPoints.size()));
    }
  }
  return input;
}

/// Edges over a third of the way round leave a tube, so that no places on it make good quads; points leave it, too.
TEST(GivenUpFeatures, FilledTubesHaveGoodQuads)
{
  for (const int edges : { 3, 4, 5 })
  {
    for (const double length : { 0.3, 1.0, 2.0, 5.0, 30.0 })
    {
      SurfaceInput input = closedTube(edges, length);
      const double radius = input.points[0].x();
      input.withoutMap = { { radius, 0, length / 2 }, { radius / 3, 0, 0 },
        { radius / 3, 0, length } };
      RemeshOptions options = quadsOfLength(1);
      options.smallDetails = SmallDetails::Keep;
      const RemeshResult result = remesh(input, options);
      ASSERT_TRUE(result.status.ok()) << result.status.message;
      EXPECT_EQ(result.certificate.withoutMap, result.surface.mesh.faceCount());
      for (const std::array<Index, 4>& quad : result.quads.quads)
      {
        EXPECT_GT(scaledJacobian(cornersOf(result.quads.points, quad)), 0.3)
          << edges << " edges, length " << length;
      }
    }
  }
}

/// With a gap that quads fit into none is.
TEST(GivenUpFeatures, BordersWithRoomHaveAMap)
{
  const test::PatchedMesh wide = test::staggeredTube(0.3);
  SurfaceInput input = test::toInput(wide.mesh);
  input.patchIds = wide.patch;
  RemeshOptions options;
  options.quads = 1500;
  options.threads = 1;
  const RemeshResult asked = remesh(input, options);
  ASSERT_TRUE(asked.status.ok()) << asked.status.message;
  EXPECT_EQ(asked.certificate.withoutMap, 0U);
}

/// A plate whose edges on some lines are features, with those of its faces cut out that a test names.
struct CutPlate
{
  template <typename OnLine, typename IsOut>
  CutPlate(const OnLine& isOnLine, const IsOut& isOut)
  {
    const Mesh mesh = test::gridPlane(8, 4);
    SurfaceInput input = test::toInput(mesh);
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      std::uint8_t bits = 0;
      for (Index i = 0; i < 3; ++i)
      {
        const Index h = 3 * f + i;
        const bool isFeature =
          isOnLine(mesh.position[mesh.origin[h]], mesh.position[mesh.target(h)]);
        bits = static_cast<std::uint8_t>(bits | (isFeature ? 1U << i : 0U));
      }
      input.featureEdges.push_back(bits);
    }
    PreparedSurface prepared = prepareSurface(input, {});
    for (Index f = 0; f < prepared.mesh.faceCount(); ++f)
    {
      if (isOut(prepared.mesh.middleOfFace(f)))
      {
        out.push_back(f);
      }
    }
    whole.surface = std::make_shared<const PreparedSurface>(std::move(prepared));
    whole.edgeLength = 1;
    whole.targetQuads = 32;
    cut = cutFaces(whole, { out, {} }, 1);
  }

  const Mesh& rest() const { return cut.rest->sized.surface->mesh; }

  FilledPart fill(QuadMesh& quads) const
  {
    // In a triangle on the side of a quad of the point: the rest may meet itself there.
    const NearestTriangle triangles(trianglesOf(rest()));
    quads.sourceFace.resize(quads.points.size());
    quads.sourceWeights.resize(quads.points.size());
    for (const std::array<Index, 4>& quad : quads.quads)
    {
      const std::array<Vector3, 4> corners = cornersOf(quads.points, quad);
      const Vector3 centre = (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
      for (const Index p : quad)
      {
        const std::vector<Index> at = triangles.within(quads.points[p], 1e-9);
        const Index f = *std::min_element(at.begin(), at.end(),
          [&](Index a, Index b) {
            return (rest().middleOfFace(a) - centre).norm() <
              (rest().middleOfFace(b) - centre).norm();
          });
        quads.sourceFace[p] = f;
        quads.sourceWeights[p] = triangles.on(f, quads.points[p]).weights;
      }
    }
    return fillCutFaces(cut, &rest(), &quads, 1, {});
  }

  std::vector<Index> out; ///< faces, ascending
  SizedSurface whole;
  CutFaces cut;
};

/// The left half of a plate is cut out. Quads of the right half have no points at the ends of the line between them,
/// but near them on the outer boundary, which is none of the left half.
TEST(FaceDivision, PointsBesideTheEndsOfTheCutAreLedThere)
{
  const CutPlate plate([](const Vector3& a, const Vector3& b) { return a.x() == 4 && b.x() == 4; },
    [](const Vector3& middle) { return middle.x() < 4; });
  ASSERT_TRUE(plate.cut.rest);
  QuadMesh quads;
  quads.points = { Vector3(4.1, 0, 0), Vector3(8, 0, 0), Vector3(8, 1.4, 0), Vector3(4, 1.4, 0),
    Vector3(8, 2.7, 0), Vector3(4, 2.7, 0), Vector3(8, 4, 0), Vector3(4.2, 4, 0) };
  quads.quads = { { 0, 1, 2, 3 }, { 3, 2, 4, 5 }, { 5, 4, 6, 7 } };
  const FilledPart filled = plate.fill(quads);
  EXPECT_TRUE(filled.failedAt.empty());
  ASSERT_EQ(filled.points, std::vector<Index>({ 0, 3, 5, 7 }));
  EXPECT_EQ(filled.quads.points[0], Vector3(4, 0, 0));
  EXPECT_LT((filled.quads.points[1] - quads.points[3]).norm(), 1e-9);
  EXPECT_LT((filled.quads.points[2] - quads.points[5]).norm(), 1e-9);
  EXPECT_EQ(filled.quads.points[3], Vector3(4, 4, 0));
}

/// Two lines cross, and two faces opposite each other are cut out. The rest has the crossing twice.
class CrossedPlate : public ::testing::Test
{
protected:
  CrossedPlate()
    : plate_([](const Vector3& a, const Vector3& b)
        { return (a.x() == 4 && b.x() == 4) || (a.y() == 2 && b.y() == 2); },
        [](const Vector3& middle) { return (middle.x() < 4) == (middle.y() < 2); })
  {
  }

  /// Two rows of quads, at their own points.
  void addRows(const Vector3& corner, const std::vector<double>& at)
  {
    const auto first = static_cast<Index>(quads_.points.size()),
               row = static_cast<Index>(at.size());
    for (const double y : { 0.0, 1.0, 2.0 })
    {
      for (const double x : at)
      {
        quads_.points.push_back(corner + Vector3(x, y, 0));
      }
    }
    for (Index i = 0; i + 1 < 3 * row; ++i)
    {
      if (i % row + 1 < row && i < 2 * row)
      {
        const Index p = first + i;
        quads_.quads.push_back({ p, p + 1, p + row + 1, p + row });
      }
    }
  }

  CutPlate plate_;
  QuadMesh quads_;
};

TEST_F(CrossedPlate, TheCrossingIsOnePoint)
{
  ASSERT_TRUE(plate_.cut.rest);
  addRows(Vector3(4, 0, 0), { 0, 1, 2, 3, 4 });
  addRows(Vector3(0, 2, 0), { 0, 1, 2, 3, 4 });
  const auto rest = static_cast<Index>(quads_.points.size());
  const FilledPart filled = plate_.fill(quads_);
  ASSERT_TRUE(filled.failedAt.empty()) << filled.failedAt[0].transpose();
  ASSERT_EQ(filled.same.size(), 1U);
  EXPECT_EQ(quads_.points[filled.same[0][0]], Vector3(4, 2, 0));
  EXPECT_EQ(quads_.points[filled.same[0][1]], Vector3(4, 2, 0));
  std::vector<std::array<Index, 4>> all = quads_.quads;
  const auto stands = [&](Index p) { return p == filled.same[0][0] ? filled.same[0][1] : p; };
  for (std::array<Index, 4>& quad : all)
  {
    std::transform(quad.begin(), quad.end(), quad.begin(), stands);
  }
  for (std::array<Index, 4> quad : filled.quads.quads)
  {
    for (Index& p : quad)
    {
      p = p < filled.points.size() ? stands(filled.points[p]) : rest + p;
    }
    all.push_back(quad);
  }
  const QuadTopology topology = analyzeQuads(all, rest + filled.quads.points.size());
  EXPECT_EQ(topology.nonManifoldEdges, 0U) << topology.text();
  EXPECT_EQ(topology.nonManifoldVertices, 0U) << topology.text();
  EXPECT_EQ(topology.components, 1U);
  EXPECT_EQ(topology.eulerCharacteristic, 1);
}

TEST_F(CrossedPlate, AllFacesAtTheCrossingAreCutOutWithIt)
{
  FailedFaces failed{ plate_.out, {} };
  EXPECT_FALSE(addFacesAt({ Vector3(2, 1, 0) }, plate_.whole, failed)); // is out already
  EXPECT_TRUE(plate_.cut.rest);
  EXPECT_TRUE(addFacesAt({ Vector3(4, 2, 0) }, plate_.whole, failed));
  EXPECT_TRUE(std::is_sorted(failed.faces.begin(), failed.faces.end()));
  const CutFaces cut = cutFaces(plate_.whole, failed, 1);
  EXPECT_EQ(cut.count, 4U);
  EXPECT_FALSE(cut.rest);
}

} // namespace
} // namespace quadrille
