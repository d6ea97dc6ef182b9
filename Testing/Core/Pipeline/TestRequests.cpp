// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Guides and target valences from the input to the quads.
#include "Base/Angles.h"
#include "Pipeline/Pipeline.h"

#include "MeshInput.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

/// Mean angle, weighted by length, of the quads' edges to the cross of `direction` at their middles, where `wants` it.
double meanAngle(const QuadMesh& quads, const std::function<bool(const Vector3&)>& wants,
  const std::function<Vector3(const Vector3&)>& direction)
{
  double sum = 0, length = 0;
  for (const std::array<Index, 4>& quad : quads.quads)
  {
    const Vector3 n = (quads.points[quad[2]] - quads.points[quad[0]])
                        .cross(quads.points[quad[3]] - quads.points[quad[1]])
                        .normalized();
    for (std::size_t i = 0; i < 4; ++i)
    {
      const Vector3& a = quads.points[quad[i]];
      const Vector3& b = quads.points[quad[(i + 1) % 4]];
      const Vector3 p = (a + b) / 2;
      if (wants(p))
      {
        const Vector3 d = direction(p);
        const double angle = std::atan2(d.cross(b - a).dot(n), d.dot(b - a));
        sum += (b - a).norm() * std::abs(angle - kPi / 2 * std::round(angle / (kPi / 2)));
        length += (b - a).norm();
      }
    }
  }
  EXPECT_GT(length, 0);
  return sum / length;
}

TEST(Requests, GuidesTurnTheQuadsOfATorus)
{
  const Mesh mesh = torus(160, 80);
  RemeshOptions options;
  options.quads = 1500;
  options.featureAngle.reset();
  options.threads = 2;
  options.coarseVertices = 300;
  const auto inside = [](const Vector3& p) { return p.x() > 0 && p.z() > 0; };
  const auto helix = [](const Vector3& p)
  {
    const Vector3 around = Vector3(-p.y(), p.x(), 0).normalized();
    const Vector3 out = (p - Vector3(p.x(), p.y(), 0).normalized()).normalized();
    return Vector3(around + out.cross(around));
  };
  SurfaceInput input = toInput(mesh);
  const RemeshResult without = remesh(input, options);
  ASSERT_TRUE(without.status.ok()) << without.status.message;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Vector3& p = mesh.position[mesh.origin[3 * f]];
    input.guideDirections.push_back(inside(p) ? helix(p) : Vector3(0, 0, 0));
  }
  const RemeshResult with = remesh(input, options);
  ASSERT_TRUE(with.status.ok()) << with.status.message;
  EXPECT_TRUE(with.certificate.valid());
  EXPECT_FALSE(with.coarse.guides.empty());
  // Without guides the quads run along the circles, 45 degrees off.
  EXPECT_GT(meanAngle(without.quads, inside, helix), 35 * kPi / 180);
  EXPECT_LT(meanAngle(with.quads, inside, helix), 5 * kPi / 180);
}

/// All round a torus, where nothing is in the way: a helix of 30 degrees is no direction of its field, but there are
/// maps along it.
TEST(Requests, AHelixRoundATorusIsFollowed)
{
  const Mesh mesh = torus(120, 60);
  RemeshOptions options;
  options.quads = 1000;
  options.featureAngle.reset();
  options.threads = 2;
  options.coarseVertices = 300;
  const auto helix = [](const Vector3& p)
  {
    const Vector3 around = Vector3(-p.y(), p.x(), 0).normalized();
    const Vector3 out = (p - Vector3(p.x(), p.y(), 0).normalized()).normalized();
    return Vector3(std::cos(kPi / 6) * around + std::sin(kPi / 6) * out.cross(around));
  };
  SurfaceInput input = toInput(mesh);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    input.guideDirections.push_back(helix(mesh.position[mesh.origin[3 * f]]));
  }
  const RemeshResult result = remesh(input, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(result.certificate.valid());
  double sum = 0, length = 0; // over the family of edges that is to follow it
  for (const std::array<Index, 4>& quad : result.quads.quads)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      const Vector3 edge = result.quads.points[quad[(i + 1) % 4]] - result.quads.points[quad[i]];
      const Vector3 d = helix(result.quads.points[quad[i]] + edge / 2);
      const double angle = std::atan2(d.cross(edge).norm(), std::abs(d.dot(edge)));
      sum += angle < kPi / 4 ? angle * edge.norm() : 0;
      length += angle < kPi / 4 ? edge.norm() : 0;
    }
  }
  // 2 degrees; a map that does not know its guides is 9 off.
  EXPECT_LT(sum / length, 3.5 * kPi / 180);
  options.threads = 1;
  const RemeshResult again = remesh(input, options);
  EXPECT_EQ(again.quads.points, result.quads.points);
}

/// On a side of a cube, whose edges hold the field, aslant by 40 degrees: one family of the quads follows over all of
/// the stroke, whether that has a radius or not.
TEST(Requests, AStrokeIsFollowedOnASideOfACube)
{
  SurfaceInput input = toInput(unitCube(1));
  RemeshOptions options;
  options.quads = 2400;
  options.threads = 2;
  const Vector3 along(std::cos(radians(40)), std::sin(radians(40)), 0);
  const Vector3 middle(0.5, 0.5, 1);
  for (const double radius : { 0.0, 0.075 })
  {
    StrokeRequest stroke;
    stroke.points = { middle - 0.2 * along, middle + 0.2 * along };
    stroke.radius = radius;
    input.drawn.strokes = { stroke };
    const RemeshResult result = remesh(input, options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_TRUE(result.certificate.valid());
    double sum = 0;
    int quads = 0;
    for (const std::array<Index, 4>& quad : result.quads.quads)
    {
      std::array<Vector3, 4> p;
      for (std::size_t i = 0; i < 4; ++i)
      {
        p[i] = result.quads.points[quad[i]];
      }
      const Vector3 off = (p[0] + p[1] + p[2] + p[3]) / 4 - middle;
      if (std::abs(off.dot(along)) < 0.2 && (off - off.dot(along) * along).norm() < 0.05)
      {
        const auto angle = [&](const Vector3& side)
        { return angleBetween(side, side.dot(along) < 0 ? -along : along); };
        sum += std::min(angle(p[1] + p[2] - p[0] - p[3]), angle(p[2] + p[3] - p[0] - p[1]));
        ++quads;
      }
    }
    EXPECT_GT(quads, 5);
    EXPECT_LT(sum / quads, radians(5)) << radius;
  }
}

TEST(Requests, CurvatureGuidesAQuarterOfAnEllipse)
{
  // Half of an elliptic cylinder, cut askew at both ends: by its boundaries alone the quads would follow the cuts.
  Mesh mesh = gridPlane(60, 60);
  for (Vector3& p : mesh.position.editAll())
  {
    const double angle = kPi * p.x() / 60;
    p = Vector3(std::cos(angle), 0.7 * std::sin(angle), p.y() / 15 + 0.8 * std::cos(angle));
  }
  RemeshOptions options;
  options.quads = 600;
  options.threads = 2;
  options.featureAngle.reset();
  const auto inside = [](const Vector3& p) { return p.y() > 0.3 && p.z() > 1.2 && p.z() < 2.8; };
  const auto axis = [](const Vector3&) { return Vector3(0, 0, 1); };
  const RemeshResult without = remesh(toInput(mesh), options);
  options.curvatureGuides = 0.3;
  const RemeshResult with = remesh(toInput(mesh), options);
  ASSERT_TRUE(without.status.ok() && with.status.ok()) << with.status.message;
  EXPECT_LT(meanAngle(with.quads, inside, axis), 0.5 * meanAngle(without.quads, inside, axis));
}

/// The valence of the quad vertex at exactly this place, or 0.
int valenceAt(const QuadMesh& quads, const Vector3& p)
{
  for (std::size_t i = 0; i < quads.points.size(); ++i)
  {
    if (quads.points[i] == p)
    {
      return quads.valence[i];
    }
  }
  return 0;
}

TEST(Requests, ValencesComeOutAtTheirPoints)
{
  const Mesh mesh = torus(120, 60);
  RemeshOptions options;
  options.quads = 1200;
  options.featureAngle.reset();
  options.threads = 2;
  options.coarseVertices = 400;
  SurfaceInput input = toInput(mesh);
  input.targetValences.assign(input.points.size(), 0);
  const std::map<Index, int> requests{ { 1000, 3 }, { 1031, 5 }, { 5010, 5 }, { 4003, 3 } };
  for (const auto& [point, valence] : requests)
  {
    input.targetValences[point] = valence;
  }
  const RemeshResult result = remesh(input, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(result.certificate.valid());
  for (const auto& [point, valence] : requests)
  {
    EXPECT_EQ(valenceAt(result.quads, input.points[point]), valence) << "point " << point;
  }
  for (const std::string& notice : result.notices)
  {
    EXPECT_EQ(notice.find("valence"), std::string::npos) << notice;
  }
}

/// All opposite sides of a box have the same number of quads, which no pair of irregular vertices on one side allows.
TEST(Requests, AValenceOnASideOfACubeCostsNoFeatures)
{
  SurfaceInput input = toInput(unitCube(12));
  RemeshOptions options;
  options.quads = 2400;
  options.featureAngle = kPi / 4;
  options.coarseVertices = 300;
  for (const auto& [place, valence] :
    { std::pair(Vector3(0.5, 0.5, 1), 3), { { 0.75, 0.25, 1 }, 5 } })
  {
    input.drawn.valences = { { place, valence } };
    const RemeshResult result = remesh(input, options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    const QuadMesh& quads = result.quads;
    double length = 0;
    for (const QuadLine& line : quads.lines)
    {
      length += (quads.points[line.a] - quads.points[line.b]).norm();
    }
    EXPECT_NEAR(length, 12, 1e-6);
    std::vector<int> irregular;
    for (Index p = 0; p < quads.points.size(); ++p)
    {
      const bool isCorner = ((quads.points[p].array() - 0.5).abs() > 0.499).all();
      if (quads.valence[p] != kRegularValence && !isCorner)
      {
        irregular.push_back(quads.valence[p]);
      }
    }
    EXPECT_EQ(valenceAt(quads, place), valence);
    std::sort(irregular.begin(), irregular.end());
    EXPECT_EQ(irregular, std::vector<int>({ 3, 3, 5, 5 }));
    EXPECT_TRUE(std::any_of(result.notices.begin(), result.notices.end(),
      [](const std::string& text)
      { return text.find("a single irregular vertex does not fit") != std::string::npos; }));
  }
}

TEST(Requests, InfeasibleValencesAreAnErrorWithTheSum)
{
  const Mesh mesh = sphere(4);
  RemeshOptions options;
  options.quads = 300;
  options.featureAngle.reset();
  options.coarseVertices = 100;
  SurfaceInput input = toInput(mesh);
  input.targetValences.assign(input.points.size(), 4);
  const RemeshResult result = remesh(input, options);
  EXPECT_EQ(result.status.code, StatusCode::Infeasible);
  EXPECT_NE(result.status.message.find("has to sum up to 8"), std::string::npos)
    << result.status.message;
  EXPECT_NE(result.status.message.find("missing 8"), std::string::npos);
  EXPECT_EQ(
    result.coarse.mesh.vertexCount(), 100u); // more vertices could not help and were not tried
  EXPECT_TRUE(result.quads.quads.empty());
}

TEST(Requests, DroppedOnesAreTold)
{
  const Mesh mesh = sphere(4);
  RemeshOptions options;
  options.quads = 300;
  options.featureAngle.reset();
  SurfaceInput input = toInput(mesh);
  input.guideDirections.assign(mesh.faceCount(), Vector3::Zero());
  input.guideDirections[17] = faceNormal(mesh, 17);
  const RemeshResult result = remesh(input, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  ASSERT_FALSE(result.notices.empty());
  EXPECT_NE(result.notices.front().find("normal to them"), std::string::npos);
}

} // namespace
} // namespace quadrille
