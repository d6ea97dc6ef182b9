// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The results of the parts of a surface become that of the whole: elements of one part after those of another.
#pragma once

#include "Mesh/SurfaceParts.h"
#include "Pipeline/Division.h"
#include "Pipeline/FaceDivision.h"
#include "Pipeline/Pipeline.h"

#include <cstddef>
#include <vector>

namespace quadrille
{

class JoinedRuns
{
public:
  explicit JoinedRuns(const SizedSurface& whole);

  /// made: in the frame, with quads.
  void add(const SizedPart& part, RemeshResult made);
  /// A part without quads, of which `made` tells why.
  void leaveOut(const SizedPart& part, const RemeshResult& made);

  /// Faces that go without a map, and their quads, whose first points are points of the rest; that is there already.
  void addFilled(const CutFaces& cut, FilledPart filled);

  const QuadMesh& quads() const { return joined_.quads; }
  bool hasQuads() const { return !joined_.quads.quads.empty(); }
  /// result: has what is told of the whole, to which comes what the parts tell, have taken and have made. Returns the
  /// surface of the parts that have quads. threads: 0: all.
  PreparedSurface take(RemeshResult& result, int threads);
  /// What the parts have taken, where the whole has no quads.
  void takeLog(RemeshResult& result);

private:
  void tellUnmet(
    const std::vector<CurveRequest>& curves, const std::vector<Index>& ids, const std::string& why);
  void addFailed(const SizedPart& part, const FailedParts& failed);
  void addMap(RunMap& made);
  void addQuads(const RunQuads& made);

  Index components_; ///< of the whole
  long long targetQuads_;
  PreparedSurface surface_;
  RemeshResult joined_;
};

} // namespace quadrille
