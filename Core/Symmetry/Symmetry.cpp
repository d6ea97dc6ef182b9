// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/Symmetry.h"

#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"
#include "Pipeline/Estimate.h"
#include "Pipeline/SizedSurface.h"
#include "Requests/Guides.h"
#include "Symmetry/CopiedRun.h"
#include "Symmetry/MirrorCut.h"
#include "Symmetry/MirrorDouble.h"
#include "Symmetry/MirrorFit.h"
#include "Symmetry/MirrorMidLine.h"
#include "Symmetry/MirrorRequests.h"
#include "Symmetry/RotationRun.h"

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
  MirrorRun(const RemeshOptions& options, const SymmetryOptions& symmetry, ResultStore* store)
    : CopiedRun(options, store), given_(symmetry.plane),
      midLine_(symmetry.planeCurve == PlaneCurve::MidLine)
  {
    if (given_)
    {
      requirePlane(*given_);
      given_->normal.stableNormalize();
    }
  }

protected:
  std::size_t copies() const override { return 2; }
  ResultKey keyOf(ResultKey of) const override
  {
    const ResultKey key = planeKey(of, made_.plane);
    return midLine_ ? KeyMaker(key).add(std::uint64_t{ 1 }).key() : key;
  }
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
        if (midLine_)
        {
          giveUpFeatures(mesh);
        }
        half_ = cutByMirror(mesh, made_.plane, tolerance_);
      });
    if (midLine_)
    {
      askMidLine(half_, made_.plane, tolerance_);
    }
    for (const std::string& notice : askOfHalf(task(), half_))
    {
      notices_.push_back(notice);
    }
    curves_ = askCurvesOfHalf(task());
    half_.input.curves = curves_.curves;
    half_.input.regularElsewhere = surface().regularElsewhere;
    inPlane_ = midLine_ ? midLineLength(half_, made_.plane, tolerance_) : 0;
    part_.input = std::move(half_.input);
    half_.input.polygonPoints = part_.input.polygonPoints; // for the weights of corners
    part_.face = half_.face;
    part_.cornerWeights = [this](Index t) { return half_.cornerWeights(surface().mesh, t); };
    lap("cut", start, surface().mesh.faceCount(), part_.face.size());
  }

  /// All quads across the plane are in the half's map before it is moved, and half of them are in front.
  double quadsBeside(double edgeLength) const override { return inPlane_ / (2 * edgeLength); }

  bool copy() override
  {
    const double start = secondsNow();
    report(options_.progress, 0.95, "Mirroring the quads");
    RemeshResult& result = made_.remeshed;
    result.givenUpFeatures.insert(result.givenUpFeatures.end(), givenUp_.begin(), givenUp_.end());
    const DoubledMesh doubled = doubleMesh(result.surface.mesh, made_.plane, tolerance_);
    CopiedMesh whole{ doubled.mesh, doubled.halfFaces, {}, doubleTurns(doubled, result.turns) };
    DoubledQuads quads =
      midLine_ ? quadsAcross(doubled, whole) : doubleQuads(result.quads, doubled, made_.plane);
    result.status = quads.status;
    if (!quads.status.ok())
    {
      notices_.push_back(quads.status.message);
      result.quads = {};
      return false;
    }
    locatePart(midLine_ ? halfOf(quads) : result.quads);
    const MirrorFit fit = fitImages(quads, *whole_, tolerance_,
      kFeatureReach * made_.deviation.maximum + tolerance_, options_.threads);
    takeQuads(std::move(quads), fit);
    if (!midLine_)
    {
      whole.uv = doubleMap(doubled, std::move(result.uv));
    }
    takeSurface(std::move(whole));
    tellTopology(summarizeTopology(result.surface.mesh, options_.threads),
      "the half in front of the mirror plane and its image have ");
    lap("mirror", start, result.quads.quads.size() / 2, result.quads.quads.size());
    return true;
  }

private:
  MirrorTask task() const
  {
    return { *whole_, made_.plane, tolerance_, made_.deviation.maximum, options_.threads,
      midLine_ };
  }

  /// What of the whole lies in the plane, where quads will have nothing. mesh: of the whole, with its features.
  void giveUpFeatures(Mesh& mesh)
  {
    const std::vector<Index> inPlane = featuresInPlane(mesh, made_.plane, tolerance_);
    for (const Index h : inPlane)
    {
      for (const Index side : { h, mesh.twin[h] })
      {
        mesh.flags.edit()[side] &= static_cast<std::uint8_t>(~(kFeatureEdge | kRequestedFeature));
      }
    }
    const double sized = mesh.sizing.empty() ? surface().area : quadrille::sizedArea(mesh);
    givenUp_ = givenUpCurves(
      mesh, inPlane, targetEdgeLength(options_, sized, made_.diagonal), FeatureLoss::MidLine);
    if (givenUp_.empty())
    {
      return;
    }
    double length = 0;
    for (const GivenUpCurve& curve : givenUp_)
    {
      length += curve.length;
    }
    const auto longest = std::max_element(givenUp_.begin(), givenUp_.end(),
      [](const GivenUpCurve& a, const GivenUpCurve& b) { return a.length < b.length; });
    notices_.push_back("features of the length " + shareText(length) +
      " lie in the mirror plane, which quads straddle, and are not followed; the longest one, of " +
      shareText(longest->lengthInQuads) + " edge lengths, is near " + placeText(longest->place) +
      ": choose an isoline for the plane's curve to keep them");
  }

  /// The map of the whole, with the half's boundary in the plane moved by half a quad, and its quads.
  DoubledQuads quadsAcross(const DoubledMesh& doubled, CopiedMesh& whole)
  {
    const RemeshResult& half = made_.remeshed;
    DoubledQuads failed;
    std::vector<Index> onFeatures;
    for (const SectorRequest& request : half.onFeatures)
    {
      onFeatures.push_back(request.vertex);
    }
    std::vector<FixedVec2> uv = half.uv;
    const Certificate before = half.certificate;
    MidLineOptions inset;
    inset.maximumBytes = options_.memoryLimit.value_or(freeMemory());
    inset.threads = options_.threads;
    inset.progress = subProgress(options_.progress, 0.95, 0.97);
    failed.status = insetPlane(half.surface, doubled, half.turns, onFeatures, inset, uv);
    if (!failed.status.ok())
    {
      return failed;
    }
    whole.uv = doubleMap(doubled, std::move(uv));
    const Certificate after = certify(
      whole.mesh, whole.uv, whole.turns, irregularOf(whole.mesh, whole.turns), options_.threads);
    if (after.notPositive > 2 * before.notPositive || after.wrongTurns > 2 * before.wrongTurns ||
      !after.whole())
    {
      failed.status = { StatusCode::NotConverged,
        "the map with a mid-line in the mirror plane is no integer-grid map: " + after.text() };
      return failed;
    }
    ExtractionOptions extraction;
    extraction.maximumNumberOfQuads = options_.maximumNumberOfQuads;
    extraction.smoothingSteps = options_.smoothingSteps;
    extraction.fixedVertices = indexVertices(half.surface);
    for (const Index v : indexVertices(half.surface))
    {
      extraction.fixedVertices.push_back(doubled.image[v]);
    }
    std::sort(extraction.fixedVertices.begin(), extraction.fixedVertices.end());
    extraction.mapIsCertified = after.valid();
    extraction.threads = options_.threads;
    extraction.progress = subProgress(options_.progress, 0.97, 0.98);
    const ExtractionResult extracted = extractQuads(whole.mesh, whole.uv, extraction);
    if (!extracted.status.ok())
    {
      failed.status = { extracted.status.code,
        "no quads across the mirror plane: " + extracted.status.message };
      return failed;
    }
    return foldQuads(extracted.mesh, doubled, made_.plane);
  }

  /// For its sources only.
  static QuadMesh halfOf(const DoubledQuads& quads)
  {
    QuadMesh half;
    const QuadMesh& all = quads.quads;
    half.points.assign(all.points.begin(), all.points.begin() + quads.halfPoints);
    half.sourceFace.assign(all.sourceFace.begin(), all.sourceFace.begin() + quads.halfPoints);
    half.sourceWeights.assign(
      all.sourceWeights.begin(), all.sourceWeights.begin() + quads.halfPoints);
    half.quadSourceFace.assign(
      all.quadSourceFace.begin(), all.quadSourceFace.begin() + quads.halfQuads);
    return half;
  }

  std::optional<MirrorPlane> given_; ///< normal: unit
  bool midLine_;
  std::vector<GivenUpCurve> givenUp_; ///< in the plane
  double inPlane_ = 0; ///< length of the plane's curve over the sizes; without mid-line 0
  MirrorHalf half_;
  HalfCurves curves_;
};

} // namespace

SymmetricResult remeshSymmetric(SurfaceInput input, const RemeshOptions& options,
  const SymmetryOptions& symmetry, ResultStore* store)
{
  if (!input.detectedFeatures.empty())
  {
    throw InvalidInput(
      "features that were detected on a finer surface cannot be cut by a symmetry: "
      "give them as feature edges.");
  }
  const TryScope tries; // but for those of the part's runs
  std::unique_ptr<CopiedRun> run;
  // What is left to do after a stop that has kept the quads of the part is short, and does not ask again.
  PollScope poll(!options.progress ? ProgressCallback()
                                   : [&](double fraction, const std::string& text)
      { return (run && run->isStopped()) || options.progress(fraction, text); });
  RemeshOptions ownOptions = options;
  ownOptions.progress = poll.callback();
  try
  {
    if (symmetry.planeCurve == PlaneCurve::MidLine && symmetry.rotation)
    {
      throw InvalidInput("a mid-line of quads belongs to a mirror plane, and a rotation has none: "
                         "choose an isoline, or a mirror plane");
    }
    if (symmetry.planeCurve == PlaneCurve::MidLine && options.method == MapMethod::Seamless)
    {
      throw InvalidInput("the method 'seamless' makes no quads, and a mid-line is made of them: "
                         "choose scale aware, or an isoline for the plane's curve");
    }
    if (symmetry.rotation)
    {
      run = std::make_unique<RotationRun>(ownOptions, *symmetry.rotation, store);
    }
    else
    {
      run = std::make_unique<MirrorRun>(ownOptions, symmetry, store);
    }
    SymmetricResult made = run->run(input);
    made.remeshed.tries.add(tries.counts());
    return made;
  }
  catch (const Cancelled&)
  {
    SymmetricResult stopped;
    stopped.remeshed.status = { StatusCode::Cancelled, "stopped on request; no quads were made" };
    return stopped;
  }
}

ConstraintWord judgeSymmetry(const SymmetricResult& made)
{
  ConstraintWord word;
  word.kind = made.rotation ? "rotation" : "symmetry";
  word.place = made.deviation.place;
  word.isMet = made.isAlike;
  word.deviation = made.deviation.rms / made.diagonal;
  word.deviation95 = made.deviation.maximum / made.diagonal;
  word.unit = "relative to the diagonal";
  if (!word.isMet)
  {
    word.reason = made.rotation ? "the wedges of the surface are not alike, see the notices"
                                : "the two sides of the surface are not alike, see the notices";
  }
  return word;
}

} // namespace quadrille
