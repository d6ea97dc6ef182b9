// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/CrossField.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <functional>
#include <utility>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

/// A plane, positive on the side of its normal.
struct LinePlane
{
  Vector3 normal;
  double offset;

  double at(const Vector3& p) const { return normal.dot(p) - offset; }
};

/// The closed line along which a plane cuts a closed mesh, with the positive side on its left; the mesh has no vertex
/// on the plane.
FieldLine lineAlong(const Mesh& mesh, const LinePlane& plane)
{
  const auto entersHere = [&](Index h)
  {
    return plane.at(mesh.position[mesh.origin[h]]) > 0 &&
      plane.at(mesh.position[mesh.target(h)]) < 0;
  };
  Index first = 0;
  while (!entersHere(first))
  {
    ++first;
  }
  // The half-edge by which the line is entered goes down, the one by which it is left goes up.
  FieldLine line;
  const auto addDirection = [&](Index f)
  { line.along.emplace_back(faceNormal(mesh, f).cross(plane.normal)); };
  Index entry = first;
  do
  {
    const Index out = plane.at(mesh.position[mesh.origin[Mesh::previous(entry)]]) > 0
      ? Mesh::next(entry)
      : Mesh::previous(entry);
    addDirection(Mesh::face(entry));
    line.crossed.push_back(out);
    entry = mesh.twin[out];
  } while (entry != first);
  addDirection(Mesh::face(first));
  return line;
}

/// Sums of 4 - valence on both sides of a plane.
std::pair<int, int> indicesBeside(const Mesh& mesh, const CrossField& field, const LinePlane& plane)
{
  std::pair<int, int> sums{ 0, 0 };
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    (plane.at(mesh.position[v]) > 0 ? sums.first : sums.second) += 4 - field.turns[v];
  }
  return sums;
}

std::vector<LinePlane> planes()
{
  const Vector3 slanted = Vector3(0.3, -0.5, 0.81).normalized();
  return { { slanted, 0.01 }, { slanted, 0.31 }, { slanted, 0.61 }, { slanted, 0.81 },
    { Vector3(0.9, 0.2, -0.4).normalized(), 0.71 } };
}

CrossFieldOptions optionsWith(const std::vector<FieldLine>& lines)
{
  CrossFieldOptions options;
  options.targetEdgeLength = 0.1;
  options.lines = lines;
  return options;
}

TEST(FieldLines, EachSideOfAClosedLineIsADisk)
{
  const Mesh mesh = sphere(4);
  for (const LinePlane& plane : planes())
  {
    const FieldLine line = lineAlong(mesh, plane);
    const CrossField field = computeCrossField(mesh, optionsWith({ line }));
    ASSERT_TRUE(field.status.ok()) << field.status.message;
    int rotation = 0;
    for (const Index h : line.crossed)
    {
      rotation += field.matching[h];
    }
    EXPECT_EQ(rotation % 4, 0);
    // A line of the quads' edges that closes is a straight boundary of both: 4 chi each.
    EXPECT_EQ(indicesBeside(mesh, field, plane), std::pair(4, 4)) << plane.offset;
  }
}

TEST(FieldLines, ChangeNothingWhereThereAreNone)
{
  const Mesh mesh = sphere(3);
  const CrossField field = computeCrossField(mesh, optionsWith({}));
  CrossFieldOptions options = optionsWith({});
  options.regular.assign(mesh.vertexCount(), 0);
  const CrossField same = computeCrossField(mesh, options);
  EXPECT_EQ(field.angle, same.angle);
  EXPECT_EQ(field.matching, same.matching);
}

TEST(FieldLines, ThatCrossBothClose)
{
  const Mesh mesh = sphere(4);
  const LinePlane a{ Vector3(1, 0.03, 0.02).normalized(), 0.203 };
  const LinePlane b{ Vector3(0.02, 1, 0.03).normalized(), -0.302 };
  const std::vector<FieldLine> lines{ lineAlong(mesh, a), lineAlong(mesh, b) };
  const CrossField field = computeCrossField(mesh, optionsWith(lines));
  ASSERT_TRUE(field.status.ok()) << field.status.message;
  EXPECT_EQ(indicesBeside(mesh, field, a), std::pair(4, 4));
  EXPECT_EQ(indicesBeside(mesh, field, b), std::pair(4, 4));
}

TEST(FieldLines, ValencesThatNoSideCanHaveAreInfeasible)
{
  const Mesh mesh = sphere(4);
  const LinePlane plane = planes()[2];
  CrossFieldOptions options = optionsWith({ lineAlong(mesh, plane) });
  options.targetValences.assign(mesh.vertexCount(), 0);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    options.targetValences[v] = plane.at(mesh.position[v]) > 0 ? 4 : 0;
  }
  EXPECT_EQ(computeCrossField(mesh, options).status.code, StatusCode::Infeasible);
  options.lines.clear();
  EXPECT_TRUE(computeCrossField(mesh, options).status.ok());
}

TEST(FieldLines, IrregularVerticesLeaveWhereTheyAreInTheWay)
{
  const Mesh mesh = sphere(4);
  const CrossField without = computeCrossField(mesh, optionsWith({}));
  CrossFieldOptions options = optionsWith({});
  options.regular.assign(mesh.vertexCount(), 0);
  Index irregular = 0;
  while (without.turns[irregular] == 4)
  {
    ++irregular;
  }
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    options.regular[v] =
      (mesh.position[v] - mesh.position[irregular]).norm() < 1.5 * options.targetEdgeLength;
  }
  const CrossField field = computeCrossField(mesh, options);
  ASSERT_TRUE(field.status.ok()) << field.status.message;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    EXPECT_TRUE(options.regular[v] == 0 || field.turns[v] == 4) << v;
  }
}

} // namespace
} // namespace quadrille
