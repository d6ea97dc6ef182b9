// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The boundary of a mesh by places: what is asked of parts of it names the places of their ends.
#pragma once

#include "Mesh/Mesh.h"

#include <vector>

namespace quadrille
{

class BoundaryPlaces
{
public:
  /// The mesh must outlive this.
  explicit BoundaryPlaces(const Mesh& mesh)
    : mesh_(mesh), outgoing_(mesh.vertexCount(), kInvalidIndex)
  {
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      if (mesh.isBoundary(h))
      {
        outgoing_[mesh.origin[h]] = h;
        vertices_.push_back(mesh.origin[h]);
      }
    }
  }

  /// The vertex of the boundary nearest to a place; kInvalidIndex where the mesh has no boundary.
  Index nearest(const Vector3& place) const
  {
    Index best = kInvalidIndex;
    double least = kInfinity;
    for (const Index v : vertices_)
    {
      const double distance = (mesh_.position[v] - place).squaredNorm();
      if (distance < least)
      {
        least = distance;
        best = v;
      }
    }
    return best;
  }

  /// The boundary from one vertex on, up to the next one that ends it; none where that is another one than `to`.
  template <typename Ends>
  std::vector<Index> walk(Index from, Index to, const Ends& ends) const
  {
    std::vector<Index> edges;
    Index v = from;
    do
    {
      const Index h = v == kInvalidIndex ? kInvalidIndex : outgoing_[v];
      if (h == kInvalidIndex)
      {
        return {};
      }
      edges.push_back(h);
      v = mesh_.target(h);
    } while (!ends(v));
    return v == to ? edges : std::vector<Index>{};
  }

private:
  const Mesh& mesh_;
  std::vector<Index> outgoing_; ///< #V: boundary half-edge; kInvalidIndex inside
  std::vector<Index> vertices_;
};

} // namespace quadrille
