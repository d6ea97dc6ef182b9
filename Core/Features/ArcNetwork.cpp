// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/ArcNetwork.h"

#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <cmath>
#include <utility>

namespace quadrille
{

namespace
{

/// A curve goes straight on where it bends by less than this (radians) over half an edge length.
constexpr double kStraightOn = 0.7;
constexpr double kCourse = 0.5;

} // namespace

ArcNetwork::ArcNetwork(const Mesh& mesh, double edgeLength)
  : mesh_(mesh), edgeLength_(edgeLength), edges_(constrainedEdges(mesh))
{
  at_ = edgesAtVertices(mesh, edges_);
  traceAll();
}

std::vector<Index> ArcNetwork::arcsAt(Index node) const
{
  std::vector<Index> found;
  for (Index i = at_.offset[node]; i < at_.offset[node + 1]; ++i)
  {
    found.push_back(arcOf_[at_.incident[i]]);
  }
  return found;
}

bool ArcNetwork::goStraightOn(Index node, Index a, Index b) const
{
  const double cosine = courseFrom(node, arcs_[a]).dot(courseFrom(node, arcs_[b]));
  return -cosine > std::cos(kStraightOn);
}

void ArcNetwork::traceAll()
{
  arcOf_.assign(mesh_.halfEdgeCount(), kInvalidIndex);
  for (Index v = 0; v < mesh_.vertexCount(); ++v)
  {
    pollNowAndThen(v);
    for (Index i = at_.offset[v]; at_.degree(v) != 2 && i < at_.offset[v + 1]; ++i)
    {
      if (arcOf_[at_.incident[i]] == kInvalidIndex)
      {
        trace(v, at_.incident[i]);
      }
    }
  }
}

void ArcNetwork::trace(Index start, Index h)
{
  const Index id = static_cast<Index>(arcs_.size());
  NetworkArc arc;
  Index v = start;
  while (true)
  {
    arcOf_[h] = id;
    arc.halfEdges.push_back(h);
    arc.length += sizedLength(mesh_, h) / edgeLength_;
    arc.removable =
      arc.removable && !mesh_.isBoundary(h) && (mesh_.flags[h] & kRequestedFeature) == 0;
    v = mesh_.otherEnd(h, v);
    if (at_.degree(v) != 2)
    {
      break;
    }
    h = at_.otherThan(h, v);
  }
  arc.ends = { start, v };
  arcs_.push_back(std::move(arc));
}

Vector3 ArcNetwork::courseFrom(Index node, const NetworkArc& arc) const
{
  const bool forward = arc.ends[0] == node;
  const std::size_t count = arc.halfEdges.size();
  Index v = node;
  double walked = 0;
  for (std::size_t i = 0; i < count && walked < kCourse; ++i)
  {
    const Index h = arc.halfEdges[forward ? i : count - 1 - i];
    walked += sizedLength(mesh_, h) / edgeLength_;
    v = mesh_.otherEnd(h, v);
  }
  return (mesh_.position[v] - mesh_.position[node]).stableNormalized();
}

} // namespace quadrille
