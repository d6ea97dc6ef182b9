// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The boundary of a surface of sheets that lie apart (see Assembly/JointSheets.h): its loops, with what of the input
/// lies there, and the nearest places on them and on features.
#pragma once

#include "Assembly/JointSheets.h"
#include "Pipeline/Pipeline.h"
#include "Quads/SurfaceWalk.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace quadrille
{

/// A boundary loop of the surface: half-edges in order, with what of the input lies there.
struct FineLoop
{
  Index sheet = 0;
  std::vector<Index> halfEdges;
  std::vector<double> arc;       ///< of the origin of each; the length of the loop at the end
  std::vector<Index> jointPoint; ///< at the origin of each, or kInvalidIndex
};

class SheetBorders
{
public:
  SheetBorders(RemeshResult& result, const JointSheets& sheets)
    : result_(result), mesh_(result.surface.mesh), quads_(result.quads), sheets_(sheets)
  {
    findFineLoops();
  }

  const std::vector<FineLoop>& loops() const { return fineLoops_; }

  Index sheetOfFace(Index f) const { return sheets_.sheetOf[result_.surface.sourcePolygon[f]]; }

  /// A place on the boundary of the surface.
  /// A place on the boundary of the surface.
  struct OnLoop
  {
    std::size_t loop = 0;
    CurvePoint at;
    double arc = 0;
    double distance = kInfinity;
  };

  OnLoop nearestOnLoops(Index sheet, const Vector3& p) const;
  std::optional<SurfacePoint> nearestOnFeatures(Index sheet, const Vector3& p) const;
  /// A point of the quads goes there, on the boundary of a sheet.
  void move(Index p, Index sheet, const Vector3& to);

private:
  /// The point of the input at a corner of the surface; none where refinement made it.
  Index inputAt(Index corner) const;
  void findFineLoops();
  CurvePoint nearestOnEdge(Index h, const Vector3& p) const;

  RemeshResult& result_;
  Mesh& mesh_;
  QuadMesh& quads_;
  const JointSheets& sheets_;
  std::vector<FineLoop> fineLoops_;
};

} // namespace quadrille
