// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/SurfacePaths.h"

#include "Prepare/InputPlaces.h"

#include "Prepare/Prepare.h"

#include <utility>

namespace quadrille
{

void SurfacePaths::use(std::shared_ptr<const PreparedSurface> made, const Frame& frame)
{
  made_ = std::move(made);
  frame_ = frame;
}

MeshCourse SurfacePaths::through(const std::vector<Vector3>& points) const
{
  if (!made_ && !mesh_)
  {
    PrepareOptions options;
    options.threads = threads_;
    mesh_ = prepareSurface(shapeOf(input_), options).mesh;
  }
  const Mesh& mesh = made_ ? made_->mesh : *mesh_;
  const Frame frame = made_ ? frame_ : Frame();
  std::vector<Vector3> framed;
  framed.reserve(points.size());
  for (const Vector3& p : points)
  {
    framed.push_back(frame.fromUser(p));
  }
  MeshCourse course = courseOnMesh(mesh, framed, threads_);
  for (Vector3& p : course.points)
  {
    p = frame.toUser(p);
  }
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    course.points[course.own[i]] = points[i];
  }
  return course;
}

} // namespace quadrille
