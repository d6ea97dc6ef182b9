// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/PackedMap.h"

#include "Base/Error.h"
#include "Base/Progress.h"

#include <string>

namespace quadrille
{

PackedMap::PackedMap(const Mesh& mesh, const std::vector<FixedVec2>& uv)
  : vertex_(mesh.vertexCount())
{
  if (uv.size() != mesh.halfEdgeCount())
  {
    throw InvalidInput("A map of " + std::to_string(uv.size()) +
      " corners cannot be packed with a mesh of " + std::to_string(mesh.halfEdgeCount()) + ".");
  }
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
  if (vertex_.size() != mesh.vertexCount())
  {
    throw InvalidInput("A map packed with " + std::to_string(vertex_.size()) +
      " vertices cannot be unpacked with " + std::to_string(mesh.vertexCount()) + ".");
  }
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
