// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What quads of a surface have to keep that was thinned out before they were made.
#pragma once

#include "Pieces/RemeshInPieces.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace quadrille::test
{

inline RemeshOptions askForQuads(std::size_t quads, int threads = 1)
{
  RemeshOptions options;
  options.quads = quads;
  options.threads = threads;
  return options;
}

/// Points lie where their sources say, and the triangle is one of the surface.
inline void expectPlacesOfSources(const PiecesResult& made, const SurfaceInput& input)
{
  const QuadMesh& quads = made.remeshed.quads;
  ASSERT_EQ(made.pointSource.size(), quads.points.size());
  ASSERT_EQ(made.quadSource.size(), quads.quads.size());
  for (std::size_t v = 0; v < quads.points.size(); ++v)
  {
    const SourceLocation& at = made.pointSource[v];
    ASSERT_LT(at.polygon, input.polygonOffsets.size() - 1);
    const auto corners = input.polygonPoints.begin() + 3 * static_cast<std::ptrdiff_t>(at.polygon);
    Vector3 place = Vector3::Zero();
    for (std::size_t k = 0; k < 3; ++k)
    {
      EXPECT_NE(std::find(corners, corners + 3, at.points[k]), corners + 3);
      EXPECT_GE(at.weights[k], 0);
      place += at.weights[k] * input.points[at.points[k]];
    }
    EXPECT_LT((place - quads.points[v]).norm(), 1e-12);
  }
}

} // namespace quadrille::test
