// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMaps.h"

#include "Base/Error.h"
#include "Extraction/Extraction.h"
#include "ForeignMaps/MapSnapping.h"
#include "ForeignMaps/MapWelding.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <tuple>

namespace quadrille::test
{
namespace
{

/// Every corner with a point of its own.
MappedTriangles soupOf(const GridMapCase& c)
{
  MappedTriangles soup;
  for (Index h = 0; h < c.mesh.halfEdgeCount(); ++h)
  {
    soup.corners.push_back(h);
    soup.position.push_back(c.mesh.position[c.mesh.origin[h]]);
    soup.uv.push_back(toDouble(c.uv[h]));
  }
  return soup;
}

/// A point for each vertex and image, as for point texture coordinates.
MappedTriangles splitAtSeams(const GridMapCase& c)
{
  MappedTriangles split;
  std::map<std::tuple<Index, std::int64_t, std::int64_t>, Index> ids;
  std::vector<Index> firstCorner;
  for (Index h = 0; h < c.mesh.halfEdgeCount(); ++h)
  {
    const auto [found, isNew] = ids.emplace(
      std::make_tuple(c.mesh.origin[h], c.uv[h].u, c.uv[h].v), static_cast<Index>(ids.size()));
    if (isNew)
    {
      split.position.push_back(c.mesh.position[c.mesh.origin[h]]);
      firstCorner.push_back(h);
    }
    split.corners.push_back(found->second);
    split.uv.push_back(toDouble(c.uv[h]));
  }
  const std::vector<FixedVec2> uv = c.uv;
  split.sameData = [uv, firstCorner](Index p, Index q)
  { return uv[firstCorner[p]] == uv[firstCorner[q]]; };
  return split;
}

void expectSameSurface(const GridMapCase& c, const Mesh& welded)
{
  EXPECT_EQ(validate(welded), "");
  const TopologySummary wanted = summarizeTopology(c.mesh);
  const TopologySummary found = summarizeTopology(welded);
  EXPECT_EQ(found.vertices, wanted.vertices);
  EXPECT_EQ(found.edges, wanted.edges);
  EXPECT_EQ(found.components, wanted.components);
  EXPECT_EQ(found.boundaryLoops, wanted.boundaryLoops);
  EXPECT_EQ(found.eulerCharacteristic, wanted.eulerCharacteristic);
  EXPECT_EQ(welded.twin, c.mesh.twin);
}

/// Two triangles (0, 0) (1, 0) (1, 1) (0, 1) of the plane spanned by x and y at `from`.
void addSquare(MappedTriangles& triangles, const Vector3& from, const Vector3& x, const Vector3& y,
  const Vector2& uv)
{
  const Index first = static_cast<Index>(triangles.position.size());
  for (const auto& [i, j] : { std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1) })
  {
    triangles.position.push_back(from + i * x + j * y);
  }
  for (const Index corner : { 0U, 1U, 2U, 0U, 2U, 3U })
  {
    const int i = corner == 1 || corner == 2 ? 1 : 0;
    const int j = corner >= 2 ? 1 : 0;
    triangles.corners.push_back(first + corner);
    triangles.uv.push_back(uv + Vector2(i, j));
  }
}

MappedTriangles asSoup(const MappedTriangles& shared)
{
  MappedTriangles soup;
  soup.uv = shared.uv;
  for (const Index p : shared.corners)
  {
    soup.corners.push_back(static_cast<Index>(soup.position.size()));
    soup.position.push_back(shared.position[p]);
  }
  return soup;
}

std::string weldingRefusal(const MappedTriangles& triangles)
{
  try
  {
    weldMap(triangles);
  }
  catch (const InvalidInput& error)
  {
    return error.what();
  }
  return {};
}

} // namespace

TEST(MapWelding, SoupsAndSeamsBecomeTheSurface)
{
  Random random(41);
  for (GridMapCase& c : allCases(2))
  {
    SCOPED_TRACE(c.name);
    MapEditor editor(c);
    editor.refine(random, 200);
    editor.shuffleCharts(random);
    for (std::size_t v = 0; v < c.mesh.position.size(); ++v)
    {
      c.mesh.position.edit()[v] +=
        1e-6 * static_cast<double>(v) * Vector3(1, 2, 3); // no two at one place
    }
    expectSameSurface(c, weldMap(soupOf(c)));
    const Mesh welded = weldMap(splitAtSeams(c));
    expectSameSurface(c, welded);
    const SnapResult snapped = snapMap(welded, splitAtSeams(c).uv);
    EXPECT_EQ(snapped.uv, c.uv);
  }
}

// Two squares side by side whose common edge is there twice.
TEST(MapWelding, KeepsSlitsThatTheFileTells)
{
  MappedTriangles squares;
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY();
  addSquare(squares, Vector3::Zero(), x, y, { 0, 0 });
  addSquare(squares, x, x, y, { 1, 0 });
  const auto components = [](const MappedTriangles& triangles)
  { return summarizeTopology(weldMap(triangles)).components; };
  std::vector<Vector2> pointUv(8);
  for (std::size_t h = 0; h < squares.corners.size(); ++h)
  {
    pointUv[squares.corners[h]] = squares.uv[h];
  }
  squares.sameData = [&pointUv](Index p, Index q) { return pointUv[p] == pointUv[q]; };
  EXPECT_EQ(components(squares), 2u);
  pointUv[5] += Vector2(1, 0); // not on the common edge
  EXPECT_EQ(components(squares), 2u);
  // A reason for copies at one end is one for the edge: a seam may end at the other.
  pointUv[4] += Vector2(1, 0);
  EXPECT_EQ(components(squares), 1u);
  pointUv[4] -= Vector2(1, 0);
  // Without vertices in the file there is nothing to tell a slit by.
  EXPECT_EQ(components(asSoup(squares)), 1u);
}

// Two sheets cross: four triangles at one edge, told apart by their images.
TEST(MapWelding, SheetsThatMeetAtAnEdgeStayApart)
{
  MappedTriangles sheets;
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY(), z = Vector3::UnitZ();
  addSquare(sheets, -x, x, y, { 0, 0 });
  addSquare(sheets, Vector3::Zero(), x, y, { 1, 0 });
  addSquare(sheets, -z, z, y, { 7.5, 0 });
  addSquare(sheets, Vector3::Zero(), z, y, { 8.5, 0 });
  const MappedTriangles equal = asSoup(sheets);
  EXPECT_EQ(summarizeTopology(weldMap(equal)).components, 2u);
  MappedTriangles whole = equal; // all four images fit each other, only equal ones tell
  for (std::size_t h = 12; h < 24; ++h)
  {
    whole.uv[h] += Vector2(0.5, 0);
  }
  EXPECT_EQ(summarizeTopology(weldMap(whole)).components, 2u);
  MappedTriangles fitting = equal; // charts of their own: whole translations between them
  for (std::size_t h = 6; h < 12; ++h)
  {
    fitting.uv[h] += Vector2(3, -2);
    fitting.uv[h + 12] += Vector2(-4, 5);
  }
  EXPECT_EQ(summarizeTopology(weldMap(fitting)).components, 2u);
  MappedTriangles unclear = fitting;
  for (std::size_t h = 12; h < 24; ++h)
  {
    unclear.uv[h] += Vector2(0.5, 0);
  }
  EXPECT_NE(weldingRefusal(unclear).find("meet at one edge"), std::string::npos)
    << weldingRefusal(unclear);
}

TEST(MapWelding, FansThatTouchInAPointStayApart)
{
  MappedTriangles squares;
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY();
  addSquare(squares, Vector3::Zero(), x, y, { 0, 0 });
  addSquare(squares, x + y, x, y, { 1, 1 });
  const Mesh mesh = weldMap(asSoup(squares));
  EXPECT_EQ(validate(mesh), "");
  EXPECT_EQ(summarizeTopology(mesh).components, 2u);
  EXPECT_EQ(mesh.vertexCount(), 8u);
}

TEST(MapWelding, RefusesGarbage)
{
  MappedTriangles good;
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY();
  addSquare(good, Vector3::Zero(), x, y, { 0, 0 });
  EXPECT_EQ(weldingRefusal(good), "");
  MappedTriangles bad = good;
  bad.position[2].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(weldingRefusal(bad).find("point 2"), std::string::npos);
  bad = good;
  bad.corners[4] = 9;
  EXPECT_NE(weldingRefusal(bad).find("cell 1"), std::string::npos);
  bad = good;
  bad.position[3] = bad.position[2];
  EXPECT_NE(weldingRefusal(bad).find("cell 1"), std::string::npos);
  bad = good;
  bad.uv.pop_back();
  EXPECT_FALSE(weldingRefusal(bad).empty());
  bad = good;
  std::swap(bad.corners[1], bad.corners[2]);
  std::swap(bad.uv[1], bad.uv[2]);
  EXPECT_NE(weldingRefusal(bad).find("orient"), std::string::npos);
  EXPECT_NE(weldingRefusal(asSoup(bad)).find("orient"), std::string::npos);
}

} // namespace quadrille::test
