// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Surfaces and questions that the tests of sessions share.
#pragma once

#include "Session/Session.h"

#include "MeshInput.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace quadrille::test
{

/// A sphere with dents, so that nothing is a tie. No features.
inline SurfaceInput dents()
{
  Mesh mesh = sphere(4);
  for (Vector3& p : mesh.position.editAll())
  {
    p *= 1 + 0.15 * std::sin(4 * p.x()) * std::cos(3 * p.y() + p.z());
  }
  return toInput(mesh);
}

inline RemeshOptions sessionOptions(std::size_t quads)
{
  RemeshOptions options;
  options.quads = quads;
  options.coarseVertices = 200;
  options.threads = 2;
  return options;
}

inline bool hasRun(const SessionReport& report, const std::string& stage)
{
  return std::any_of(report.stages.begin(), report.stages.end(),
    [&](const StageRecord& record) { return record.stage == stage; });
}

/// Bit by bit.
inline bool areSame(const QuadMesh& a, const QuadMesh& b)
{
  return a.quads == b.quads && a.points.size() == b.points.size() &&
    std::memcmp(a.points.data(), b.points.data(), a.points.size() * sizeof(Vector3)) == 0;
}

/// By place.
using PlaceValences = std::map<Vector3, int, PlaceOrder>;
inline PlaceValences valencesOf(const SessionResult& result)
{
  PlaceValences valences;
  for (const IrregularVertex& vertex : result.irregular)
  {
    valences[vertex.place] = vertex.valence;
  }
  return valences;
}

/// Of (4 - valence) over the quads' points; on boundaries 3 is regular.
inline int indexSum(const QuadMesh& quads)
{
  int sum = 0;
  for (std::size_t i = 0; i < quads.points.size(); ++i)
  {
    sum += 4 - quads.valence[i] - (quads.onBoundary[i] != 0 ? 1 : 0);
  }
  return sum;
}

/// The valence of the quads exactly at a place; 0 where none of their points is.
inline int quadValenceAt(const QuadMesh& quads, const Vector3& p)
{
  for (std::size_t i = 0; i < quads.points.size(); ++i)
  {
    if ((quads.points[i] - p).norm() < 1e-9)
    {
      return quads.valence[i];
    }
  }
  return 0;
}

/// The point of the input farthest from all irregular vertices.
inline Vector3 emptiestPlace(const Session& session, const std::vector<IrregularVertex>& irregular)
{
  Vector3 best = Vector3::Zero();
  double farthest = -1;
  for (const Vector3& p : session.surface().points)
  {
    double nearest = 1e300;
    for (const IrregularVertex& vertex : irregular)
    {
      nearest = std::min(nearest, (vertex.place - p).norm());
    }
    if (nearest > farthest)
    {
      farthest = nearest;
      best = p;
    }
  }
  return best;
}

} // namespace quadrille::test
