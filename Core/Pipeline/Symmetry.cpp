// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Symmetry.h"

#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Mesh/MirrorCut.h"
#include "Mesh/Topology.h"
#include "Pipeline/CopiedRun.h"
#include "Pipeline/MirrorDouble.h"
#include "Pipeline/MirrorFit.h"
#include "Pipeline/MirrorRequests.h"
#include "Pipeline/RotationRun.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace quadrille
{

namespace
{

/// The image of a feature may be farther from its counterpart than the image of the surface from the surface.
constexpr double kFeatureReach = 3;

/// A plane in the store.
struct StoredPlane
{
  MirrorPlane plane;
  MirrorDeviation deviation;
};

ResultKey planeKey(ResultKey surface, const MirrorPlane& plane)
{
  KeyMaker key(surface);
  for (int i = 0; i < 3; ++i)
  {
    key.add(plane.origin[i]).add(plane.normal[i]);
  }
  return key.key();
}

void requirePlane(const MirrorPlane& plane)
{
  const double length = plane.normal.stableNorm();
  if (!plane.origin.allFinite() || !(length > 0 && std::isfinite(length)))
  {
    throw InvalidInput("the normal of the mirror plane must be a finite vector other than zero, "
                       "and its origin finite: give another plane, or have it found");
  }
}

class MirrorRun : public CopiedRun
{
public:
  MirrorRun(const RemeshOptions& options, std::optional<MirrorPlane> plane, ResultStore* store)
    : CopiedRun(options, store), given_(std::move(plane))
  {
    if (given_)
    {
      requirePlane(*given_);
      given_->normal.stableNormalize();
    }
  }

protected:
  std::size_t copies() const override { return 2; }
  ResultKey keyOf(ResultKey of) const override { return planeKey(of, made_.plane); }
  std::vector<CurveOutcome> outcomes(const std::vector<CurveOutcome>& ofPart) const override
  {
    return outcomesOfWhole(task(), curves_, ofPart);
  }

  void choose() override
  {
    const double start = secondsNow();
    report(options_.progress, 0.02, "Looking for the mirror plane");
    const ResultKey key = given_ ? planeKey(key_, *given_) : KeyMaker(key_).add(1.0).key();
    auto stored = store_ != nullptr ? store_->find<StoredPlane>(key) : nullptr;
    if (stored == nullptr)
    {
      stored = std::make_shared<StoredPlane>();
      stored->plane = given_ ? *given_ : findMirrorPlane(whole_->faces, options_.threads);
      stored->deviation = mirrorDeviation(whole_->faces, stored->plane, options_.threads);
      if (store_ != nullptr)
      {
        store_->put(key, stored, sizeof(StoredPlane));
      }
      lap("plane", start, surface().mesh.faceCount(), 1);
    }
    else
    {
      reused_.emplace_back("plane");
    }
    made_.plane = stored->plane;
    made_.deviation = stored->deviation;
    const MirrorDeviation& deviation = made_.deviation;
    tell(std::string("mirror plane ") + (given_ ? "given" : "found") + ": through " +
        placeText(made_.plane.origin) + " with normal " + placeText(made_.plane.normal) +
        "; the mirror image is " + shareText(deviation.rms / made_.diagonal) +
        " of the diagonal from the surface in the mean (root of squares), and at most " +
        shareText(deviation.maximum / made_.diagonal) + ", for " + placeText(deviation.place),
      "give another plane, or switch the symmetry off");
  }

  void cut() override
  {
    const double start = secondsNow();
    report(options_.progress, 0.08, "Cutting the surface in half");
    double front = 0, back = 0;
    for (const Vector3& p : surface().mesh.position)
    {
      front = std::max(front, made_.plane.height(p));
      back = std::min(back, made_.plane.height(p));
    }
    if (!(front > tolerance_ && back < -tolerance_))
    {
      throw InvalidInput(std::string("nothing of the surface lies ") +
        (front > tolerance_ ? "behind" : "in front of") + " the mirror plane through " +
        placeText(made_.plane.origin) + " with normal " + placeText(made_.plane.normal) +
        ": move the plane, or have it found");
    }
    withFeatures(
      [&](Mesh& mesh)
      {
        requestCutFeatures(mesh, made_.plane, tolerance_);
        half_ = cutByMirror(mesh, made_.plane, tolerance_);
      });
    for (const std::string& notice : askOfHalf(task(), half_))
    {
      notices_.push_back(notice);
    }
    curves_ = askCurvesOfHalf(task());
    half_.input.curves = curves_.curves;
    half_.input.regularElsewhere = surface().regularElsewhere;
    part_.input = std::move(half_.input);
    half_.input.polygonPoints = part_.input.polygonPoints; // for the weights of corners
    part_.face = half_.face;
    part_.cornerWeights = [this](Index t) { return half_.cornerWeights(surface().mesh, t); };
    lap("cut", start, surface().mesh.faceCount(), part_.face.size());
  }

  bool copy() override
  {
    const double start = secondsNow();
    report(options_.progress, 0.95, "Mirroring the quads");
    RemeshResult& result = made_.remeshed;
    const DoubledMesh doubled = doubleMesh(result.surface.mesh, made_.plane, tolerance_);
    DoubledQuads quads = doubleQuads(result.quads, doubled, made_.plane);
    result.status = quads.status;
    if (!quads.status.ok())
    {
      notices_.push_back(quads.status.message);
      result.quads = {};
      return false;
    }
    locatePart(result.quads);
    const MirrorFit fit = fitImages(quads, *whole_, tolerance_,
      kFeatureReach * made_.deviation.maximum + tolerance_, options_.threads);
    takeQuads(std::move(quads), fit);
    takeSurface({ doubled.mesh, doubled.halfFaces, doubleMap(doubled, std::move(result.uv)),
      doubleTurns(doubled, result.turns) });
    tellTopology(summarizeTopology(result.surface.mesh, options_.threads),
      "the half in front of the mirror plane and its image have ");
    lap("mirror", start, result.quads.quads.size() / 2, result.quads.quads.size());
    return true;
  }

private:
  MirrorTask task() const
  {
    return { *whole_, made_.plane, tolerance_, made_.deviation.maximum, options_.threads };
  }

  std::optional<MirrorPlane> given_; ///< normal: unit
  MirrorHalf half_;
  HalfCurves curves_;
};

} // namespace

SymmetricResult remeshSymmetric(SurfaceInput input, const RemeshOptions& options,
  const SymmetryOptions& symmetry, ResultStore* store)
{
  std::unique_ptr<CopiedRun> run;
  // What is left to do after a stop that has kept the quads of the part is short, and does not ask again.
  PollScope poll(!options.progress ? ProgressCallback()
                                   : [&](double fraction, const std::string& text)
      { return (run && run->isStopped()) || options.progress(fraction, text); });
  RemeshOptions ownOptions = options;
  ownOptions.progress = poll.callback();
  try
  {
    if (symmetry.rotation)
    {
      run = std::make_unique<RotationRun>(ownOptions, *symmetry.rotation, store);
    }
    else
    {
      run = std::make_unique<MirrorRun>(ownOptions, symmetry.plane, store);
    }
    return run->run(input);
  }
  catch (const Cancelled&)
  {
    SymmetricResult stopped;
    stopped.remeshed.status = { StatusCode::Cancelled, "stopped on request; no quads were made" };
    return stopped;
  }
}

} // namespace quadrille
