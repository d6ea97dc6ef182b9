// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a decimation leaves of each component of a mesh.
#pragma once

#include "Hierarchy/DecimationMesh.h"

#include <cstddef>
#include <numeric>
#include <vector>

namespace quadrille
{

/// Connected components of what is alive, and how many vertices each has to keep.
class ComponentShares
{
public:
  explicit ComponentShares(const DecimationMesh& mesh);

  Index needed() const { return std::accumulate(keep_.begin(), keep_.end(), Index{ 0 }); }
  std::size_t components() const { return count_.size(); }
  bool maySpare(Index v) const { return count_[component_[v]] > keep_[component_[v]]; }
  void remove(Index v) { --count_[component_[v]]; }
  Index total() const { return std::accumulate(count_.begin(), count_.end(), Index{ 0 }); }

private:
  template <typename Body>
  static void visitNeighbours(const DecimationMesh& mesh, Index v, const Body& body)
  {
    const Index first = mesh.outgoing[v];
    Index h = first;
    do
    {
      body(mesh.target(h));
      body(mesh.origin[Mesh::previous(h)]);
      h = mesh.twin[Mesh::previous(h)];
    } while (h != first && h != kInvalidIndex);
  }
  void countEdgesAndFaces(const DecimationMesh& mesh, std::vector<long>& euler) const;
  std::vector<Index> component_;
  std::vector<Index> count_;
  std::vector<Index> keep_;
};

} // namespace quadrille
