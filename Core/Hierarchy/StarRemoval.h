// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Removal of one vertex in phase 1, in whatever order: FreeStar where it is made for the star, VertexRemoval
/// elsewhere.
#pragma once

#include "Hierarchy/FreeStar.h"
#include "Hierarchy/VertexRemoval.h"

namespace quadrille
{

class StarRemoval
{
public:
  using Outcome = FreeStar::Outcome;

  /// `guards` must outlive this object, and not change.
  StarRemoval(DecimationMesh& mesh, const RemovalGuards& guards)
    : mesh_(mesh), guards_(guards), small_(mesh, guards), any_(mesh)
  {
  }

  /// Collects the star of a live vertex. False when it can never be removed.
  bool gather(Index v)
  {
    vertex_ = v;
    const int valence = mesh_.valence[v];
    isSmall_ = mesh_.curves.kind[v] == VertexKind::Free && valence >= FreeStar::kLeast &&
      valence <= FreeStar::kMost;
    if (isSmall_)
    {
      small_.gather(v);
      return true;
    }
    return any_.gather(v);
  }
  int ringSize() const { return isSmall_ ? small_.ringSize() : any_.ringSize(); }
  Index ringVertex(int i) const { return isSmall_ ? small_.ringVertex(i) : any_.ringVertex(i); }

  /// E_uni: the shortest edge at the vertex, of a curve vertex the shorter one of its two curve edges. `unit` is a
  /// length of about that size, for single precision.
  double shortestEdge(double unit)
  {
    return isSmall_ ? double{ small_.shortestEdge(unit) } * unit : any_.shortestEdge();
  }

  /// After shortestEdge(): finds the new triangulation. Never Unsuited.
  Outcome plan()
  {
    const Outcome outcome = isSmall_ && hasFreeRing() ? small_.plan() : Outcome::Unsuited;
    if (outcome != Outcome::Unsuited)
    {
      return outcome;
    }
    if (isSmall_)
    {
      isSmall_ = false;
      if (!any_.gather(vertex_))
      {
        return Outcome::Refused;
      }
    }
    return any_.plan(guards_) ? Outcome::Planned : Outcome::Refused;
  }

  /// Carries out the plan and logs it.
  void apply(RecordWriter& log) { isSmall_ ? small_.apply(log) : any_.apply(log); }

private:
  bool hasFreeRing() const
  {
    for (int i = 0; i < small_.ringSize(); ++i)
    {
      if (mesh_.curves.kind[small_.ringVertex(i)] != VertexKind::Free)
      {
        return false;
      }
    }
    return true;
  }

  DecimationMesh& mesh_;
  const RemovalGuards& guards_;
  FreeStar small_;
  VertexRemoval any_;
  Index vertex_ = kInvalidIndex;
  bool isSmall_ = false;
};

} // namespace quadrille
