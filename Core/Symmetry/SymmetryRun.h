// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads of a part of a surface, and their images under an isometry, as one mesh: remeshSymmetric().
#pragma once

#include "Mesh/Topology.h"
#include "Symmetry/ImageFit.h"
#include "Symmetry/PartDrawn.h"
#include "Symmetry/PartRequests.h"
#include "Symmetry/PartSources.h"
#include "Symmetry/PlaneCut.h"
#include "Symmetry/Symmetry.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace quadrille
{

/// "0.0012".
std::string shareText(double share);

/// The image of a single place, as of a feature or a cut, may be so many times as far from its counterpart as the image
/// of the surface from the surface.
constexpr double kReachOfDeviation = 3;

/// One run: each step leaves what the next ones need.
class SymmetryRun
{
public:
  /// Throws InvalidInput for a plane or an axis without direction, and an order out of its range.
  SymmetryRun(const RemeshOptions& options, const SymmetryOptions& symmetry, ResultStore* store);

  SymmetricResult run(SurfaceInput& input);
  /// Whether the run of the part was stopped with quads, see RemeshResult::stopped.
  bool isStopped() const { return !made_.remeshed.stopped.empty(); }

private:
  /// What was asked for about the symmetry, and what it came to.
  struct Asked
  {
    bool isGiven = false; ///< the plane or the axis
    bool midLine = false; ///< quads across the plane
    // Of a mid-line.
    std::vector<GivenUpCurve> givenUp; ///< in the plane
    double inPlane = 0;                ///< length of the plane's curve over the sizes
    PartCurves curves;
    DrawnRequests drawn; ///< of the whole
  };
  /// What comes before that of the part's run.
  struct Told
  {
    std::vector<std::string> notices, reused;
    StageRecords laps;
  };

  const PreparedSurface& surface() const { return whole_->surface; }
  /// How many parts make the whole.
  std::size_t copies() const { return static_cast<std::size_t>(isometry_.order); }
  bool isMirror() const { return isometry_.isReflection; }
  PartTask task() const;
  /// Of a result that depends on the symmetry.
  ResultKey keyOf(ResultKey of) const;
  void lap(const char* stage, double start, std::size_t in, std::size_t out);

  void prepare(SurfaceInput& input);
  /// The symmetry: given or found; told, and refused where the surface has not got it.
  void choose();
  void tellChosen();
  /// Makes the part, with what is asked of it.
  void cut();
  void cutHalf();
  void requireBothSides() const;
  void cutOneWedge();
  void tellPoles();
  /// What `act` sees of the whole has only the features that the edge length resolves.
  void withFeatures(const std::function<void(Mesh&, double edgeLength)>& act);

  void remeshAndCopy();
  void remeshPart(std::size_t more);
  /// Quads that the part needs beside its share of the whole's, at this edge length.
  double quadsBeside(double edgeLength) const { return asked_.inPlane / (2 * edgeLength); }

  /// The quads of the part and their images become the result's. False where they are no mesh and more quads would
  /// help.
  bool copy();
  void locatePart(
    const QuadMesh& part, const CutQuads& cut, const std::vector<std::uint8_t>& moved);
  void takeQuads(CopiedQuads quads);
  void tellMoved(const CopiedQuads& quads, const FittedImages& fit);
  /// The mapped surface of the whole, which is certified.
  void takeSurface(CopiedMesh copied);
  ImageSources imageSources(const CopiedMesh& copied) const;
  void certifyWhole();
  void ownFrame();
  TopologySummary madeTopology() const;
  void tellTopology();

  RemeshOptions options_; ///< with the number of quads of the whole, once it is known
  ResultStore* store_;
  Isometry isometry_;
  Asked asked_;
  ResultKey key_ = 0;
  double tolerance_ = 0;
  std::shared_ptr<SearchedSurface> whole_;
  SurfacePart part_;
  SymmetricResult made_;
  Told told_;
};

} // namespace quadrille
