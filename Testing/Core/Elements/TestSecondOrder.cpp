// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "TestMeshes.h"

#include "Base/Error.h"
#include "Elements/QuadraticShape.h"
#include "Elements/SecondOrder.h"
#include "Elements/SurfaceSection.h"
#include "Quads/QuadShape.h"

#include <Eigen/LU>

#include <gtest/gtest.h>

#include <set>

namespace quadrille::test
{
namespace
{

SurfacePoint atVertex(const Mesh& mesh, Index v)
{
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.origin[h] == v)
    {
      SurfacePoint point{ Mesh::face(h), {} };
      point.weights[h % 3] = 1;
      return point;
    }
  }
  ADD_FAILURE() << "no face at vertex " << v;
  return {};
}

Index vertexAt(const Mesh& mesh, const Vector3& p)
{
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    if ((mesh.position[v] - p).norm() < 1e-9)
    {
      return v;
    }
  }
  ADD_FAILURE() << "no vertex at " << p.transpose();
  return 0;
}

/// columns x rows quads (closed in u, and if asked in v), whose corners are vertices of the surface.
QuadsOnSurface gridQuads(const Mesh& mesh, int columns, int rows, bool closedV,
  const std::function<Vector3(double u, double v)>& position)
{
  QuadsOnSurface result;
  const int lines = closedV ? rows : rows + 1;
  for (int j = 0; j < lines; ++j)
  {
    for (int i = 0; i < columns; ++i)
    {
      const Index v =
        vertexAt(mesh, position(static_cast<double>(i) / columns, static_cast<double>(j) / rows));
      result.points.push_back(mesh.position[v]);
      result.places.push_back(atVertex(mesh, v));
    }
  }
  const auto point = [&](int i, int j)
  { return static_cast<Index>(j % lines * columns + i % columns); };
  for (int j = 0; j < rows; ++j)
  {
    for (int i = 0; i < columns; ++i)
    {
      result.quads.push_back(
        { point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1) });
    }
  }
  return result;
}

QuadraticNodes nodesOf(
  const QuadsOnSurface& quads, const SecondOrderNodes& nodes, Index q, bool hasCentre)
{
  QuadraticNodes x{};
  for (std::size_t i = 0; i < 4; ++i)
  {
    x[i] = quads.points[quads.quads[q][i]];
    x[4 + i] = nodes.points[nodes.edgesOfQuad[q][i]];
  }
  x[8] = hasCentre ? nodes.points[nodes.edges.size() + q] : Vector3::Zero();
  return x;
}

/// The determinants from the polynomials that go through the nodes, found by solving for their coefficients, and not
/// from formulas for shape functions.
double leastByInterpolation(const QuadraticNodes& x, int nodes)
{
  const auto powers = [nodes](double u, double v)
  {
    Eigen::VectorXd p(nodes);
    p.head(8) << 1, u, v, u * u, u * v, v * v, u * u * v, u * v * v;
    if (nodes == 9)
    {
      p[8] = u * u * v * v;
    }
    return p;
  };
  const std::array<std::array<double, 2>, 9> at{ { { -1, -1 }, { 1, -1 }, { 1, 1 }, { -1, 1 },
    { 0, -1 }, { 1, 0 }, { 0, 1 }, { -1, 0 }, { 0, 0 } } };
  Eigen::MatrixXd system(nodes, nodes), values(nodes, 3);
  for (int i = 0; i < nodes; ++i)
  {
    const auto k = static_cast<std::size_t>(i);
    system.row(i) = powers(at[k][0], at[k][1]).transpose();
    values.row(i) = x[k].transpose();
  }
  const Eigen::MatrixXd coefficients = system.fullPivLu().solve(values);
  const Vector3 normal = (x[2] - x[0]).cross(x[3] - x[1]).normalized();
  double least = std::numeric_limits<double>::infinity();
  for (const Vector2& place : jacobianPlaces(nodes))
  {
    // Central differences of polynomials of degree two in each variable are exact.
    const auto value = [&](double u, double v) -> Vector3
    { return coefficients.transpose() * powers(u, v); };
    const double u = place.x(), v = place.y();
    const Vector3 along = (value(u + 0.5, v) - value(u - 0.5, v));
    const Vector3 across = (value(u, v + 0.5) - value(u, v - 0.5));
    least = std::min(least, normal.dot(along.cross(across)));
  }
  return least;
}

void expectGood(const Mesh& mesh, const QuadsOnSurface& quads, const SecondOrderNodes& nodes)
{
  const bool hasCentres = nodes.points.size() > nodes.edges.size();
  for (Index q = 0; q < quads.quads.size(); ++q)
  {
    EXPECT_GT(leastByInterpolation(nodesOf(quads, nodes, q, hasCentres), hasCentres ? 9 : 8), 0)
      << q;
  }
  for (std::size_t n = 0; n < nodes.points.size(); ++n)
  {
    if (nodes.kinds[n] != NodePlace::MovedOff)
    {
      EXPECT_LT((positionOf(mesh, nodes.places[n]) - nodes.points[n]).norm(), 1e-14);
    }
  }
}

SecondOrderNodes placed(const Mesh& mesh, const QuadsOnSurface& quads, int count, int threads = 1)
{
  SecondOrderOptions options;
  options.nodes = count;
  options.threads = threads;
  return placeSecondOrderNodes(mesh, quads, options);
}

TEST(QuadraticShape, IsThatOfThePolynomialsThroughTheNodes)
{
  const QuadraticNodes x{ Vector3{ 0, 0, 0 }, Vector3{ 2, 0.1, 0.2 }, Vector3{ 2.2, 1.5, 0.1 },
    Vector3{ -0.3, 1.2, 0 }, Vector3{ 1.1, -0.2, 0.3 }, Vector3{ 2.3, 0.8, 0.2 },
    Vector3{ 0.9, 1.6, 0.4 }, Vector3{ -0.2, 0.5, 0.1 }, Vector3{ 1, 0.7, 0.5 } };
  for (const int nodes : { 8, 9 })
  {
    const double least = QuadraticShape(nodes).leastDeterminant(x);
    EXPECT_NEAR(least, leastByInterpolation(x, nodes), 1e-12);
    EXPECT_GT(std::abs(least), 0.01);
  }
}

TEST(QuadraticShape, OfAStraightRectangleIsAQuarterOfItsArea)
{
  QuadraticNodes x{ Vector3{ 0, 0, 0 }, Vector3{ 3, 0, 0 }, Vector3{ 3, 2, 0 }, Vector3{ 0, 2, 0 },
    Vector3{ 1.5, 0, 0 }, Vector3{ 3, 1, 0 }, Vector3{ 1.5, 2, 0 }, Vector3{ 0, 1, 0 },
    Vector3{ 1.5, 1, 0 } };
  EXPECT_NEAR(QuadraticShape(8).leastDeterminant(x), 1.5, 1e-14);
  EXPECT_NEAR(QuadraticShape(9).leastDeterminant(x), 1.5, 1e-14);
  x[4].x() = 0.75; // a quarter point: the determinant vanishes at the corner
  EXPECT_NEAR(QuadraticShape(8).leastDeterminant(x), 0, 1e-14);
}

/// On a cylinder the plane of an edge round it cuts the facets in a polygon whose middle, by symmetry, is a vertex.
TEST(SecondOrder, NodesOfACylinderLieOnItsCircles)
{
  const double kHeight = 2;
  const auto position = [=](double u, double v)
  { return Vector3(std::cos(2 * kPi * u), std::sin(2 * kPi * u), kHeight * v); };
  const Mesh mesh = parametricGrid(240, 24, false, position);
  const QuadsOnSurface quads = gridQuads(mesh, 24, 4, false, position);
  for (const int count : { 8, 9 })
  {
    const SecondOrderNodes nodes = placed(mesh, quads, count);
    EXPECT_TRUE(nodes.byNearest.empty());
    EXPECT_TRUE(nodes.withoutCurve.empty());
    EXPECT_TRUE(nodes.invertedQuads.empty());
    ASSERT_EQ(nodes.edges.size(), 24u * 5 + 24 * 4);
    for (std::size_t n = 0; n < nodes.points.size(); ++n)
    {
      EXPECT_EQ(nodes.kinds[n], NodePlace::Surface);
      // Vertices lie on the circle; the height is that of the middle.
      EXPECT_NEAR(nodes.points[n].head<2>().norm(), 1, 1e-12);
      if (n < nodes.edges.size())
      {
        const auto [a, b] = nodes.edges[n];
        EXPECT_NEAR(nodes.points[n].z(), (quads.points[a].z() + quads.points[b].z()) / 2, 1e-12);
      }
    }
    expectGood(mesh, quads, nodes);
  }
}

/// The middle of an edge of a sphere lies near that of the great circle: the plane of the edge is tilted, as corners at
/// vertices are an edge of the facets off, and the arc rises by 0.18 above its chord.
TEST(SecondOrder, NodesOfASphereLieOnGreatCircles)
{
  const Mesh mesh = sphere(5);
  double edge = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    edge = std::max(edge, mesh.edgeVector(h).norm());
  }
  // A cube blown up: its corners and the centres of its edges at the nearest vertices.
  QuadsOnSurface quads;
  const Mesh cube = unitCube(1);
  const auto nearest = [&](const Vector3& p)
  {
    Index best = 0;
    for (Index v = 0; v < mesh.vertexCount(); ++v)
    {
      best = (mesh.position[v] - p).norm() < (mesh.position[best] - p).norm() ? v : best;
    }
    return best;
  };
  for (const Vector3& p : cube.position)
  {
    const Index v = nearest((p - Vector3(0.5, 0.5, 0.5)).normalized());
    quads.points.push_back(mesh.position[v]);
    quads.places.push_back(atVertex(mesh, v));
  }
  const auto corner = [&](double x, double y, double z) { return vertexAt(cube, { x, y, z }); };
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const int side : { 0, 1 })
    {
      std::array<Index, 4> quad{};
      const std::array<std::array<int, 2>, 4> ring{ { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } } };
      for (std::size_t i = 0; i < 4; ++i)
      {
        Vector3 p;
        p[axis] = side;
        p[(axis + 1) % 3] = ring[i][0];
        p[(axis + 2) % 3] = ring[i][1];
        quad[side == 1 ? i : 3 - i] = corner(p.x(), p.y(), p.z());
      }
      quads.quads.push_back(quad);
    }
  }
  const SecondOrderNodes nodes = placed(mesh, quads, 9);
  ASSERT_EQ(nodes.edges.size(), 12u);
  EXPECT_TRUE(nodes.byNearest.empty());
  for (std::size_t n = 0; n < 12; ++n)
  {
    const auto [a, b] = nodes.edges[n];
    const Vector3 middle = (quads.points[a] + quads.points[b]).normalized();
    EXPECT_LT((nodes.points[n] - middle).norm(), 0.18 * edge);
    EXPECT_LE(nodes.points[n].norm(), 1 + 1e-14);
    EXPECT_GE(
      nodes.points[n].norm(), std::cos(edge / std::sqrt(3.0))); // what facets leave of the radius
  }
  expectGood(mesh, quads, nodes);
}

/// A box: a node on a sharp edge lies on it, though the surface goes down on both sides.
TEST(SecondOrder, NodesOfFeaturesLieOnThem)
{
  const Mesh mesh = unitCube(6); // no flags: the dihedral angle leads along the edges
  QuadsOnSurface quads;
  for (const Vector3& p : std::vector<Vector3>{
         { 0, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 }, { 0, 0, 0 }, { 1, 0, 0 } })
  {
    const Index v = vertexAt(mesh, p);
    quads.points.push_back(mesh.position[v]);
    quads.places.push_back(atVertex(mesh, v));
  }
  quads.quads = { { 0, 1, 2, 3 }, { 4, 5, 1, 0 } };
  quads.featureEdges = { 0b1111, 0b1111 };
  const SecondOrderNodes nodes = placed(mesh, quads, 8);
  // Edges of one quad count as boundary of the quads, and the closed cube has none to go along.
  std::vector<Index> boundary;
  for (Index e = 0; e < nodes.edges.size(); ++e)
  {
    if (nodes.onBoundary[e])
    {
      boundary.push_back(e);
    }
    const auto [a, b] = nodes.edges[e];
    EXPECT_LT((nodes.points[e] - (quads.points[a] + quads.points[b]) / 2).norm(), 1e-12);
  }
  EXPECT_EQ(boundary.size(), 6u);
  EXPECT_EQ(nodes.withoutCurve, boundary);
}

/// A bent crease: the nodes lie on the polyline, in its middle, not where the straight way over the faces goes.
TEST(SecondOrder, FollowsABentCrease)
{
  // A disc of radius 1 on a cylinder: the rim is a feature, and a way over the flat disc would be shorter.
  constexpr int kAround = 48;
  const auto position = [](double u, double v)
  {
    const double r = v <= 0.5 ? 2 * v : 1;
    const double z = v <= 0.5 ? 0 : -(v - 0.5);
    return Vector3(
      (0.1 + 0.9 * r) * std::cos(2 * kPi * u), (0.1 + 0.9 * r) * std::sin(2 * kPi * u), z);
  };
  const Mesh mesh = parametricGrid(kAround, 20, false, position);
  QuadsOnSurface quads = gridQuads(mesh, 6, 2, false, position);
  for (auto& q : quads.quads)
  {
    std::reverse(q.begin(), q.end()); // the normals of the mesh do not matter for the curve
  }
  quads.featureEdges.assign(quads.quads.size(), 0);
  for (std::size_t q = 0; q < quads.quads.size(); ++q)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      const Vector3 a = quads.points[quads.quads[q][i]];
      const Vector3 b = quads.points[quads.quads[q][(i + 1) % 4]];
      if (std::abs(a.head<2>().norm() - 1) < 1e-9 && std::abs(b.head<2>().norm() - 1) < 1e-9 &&
        a.z() == 0 && b.z() == 0)
      {
        quads.featureEdges[q] = static_cast<std::uint8_t>(quads.featureEdges[q] | 1U << i);
      }
    }
  }
  const SecondOrderNodes nodes = placed(mesh, quads, 8);
  int onRim = 0;
  for (Index e = 0; e < nodes.edges.size(); ++e)
  {
    const Vector3 a = quads.points[nodes.edges[e][0]], b = quads.points[nodes.edges[e][1]];
    if (a.z() == 0 && b.z() == 0 && std::abs(a.norm() - 1) < 1e-9 && std::abs(b.norm() - 1) < 1e-9)
    {
      ++onRim;
      EXPECT_LT((nodes.points[e] - (a + b).normalized()).norm(), 1e-12); // a vertex, by symmetry
    }
  }
  EXPECT_EQ(onRim, 6);
  EXPECT_TRUE(nodes.withoutCurve.empty());
}

/// One quad on a trapezoid 20 wide at the top, 14 at the bottom and 10 high, whose bottom has a spike: the vertex
/// `column` of 20 lies `depth` below.
struct SpikedTrapezoid
{
  Mesh mesh = gridPlane(20, 10);
  QuadsOnSurface quads;

  SpikedTrapezoid(int column, double depth)
  {
    const std::array<Index, 4> corners{ vertexAt(mesh, { 0, 0, 0 }), vertexAt(mesh, { 20, 0, 0 }),
      vertexAt(mesh, { 20, 10, 0 }), vertexAt(mesh, { 0, 10, 0 }) };
    const Index spike = vertexAt(mesh, { static_cast<double>(column), 0, 0 });
    for (Vector3& p : mesh.position.editAll())
    {
      p.x() = 10 + (p.x() - 10) * (0.7 + 0.03 * p.y());
    }
    mesh.position.edit()[spike].y() = -depth;
    for (const Index v : corners)
    {
      quads.points.push_back(mesh.position[v]);
      quads.places.push_back(atVertex(mesh, v));
    }
    quads.quads = { { 0, 1, 2, 3 } };
  }
};

/// The middle by length would be on the way back from the spike, and the element folded.
TEST(SecondOrder, LongDetoursOfACurveDoNotShiftItsMiddle)
{
  const SpikedTrapezoid c(2, 8);
  const SecondOrderNodes nodes = placed(c.mesh, c.quads, 9);
  EXPECT_EQ(nodes.kinds, std::vector<NodePlace>(5, NodePlace::Surface));
  EXPECT_LT((nodes.points[0] - Vector3(10, 0, 0)).norm(), 1e-12);
  expectGood(c.mesh, c.quads, nodes);
}

/// With the spike in the middle the tangents at the corners go down steeply, and the sides lean over them.
TEST(SecondOrder, MovesNodesBackAlongTheCurve)
{
  const SpikedTrapezoid c(10, 12); // deeper, the way round the other sides would be shorter
  for (const int count : { 8, 9 })
  {
    const SecondOrderNodes nodes = placed(c.mesh, c.quads, count);
    EXPECT_EQ(nodes.kinds[0], NodePlace::MovedAlong);
    EXPECT_LT((nodes.points[0] - Vector3(10, 0, 0)).norm(), 1); // a side of the spike is that near
    for (std::size_t e = 1; e < 4; ++e)
    {
      EXPECT_EQ(nodes.kinds[e], NodePlace::Surface);
    }
    expectGood(c.mesh, c.quads, nodes);
  }
}

/// Where the curve comes no nearer to the straight edge than its ends, the node leaves it.
TEST(SecondOrder, MovesNodesOffWhereNothingElseHelps)
{
  // A disc that hangs below a trapezoid by a narrow neck.
  std::vector<Vector3> points{ { -0.1, 0, 0 }, { 0.1, 0, 0 }, { 0.3, 0.2, 0 }, { -0.3, 0.2, 0 },
    { 0, -1, 0 } };
  std::vector<Triangle> triangles{ { 0, 1, 2 }, { 0, 2, 3 }, { 4, 1, 0 } };
  constexpr int kAround = 40;
  const double neck = std::asin(0.1);
  Index last = 0;
  for (int i = 1; i < kAround; ++i)
  {
    const double angle = neck + i * (2 * kPi - 2 * neck) / kAround; // from A down and round to B
    points.emplace_back(-std::sin(angle), -1 + std::cos(angle), 0);
    triangles.push_back({ 4, last, static_cast<Index>(points.size() - 1) });
    last = static_cast<Index>(points.size() - 1);
  }
  triangles.push_back({ 4, last, 1 });
  const Mesh mesh = makeMesh(points, triangles);
  QuadsOnSurface quads;
  for (Index v = 0; v < 4; ++v)
  {
    quads.points.push_back(mesh.position[v]);
    quads.places.push_back(atVertex(mesh, v));
  }
  quads.quads = { { 0, 1, 2, 3 } };
  const SecondOrderNodes nodes = placed(mesh, quads, 8);
  EXPECT_EQ(nodes.kinds[0], NodePlace::MovedOff);
  expectGood(mesh, quads, nodes);
}

/// Two sheets near each other: a node must not land on the other one.
TEST(SecondOrder, StaysOnItsSheetOfAThinWall)
{
  const auto wave = [](double u, double v)
  {
    // Closed in u: out along the upper side, back along the lower one, a hundredth below.
    const double x = u < 0.5 ? 2 * u : 2 - 2 * u;
    const double z = 0.3 * std::sin(kPi * x) - (u < 0.5 ? 0 : 0.01);
    return Vector3(x, 2 * v, z);
  };
  const Mesh mesh = parametricGrid(80, 20, false, wave);
  const QuadsOnSurface quads = gridQuads(mesh, 8, 2, false, wave);
  const SecondOrderNodes nodes = placed(mesh, quads, 8);
  for (Index q = 0; q < quads.quads.size(); ++q)
  {
    const bool isUpper = q % 8 < 4;
    for (const Index edge : nodes.edgesOfQuad[q])
    {
      const Vector3& p = nodes.points[edge];
      if (p.x() > 0.05 && p.x() < 0.95)
      {
        EXPECT_NEAR(p.z() - 0.3 * std::sin(kPi * p.x()), isUpper ? 0 : -0.01,
          0.004); // facets: 0.3 (pi / 40)^2 / 8
      }
    }
  }
  EXPECT_TRUE(nodes.byNearest.empty());
}

TEST(SecondOrder, DoesNotDependOnThreads)
{
  const auto position = [](double u, double v)
  {
    const double r = 1 + 0.4 * std::cos(2 * kPi * v);
    return Vector3(
      r * std::cos(2 * kPi * u), r * std::sin(2 * kPi * u), 0.4 * std::sin(2 * kPi * v));
  };
  const Mesh mesh = parametricGrid(120, 60, true, position);
  const QuadsOnSurface quads = gridQuads(mesh, 40, 20, true, position);
  const SecondOrderNodes one = placed(mesh, quads, 9, 1);
  const SecondOrderNodes three = placed(mesh, quads, 9, 3);
  ASSERT_EQ(one.edges.size(), 2 * quads.quads.size()); // closed, chi 0
  EXPECT_EQ(one.edges, three.edges);
  EXPECT_EQ(one.points, three.points);
  EXPECT_EQ(one.kinds, three.kinds);
  expectGood(mesh, quads, one);
}

TEST(SecondOrder, NamesQuadsWhoseCornersAloneAreInverted)
{
  const Mesh mesh = gridPlane(10, 10);
  double side = 0;
  for (const Vector3& p : mesh.position)
  {
    side = std::max(side, p.x());
  }
  QuadsOnSurface quads;
  for (const Vector3& p : std::vector<Vector3>{
         { 0, 0, 0 }, { side, 0, 0 }, { 0.2 * side, 0.2 * side, 0 }, { 0, side, 0 } })
  {
    const Index v = vertexAt(mesh, p);
    quads.points.push_back(mesh.position[v]);
    quads.places.push_back(atVertex(mesh, v));
  }
  quads.quads = { { 0, 1, 2, 3 } };
  const SecondOrderNodes nodes = placed(mesh, quads, 8);
  EXPECT_EQ(nodes.invertedQuads, std::vector<Index>{ 0 });
}

TEST(SecondOrder, RefusesWhatDoesNotFit)
{
  const Mesh mesh = gridPlane(2, 2);
  QuadsOnSurface quads;
  EXPECT_THROW(placed(mesh, quads, 7), InvalidInput);
  quads.points = { mesh.position[0] };
  EXPECT_THROW(placed(mesh, quads, 8), InvalidInput); // no place
  quads.places = { atVertex(mesh, 0) };
  quads.quads = { { 0, 0, 0, 1 } };
  EXPECT_THROW(placed(mesh, quads, 8), InvalidInput);
}

} // namespace
} // namespace quadrille::test
