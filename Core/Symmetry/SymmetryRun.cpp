// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/SymmetryRun.h"

#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Base/TryCount.h"
#include "Features/CreaseCurves.h"
#include "Features/FeatureFilter.h"
#include "Mesh/ContentHash.h"
#include "Mesh/Sizing.h"
#include "Pipeline/Notices.h"
#include "Pipeline/PlannedSurface.h"
#include "Pipeline/QuadsOfShape.h"
#include "Pipeline/SizedSurface.h"
#include "Pipeline/SmallDetails.h"
#include "Prepare/Prepare.h"
#include "Prepare/RepairText.h"
#include "Requests/Guides.h"
#include "Symmetry/MidLine.h"
#include "Symmetry/WedgeCut.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

namespace quadrille
{

namespace
{

/// Times as many quads as were asked for, at most, where the part is too narrow for them.
constexpr std::size_t kMostTimesQuads = 4;
/// Places on both sides of a wedge may be farther from each other's image than the surface from its own, by this share
/// of the diagonal, and by kReachOfDeviation.
constexpr double kSeamReach = 1e-3;
/// Quads that may meet in a point on the axis: their corners have 20 degrees.
constexpr int kMostAtPole = 18;

/// A plane or an axis in the store.
struct StoredIsometry
{
  Isometry isometry;
  ImageDeviation deviation;
};

/// As it is asked for; origin and direction say something where they are given.
Isometry askedFor(const SymmetryOptions& symmetry)
{
  if (!symmetry.rotation)
  {
    return Isometry::of(symmetry.plane.value_or(MirrorPlane()));
  }
  const int order = symmetry.rotation->order;
  refuseIf(order < kLeastOrder || order > kMostOrder, "the order of a rotation must be ",
    kLeastOrder, " to ", kMostOrder, ", not ", order);
  return Isometry::of(symmetry.rotation->axis.value_or(RotationAxis()), order);
}

void requireDirection(const Isometry& isometry)
{
  const double length = isometry.direction.stableNorm();
  if (!isometry.origin.allFinite() || !(length > 0 && std::isfinite(length)))
  {
    throw InvalidInput(isometry.isReflection
        ? "the normal of the mirror plane must be a finite vector other than zero, and its origin "
          "finite: give another plane, or have it found"
        : "the direction of the axis of rotation must be a finite vector other than zero, and its "
          "origin finite: give another axis, or have it found");
  }
}

KeyMaker kindKey(ResultKey of, const Isometry& isometry)
{
  KeyMaker key(of);
  key.add(std::uint64_t{ isometry.isReflection });
  key.add(static_cast<std::uint64_t>(isometry.order));
  return key;
}

ResultKey placedKey(ResultKey of, const Isometry& isometry)
{
  KeyMaker key = kindKey(of, isometry);
  for (int i = 0; i < 3; ++i)
  {
    key.add(isometry.origin[i]).add(isometry.direction[i]);
  }
  return key.key();
}

} // namespace

std::string shareText(double share)
{
  std::ostringstream text;
  text << std::setprecision(2) << share;
  return text.str();
}

SymmetryRun::SymmetryRun(
  const RemeshOptions& options, const SymmetryOptions& symmetry, ResultStore* store)
  : options_(options), store_(store), isometry_(askedFor(symmetry))
{
  asked_.isGiven =
    symmetry.rotation ? symmetry.rotation->axis.has_value() : symmetry.plane.has_value();
  asked_.midLine = symmetry.planeCurve == PlaneCurve::MidLine;
  if (asked_.isGiven)
  {
    requireDirection(isometry_);
    isometry_.direction.stableNormalize();
  }
}

SymmetricResult SymmetryRun::run(SurfaceInput& input)
{
  prepare(input);
  choose();
  cut();
  remeshAndCopy();
  RemeshResult& result = made_.remeshed;
  if (isStopped() && !result.status.ok())
  {
    // With more quads there might have been some.
    throw Cancelled();
  }
  const auto putBefore = [](std::vector<std::string>& all, const std::vector<std::string>& first)
  { all.insert(all.begin(), first.begin(), first.end()); };
  putBefore(result.notices, told_.notices);
  putBefore(result.reused, told_.reused);
  result.stages = told_.laps.all();
  return std::move(made_);
}

void SymmetryRun::prepare(SurfaceInput& input)
{
  const double start = secondsNow();
  report(options_.progress, 0, "Preparing the symmetry");
  checkOptions(options_);
  if (store_ != nullptr)
  {
    key_ =
      KeyMaker(contentHash(input, options_.threads)).add(options_.featureAngle.value_or(0)).key();
    whole_ = store_->find<SearchedSurface>(key_);
  }
  if (whole_ != nullptr)
  {
    checkRequests(input);
    PreparedSurface& surface = whole_->surface;
    surface.valenceRequests.clear();
    surface.unusedValences = 0;
    collectRequests(input, surface, options_.threads);
    told_.reused.emplace_back("whole");
  }
  else
  {
    PrepareOptions prepareOptions;
    prepareOptions.featureAngle = options_.featureAngle;
    prepareOptions.threads = options_.threads;
    whole_ = std::make_shared<SearchedSurface>(prepareSurface(input, prepareOptions));
    poll();
    if (store_ != nullptr)
    {
      store_->put(key_, whole_, whole_->bytes());
    }
    lap("whole", start, input.polygonOffsets.size() - 1, surface().mesh.faceCount());
  }
  for (const std::string& sentence : repairSentences(surface().repair))
  {
    told_.notices.push_back("input: " + sentence);
  }
  tell({ settleQuads(surface(), areaOverSizes(surface()), store_, key_, options_) }, told_.notices);
  made_.diagonal = surface().boundingBoxDiagonal;
  tolerance_ = kRoundingOfSingle * made_.diagonal;
  asked_.drawn = std::move(input.drawn);
  input = {};
}

PartTask SymmetryRun::task() const
{
  return { *whole_, isometry_, part_.startAngle, tolerance_, made_.deviation.maximum,
    options_.threads, asked_.midLine };
}

ResultKey SymmetryRun::keyOf(ResultKey of) const
{
  const ResultKey key = placedKey(of, isometry_);
  return asked_.midLine ? KeyMaker(key).add(std::uint64_t{ 1 }).key() : key;
}

void SymmetryRun::choose()
{
  const double start = secondsNow();
  const std::string kind = isMirror() ? "plane" : "axis";
  report(options_.progress, 0.02,
    isMirror() ? "Looking for the mirror plane" : "Looking for the axis of rotation");
  const ResultKey key =
    asked_.isGiven ? placedKey(key_, isometry_) : kindKey(key_, isometry_).key();
  auto stored = store_ != nullptr ? store_->find<StoredIsometry>(key) : nullptr;
  if (stored == nullptr)
  {
    stored = std::make_shared<StoredIsometry>();
    stored->isometry =
      asked_.isGiven ? isometry_ : findIsometry(whole_->faces, isometry_, options_.threads);
    stored->deviation = imageDeviation(whole_->faces, stored->isometry, options_.threads);
    if (store_ != nullptr)
    {
      store_->put(key, stored, sizeof(StoredIsometry));
    }
    lap(kind.c_str(), start, surface().mesh.faceCount(), 1);
  }
  else
  {
    told_.reused.push_back(kind);
  }
  isometry_ = stored->isometry;
  made_.deviation = stored->deviation;
  if (isMirror())
  {
    made_.plane = isometry_.plane();
  }
  else
  {
    made_.rotation = MadeRotation{ isometry_.axis(), isometry_.order };
  }
  tellChosen();
}

void SymmetryRun::tellChosen()
{
  const ImageDeviation& deviation = made_.deviation;
  const std::string how =
    std::string(asked_.isGiven ? "given" : "found") + ": through " + placeText(isometry_.origin);
  const std::string rms = shareText(deviation.rms / made_.diagonal) + " of the diagonal from ";
  const std::string text =
    (isMirror() ? "mirror plane " + how + " with normal " + placeText(isometry_.direction) +
          "; the mirror image is " + rms + "the surface"
                : "axis of order " + std::to_string(isometry_.order) + " " + how + " along " +
          placeText(isometry_.direction) + "; turned by one step the surface is " + rms +
          "itself") +
    " in the mean (root of squares), and at most " + shareText(deviation.maximum / made_.diagonal) +
    ", for " + placeText(deviation.place);
  if (deviation.rms / made_.diagonal > kLeastSymmetric)
  {
    throw InvalidInput("the surface is not symmetric (" + text + "; the limit is " +
      shareText(kLeastSymmetric) + "): give another " + (isMirror() ? "plane" : "axis or order") +
      ", or switch the symmetry off");
  }
  told_.notices.push_back(text);
}

void SymmetryRun::cut()
{
  const double start = secondsNow();
  report(options_.progress, 0.08,
    isMirror() ? "Cutting the surface in half" : "Cutting a wedge out of the surface");
  isMirror() ? cutHalf() : cutOneWedge();
  for (const std::string& notice : askOfPart(task(), part_))
  {
    told_.notices.push_back(notice);
  }
  part_.input.drawn = drawnOfPart(task(), part_, asked_.drawn, told_.notices);
  asked_.curves = askCurvesOfPart(task());
  part_.input.curves = asked_.curves.curves;
  part_.input.regularElsewhere = surface().regularElsewhere;
  asked_.inPlane = asked_.midLine ? midLineLength(part_, tolerance_) : 0;
  lap("cut", start, surface().mesh.faceCount(), part_.face.size());
}

void SymmetryRun::cutHalf()
{
  const MirrorPlane plane = isometry_.plane();
  requireBothSides();
  withFeatures(
    [&](Mesh& mesh, double edgeLength)
    {
      requestCutFeatures(mesh, plane, tolerance_);
      if (asked_.midLine)
      {
        asked_.givenUp = giveUpInPlane(mesh, plane, tolerance_, edgeLength, told_.notices);
      }
      part_ = cutByPlane(mesh, plane, tolerance_);
    });
  if (asked_.midLine)
  {
    askMidLine(part_, tolerance_);
  }
}

void SymmetryRun::requireBothSides() const
{
  double front = 0, back = 0;
  for (const Vector3& p : surface().mesh.position)
  {
    front = std::max(front, isometry_.plane().height(p));
    back = std::min(back, isometry_.plane().height(p));
  }
  if (!(front > tolerance_ && back < -tolerance_))
  {
    throw InvalidInput(std::string("nothing of the surface lies ") +
      (front > tolerance_ ? "behind" : "in front of") + " the mirror plane through " +
      placeText(isometry_.origin) + " with normal " + placeText(isometry_.direction) +
      ": move the plane, or have it found");
  }
}

void SymmetryRun::cutOneWedge()
{
  const double slack = kSeamReach * made_.diagonal + tolerance_;
  const WedgeReach reach{ kReachOfDeviation * made_.deviation.maximum + slack,
    kReachOfDeviation * made_.deviation.rms + slack };
  withFeatures(
    [&](Mesh& mesh, double)
    {
      {
        // Which features the cut meets is not known before.
        Mesh all = mesh;
        std::uint8_t* const flags = all.flags.edit();
        for (Index h = 0; h < all.halfEdgeCount(); ++h)
        {
          flags[h] |= all.isFeature(h) ? kRequestedFeature : 0;
        }
        part_ = cutWedge(all, isometry_, tolerance_, reach);
      }
      for (const MirrorPlane& plane : part_.planes)
      {
        requestCutFeatures(mesh, plane, tolerance_);
      }
      part_ = cutWedge(mesh, isometry_, tolerance_, reach, part_.startAngle);
    });
  if (!part_.mismatch.empty())
  {
    throw InvalidInput("the surface has no wedge of order " + std::to_string(isometry_.order) +
      " round the axis through " + placeText(isometry_.origin) + " along " +
      placeText(isometry_.direction) + ": " + part_.mismatch +
      "; give another axis or order, or switch the symmetry off");
  }
  tellPoles();
}

/// All quads at a place on the axis are images of each other.
void SymmetryRun::tellPoles()
{
  const int order = isometry_.order;
  if (part_.poles.empty())
  {
    return;
  }
  if (order > kMostAtPole)
  {
    throw InvalidInput("the axis meets the surface at " + placeText(part_.poles.front()) +
      ", where a rotation of order " + std::to_string(order) + " needs at least " +
      std::to_string(order) + " quads in one point, and " + std::to_string(kMostAtPole) +
      " are the limit: cut a hole round the axis, or give a divisor of the order");
  }
  if (kRegularValence % order != 0)
  {
    told_.notices.push_back("the axis meets the surface at " + std::to_string(part_.poles.size()) +
      " places, one of them " + placeText(part_.poles.front()) +
      ": the number of quads there is a multiple of " + std::to_string(order));
  }
}

void SymmetryRun::withFeatures(const std::function<void(Mesh&, double edgeLength)>& act)
{
  Mesh mesh = whole_->surface.mesh;
  const double sizedArea = mesh.sizing.empty() ? surface().area : quadrille::sizedArea(mesh);
  const double edgeLength = targetEdgeLength(options_, sizedArea, made_.diagonal);
  FeatureFilterReport filtered =
    removeUnresolvedFeatures(mesh, options_.smallestDetail * edgeLength, options_.threads);
  if (judgesCreases(options_) && !whole_->surface.facets.isDesigned)
  {
    removeFalseCreases(mesh, edgeLength, options_.threads, filtered);
  }
  act(mesh, edgeLength);
}

/// Where the part is one quad wide, with twice as many quads.
void SymmetryRun::remeshAndCopy()
{
  std::string firstCrowded; // where, with the number that was asked for
  for (std::size_t more = 1;; more *= 2)
  {
    countTry(Try::TwiceTheQuads, more > 1 ? 1 : 0);
    remeshPart(more);
    told_.laps.add(made_.remeshed.stages);
    const bool isCrowded = made_.remeshed.status.ok() && !copy();
    const bool hasLed = more > 1 && made_.remeshed.status.ok() && !isCrowded;
    countTryLed(Try::TwiceTheQuads, hasLed ? 1 : 0);
    if (isCrowded && firstCrowded.empty())
    {
      firstCrowded = made_.remeshed.status.message;
    }
    if (!isCrowded && !firstCrowded.empty())
    {
      told_.notices.push_back(firstCrowded);
    }
    if (!isCrowded || isStopped() || more == kMostTimesQuads)
    {
      break; // the last one that is crowded is told as the failure
    }
  }
}

void SymmetryRun::remeshPart(std::size_t more)
{
  RemeshOptions options = options_;
  options.progress = subProgress(options_.progress, 0.1, 0.95);
  options.knownMap = 0; // it would be that of a whole
  if (maySimplify(options))
  {
    options.smallDetails = SmallDetails::Resolve; // holes on the cuts go through to the other side
  }
  double beside = 0, lengthShare = 1;
  if (options_.quads)
  {
    options.quads = more * ((*options_.quads + copies() - 1) / copies());
    beside = std::round(
      quadsBeside(std::sqrt(surface().area / static_cast<double>(copies() * *options.quads))));
    *options.quads += static_cast<std::size_t>(beside);
  }
  else
  {
    const double asked =
      options_.edgeLength ? *options_.edgeLength : options_.relativeEdgeLength * made_.diagonal;
    options.edgeLength = asked / std::sqrt(static_cast<double>(more));
    beside = quadsBeside(*options.edgeLength);
    const double share =
      surface().area / (static_cast<double>(copies()) * *options.edgeLength * *options.edgeLength);
    if (beside > 0)
    {
      lengthShare = std::sqrt(share / (share + beside));
      *options.edgeLength *= lengthShare;
    }
  }
  options.maximumNumberOfQuads = std::max<std::size_t>(1, options_.maximumNumberOfQuads / copies());
  made_.remeshed =
    store_ != nullptr ? remesh(part_.input, options, *store_) : remesh(part_.input, options);
  made_.remeshed.targetQuads -=
    std::min(static_cast<std::size_t>(beside), made_.remeshed.targetQuads - 1);
  made_.remeshed.targetQuads *= copies();
  made_.remeshed.targetEdgeLength /= lengthShare;
  made_.remeshed.curves = outcomesOfWhole(task(), asked_.curves, made_.remeshed.curves);
}

void SymmetryRun::lap(const char* stage, double start, std::size_t in, std::size_t out)
{
  told_.laps.add(stage, secondsNow() - start, in, out);
}

} // namespace quadrille
