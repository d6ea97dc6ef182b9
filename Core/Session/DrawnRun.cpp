// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/DrawnRun.h"

#include "Base/TryCount.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <set>
#include <utility>

namespace quadrille
{
namespace
{

bool isDrawnMove(const PlacedConstraint& constraint)
{
  return constraint.kind == ConstraintKind::Move;
}

bool isDrawnCurve(const PlacedConstraint& constraint)
{
  return constraint.kind == ConstraintKind::Connection || constraint.kind == ConstraintKind::Cycle;
}

std::string nameOfPlaced(const PlacedConstraint& constraint)
{
  return std::string(nameOf(constraint.kind)) + ' ' + std::to_string(constraint.source);
}

/// Keeps those of a list that the placed ones of a kind, in their order, stand for.
template <typename Request>
void keepOf(ConstraintKind kind, const std::vector<PlacedConstraint>& placed,
  const std::vector<bool>& isLeftOut, std::vector<Request>& requests)
{
  std::vector<Request> kept;
  std::size_t at = 0;
  for (std::size_t i = 0; i < placed.size(); ++i)
  {
    if (placed[i].kind != kind || !placed[i].whyNot.empty())
    {
      continue;
    }
    if (!isLeftOut[i])
    {
      kept.push_back(std::move(requests.at(at)));
    }
    ++at;
  }
  requests = std::move(kept);
}

/// Several at one place are one request.
void keepValences(const std::vector<PlacedConstraint>& placed, const std::vector<bool>& isLeftOut,
  std::vector<ValencePlace>& requests)
{
  std::set<std::size_t> kept;
  for (std::size_t i = 0; i < placed.size(); ++i)
  {
    if (placed[i].kind == ConstraintKind::Valence && placed[i].whyNot.empty() && !isLeftOut[i])
    {
      const Vector3& at = placed[i].path.front();
      const auto nearest = std::min_element(requests.begin(), requests.end(),
        [&](const ValencePlace& a, const ValencePlace& b)
        { return (a.place - at).squaredNorm() < (b.place - at).squaredNorm(); });
      kept.insert(static_cast<std::size_t>(nearest - requests.begin()));
    }
  }
  std::vector<ValencePlace> left;
  std::transform(
    kept.begin(), kept.end(), std::back_inserter(left), [&](std::size_t i) { return requests[i]; });
  requests = std::move(left);
}

void keepCurves(std::vector<PlacedConstraint>& placed, const std::vector<bool>& isLeftOut,
  std::vector<CurveRequest>& curves)
{
  std::vector<bool> goes(curves.size(), false);
  for (std::size_t i = 0; i < placed.size(); ++i)
  {
    if (isDrawnCurve(placed[i]) && isLeftOut[i])
    {
      goes.at(placed[i].curve) = true;
    }
  }
  std::vector<std::size_t> now(curves.size(), 0);
  std::vector<CurveRequest> kept;
  for (std::size_t c = 0; c < curves.size(); ++c)
  {
    now[c] = kept.size();
    if (!goes[c])
    {
      kept.push_back(std::move(curves[c]));
    }
  }
  for (std::size_t i = 0; i < placed.size(); ++i)
  {
    placed[i].curve = isDrawnCurve(placed[i]) ? now[placed[i].curve] : placed[i].curve;
  }
  curves = std::move(kept);
}

/// The runs of one surface.
class DrawnRun
{
public:
  DrawnRun(const SurfaceInput& input, const RemeshOptions& options, const RemeshRun& run,
    const KnownOfMoves& known, const std::vector<PlacedConstraint>& placed)
    : input_(input), options_(options), run_(run), known_(known), placed_(placed),
      isLeftOut_(placed.size(), false)
  {
    for (std::size_t i = 0; i < placed.size(); ++i)
    {
      if (!isDrawnMove(placed[i]) && placed[i].whyNot.empty())
      {
        rest_.push_back(i); // moves are left out where they are made
      }
    }
  }

  UncutResult make()
  {
    UncutResult made = runWithout(isLeftOut_);
    if (rest_.empty() || !fails(made))
    {
      return made;
    }
    const std::vector<PlacedConstraint> ofAll = made_;
    const std::vector<std::string> noticesOfAll = notices_;
    const bool failsWithout = failsWithoutAny();
    if (failsWithout || !fails(made))
    {
      made_ = ofAll; // without them it is so, too
      notices_ = noticesOfAll;
      return made;
    }
    while (fails(made))
    {
      const auto last = lastOfShortestFailing(rest_.size(),
        [&](std::size_t count)
        {
          countTry(Try::WithoutConstraint);
          return fails(runWithout(withFirst(count)));
        });
      if (wasStopped_ || !last)
      {
        return stopped();
      }
      leaveOut(*last);
      made = runWithout(isLeftOut_);
    }
    countTryLed(
      Try::WithoutConstraint, made.remeshed.status.ok() ? whyNot_.size() : std::size_t{ 0 });
    return made;
  }

  /// Of the last run.
  void take(std::vector<PlacedConstraint>& placed, std::vector<std::string>& notices)
  {
    placed = std::move(made_);
    for (const auto& [i, why] : whyNot_)
    {
      placed[i].whyNot = why;
      notices.push_back(nameOfPlaced(placed[i]) + " is left out: " + why);
    }
    notices.insert(notices.end(), notices_.begin(), notices_.end());
  }

private:
  static UncutResult stopped()
  {
    UncutResult none;
    none.remeshed.becomeStopped();
    return none;
  }

  /// Altogether, or in more components than without what was drawn.
  bool fails(const UncutResult& made) const
  {
    return made.remeshed.failsAsAsked() || made.remeshed.failed.components > withoutQuads_;
  }

  /// Whether it fails altogether without the rest; else it is known then how many components do.
  bool failsWithoutAny()
  {
    std::vector<PlacedConstraint> placed = placed_;
    const ResultKey key = known_.store == nullptr
      ? 0
      : keyOfFailed(withoutDrawn(input_, withFirst(0), placed), options_);
    const auto known = findIn<std::size_t>(known_.store, key);
    if (known)
    {
      withoutQuads_ = *known;
      return false;
    }
    const UncutResult without = runWithout(withFirst(0));
    withoutQuads_ = without.remeshed.failed.components;
    const bool isWhole = without.remeshed.status.ok() && !wasStopped_;
    if (isWhole && known_.store != nullptr)
    {
      known_.store->put(key, std::make_shared<std::size_t>(withoutQuads_), sizeof(std::size_t));
    }
    return without.remeshed.failsAsAsked();
  }

  /// The first `count` of the rest.
  std::vector<bool> withFirst(std::size_t count) const
  {
    std::vector<bool> isLeftOut = isLeftOut_;
    for (std::size_t r = count; r < rest_.size(); ++r)
    {
      isLeftOut[rest_[r]] = true;
    }
    return isLeftOut;
  }

  UncutResult runWithout(const std::vector<bool>& isLeftOut)
  {
    if (wasStopped_)
    {
      return stopped();
    }
    made_ = placed_;
    notices_.clear();
    SurfaceInput input = withoutDrawn(input_, isLeftOut, made_);
    UncutResult made = asksForMoves(made_)
      ? remeshWithMoves(input, options_, run_, known_, made_, notices_)
      : run_(std::move(input), options_);
    wasStopped_ = made.remeshed.wasStopped();
    return made;
  }

  /// r: in the rest.
  void leaveOut(std::size_t r)
  {
    const UncutResult with = runWithout(withFirst(r + 1));
    isLeftOut_[rest_[r]] = true;
    const std::string lost = with.remeshed.failed.lostText(withoutQuads_);
    whyNot_.emplace_back(rest_[r],
      cannotBeMet(
        r, [this](std::size_t i) { return nameOfPlaced(placed_[rest_[i]]); },
        lost.empty() ? with.remeshed.status.message : lost));
    rest_.erase(rest_.begin() + static_cast<std::ptrdiff_t>(r));
  }

  const SurfaceInput& input_;
  const RemeshOptions& options_;
  const RemeshRun& run_;
  const KnownOfMoves& known_;
  const std::vector<PlacedConstraint>& placed_;
  std::vector<bool> isLeftOut_;
  std::vector<std::size_t> rest_; ///< that may be left out, and are not so far
  std::vector<std::pair<std::size_t, std::string>> whyNot_;
  std::size_t withoutQuads_ = 0; ///< connected components, whatever is drawn
  bool wasStopped_ = false;      ///< no run may follow
  // Of the last run:
  std::vector<PlacedConstraint> made_;
  std::vector<std::string> notices_;
};

} // namespace

SurfaceInput withoutDrawn(const SurfaceInput& input, const std::vector<bool>& isLeftOut,
  std::vector<PlacedConstraint>& placed)
{
  SurfaceInput result = input;
  if (std::find(isLeftOut.begin(), isLeftOut.end(), true) == isLeftOut.end())
  {
    return result;
  }
  DrawnRequests& drawn = result.drawn;
  keepOf(ConstraintKind::Feature, placed, isLeftOut, drawn.features);
  keepOf(ConstraintKind::Stroke, placed, isLeftOut, drawn.strokes);
  keepOf(ConstraintKind::Cleared, placed, isLeftOut, drawn.cleared);
  keepOf(ConstraintKind::Size, placed, isLeftOut, drawn.sizes);
  keepValences(placed, isLeftOut, drawn.valences);
  keepCurves(placed, isLeftOut, result.curves);
  return result;
}

UncutResult remeshWithDrawn(const SurfaceInput& input, const RemeshOptions& options,
  const RemeshRun& run, const KnownOfMoves& known, std::vector<PlacedConstraint>& placed,
  std::vector<std::string>& notices)
{
  DrawnRun drawn(input, options, run, known, placed);
  UncutResult made = drawn.make();
  drawn.take(placed, notices);
  return made;
}

} // namespace quadrille
