// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Sizes/CornerCurvatures.h"

#include "Base/Parallel.h"

#include <algorithm>
#include <cstddef>

namespace quadrille
{
namespace
{

/// Of a place in a triangle of the input, the weights of the corners as KnownCurvature has them.
struct KnownPlace
{
  const KnownCurvature& known;
  std::array<double, 3> weights{};

  KnownPlace(const PreparedSurface& surface, const SourceLocation& at)
    : known(surface.curvatures[at.polygon])
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto* found = std::find(known.points.begin(), known.points.end(), at.points[k]);
      const auto corner = static_cast<std::size_t>(found - known.points.begin());
      weights[corner % 3] += found == known.points.end() ? kNotKnown : at.weights[k];
    }
  }

  float ofSurface() const
  {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k)
    {
      sum += weights[k] * known.atCorner[k];
    }
    return static_cast<float>(sum);
  }

  float ofSide() const
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      if (std::abs(weights[k]) < kRoundingOfSingle)
      {
        return known.alongSide[(k + 1) % 3];
      }
    }
    return kNotKnown;
  }
};

} // namespace

CornerCurvatures cornerCurvatures(const PreparedSurface& surface, int threads)
{
  CornerCurvatures result;
  if (surface.curvatures.empty())
  {
    return result;
  }
  const Mesh& mesh = surface.mesh;
  result.atCorner.resize(mesh.halfEdgeCount());
  result.along.assign(mesh.halfEdgeCount(), kNotKnown);
  parallelForEach<Index>(mesh.faceCount(), kMediumChunk, threads,
    [&](Index f)
    {
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        const std::array<double, 3> corner = cornerWeight(h);
        result.atCorner[h] = KnownPlace(surface, surface.locate(f, corner)).ofSurface();
        if (mesh.isConstrained(h))
        {
          const std::array<double, 3> next = cornerWeight(Mesh::next(h));
          const std::array<double, 3> middle{ (corner[0] + next[0]) / 2, (corner[1] + next[1]) / 2,
            (corner[2] + next[2]) / 2 };
          result.along[h] = KnownPlace(surface, surface.locate(f, middle)).ofSide();
        }
      }
    });
  return result;
}

} // namespace quadrille
