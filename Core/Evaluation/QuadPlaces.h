// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The quads near a place: what is there of what a user asked for.
#pragma once

#include "Extraction/Extraction.h"
#include "Mesh/BoxTree.h"

#include <array>
#include <optional>
#include <vector>

namespace quadrille
{

/// The valence of the quads at a place, on boundaries one more, as it is asked for there; regular where no point of
/// theirs lies.
class ReachedValences
{
public:
  /// Here, and below, mesh stays as it is while the object is used.
  explicit ReachedValences(const QuadMesh& mesh);
  int at(const Vector3& p) const;
  /// The point of the quads at the place, if there is one.
  std::optional<Index> pointAt(const Vector3& p) const;

private:
  const QuadMesh& mesh_;
  BoxTree tree_;
  double tolerance_ = 0;
};

/// The quad nearest to a place, as two triangles.
class NearestQuads
{
public:
  struct Place
  {
    Index quad = kInvalidIndex;
    Vector3 point = Vector3::Zero();
    /// Unit tangents of its two families of edges, blended from opposite edges.
    std::array<Vector3, 2> along;
  };

  explicit NearestQuads(const QuadMesh& mesh);
  std::optional<Place> at(const Vector3& p) const;

private:
  std::array<Vector3, 3> triangle(Index i) const;

  const QuadMesh& mesh_;
  BoxTree tree_; ///< of two triangles a quad
};

/// The edge of the quads nearest to a place.
class NearestEdges
{
public:
  struct Place
  {
    double distance = 0; ///< in units of the points
    double length = 0;   ///< of the edge
  };

  explicit NearestEdges(const QuadMesh& mesh);
  std::optional<Place> at(const Vector3& p) const;

private:
  const QuadMesh& mesh_;
  std::vector<std::array<Index, 2>> edges_;
  BoxTree tree_;
};

} // namespace quadrille
