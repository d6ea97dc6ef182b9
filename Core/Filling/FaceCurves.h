// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The curves round faces that are to be filled with quads, and how many edges each gets: a face can be filled where
/// all round it there is an even number.
#pragma once

#include "Mesh/Mesh.h"
#include "Quads/SurfaceWalk.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace quadrille
{

/// An edge of the surface and the way in which a curve passes it.
struct CurveStep
{
  Index h = kInvalidIndex;
  bool forwards = true;
};

/// A curve whose number of edges is free: between two faces, in one, or along a boundary.
struct FaceCurve
{
  std::vector<CurveStep> steps;
  bool closed = false;          ///< ends where it begins
  double length = 0;            ///< in edge lengths of the quads there
  std::size_t edges = 1;        ///< that it gets
  std::size_t least = 1;        ///< that it must have, or edges would lie on each other
  std::array<Index, 2> faces{}; ///< on both sides; kInvalidIndex on the other side of a boundary
  std::array<Index, 2> loops{}; ///< of these faces' boundaries; as for faces
};

/// Faces are the parts of a mesh between its features. Parts of its boundary are given: there quads beside have points.
class FaceCurves
{
public:
  /// isGiven: #H, for half-edges of the boundary. edgeLength: of the quads where sizes are 1.
  FaceCurves(const Mesh& mesh, std::vector<std::uint8_t> isGiven, double edgeLength);

  const std::vector<Index>& faceOf() const { return faceOf_; } ///< #F
  Index faceCount() const { return faces_; }
  bool isGiven(Index h) const { return isGiven_[h] != 0; }

  /// given: points of the quads beside, on edges that are given. Where curves end on these a near point is moved to
  /// that place; their order stays.
  void setGiven(std::vector<CurvePoint> given);
  const std::vector<CurvePoint>& given() const
  {
    return given_;
  } ///< by the boundary's half-edges, t in [0, 1)

  /// Numbers of edges near the lengths of the curves, such that as many faces as can be have an even number round them,
  /// and none is a single quad that has a flat corner or is folded. Returns those with an odd number: no two of them
  /// can get an edge more by curves between them.
  std::vector<Index> chooseNumbers();
  const std::vector<FaceCurve>& curves() const { return curves_; }
  /// The points that the edges of a curve meet at, but for its ends, along it: at equal distances.
  std::vector<CurvePoint> pointsAlong(const FaceCurve& curve) const;
  /// Which faces can pass edges on to each other by free curves: a number per face.
  const std::vector<Index>& groupOf() const { return groupOf_; }

private:
  void findCurves();
  FaceCurve trace(CurveStep first, std::vector<std::uint8_t>& isDone) const;
  std::optional<CurveStep> stepAfter(const CurveStep& step) const;
  bool isNode(Index v) const;
  std::vector<Index> endsOnGiven() const;
  struct LoopPlace
  {
    Index rank; ///< of the half-edge, rising along the loop
    double t;
    Index id;

    bool operator<(const LoopPlace& other) const
    {
      return std::pair(rank, t) < std::pair(other.rank, other.t);
    }
  };
  void moveToEnds(const std::vector<LoopPlace>& ends, const std::vector<LoopPlace>& points);
  void findGroups();
  Index beginOf(const CurveStep& step) const
  {
    return step.forwards ? mesh_.origin[step.h] : mesh_.target(step.h);
  }
  Index endOf(const CurveStep& step) const
  {
    return step.forwards ? mesh_.target(step.h) : mesh_.origin[step.h];
  }
  std::vector<Vector3> cornersRound(Index face) const;
  std::vector<Index> flatFaces(const std::vector<Index>& singleQuads) const;

  const Mesh& mesh_;
  std::vector<std::uint8_t> isGiven_;
  std::vector<double> quads_; ///< #H, see quadsAlongCurves
  std::vector<Index> faceOf_;
  Index faces_ = 0;
  std::vector<Index> loopOf_; ///< of boundaries of faces, per half-edge; kInvalidIndex inside
  Index loops_ = 0;
  std::vector<Index> nextOnLoop_;      ///< per half-edge of these boundaries
  std::vector<Index> edges_;           ///< constrained, the lower half-edge of each
  std::vector<std::vector<Index>> at_; ///< of these, per vertex
  std::vector<FaceCurve> curves_;
  std::vector<CurvePoint> given_;
  std::vector<Index> groupOf_;
  std::vector<std::uint8_t> reachesBoundary_; ///< per group
};

} // namespace quadrille
