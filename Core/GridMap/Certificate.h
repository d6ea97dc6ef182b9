// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The exact check of a map on corners, and what follows from its uv: transitions and their rotations.
#pragma once

#include "Base/FixedPoint.h"
#include "Mesh/Mesh.h"

#include <string>
#include <vector>

namespace quadrille
{

constexpr std::size_t kWorstFaces = 16;

/// Why a map is, or is not, an integer-grid map. All counts are zero for a valid one.
struct Certificate
{
  std::size_t triangles = 0;
  std::size_t withoutMap =
    0; ///< triangles beside, in faces that were filled with quads without a map
  std::size_t notPositive = 0;   ///< triangles with !(det > 0)
  std::size_t wrongTurns = 0;    ///< vertices whose winding is not the expected one
  std::size_t seamResiduals = 0; ///< edges whose two images differ by more than a transition
  std::size_t offAxes = 0;       ///< constrained edges that are not parallel to an axis
  std::size_t offIsolines = 0;   ///< constrained edges that do not lie on an integer isoline
  std::size_t offIntegers = 0;   ///< integer vertices (singular, corner, end) not at integer points
  std::size_t fractionalTransitions = 0; ///< transitions whose translation is not whole
  double minimumDeterminant = 0; ///< smallest det(u, v edges), in quads^2 (twice the uv area)
  double area = 0;               ///< total uv area in quads: the number of quads to expect
  std::vector<Index> worstFaces; ///< up to kWorstFaces faces, smallest determinant first

  bool seamless() const
  {
    return notPositive == 0 && wrongTurns == 0 && seamResiduals == 0 && offAxes == 0;
  }
  bool valid() const
  {
    return seamless() && offIsolines == 0 && offIntegers == 0 && fractionalTransitions == 0;
  }
  /// Everything that has to be whole is so, whatever the triangles do.
  bool whole() const
  {
    return seamResiduals == 0 && offAxes == 0 && offIsolines == 0 && offIntegers == 0 &&
      fractionalTransitions == 0;
  }
  std::string text() const; ///< one line for people
};

/// The transition of half-edge h (chart of face(h) -> chart of the twin's face), exact. For a zero-length
/// image of the edge `fallbackRotation` is taken. residual, when given, is set to whether the far end disagrees.
Transition transitionOf(const Mesh& mesh, const std::vector<FixedVec2>& uv, Index h,
  int fallbackRotation = 0, bool* residual = nullptr);

/// #H: rotation of each half-edge's transition; 0 on boundaries. threads: 0 means all.
std::vector<std::int8_t> matchingOf(
  const Mesh& mesh, const std::vector<FixedVec2>& uv, int threads);

/// Exact check of a map. expectedTurns: #V (see CrossField::turns). integerVertex: #V flags. threads: 0: all; the
/// result does not depend on it.
Certificate certify(const Mesh& mesh, const std::vector<FixedVec2>& uv,
  const std::vector<int>& expectedTurns, const std::vector<std::uint8_t>& integerVertex,
  int threads = 0);

} // namespace quadrille
