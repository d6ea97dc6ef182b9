// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Where the surface of a part, as it was remeshed, and its images lie on the whole.
#pragma once

#include "Symmetry/Copies.h"
#include "Symmetry/ImageFit.h"
#include "Symmetry/PlaneCut.h"

#include <array>
#include <vector>

namespace quadrille
{

/// Per face of the images, those of the first one first.
struct ImageSources
{
  std::vector<Index> face;          ///< of the whole, under it
  std::vector<FaceWeights> weights; ///< of its corners, in that face
};

class PartSources
{
public:
  /// made: the surface of the part.
  PartSources(const SearchedSurface& whole, const SurfacePart& part, const PreparedSurface& made)
    : whole_(whole), part_(part), made_(made)
  {
  }

  /// The face of the whole that a face of the part is in, and its corners in weights of the corners of that.
  Index faceOf(Index f) const { return part_.face[made_.sourcePolygon[f]]; }
  FaceWeights weightsOf(Index f) const;
  /// A place in a face of the part, on the input.
  SourceLocation locate(Index f, const std::array<double, 3>& weights) const;
  /// Under the centres of faces of images, and there the nearest corners. deviation: of images from the surface, as the
  /// root of the mean square. tolerance: of places on it.
  ImageSources ofImages(
    const CopiedMesh& copied, double deviation, double tolerance, int threads) const;

private:
  std::size_t cornerOf(Index t, Index point) const;

  const SearchedSurface& whole_;
  const SurfacePart& part_;
  const PreparedSurface& made_;
};

} // namespace quadrille
