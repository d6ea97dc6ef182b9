// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/SurfacePaths.h"

#include "Prepare/Prepare.h"
#include "Requests/MeshPaths.h"

#include <utility>

namespace quadrille
{

void SurfacePaths::use(std::shared_ptr<const PreparedSurface> made, const Frame& frame)
{
  made_ = std::move(made);
  frame_ = frame;
}

SurfacePaths::Path SurfacePaths::through(const std::vector<Vector3>& points) const
{
  if (!made_ && !mesh_)
  {
    SurfaceInput shape;
    shape.points = input_.points;
    shape.polygonOffsets = input_.polygonOffsets;
    shape.polygonPoints = input_.polygonPoints;
    PrepareOptions options;
    options.threads = threads_;
    mesh_ = prepareSurface(std::move(shape), options).mesh;
  }
  const Mesh& mesh = made_ ? made_->mesh : *mesh_;
  const Frame frame = made_ ? frame_ : Frame();
  std::vector<Vector3> framed;
  framed.reserve(points.size());
  for (const Vector3& p : points)
  {
    framed.push_back(frame.fromUser(p));
  }
  const std::vector<MeshPlace> places = placesOnMesh(mesh, framed, threads_);
  Path path;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (i > 0 && points[i - 1] != points[i])
    {
      const std::optional<MeshPath> way = pathOnMesh(mesh, places[i - 1], places[i]);
      if (way)
      {
        for (const EdgeCrossing& crossing : way->crossings)
        {
          path.points.push_back(frame.toUser(crossing.point(mesh)));
        }
      }
      else if (!path.tornBehind)
      {
        path.tornBehind = i - 1;
      }
    }
    if (path.points.empty() || path.points.back() != points[i])
    {
      path.points.push_back(points[i]);
    }
  }
  return path;
}

} // namespace quadrille
