// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces/RemeshInPieces.h"

#include "Base/Error.h"
#include "MeshInput.h"
#include "PiecesChecks.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

class InputTriangles : public TriangleSource
{
public:
  explicit InputTriangles(SurfaceInput input) : input_(std::move(input)) {}

  SurfaceInput& input() { return input_; }
  std::size_t pointCount() const override { return input_.points.size(); }
  std::size_t triangleCount() const override { return input_.polygonOffsets.size() - 1; }
  void corners(std::size_t begin, std::size_t end, Index* ids) const override
  {
    std::copy(input_.polygonPoints.begin() + static_cast<std::ptrdiff_t>(3 * begin),
      input_.polygonPoints.begin() + static_cast<std::ptrdiff_t>(3 * end), ids);
  }
  void positions(const Index* ids, std::size_t count, Vector3* places) const override
  {
    std::transform(ids, ids + count, places, [this](Index id) { return input_.points[id]; });
  }

private:
  SurfaceInput input_;
};

PiecesOptions piecesOf(std::size_t triangles)
{
  PiecesOptions pieces;
  pieces.trianglesOfPiece = triangles;
  return pieces;
}

/// The Euler characteristic of quads whose edges have two quads at most.
long long eulerOfQuads(const QuadMesh& mesh)
{
  std::map<std::pair<Index, Index>, int> edges;
  for (const std::array<Index, 4>& quad : mesh.quads)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      EXPECT_LE(++edges[std::minmax(quad[i], quad[(i + 1) % 4])], 2);
    }
  }
  return static_cast<long long>(mesh.points.size()) - static_cast<long long>(edges.size()) +
    static_cast<long long>(mesh.quads.size());
}

TEST(RemeshInPieces, TorusOfManyPieces)
{
  InputTriangles source(toInput(torus(160, 80, 2, 1)));
  const PiecesResult made = remeshInPieces(source, askForQuads(500), piecesOf(2000));
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  EXPECT_GT(made.pieces, 8U);
  EXPECT_LT(made.joinedTriangles, source.triangleCount());
  EXPECT_TRUE(made.remeshed.certificate.valid());
  EXPECT_NEAR(static_cast<double>(made.remeshed.quads.quads.size()), 500, 100);
  EXPECT_EQ(eulerOfQuads(made.remeshed.quads), 0);
  expectPlacesOfSources(made, source.input());
}

TEST(RemeshInPieces, TheSameForAnyNumberOfThreads)
{
  InputTriangles source(toInput(torus(160, 80, 2, 1)));
  const PiecesResult one = remeshInPieces(source, askForQuads(400, 1), piecesOf(3000));
  const PiecesResult four = remeshInPieces(source, askForQuads(400, 4), piecesOf(3000));
  ASSERT_EQ(one.remeshed.quads.quads, four.remeshed.quads.quads);
  EXPECT_EQ(one.remeshed.quads.points, four.remeshed.quads.points);
  for (std::size_t v = 0; v < one.pointSource.size(); ++v)
  {
    EXPECT_EQ(one.pointSource[v].polygon, four.pointSource[v].polygon);
    EXPECT_EQ(one.pointSource[v].weights, four.pointSource[v].weights);
  }
}

TEST(RemeshInPieces, EdgesOfACubeStaySharp)
{
  InputTriangles source(toInput(unitCube(40)));
  const PiecesResult made = remeshInPieces(source, askForQuads(600), piecesOf(1500));
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  EXPECT_GT(made.pieces, 6U);
  // All eight corners are points of the quads, and each edge of the cube is a line of them.
  const QuadMesh& quads = made.remeshed.quads;
  double length = 0;
  for (const QuadLine& line : quads.lines)
  {
    length += (quads.points[line.a] - quads.points[line.b]).norm();
  }
  EXPECT_NEAR(length, 12, 1e-6);
  std::size_t corners = 0;
  for (const Vector3& p : quads.points)
  {
    corners += ((p - Vector3::Constant(0.5)).cwiseAbs() - Vector3::Constant(0.5)).norm() < 1e-6;
  }
  EXPECT_EQ(corners, 8U);
}

TEST(RemeshInPieces, AnOpenSurfaceKeepsItsBoundary)
{
  InputTriangles source(toInput(gridPlane(90, 90)));
  const PiecesResult made = remeshInPieces(source, askForQuads(300), piecesOf(2500));
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  EXPECT_GT(made.pieces, 4U);
  EXPECT_EQ(eulerOfQuads(made.remeshed.quads), 1);
  expectPlacesOfSources(made, source.input());
}

/// Two halves whose points along the cut are in the same places and are not the same, as parts that were put together.
TEST(RemeshInPieces, BoundariesInTheSamePlaceAreJoined)
{
  SurfaceInput whole = toInput(torus(160, 80, 2, 1));
  std::map<Index, Index> copies;
  for (std::size_t f = 0; f + 1 < whole.polygonOffsets.size(); ++f)
  {
    Vector3 middle = Vector3::Zero();
    for (std::size_t i = 0; i < 3; ++i)
    {
      middle += whole.points[whole.polygonPoints[3 * f + i]] / 3;
    }
    for (std::size_t i = 0; i < 3 && middle.y() < 0; ++i)
    {
      Index& corner = whole.polygonPoints.edit()[3 * f + i];
      const auto [copy, isNew] = copies.emplace(corner, static_cast<Index>(whole.points.size()));
      if (isNew)
      {
        const Vector3 place = whole.points[corner];
        whole.points.push_back(place);
      }
      corner = copy->second;
    }
  }
  InputTriangles source(std::move(whole));
  const PiecesResult made = remeshInPieces(source, askForQuads(500), piecesOf(2000));
  ASSERT_TRUE(made.remeshed.status.ok()) << made.remeshed.status.message;
  EXPECT_EQ(eulerOfQuads(made.remeshed.quads), 0);
  EXPECT_TRUE(std::none_of(made.remeshed.quads.onBoundary.begin(),
    made.remeshed.quads.onBoundary.end(), [](std::uint8_t on) { return on != 0; }));
}

TEST(RemeshInPieces, RefusesWhatIsNoSurface)
{
  const auto messageOf = [](TriangleSource& source)
  {
    try
    {
      remeshInPieces(source, askForQuads(100), piecesOf(1000));
    }
    catch (const InvalidInput& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  InputTriangles outOfRange(toInput(sphere(4)));
  outOfRange.input().polygonPoints.edit()[300] = 123456;
  EXPECT_NE(messageOf(outOfRange).find("polygon 100 uses point 123456"), std::string::npos);
  InputTriangles notFinite(toInput(sphere(4)));
  notFinite.input().points.edit()[7].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(messageOf(notFinite).find("point 7 has a coordinate"), std::string::npos);
  SurfaceInput nothing;
  nothing.polygonOffsets = { 0 };
  InputTriangles empty(nothing);
  EXPECT_NE(messageOf(empty).find("0 triangles"), std::string::npos);
  InputTriangles good(toInput(sphere(4)));
  EXPECT_THROW(remeshInPieces(good, askForQuads(100), piecesOf(10)), InvalidInput);
}

/// Sizes that no array here could have: refused by their numbers, before anything is read.
TEST(RemeshInPieces, RefusesMoreThanNumbersTell)
{
  class Fake : public TriangleSource
  {
  public:
    Fake(std::size_t points, std::size_t triangles) : points_(points), triangles_(triangles) {}
    std::size_t pointCount() const override { return points_; }
    std::size_t triangleCount() const override { return triangles_; }
    void corners(std::size_t, std::size_t, Index*) const override { ADD_FAILURE(); }
    void positions(const Index*, std::size_t, Vector3*) const override { ADD_FAILURE(); }

  private:
    std::size_t points_, triangles_;
  };
  for (const auto& [points, triangles] : { std::pair<std::size_t, std::size_t>(10, 0xffffffffU),
         { 0xffffffffU, 10 }, { 0x100000003U, 10 }, { 10, 0x100000003U } })
  {
    EXPECT_THROW(remeshInPieces(Fake(points, triangles), askForQuads(100)), InvalidInput);
  }
}

TEST(RemeshInPieces, StopsOnRequest)
{
  InputTriangles source(toInput(torus(160, 80, 2, 1)));
  for (const double at : { 0.0, 0.2, 0.7, 0.9 })
  {
    RemeshOptions options = askForQuads(500);
    bool hasAsked = false;
    options.progress = [&](double fraction, const std::string&)
    {
      hasAsked = hasAsked || fraction >= at;
      return !hasAsked;
    };
    const PiecesResult made = remeshInPieces(source, options, piecesOf(2000));
    EXPECT_EQ(made.remeshed.status.code, StatusCode::Cancelled) << at;
    EXPECT_TRUE(made.remeshed.quads.quads.empty());
  }
}

TEST(RemeshInPieces, TellsWhereMemoryIsShort)
{
  InputTriangles source(toInput(torus(160, 80, 2, 1)));
  RemeshOptions options = askForQuads(500);
  options.memoryLimit = 1e6;
  const PiecesResult made = remeshInPieces(source, options, piecesOf(2000));
  EXPECT_EQ(made.remeshed.status.code, StatusCode::TooLarge);
  EXPECT_NE(made.remeshed.status.message.find("of memory would be needed"), std::string::npos);
}

} // namespace
} // namespace quadrille
