// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Shifts, scales and mirror images of a surface have the same quads.
#include "MeshInput.h"
#include "PlyFile.h"
#include "TestMeshes.h"

#include "Pipeline/Pipeline.h"
#include "Requests/SurfacePlaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace quadrille
{
namespace
{

using Move = std::function<Vector3(const Vector3&)>;

struct Model
{
  std::string name;
  SurfaceInput input;
  double quads;
};

std::vector<Model> models()
{
  std::vector<Model> all;
  for (const char* name : { "part.ply", "frame.ply", "beast.ply" })
  {
    if (const auto input = test::loadPly(std::string(QUADRILLE_DATA) + "/" + name))
    {
      all.push_back({ name, *input, 1500 });
    }
  }
  EXPECT_EQ(all.size(), 3U);
  // Full of ties, on whole numbers.
  all.push_back({ "cube", test::toInput(test::unitCube(12)), 600 });
  all.push_back({ "square torus", test::toInput(test::squareTorus(6)), 600 });
  all.push_back({ "plane",
    test::toInput(test::planeCells(20, 20, [](int x, int y) { return x < 12 || y < 8; })), 200 });
  return all;
}

RemeshResult quadsOf(const SurfaceInput& input, double quads)
{
  RemeshOptions options;
  options.quads = static_cast<std::size_t>(quads);
  options.threads = 2;
  options.mergeCharts = true;
  return remesh(input, options);
}

SurfaceInput moved(SurfaceInput input, const Move& move, bool reverse)
{
  std::transform(input.points.begin(), input.points.end(), input.points.edit(), move);
  for (std::size_t p = 0; reverse && p + 1 < input.polygonOffsets.size(); ++p)
  {
    std::reverse(input.polygonPoints.edit() + input.polygonOffsets[p],
      input.polygonPoints.edit() + input.polygonOffsets[p + 1]);
  }
  return input;
}

/// Quads begun at their lowest point; as they run, or the other way round.
std::vector<std::array<Index, 4>> canonical(std::vector<std::array<Index, 4>> quads, bool reverse)
{
  for (std::array<Index, 4>& quad : quads)
  {
    if (reverse)
    {
      std::reverse(quad.begin(), quad.end());
    }
    std::rotate(quad.begin(), std::min_element(quad.begin(), quad.end()), quad.end());
  }
  return quads;
}

/// The same quads over the same points, up to `tolerance` in units of the first; with the faces' sense, as the input
/// has it.
void expectSameAfterMove(const RemeshResult& here, const RemeshResult& there, const Move& back,
  double tolerance, bool reversed)
{
  ASSERT_TRUE(there.status.ok()) << there.status.message;
  ASSERT_EQ(there.quads.points.size(), here.quads.points.size());
  EXPECT_EQ(there.quads.valence, here.quads.valence);
  EXPECT_EQ(canonical(there.quads.quads, reversed), canonical(here.quads.quads, false));
  for (std::size_t p = 0; p < here.quads.points.size(); ++p)
  {
    ASSERT_LE((back(there.quads.points[p]) - here.quads.points[p]).norm(), tolerance);
  }
  EXPECT_TRUE(there.certificate.valid() == here.certificate.valid());
}

TEST(Similarities, AShiftChangesNothing)
{
  for (const Model& model : models())
  {
    SCOPED_TRACE(model.name);
    const RemeshResult here = quadsOf(model.input, model.quads);
    ASSERT_TRUE(here.status.ok()) << here.status.message;
    const double diagonal = diagonalOf(model.input.points);
    const Vector3 shift = 1e4 * diagonal * Vector3(1, -0.77, 0.3);
    const RemeshResult there =
      quadsOf(moved(
                model.input, [&](const Vector3& p) { return Vector3(p + shift); }, false),
        model.quads);
    // A coordinate there is known to 2^-40 diagonals; smoothing weighs the same numbers.
    expectSameAfterMove(
      here, there, [&](const Vector3& p) { return Vector3(p - shift); }, 1e-7 * diagonal, false);
  }
}

TEST(Similarities, AScaleChangesNothing)
{
  for (const Model& model : models())
  {
    SCOPED_TRACE(model.name);
    const RemeshResult here = quadsOf(model.input, model.quads);
    const double diagonal = diagonalOf(model.input.points);
    for (const double scale : { 1e-9, 1e9 })
    {
      const RemeshResult there =
        quadsOf(moved(
                  model.input, [&](const Vector3& p) { return Vector3(scale * p); }, false),
          model.quads);
      expectSameAfterMove(
        here, there, [&](const Vector3& p) { return Vector3(p / scale); }, 1e-9 * diagonal, false);
      EXPECT_NEAR(
        there.targetEdgeLength, scale * here.targetEdgeLength, 1e-9 * there.targetEdgeLength);
      EXPECT_NEAR(there.surface.area, scale * scale * here.surface.area, 1e-9 * there.surface.area);
    }
  }
}

/// Files of both kinds: with faces reversed, as ParaView's Reflect writes them, and with points mirrored only.
TEST(Similarities, AMirrorImageHasTheMirrorImageOfTheQuads)
{
  for (const Model& model : models())
  {
    SCOPED_TRACE(model.name);
    const RemeshResult here = quadsOf(model.input, model.quads);
    for (int axis = 0; axis < 3; ++axis)
    {
      const Move mirror = [axis](const Vector3& p)
      {
        Vector3 image = p;
        image[axis] = -image[axis];
        return image;
      };
      for (const bool reverse : { false, true })
      {
        const RemeshResult there = quadsOf(moved(model.input, mirror, reverse), model.quads);
        expectSameAfterMove(here, there, mirror, 0, reverse);
      }
    }
  }
}

/// What comes with the quads lies on the user's surface, too, whatever the run has turned round.
TEST(Similarities, MapAndSourcesFitTheUsersSurface)
{
  for (const Model& model : models())
  {
    SCOPED_TRACE(model.name);
    for (const bool mirrored : { false, true })
    {
      const Vector3 sign(mirrored ? -1 : 1, 1, 1);
      const SurfaceInput input = moved(
        model.input, [&](const Vector3& p) { return Vector3(sign.cwiseProduct(p)); }, mirrored);
      const RemeshResult result = quadsOf(input, model.quads);
      ASSERT_TRUE(result.status.ok()) << result.status.message;
      const Mesh& mesh = result.surface.mesh;
      EXPECT_EQ(validate(mesh), "");
      EXPECT_EQ(validate(result.coarse.mesh), "");
      std::size_t against = 0;
      for (Index f = 0; f < mesh.faceCount(); ++f)
      {
        const Vector3 n = mesh.edgeVector(3 * f).cross(mesh.edgeVector(3 * f + 1));
        const Index* ids =
          input.polygonPoints.data() + input.polygonOffsets[result.surface.sourcePolygon[f]];
        const Vector3 wanted = (input.points[ids[1]] - input.points[ids[0]])
                                 .cross(input.points[ids[2]] - input.points[ids[0]]);
        against += n.dot(wanted) < 0 ? 1 : 0;
      }
      EXPECT_EQ(against, 0U);
      std::vector<std::uint8_t> integer(mesh.vertexCount(), 0);
      const Certificate again = certify(mesh, result.uv, result.turns, integer, 1);
      EXPECT_EQ(again.notPositive, result.certificate.notPositive);
      EXPECT_EQ(again.wrongTurns, result.certificate.wrongTurns);
      EXPECT_EQ(again.seamResiduals, result.certificate.seamResiduals);
      for (std::size_t p = 0; p < result.quads.points.size(); ++p)
      {
        const Index f = result.quads.sourceFace[p];
        Vector3 place = Vector3::Zero();
        for (Index i = 0; i < 3; ++i)
        {
          place += result.quads.sourceWeights[p][i] * mesh.position[mesh.origin[3 * f + i]];
        }
        ASSERT_LE(
          (place - result.quads.points[p]).norm(), 1e-6 * result.surface.boundingBoxDiagonal);
      }
      for (const QuadLine& line : result.quads.lines)
      {
        EXPECT_TRUE(mesh.isConstrained(line.halfEdge));
        const Vector3 along = result.quads.points[line.b] - result.quads.points[line.a];
        EXPECT_EQ(line.boundary, mesh.isBoundary(line.halfEdge));
        EXPECT_GT(along.norm(), 0);
      }
    }
  }
}

TEST(Similarities, PointsOnVerticesHaveTheInputsOwnNumbers)
{
  const Vector3 shift(1234567.1, -7654321.9, 0.1234567);
  const SurfaceInput input = moved(
    test::toInput(test::unitCube(12)),
    [&](const Vector3& p) { return Vector3(1.23456789 * p + shift); }, false);
  const RemeshResult result = quadsOf(input, 600);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  std::size_t corners = 0;
  for (const Vector3& p : result.quads.points)
  {
    corners += std::find(input.points.begin(), input.points.end(), p) != input.points.end() ? 1 : 0;
  }
  EXPECT_GE(corners, 8U); // those of the cube
}

TEST(Similarities, AnEdgeLengthIsInUnitsOfTheInput)
{
  const Vector3 shift = Vector3::Constant(1e6);
  const SurfaceInput input = moved(
    test::toInput(test::sphere(4)), [&](const Vector3& p) { return Vector3(50 * p + shift); },
    false);
  RemeshOptions options;
  options.edgeLength = 7.3;
  const RemeshResult result = remesh(input, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(result.targetEdgeLength, 7.3);
  const double wanted = 4 * 3.14159 * 50 * 50 / (7.3 * 7.3);
  EXPECT_NEAR(static_cast<double>(result.quads.quads.size()), wanted, 0.15 * wanted);
}

} // namespace
} // namespace quadrille
