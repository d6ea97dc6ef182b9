// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What strips do to an integer map, and the faces that they cross.
#pragma once

#include "Integers/IntegerMap.h"
#include "Integers/StripSearch.h"
#include "Integers/UvMesh.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// Makes the steps of a strip, or takes them back.
void apply(IntegerMap& map, const Strip& strip);
void revert(IntegerMap& map, const Strip& strip);

/// Applies and returns the change of energy.
double applyMeasured(IntegerMap& map, const Strip& strip);

/// The faces on both sides of a strip's steps.
struct CrossedFaces
{
  std::vector<Index> faces; ///< each once
  bool repeated = false;    ///< whether the strip crosses one of them twice
};

CrossedFaces crossedFaces(const UvMesh& mesh, const Strip& strip);

/// Of all the faces together.
inline std::int64_t brokenness(const IntegerMap& map, const std::vector<Index>& faces)
{
  std::int64_t sum = 0;
  for (const Index f : faces)
  {
    sum += IntegerMap::brokenness(map.determinant(f));
  }
  return sum;
}

/// The faces at a vertex, ascending.
std::vector<Index> facesAround(const UvMesh& mesh, Index v);

} // namespace quadrille
