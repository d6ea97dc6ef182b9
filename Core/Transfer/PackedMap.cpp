// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/PackedMap.h"

#include "Base/Progress.h"
#include "Base/Refuse.h"

namespace quadrille
{

PackedMap::PackedMap(const Mesh& mesh, const std::vector<FixedVec2>& uv)
  : vertex_(mesh.vertexCount())
{
  refuseIf(uv.size() != mesh.halfEdgeCount(), "A map of ", uv.size(),
    " corners cannot be packed with a mesh of ", mesh.halfEdgeCount(), ".");
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    vertex_[mesh.origin[h]] = uv[h];
  }
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    if (uv[h] != vertex_[mesh.origin[h]])
    {
      corner_.push_back(h);
      uv_.push_back(uv[h]);
    }
  }
}

std::vector<FixedVec2> PackedMap::unpack(const Mesh& mesh) const
{
  refuseIf(vertex_.size() != mesh.vertexCount(), "A map packed with ", vertex_.size(),
    " vertices cannot be unpacked with ", mesh.vertexCount(), ".");
  std::vector<FixedVec2> uv;
  uv.reserve(mesh.halfEdgeCount());
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    uv.push_back(vertex_[mesh.origin[h]]);
  }
  for (std::size_t i = 0; i < corner_.size(); ++i)
  {
    pollNowAndThen(i);
    uv[corner_[i]] = uv_[i];
  }
  return uv;
}

std::size_t PackedMap::bytes() const
{
  return sizeof(FixedVec2) * (vertex_.size() + uv_.size()) + sizeof(Index) * corner_.size();
}

} // namespace quadrille
