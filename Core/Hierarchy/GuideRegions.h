// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Guides in the hierarchy [Ebke et al. 2016, Section 5.2]: regions, that is connected sets of guided faces, keep their
/// borders and corners while phase 2 decimates, and directions are carried from the triangles that go to those that
/// come.
///
/// Where we differ: phase 1 does not look at guides, so that a change of guides never repeats it. The triangles of the
/// intermediate level, a little above s/2 long, take their guides from the finest level by their barycentres; what
/// falls between them (a stroke along a line of faces) reaches s/4 to each side. Parts of regions that are thinner than
/// 3/4 s to each side lead so far beside them, up to features. Border vertices are removed like free
/// ones, with the new border edge among the triangulation's: nothing has to lie on an isoline there.
#pragma once

#include "Hierarchy/DecimationMesh.h"

#include <array>
#include <vector>

namespace quadrille
{

class VertexRemoval;

/// Guides of the faces of a level: that of the fine face at the barycentre. Guided fine faces that no triangle near by
/// has taken a guide from give theirs to triangles whose barycentre is within `reach`, those of thin parts within three
/// times that. The direction is rotated with the normal.
/// fineGuides: ascending by face. Empty when no face has one.
std::vector<Guide> guidesOfLevel(const Mesh& fine, const Level& level,
  const std::vector<FaceGuide>& fineGuides, double reach, int threads);

/// Gives the mesh guides (#F): flags the borders of their regions, except where a feature or the boundary parts them
/// anyway, and says which vertices lie inside a border. Returns the vertices that have to stay: where borders end,
/// meet or touch a feature or the boundary, and corners, at which a region's inner angle is below 3/4 pi both at the
/// vertex and between points `length` away along the border. Of corners closer than `length` only the sharpest stays.
std::vector<Index> markGuideRegions(
  DecimationMesh& mesh, const std::vector<Guide>& guides, double length);

/// Carries guides across the removal of a vertex: a new triangle adopts the direction of the old one that contains
/// its barycentre in the planar map of the star, on its side of the border or feature through the vertex.
class GuideCarrier
{
public:
  /// Before the removal is applied. Does nothing where no face of the star is guided.
  void gather(const DecimationMesh& mesh, const VertexRemoval& removal);
  /// Afterwards.
  void carry(DecimationMesh& mesh);

private:
  struct StarFace
  {
    Index face = kInvalidIndex;
    int side = 0;
    Guide guide;
  };
  std::size_t next(std::size_t i) const { return i + 1 == ring_.size() ? 0 : i + 1; }
  void mapToPlane(const VertexRemoval& removal);
  std::size_t containing(const Vector2& point, int side) const;
  Guide transport(std::size_t from, const std::array<std::size_t, 3>& to) const;

  std::vector<StarFace> faces_; ///< empty: nothing to carry
  std::vector<Index> ring_;
  std::vector<Vector3> spoke_;
  std::vector<Vector2> planar_;
  int split_ = 0; ///< ring position where the second side begins; 0: one side
};

} // namespace quadrille
