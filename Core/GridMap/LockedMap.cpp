// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/LockedMap.h"

#include "Base/Refuse.h"
#include "GridMap/MapShape.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <string>

namespace quadrille
{
namespace
{

/// Transition of h with the rotation of the field.
Transition fieldTransition(
  const Mesh& mesh, const CrossField& field, const std::vector<FixedVec2>& uv, Index h)
{
  const int rotation = field.matching[h] & 3;
  return { rotation, uv[Mesh::next(mesh.twin[h])] - rotate(uv[h], rotation) };
}

} // namespace

LockedMap::LockedMap(const Mesh& mesh, const CrossField& field, const std::vector<FixedVec2>& uv)
  : mesh_(mesh), field_(field), uv_(uv), place_(mesh.origin.size()), master_(mesh.vertexCount()),
    lockedU_(mesh.vertexCount(), 0), lockedV_(mesh.vertexCount(), 0)
{
  refuseIf(uv.size() != mesh.origin.size() || field.matching.size() != mesh.origin.size() ||
      field.alignment.size() != mesh.origin.size() || field.turns.size() != mesh.position.size(),
    "embedding: map or field do not have the size of the mesh");
  checkTransitions();
  checkIsolines();
  lockIntegers();
  const std::vector<Index> outgoing = outgoingHalfEdges(mesh);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    if (outgoing[v] != kInvalidIndex)
    {
      placeCorners(v, outgoing[v]);
    }
  }
  lockIsolines();
  numberUnknowns();
}

void LockedMap::checkTransitions() const
{
  for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
  {
    if (mesh_.isBoundary(h))
    {
      continue;
    }
    const Transition transition = fieldTransition(mesh_, field_, uv_, h);
    refuseIf(transition.apply(uv_[Mesh::next(h)]) != uv_[mesh_.twin[h]],
      "embedding: the two images of half-edge ", h,
      " do not agree under the quarter turns of the field");
    if (!isInteger(transition.translation))
    {
      refuse("embedding: the transition of half-edge " + std::to_string(h) + " is not whole");
    }
  }
}

void LockedMap::checkIsolines() const
{
  for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
  {
    if (!mesh_.isConstrained(h))
    {
      continue;
    }
    const FixedVec2 a = rotate(uv_[h], -field_.alignment[h]);
    const FixedVec2 b = rotate(uv_[Mesh::next(h)], -field_.alignment[h]);
    refuseIf(a.v != b.v || !isInteger(a.v), "embedding: constrained half-edge ", h,
      " does not lie on an integer isoline");
  }
}

void LockedMap::lockIntegers()
{
  lockedU_ = lockedV_ = integerVertices(mesh_, field_);
  for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
  {
    refuseIf(lockedU_[mesh_.origin[h]] && !isInteger(uv_[h]), "embedding: vertex ", mesh_.origin[h],
      " does not lie at a whole point");
  }
}

/// Walks round the vertex counterclockwise from its master corner.
void LockedMap::placeCorners(Index v, Index start)
{
  master_[v] = uv_[start];
  place_[start] = Transition();
  for (Index h = start;;)
  {
    const Index next = mesh_.rotateCounterclockwise(h);
    if (next == kInvalidIndex)
    {
      return;
    }
    const Transition place =
      fieldTransition(mesh_, field_, uv_, Mesh::previous(h)).after(place_[h]);
    if (next == start)
    {
      refuseIf(!isLocked(v) && !place.isIdentity(), "embedding: the transitions round vertex ", v,
        " do not close");
      return;
    }
    place_[next] = place;
    h = next;
  }
}

/// A vertex on a constrained edge keeps the coordinate across it.
void LockedMap::lockIsolines()
{
  for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
  {
    if (!mesh_.isConstrained(h))
    {
      continue;
    }
    for (const Index corner : { h, Mesh::next(h) })
    {
      const bool alongU = ((field_.alignment[h] - place_[corner].rotation) & 1) == 0;
      (alongU ? lockedV_ : lockedU_)[mesh_.origin[corner]] = 1;
    }
  }
}

void LockedMap::numberUnknowns()
{
  unknownU_.assign(mesh_.vertexCount(), kInvalidIndex);
  unknownV_.assign(mesh_.vertexCount(), kInvalidIndex);
  for (Index v = 0; v < mesh_.vertexCount(); ++v)
  {
    unknownU_[v] = lockedU_[v] ? kInvalidIndex : unknowns_++;
    unknownV_[v] = lockedV_[v] ? kInvalidIndex : unknowns_++;
  }
}

UntangleProblem LockedMap::problem(double edgeLength) const
{
  UntangleProblem problem;
  std::vector<Eigen::Triplet<double>> triplets;
  problem.offset.resize(2 * Eigen::Index(mesh_.halfEdgeCount()));
  for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
  {
    const Index v = mesh_.origin[h];
    const Index unknown[2] = { unknownU_[v], unknownV_[v] };
    const FixedVec2 locked{ lockedU_[v] ? master_[v].u : 0, lockedV_[v] ? master_[v].v : 0 };
    problem.offset.segment<2>(2 * Eigen::Index(h)) = toDouble(place_[h].apply(locked));
    for (int i = 0; i < 2; ++i)
    {
      if (unknown[i] != kInvalidIndex)
      {
        const CornerAxis axis = cornerAxis(i, place_[h].rotation);
        triplets.emplace_back(
          static_cast<int>(2 * h) + axis.coordinate, static_cast<int>(unknown[i]), axis.sign);
      }
    }
  }
  problem.basis.resize(problem.offset.size(), unknowns_);
  problem.basis.setFromTriplets(triplets.begin(), triplets.end());
  for (Index f = 0; f < mesh_.faceCount(); ++f)
  {
    addTriangle(problem, { 3 * f, 3 * f + 1, 3 * f + 2 }, mesh_, field_, f, 0, edgeLength);
  }
  guardEdges(problem,
    guardedEdges(
      mesh_, field_, edgeLength, [](Index h) { return h; }, [](Index) { return 0; }));
  return problem;
}

Eigen::VectorXd LockedMap::start() const
{
  Eigen::VectorXd y(unknowns_);
  for (Index v = 0; v < mesh_.vertexCount(); ++v)
  {
    if (!lockedU_[v])
    {
      y[unknownU_[v]] = toDouble(master_[v].u);
    }
    if (!lockedV_[v])
    {
      y[unknownV_[v]] = toDouble(master_[v].v);
    }
  }
  return y;
}

std::vector<FixedVec2> LockedMap::snap(const Eigen::VectorXd& y) const
{
  std::vector<FixedVec2> uv(mesh_.origin.size());
  for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
  {
    const Index v = mesh_.origin[h];
    const FixedVec2 p{ lockedU_[v] ? master_[v].u : toFixed(y[unknownU_[v]]),
      lockedV_[v] ? master_[v].v : toFixed(y[unknownV_[v]]) };
    uv[h] = place_[h].apply(p);
  }
  return uv;
}

/// From an integer vertex along constrained half-edge h to the next one, measured along the axes.
std::int64_t LockedMap::chainLength(Index h) const
{
  std::int64_t length = 0;
  for (;;)
  {
    length += rotate(uv_[Mesh::next(h)] - uv_[h], -field_.alignment[h]).u;
    if (isLocked(mesh_.target(h)))
    {
      return length;
    }
    h = Mesh::next(h);
    while (!mesh_.isConstrained(h))
    {
      h = mesh_.rotateClockwise(h);
    }
  }
}

MapDefects LockedMap::hopeless() const
{
  MapDefects result;
  for (Index f = 0; f < mesh_.faceCount(); ++f)
  {
    const Index* v = &mesh_.origin[3 * f];
    if (isLocked(v[0]) && isLocked(v[1]) && isLocked(v[2]) &&
      orientation(uv_[3 * f], uv_[3 * f + 1], uv_[3 * f + 2]) <= 0)
    {
      result.notPositive.push_back(f);
    }
  }
  for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
  {
    if (mesh_.isConstrained(h) && isLocked(mesh_.origin[h]) && chainLength(h) <= 0)
    {
      result.reversed.push_back(h);
    }
  }
  return result;
}

} // namespace quadrille
