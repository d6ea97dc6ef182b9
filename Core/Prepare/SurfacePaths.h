// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The way over a surface that a polyline near it stands for: the one that a run takes.
#pragma once

#include "Mesh/Surface.h"
#include "Prepare/Frame.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace quadrille
{

/// Not for several threads at once.
class SurfacePaths
{
public:
  struct Path
  {
    std::vector<Vector3> points; ///< the polyline's, and where it passes from face to face
    /// The first of two points of the polyline that lie on different parts of the surface, if there are such; the path
    /// is straight between them.
    std::optional<std::size_t> tornBehind;
  };

  /// The surface is prepared with the first question that needs it, and has to stay as it is. threads: 0: all.
  explicit SurfacePaths(const SurfaceInput& input, int threads = 1)
    : input_(input), threads_(threads)
  {
  }

  /// Takes a surface that a run has made of the input, in the run's frame, in place of what would be prepared; null:
  /// none any more. Its faces may be others, its shape is the same.
  void use(std::shared_ptr<const PreparedSurface> made, const Frame& frame);
  /// Straight over faces, see pathOnMesh. points: on the surface. Throws InvalidInput as prepareSurface does.
  Path through(const std::vector<Vector3>& points) const;

private:
  const SurfaceInput& input_;
  int threads_;
  std::shared_ptr<const PreparedSurface> made_;
  Frame frame_;                      ///< of that
  mutable std::optional<Mesh> mesh_; ///< prepared
};

} // namespace quadrille
