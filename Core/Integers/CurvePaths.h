// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Ways through the faces of a mesh along curves that a user has drawn. Of a curve only its course counts: which way
/// round vertices, handles and holes it goes.
#pragma once

#include "Mesh/Mesh.h"
#include "Requests/Guides.h"

#include <optional>
#include <vector>

namespace quadrille
{

/// From face to face, also across features.
struct FacePath
{
  Index first = kInvalidIndex; ///< the face that it begins in
  std::vector<Index> crossed;  ///< half-edges through which it leaves its faces

  /// The faces in order.
  std::vector<Index> faces(const Mesh& mesh) const;
};

/// The curve's own points and more between them, at most `spacing` apart.
std::vector<Vector3> sampleCurve(const CurveRequest& curve, double spacing);

/// From p to the nearest place on a curve that was sampled; infinite where that is a single point.
double distanceToCurve(const std::vector<Vector3>& samples, const Vector3& p);

/// The way along the curve from the star of vertex a to that of b. Empty where nothing joins them.
std::optional<FacePath> pathAlong(const Mesh& mesh, const CurveRequest& curve, Index a, Index b);

/// Its direction in each of its faces, over some faces before and behind; zero where it has none.
std::vector<Vector3> directionsAlong(const Mesh& mesh, const FacePath& path);

/// Gives the faces of the path that have no guide yet its direction. guides: #F.
void guideAlong(const Mesh& mesh, const FacePath& path, float weight, std::vector<Guide>& guides);

} // namespace quadrille
