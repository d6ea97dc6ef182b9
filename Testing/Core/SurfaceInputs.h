// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Inputs for the tests of surface preparation, and what must hold for every prepared surface.
#pragma once

#include "Base/Error.h"
#include "Mesh/Surface.h"
#include "MeshInput.h"
#include "Prepare/Prepare.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

namespace quadrille::test
{

inline SurfaceInput makeInput(
  std::vector<Vector3> points, const std::vector<std::vector<Index>>& polygons)
{
  SurfaceInput input;
  input.points = std::move(points);
  input.polygonOffsets.push_back(0);
  for (const std::vector<Index>& polygon : polygons)
  {
    input.polygonPoints.append(polygon.begin(), polygon.end());
    input.polygonOffsets.push_back(static_cast<Index>(input.polygonPoints.size()));
  }
  return input;
}

/// Each triangle with points of its own, as an STL file has them.
inline SurfaceInput toSoup(const Mesh& mesh)
{
  SurfaceInput input = toInput(mesh);
  input.points.clear();
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    input.points.push_back(mesh.position[mesh.origin[h]]);
    input.polygonPoints.edit()[h] = h;
  }
  return input;
}

/// Turns over every face that a fixed sequence of coin tosses says.
inline SurfaceInput withRandomOrientation(SurfaceInput input)
{
  std::mt19937 random(7);
  for (std::size_t i = 0; i + 2 < input.polygonPoints.size(); i += 3)
  {
    if (random() % 2 == 0)
    {
      std::swap(input.polygonPoints.edit()[i + 1], input.polygonPoints.edit()[i + 2]);
    }
  }
  return input;
}

inline PreparedSurface prepare(
  const SurfaceInput& input, std::optional<double> featureAngle = std::nullopt, int threads = 1)
{
  PrepareOptions options;
  options.featureAngle = featureAngle;
  options.threads = threads;
  return prepareSurface(input, options);
}

inline std::string messageOf(const std::function<void()>& call)
{
  try
  {
    call();
  }
  catch (const InvalidInput& error)
  {
    return error.what();
  }
  return {};
}

inline bool contains(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

/// Both half-edges of a feature count.
inline Index featureHalfEdges(const Mesh& mesh)
{
  Index count = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    count += mesh.isFeature(h) ? 1 : 0;
  }
  return count;
}

inline double area(const Mesh& mesh)
{
  double sum = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); h += 3)
  {
    sum += mesh.edgeVector(h).cross(mesh.edgeVector(h + 1)).norm() / 2;
  }
  return sum;
}

inline double signedVolume(const Mesh& mesh)
{
  double volume = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); h += 3)
  {
    volume += mesh.position[mesh.origin[h]].dot(
      mesh.position[mesh.origin[h + 1]].cross(mesh.position[mesh.origin[h + 2]]));
  }
  return volume / 6;
}

/// Where the sources say that corner `corner` of face f of the surface lies on the input's points.
inline Vector3 cornerOnInput(
  const PreparedSurface& surface, const std::vector<Vector3>& points, Index f, std::size_t corner)
{
  std::array<double, 3> weights{};
  weights[corner] = 1;
  const SourceLocation location = surface.locate(f, weights);
  Vector3 p = Vector3::Zero();
  for (std::size_t k = 0; k < 3; ++k)
  {
    p += location.weights[k] * points[location.points[k]];
  }
  return p;
}

/// A valid mesh, and sources that lead from every corner back to the same place on the input.
inline void expectSound(const PreparedSurface& surface, const SurfaceInput& input)
{
  EXPECT_EQ(validate(surface.mesh), "");
  ASSERT_EQ(surface.sourcePolygon.size(), surface.mesh.faceCount());
  ASSERT_EQ(surface.sourcePoints.size(), surface.mesh.faceCount());
  EXPECT_EQ(surface.components, summarizeTopology(surface.mesh).components);
  double worst = 0;
  for (Index f = 0; f < surface.mesh.faceCount(); ++f)
  {
    EXPECT_LT(surface.sourcePolygon[f], input.polygonOffsets.size() - 1);
    for (std::size_t corner = 0; corner < 3; ++corner)
    {
      const Vector3 p = cornerOnInput(surface, input.points, f, corner);
      const Index v = surface.mesh.origin[3 * f + static_cast<Index>(corner)];
      worst = std::max(worst, (p - surface.mesh.position[v]).norm());
    }
  }
  // A few roundings of coordinates about the size of the box.
  EXPECT_LE(worst, 1e-12 * surface.boundingBoxDiagonal);
}

} // namespace quadrille::test
