// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/Frame.h"

#include "MeshInput.h"
#include "PlyFile.h"
#include "TestMeshes.h"

#include "Base/PlaceText.h"
#include "Mesh/Topology.h"
#include "Prepare/Prepare.h"
#include "Prepare/Refine.h"
#include "Requests/SurfacePlaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace quadrille
{
namespace
{

SurfaceInput model(const char* name)
{
  const auto input = test::loadPly(std::string(QUADRILLE_DATA) + "/" + name);
  EXPECT_TRUE(input.has_value()) << name;
  return input.value_or(SurfaceInput{});
}

SurfaceInput moved(SurfaceInput input, const std::function<Vector3(const Vector3&)>& move)
{
  std::transform(input.points.begin(), input.points.end(), input.points.edit(), move);
  return input;
}

/// As ParaView's Reflect does: each polygon backwards; bits of edges go along.
SurfaceInput withFacesReversed(SurfaceInput input)
{
  for (std::size_t p = 0; p + 1 < input.polygonOffsets.size(); ++p)
  {
    const Index begin = input.polygonOffsets[p];
    const Index count = input.polygonOffsets[p + 1] - begin;
    std::reverse(input.polygonPoints.edit() + begin, input.polygonPoints.edit() + begin + count);
    if (!input.featureEdges.empty())
    {
      unsigned bits = 0;
      for (Index i = 0; i < count; ++i)
      {
        bits |= (input.featureEdges[p] >> i & 1U) << (2 * count - 2 - i) % count;
      }
      input.featureEdges[p] = static_cast<std::uint8_t>(bits);
    }
  }
  return input;
}

PreparedSurface prepared(const FramedInput& framed)
{
  PrepareOptions options;
  options.featureAngle = 0.7;
  options.threads = 2;
  return prepareSurface(framed.input, options);
}

std::size_t countFeatures(const Mesh& mesh)
{
  std::size_t count = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    count += mesh.isFeature(h) && (mesh.isBoundary(h) || h < mesh.twin[h]) ? 1 : 0;
  }
  return count;
}

TEST(Frame, ASurfaceInSinglePrecisionIsTheSameAfterAnyShift)
{
  for (const char* name : { "part.ply", "frame.ply", "beast.ply" })
  {
    const SurfaceInput input = model(name);
    const double diagonal = diagonalOf(input.points);
    const FramedInput here = enterFrame(input, 1);
    for (const double far : { 1.0, 33.3, 10000.0 })
    {
      const Vector3 shift = far * diagonal * Vector3(1, -0.77, 0.3);
      const FramedInput there =
        enterFrame(moved(input, [&](const Vector3& p) { return Vector3(p + shift); }), 2);
      std::size_t different = 0;
      for (std::size_t i = 0; i < input.points.size(); ++i)
      {
        const double distance =
          (here.input.points[i] - there.input.points[i]).cwiseAbs().maxCoeff();
        different += distance > 0 ? 1 : 0;
        ASSERT_LE(distance, std::ldexp(1.0, -26)) << name;
      }
      // Numbers that are small in the input have more binary digits than are left after the shift.
      EXPECT_LE(different, input.points.size() / 1000) << name << " " << far;
      EXPECT_EQ(here.frame.sign, there.frame.sign);
      EXPECT_EQ(here.frame.reversed, there.frame.reversed);
    }
  }
}

TEST(Frame, FeaturesDoNotDependOnTheDistanceFromTheOrigin)
{
  const SurfaceInput input = model("part.ply");
  const std::size_t sharp = countFeatures(prepared(enterFrame(input, 1)).mesh);
  EXPECT_GT(sharp, 100u);
  const Vector3 shift = Vector3::Constant(1e4 * diagonalOf(input.points));
  EXPECT_EQ(countFeatures(prepared(
              enterFrame(moved(input, [&](const Vector3& p) { return Vector3(p + shift); }), 1))
                            .mesh),
    sharp);
}

TEST(Frame, AScaleIsUndone)
{
  const SurfaceInput input = model("beast.ply");
  const FramedInput here = enterFrame(input, 1);
  for (const double scale : { 1e-9, 3.7, 1e9 })
  {
    const FramedInput there =
      enterFrame(moved(input, [&](const Vector3& p) { return Vector3(scale * p); }), 1);
    EXPECT_NEAR(there.frame.unit, scale * here.frame.unit, 1e-12 * there.frame.unit);
    EXPECT_EQ(there.input.points, here.input.points) << scale;
  }
}

/// Both kinds of files: with faces that were turned round, and with faces as they were, so that the surface is inside
/// out.
TEST(Frame, AMirrorImageIsTheSameSurface)
{
  for (const char* name : { "part.ply", "frame.ply", "beast.ply" })
  {
    const SurfaceInput input = model(name);
    const PreparedSurface here = prepared(enterFrame(input, 1));
    for (int mirrored = 1; mirrored < 8; ++mirrored)
    {
      const Vector3 sign(mirrored & 1 ? -1 : 1, mirrored & 2 ? -1 : 1, mirrored & 4 ? -1 : 1);
      const SurfaceInput image =
        moved(input, [&](const Vector3& p) { return Vector3(sign.cwiseProduct(p)); });
      for (const SurfaceInput& kind : { image, withFacesReversed(image) })
      {
        EXPECT_EQ(prepared(enterFrame(kind, 2)).hash, here.hash) << name << " " << mirrored;
      }
    }
  }
}

TEST(Frame, PolygonsAndTheirMarkedEdgesAreMirroredToo)
{
  // A cube of six squares, one edge marked from one side only, and without its lid.
  SurfaceInput input;
  for (int i = 0; i < 8; ++i)
  {
    input.points.emplace_back(i & 1, (i >> 1) & 1, (i >> 2) & 1);
  }
  input.points.edit()[7] = Vector3(1.5, 1.25, 1.75);
  input.polygonPoints = { 0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2 };
  input.polygonOffsets = { 0, 4, 8, 12, 16, 20 };
  input.featureEdges = { 0, 1, 0, 2, 0 };
  const PreparedSurface here = prepared(enterFrame(input, 1));
  const auto requested = [](const Mesh& mesh)
  { return std::count(mesh.flags.begin(), mesh.flags.end(), kFeatureEdge | kRequestedFeature); };
  EXPECT_EQ(requested(here.mesh), 4);
  const SurfaceInput image =
    moved(input, [](const Vector3& p) { return Vector3(-p.x(), p.y(), p.z()); });
  EXPECT_EQ(prepared(enterFrame(image, 1)).hash, here.hash);
  EXPECT_EQ(prepared(enterFrame(withFacesReversed(image), 1)).hash, here.hash);
  EXPECT_EQ(prepared(enterFrame(withFacesReversed(input), 1)).hash, here.hash);
}

TEST(Frame, FacesLookOutwards)
{
  for (const SurfaceInput& input :
    { test::toInput(test::sphere(2)), withFacesReversed(test::toInput(test::sphere(2))) })
  {
    const Mesh mesh = prepared(enterFrame(input, 1)).mesh;
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      EXPECT_GT(mesh.position[mesh.origin[3 * f]].dot(
                  mesh.edgeVector(3 * f).cross(mesh.edgeVector(3 * f + 1))),
        0);
    }
  }
}

TEST(Frame, TheUsersNumbersComeBackWithEveryBit)
{
  SurfaceInput input = model("part.ply");
  const Vector3 shift(1234567.1, -7654321.9, 0.1234567);
  input = moved(input, [&](const Vector3& p) { return Vector3(1.23456789 * p + shift); });
  const FramedInput framed = enterFrame(input, 1);
  PreparedSurface surface = prepared(framed);
  const std::vector<Vector3> positions = userPositions(surface, framed.frame, framed.points);
  for (Index h = 0; h < surface.mesh.halfEdgeCount(); ++h)
  {
    const Index point = surface.sourcePoints[h / 3][h % 3];
    ASSERT_EQ(positions[surface.mesh.origin[h]], input.points[point]);
  }
  // Vertices that refinement makes lie on the edges of the input.
  refineSurface(surface, 0.02 * surface.boundingBoxDiagonal, {});
  const std::vector<Vector3> refined = userPositions(surface, framed.frame, framed.points);
  ASSERT_GT(surface.mesh.faceCount(), framed.input.polygonOffsets.size());
  for (Index h = 0; h < surface.mesh.halfEdgeCount(); ++h)
  {
    std::array<double, 3> corner{};
    corner[h % 3] = 1;
    const SourceLocation at = surface.locate(h / 3, corner);
    Vector3 place = Vector3::Zero();
    for (std::size_t k = 0; k < 3; ++k)
    {
      place += at.weights[k] * (input.points[at.points[k]] - shift);
    }
    // Two roundings of coordinates of seven million.
    ASSERT_LE((refined[surface.mesh.origin[h]] - shift - place).norm(), 4e-9);
  }
}

TEST(Frame, FinePartsOfWideScenesHaveAFinerGrid)
{
  // Two spheres of radius 1, ten million apart: steps of 2^-26 would be a sixth of a radius.
  SurfaceInput input = test::toInput(test::sphere(3));
  const std::size_t count = input.points.size();
  const std::size_t corners = input.polygonPoints.size();
  for (std::size_t i = 0; i < count; ++i)
  {
    input.points.push_back(input.points[i] + Vector3(1e7, 0, 0));
  }
  for (std::size_t i = 0; i < corners; ++i)
  {
    input.polygonPoints.push_back(static_cast<Index>(input.polygonPoints[i] + count));
  }
  for (Index f = 0; 3 * f < corners; ++f)
  {
    input.polygonOffsets.push_back(static_cast<Index>(corners + 3 * (f + 1)));
  }
  const FramedInput framed = enterFrame(input, 1);
  for (std::size_t i = 0; i < input.points.size(); ++i)
  {
    EXPECT_LE((framed.frame.toUser(framed.input.points[i]) - input.points[i]).norm(), 1e-3);
  }
}

TEST(Frame, PointsThatNoPolygonUsesDoNotCount)
{
  SurfaceInput input = test::toInput(test::sphere(2));
  const FramedInput alone = enterFrame(input, 1);
  input.points.emplace_back(1e9, 0, 0);
  const FramedInput both = enterFrame(input, 1);
  EXPECT_EQ(both.frame.unit, alone.frame.unit);
  EXPECT_EQ(both.frame.centre, alone.frame.centre);
}

TEST(Frame, SurfacesWithoutExtentAreLeftAlone)
{
  SurfaceInput input;
  input.points.assign(3, Vector3(1, 2, 3));
  input.polygonPoints = { 0, 1, 2 };
  input.polygonOffsets = { 0, 3 };
  EXPECT_EQ(enterFrame(input, 1).input.points, input.points);
  EXPECT_THROW(prepared(enterFrame(input, 1)), InvalidInput);
  input.points.edit()[1].x() = NAN;
  EXPECT_THROW(enterFrame(input, 1), InvalidInput);
}

TEST(Frame, LengthsComeBack)
{
  Frame frame;
  for (int i = 1; i < 1000; ++i)
  {
    frame.unit = std::exp(0.1 * i - 50) / 3;
    const double length = roundedLength(1 / (i + 0.1));
    EXPECT_EQ(frame.lengthOf(frame.unit * length), length);
  }
}

TEST(Frame, FacesReversedTwiceAreAsBefore)
{
  const Mesh mesh = test::markFeatures(test::openCylinder(16, 8), 0.7);
  Mesh reversed = mesh;
  reverseFaces(reversed);
  EXPECT_EQ(validate(reversed), "");
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    EXPECT_EQ(reversed.origin[reversedCorner(h)], mesh.origin[h]);
    EXPECT_EQ(reversed.origin[reversedEdge(h)], mesh.target(h));
  }
  reverseFaces(reversed);
  EXPECT_EQ(reversed.origin, mesh.origin);
  EXPECT_EQ(reversed.twin, mesh.twin);
  EXPECT_EQ(reversed.flags, mesh.flags);
}

TEST(Frame, MessagesNamePlacesOfTheUser)
{
  EXPECT_EQ(placeText(Vector3(1, 2, 3)), "(1, 2, 3)");
  {
    // A metre of a map, far from its origin: millimetres are told.
    const PlaceScope scope(Vector3(4500000, 5400000, 300), 1, Vector3(-1, 1, 1));
    EXPECT_EQ(placeText(Vector3(0.125, 0.25, 0.5)), "(4499999.875, 5400000.25, 300.5)");
  }
  EXPECT_EQ(placeText(Vector3(1, 2, 3)), "(1, 2, 3)");
  // What rounding leaves of zero.
  EXPECT_EQ(placeText(Vector3(-1.1e-16, 49, 1e-5)), "(0, 49, 1e-05)");
}

} // namespace
} // namespace quadrille
