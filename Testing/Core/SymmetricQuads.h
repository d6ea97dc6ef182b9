// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What all symmetric quads have.
#pragma once

#include "Evaluation/QuadQuality.h"
#include "NearestPoint.h"
#include "Symmetry/Symmetry.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace quadrille::test
{

using Quad = std::array<Index, 4>;

/// The same for quads that differ by the first corner only.
inline Quad fromLowest(Quad quad)
{
  std::rotate(quad.begin(), std::min_element(quad.begin(), quad.end()), quad.end());
  return quad;
}

inline RemeshOptions aboutQuads(std::size_t quads)
{
  RemeshOptions options;
  options.quads = quads;
  options.threads = 2;
  options.coarseVertices = 300;
  return options;
}

inline SymmetryOptions about(const Vector3& origin, const Vector3& normal)
{
  return { MirrorPlane{ origin, normal } };
}

inline Vector3 placeOf(const SourceLocation& location, const SurfaceInput& input)
{
  Vector3 place = Vector3::Zero();
  for (std::size_t i = 0; i < 3; ++i)
  {
    place += location.weights[i] * input.points[location.points[i]];
  }
  return place;
}

/// The permutation is an involution and maps quads to quads, turned round.
inline void expectSymmetricConnectivity(const SymmetricResult& made)
{
  const QuadMesh& quads = made.remeshed.quads;
  const std::vector<Index>& image = made.mirrorPoint;
  ASSERT_EQ(image.size(), quads.points.size());
  for (Index p = 0; p < image.size(); ++p)
  {
    ASSERT_LT(image[p], image.size());
    ASSERT_EQ(image[image[p]], p);
    EXPECT_EQ(quads.valence[image[p]], quads.valence[p]);
    EXPECT_EQ(quads.onBoundary[image[p]], quads.onBoundary[p]);
  }
  std::set<Quad> all;
  for (const Quad& quad : quads.quads)
  {
    EXPECT_TRUE(all.insert(fromLowest(quad)).second);
  }
  for (const Quad& quad : quads.quads)
  {
    const Quad turned{ image[quad[0]], image[quad[3]], image[quad[2]], image[quad[1]] };
    EXPECT_EQ(all.count(fromLowest(turned)), 1U);
  }
}

/// The plane's curve is an isoline: no quad lies on both sides.
inline void expectPlaneOnEdges(const SymmetricResult& made)
{
  const QuadMesh& quads = made.remeshed.quads;
  for (std::size_t q = 0; q < quads.quads.size(); ++q)
  {
    std::size_t inPlane = 0;
    for (const Index p : quads.quads[q])
    {
      inPlane += made.mirrorPoint[p] == p ? 1 : 0;
    }
    EXPECT_LE(inPlane, 3U);
  }
  for (Index p = 0; p < quads.points.size(); ++p)
  {
    if (made.mirrorPoint[p] == p)
    {
      // Rounding of a coordinate.
      EXPECT_LE(std::abs(made.plane.height(quads.points[p])), 1e-12 * made.diagonal);
    }
  }
}

inline void expectExactImages(const SymmetricResult& made)
{
  const std::vector<Vector3>& points = made.remeshed.quads.points;
  double worst = 0;
  for (Index p = 0; p < points.size(); ++p)
  {
    worst = std::max(worst, (made.plane.image(points[p]) - points[made.mirrorPoint[p]]).norm());
  }
  EXPECT_LE(worst, 1e-12 * made.diagonal);
  EXPECT_EQ(made.movedPoints, 0U);
}

/// Each point is where its source says.
inline void expectSources(
  const SymmetricResult& made, const SurfaceInput& input, double tolerance = 2e-9)
{
  const QuadMesh& quads = made.remeshed.quads;
  ASSERT_EQ(made.pointSources.size(), quads.points.size());
  ASSERT_EQ(made.quadPolygons.size(), quads.quads.size());
  for (std::size_t p = 0; p < quads.points.size(); ++p)
  {
    const SourceLocation& source = made.pointSources[p];
    EXPECT_LE((placeOf(source, input) - quads.points[p]).norm(), tolerance * made.diagonal);
    for (const Index id : source.points)
    {
      const auto begin = input.polygonPoints.begin() + input.polygonOffsets[source.polygon];
      const auto end = input.polygonPoints.begin() + input.polygonOffsets[source.polygon + 1];
      EXPECT_NE(std::find(begin, end, id), end);
    }
  }
}

inline void expectWhole(const SymmetricResult& made, long long euler, bool closed)
{
  const QuadQuality quality = evaluateQuads(made.remeshed.quads.points, made.remeshed.quads.quads);
  EXPECT_TRUE(quality.manifold);
  EXPECT_EQ(quality.closed, closed);
  EXPECT_EQ(quality.eulerCharacteristic, euler);
  EXPECT_EQ(quality.nonPositiveJacobians, 0U);
  EXPECT_TRUE(made.remeshed.certificate.valid()) << made.remeshed.certificate.text();
  EXPECT_EQ(made.remeshed.certificate.triangles, made.remeshed.surface.mesh.faceCount());
  EXPECT_EQ(validate(made.remeshed.surface.mesh), "");
}

inline Mesh turned(Mesh mesh, const Vector3& axis, double angle, const Vector3& shift)
{
  const Eigen::AngleAxisd turn(angle, axis.normalized());
  for (Vector3& p : mesh.position.editAll())
  {
    p = turn * p + shift;
  }
  return mesh;
}

/// Three axes of different lengths, and a bump, so that x is the only mirror plane.
inline Mesh lopsidedEllipsoid(int level)
{
  Mesh mesh = sphere(level);
  for (Vector3& p : mesh.position.editAll())
  {
    const double bump = 0.25 * std::exp(-8 * (p - Vector3(0, 0.6, 0.8)).squaredNorm());
    p = (1 + bump) * Vector3(p.x(), 1.6 * p.y() + 0.2 * p.z(), 1.2 * p.z());
  }
  return mesh;
}

inline Mesh withNoise(Mesh mesh, double size)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> offset(-size, size);
  for (Vector3& p : mesh.position.editAll())
  {
    p += Vector3(offset(random), offset(random), offset(random));
  }
  return mesh;
}

inline bool hasNotice(const SymmetricResult& made, const std::string& text)
{
  const std::vector<std::string>& notices = made.remeshed.notices;
  return std::any_of(notices.begin(), notices.end(),
    [&](const std::string& notice) { return notice.find(text) != std::string::npos; });
}

} // namespace quadrille::test
