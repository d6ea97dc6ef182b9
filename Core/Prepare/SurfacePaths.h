// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The way over a surface that a polyline near it stands for: the one that a run takes.
#pragma once

#include "Mesh/Surface.h"
#include "Prepare/Frame.h"
#include "Requests/MeshPaths.h"

#include <memory>
#include <optional>
#include <vector>

namespace quadrille
{

/// Not for several threads at once.
class SurfacePaths
{
public:
  /// The surface is prepared with the first question that needs it, and has to stay as it is. threads: 0: all.
  explicit SurfacePaths(const SurfaceInput& input, int threads = 1)
    : input_(input), threads_(threads)
  {
  }

  /// Takes a surface that a run has made of the input, in the run's frame, in place of what would be prepared; null:
  /// none any more. Its faces may be others, its shape is the same.
  void use(std::shared_ptr<const PreparedSurface> made, const Frame& frame);
  /// See courseOnMesh. points: on the surface. Throws InvalidInput as prepareSurface does.
  MeshCourse through(const std::vector<Vector3>& points) const;

private:
  const SurfaceInput& input_;
  int threads_;
  std::shared_ptr<const PreparedSurface> made_;
  Frame frame_;                      ///< of that
  mutable std::optional<Mesh> mesh_; ///< prepared
};

} // namespace quadrille
