// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/RotationRun.h"

#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Evaluation/QuadQuality.h"
#include "Symmetry/RotationCopies.h"
#include "Symmetry/RotationSearch.h"

#include <cmath>
#include <memory>
#include <utility>

namespace quadrille
{

namespace
{

/// Places on both sides of a wedge may be farther from each other's image than the surface from its own, by this share
/// of the diagonal.
constexpr double kSeamReach = 1e-3;
/// And by this factor.
constexpr double kSeamFactor = 3;
/// Quads that may meet in a point on the axis: their corners have 20 degrees.
constexpr int kMostAtPole = 18;

struct StoredAxis
{
  RotationAxis axis;
  MirrorDeviation deviation;
};

ResultKey axisKey(ResultKey of, const RotationAxis& axis, int order)
{
  KeyMaker key(of);
  key.add(static_cast<std::uint64_t>(order));
  for (int i = 0; i < 3; ++i)
  {
    key.add(axis.origin[i]).add(axis.direction[i]);
  }
  return key.key();
}

} // namespace

RotationRun::RotationRun(
  const RemeshOptions& options, const RotationRequest& request, ResultStore* store)
  : CopiedRun(options, store), order_(request.order), given_(request.axis)
{
  if (order_ < kLeastOrder || order_ > kMostOrder)
  {
    throw InvalidInput("the order of a rotation must be " + std::to_string(kLeastOrder) + " to " +
      std::to_string(kMostOrder) + ", not " + std::to_string(order_));
  }
  if (given_)
  {
    const double length = given_->direction.stableNorm();
    if (!given_->origin.allFinite() || !(length > 0 && std::isfinite(length)))
    {
      throw InvalidInput("the direction of the axis of rotation must be a finite vector other than "
                         "zero, and its origin finite: give another axis, or have it found");
    }
    given_->direction.stableNormalize();
  }
}

ResultKey RotationRun::keyOf(ResultKey of) const
{
  return axisKey(of, made_.rotation->axis, order_);
}

RotationTask RotationRun::task() const
{
  return { *whole_, *made_.rotation, wedge_.startAngle, tolerance_, made_.deviation.maximum,
    options_.threads };
}

std::vector<CurveOutcome> RotationRun::outcomes(const std::vector<CurveOutcome>& ofPart) const
{
  return outcomesOfWhole(task(), curves_, ofPart);
}

void RotationRun::choose()
{
  const double start = secondsNow();
  report(options_.progress, 0.02, "Looking for the axis of rotation");
  const ResultKey key = given_
    ? axisKey(key_, *given_, order_)
    : KeyMaker(key_).add(std::uint64_t{ 2 }).add(static_cast<std::uint64_t>(order_)).key();
  auto stored = store_ != nullptr ? store_->find<StoredAxis>(key) : nullptr;
  if (stored == nullptr)
  {
    stored = std::make_shared<StoredAxis>();
    stored->axis = given_ ? *given_ : findRotationAxis(whole_->faces, order_, options_.threads);
    stored->deviation = rotationDeviation(whole_->faces, stored->axis, order_, options_.threads);
    if (store_ != nullptr)
    {
      store_->put(key, stored, sizeof(StoredAxis));
    }
    lap("axis", start, surface().mesh.faceCount(), 1);
  }
  else
  {
    reused_.emplace_back("axis");
  }
  made_.rotation = MadeRotation{ stored->axis, order_ };
  made_.deviation = stored->deviation;
  const MirrorDeviation& deviation = made_.deviation;
  tell("axis of order " + std::to_string(order_) + (given_ ? " given" : " found") + ": through " +
      placeText(stored->axis.origin) + " along " + placeText(stored->axis.direction) +
      "; turned by one step the surface is " + shareText(deviation.rms / made_.diagonal) +
      " of the diagonal from itself in the mean (root of squares), and at most " +
      shareText(deviation.maximum / made_.diagonal) + ", for " + placeText(deviation.place),
    "give another axis or order, or switch the symmetry off");
}

void RotationRun::cut()
{
  const double start = secondsNow();
  report(options_.progress, 0.08, "Cutting a wedge out of the surface");
  const double slack = kSeamReach * made_.diagonal + tolerance_;
  const WedgeReach reach{ kSeamFactor * made_.deviation.maximum + slack,
    kSeamFactor * made_.deviation.rms + slack };
  withFeatures(
    [&](Mesh& mesh)
    {
      {
        // Which features the cut meets is not known before.
        Mesh all = mesh;
        std::uint8_t* const flags = all.flags.edit();
        for (Index h = 0; h < all.halfEdgeCount(); ++h)
        {
          flags[h] |= all.isFeature(h) ? kRequestedFeature : 0;
        }
        wedge_ = cutWedge(all, made_.rotation->axis, order_, tolerance_, reach);
      }
      for (const MirrorPlane& plane : wedge_.planes)
      {
        requestCutFeatures(mesh, plane, tolerance_);
      }
      wedge_ = cutWedge(mesh, made_.rotation->axis, order_, tolerance_, reach, wedge_.startAngle);
    });
  if (!wedge_.mismatch.empty())
  {
    throw InvalidInput("the surface has no wedge of order " + std::to_string(order_) +
      " round the axis through " + placeText(made_.rotation->axis.origin) + " along " +
      placeText(made_.rotation->axis.direction) + ": " + wedge_.mismatch +
      "; give another axis or order, or switch the symmetry off");
  }
  tellPoles();
  part_.input = std::move(wedge_.input);
  for (const std::string& notice : askOfWedge(task(), wedge_, part_.input))
  {
    notices_.push_back(notice);
  }
  curves_ = askCurvesOfWedge(task());
  part_.input.curves = curves_.curves;
  part_.input.regularElsewhere = surface().regularElsewhere;
  part_.face = wedge_.face;
  part_.cornerWeights = [this](Index t) { return wedge_.weights[t]; };
  lap("cut", start, surface().mesh.faceCount(), part_.face.size());
}

/// All quads at a place on the axis are images of each other.
void RotationRun::tellPoles()
{
  if (wedge_.poles.empty())
  {
    return;
  }
  if (order_ > kMostAtPole)
  {
    throw InvalidInput("the axis meets the surface at " + placeText(wedge_.poles.front()) +
      ", where a rotation of order " + std::to_string(order_) + " needs at least " +
      std::to_string(order_) + " quads in one point, and " + std::to_string(kMostAtPole) +
      " are the limit: cut a hole round the axis, or give a divisor of the order");
  }
  constexpr int kRegular = 4;
  if (kRegular % order_ != 0)
  {
    notices_.push_back("the axis meets the surface at " + std::to_string(wedge_.poles.size()) +
      " places, one of them " + placeText(wedge_.poles.front()) +
      ": the number of quads there is a multiple of " + std::to_string(order_));
  }
}

bool RotationRun::copy()
{
  const double start = secondsNow();
  report(options_.progress, 0.95, "Turning the quads");
  RemeshResult& result = made_.remeshed;
  const MadeRotation& rotation = *made_.rotation;
  QuadMesh wedge = std::move(result.quads);
  result.quads = {};
  const WedgeSeams seams = pairSeams(wedge, result.surface.mesh, part_.input.seams, rotation);
  if (!seams.status.ok())
  {
    result.status = seams.status;
    return true;
  }
  locatePart(wedge);
  const std::vector<std::uint8_t> moved =
    fitSeams(wedge, seams.pairs, rotation, *whole_, tolerance_);
  relocate(wedge, moved);
  DoubledQuads quads = turnQuads(wedge, result.surface.mesh, seams.pairs, rotation);
  result.status = quads.status;
  if (!quads.status.ok())
  {
    notices_.push_back(quads.status.message);
    made_.pointSources.clear();
    made_.quadPolygons.clear();
    return false;
  }
  // Points in the second half plane are those of the next wedge.
  std::vector<std::uint8_t> isDouble(wedge.points.size(), 0);
  for (const SeamPoints& pair : seams.pairs)
  {
    isDouble[pair.second] = pair.first != pair.second ? 1 : 0;
  }
  std::size_t kept = 0;
  for (std::size_t p = 0; p < isDouble.size(); ++p)
  {
    if (isDouble[p] == 0)
    {
      made_.pointSources[kept++] = made_.pointSources[p];
    }
  }
  made_.pointSources.resize(kept);
  const MirrorFit fit = fitImages(quads, *whole_, tolerance_,
    kSeamFactor * made_.deviation.maximum + tolerance_, options_.threads);
  takeQuads(std::move(quads), fit);
  takeSurface(turnMesh(result.surface.mesh, result.uv, result.turns, rotation));
  const QuadQuality quality = evaluateQuads(result.quads.points, result.quads.quads);
  TopologySummary made;
  made.components = static_cast<Index>(quality.components);
  made.boundaryLoops = static_cast<Index>(quality.boundaryLoops);
  made.eulerCharacteristic = quality.eulerCharacteristic;
  tellTopology(made, "the turned quads have ");
  lap("turn", start, wedge.quads.size(), result.quads.quads.size());
  return true;
}

/// Where moved points of the wedge lie on the input.
void RotationRun::relocate(const QuadMesh& quads, const std::vector<std::uint8_t>& moved)
{
  for (std::size_t p = 0; p < moved.size(); ++p)
  {
    if (moved[p] != 0)
    {
      const NearestTriangle::Place place = *whole_->faces.at(quads.points[p]);
      made_.pointSources[p] = surface().locate(place.triangle, place.weights);
    }
  }
}

} // namespace quadrille
