// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/StateRun.h"

#include "Base/Clock.h"
#include "Base/Lists.h"
#include "Base/PlaceText.h"
#include "Base/TryCount.h"
#include "Session/ComposedInput.h"
#include "Session/ConstraintReports.h"
#include "Session/DrawnRun.h"
#include "Symmetry/Symmetry.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace quadrille
{
namespace
{

/// Whether the run has taken details of the surface out, with which nothing else led to quads.
bool hasFewerDetails(const RemeshResult& made)
{
  return made.status.ok() && made.tries.led[static_cast<std::size_t>(Try::FewerDetails)] > 0;
}

/// Whether quads that fill a face without a map cannot have it.
bool asksOfMap(const ConstraintContent& content)
{
  return std::holds_alternative<ValenceAt>(content) ||
    std::holds_alternative<IrregularEdit>(content) || std::holds_alternative<Connection>(content) ||
    std::holds_alternative<Cycle>(content);
}

/// All runs that a state needs.
class StateRun
{
public:
  StateRun(SessionData& data, const SessionState& state, bool isPreview)
    : data_(data), state_(state), options_(state.settings)
  {
    options_.threads = data.limits.threads;
    options_.memoryLimit = data.limits.memoryLimit;
    options_.progress = data.limits.progress;
    options_.preview = isPreview;
    options_.mergeCharts = false;
    options_.knownMap = 0;
  }

  MadeState run()
  {
    const double start = secondsNow();
    const TryScope tries; // but for those of the pipeline's runs
    RemeshResult made = runUntilMet();
    if (made.status.code == StatusCode::Cancelled)
    {
      return { nullptr, made.status };
    }
    auto result = std::make_shared<SessionResult>();
    takeIrregular(made, *result);
    result->targetEdgeLength = made.targetEdgeLength;
    result->targetQuads = made.targetQuads;
    takeReport(made, *result);
    result->report.tries.add(tries.counts());
    if (made.status.ok())
    {
      result->mirrorPoint = std::move(mirrored_.mirrorPoint);
      result->rotatedPoint = std::move(mirrored_.rotatedPoint);
    }
    result->quads = std::move(made.quads);
    result->report.seconds = secondsNow() - start;
    return { std::move(result), {} };
  }

private:
  /// Of constraints that cannot be met together with all that came before, each is left out.
  RemeshResult runUntilMet()
  {
    std::map<int, std::string> leftOut;
    RemeshResult made = runWith(leftOut);
    if (fails(made, leftOut) && composed_.input.regularOnFeatures)
    {
      whyNotHeld_ = reasonOf(made);
      countTry(Try::WithoutHeld, wasStopped_ ? 0 : 1);
      made = runWith(leftOut);
    }
    while (fails(made, leftOut))
    {
      const auto culprit = lastOfShortestFailing(leftOut);
      if (!culprit)
      {
        compose(leftOut);
        break;
      }
      leftOut.insert(*culprit);
      made = runWith(leftOut);
    }
    if (made.status.ok())
    {
      countTryLed(Try::WithoutHeld, whyNotHeld_.empty() ? 0 : 1);
      countTryLed(Try::WithoutConstraint, leftOut.size());
      countTryLed(Try::WithoutSymmetry, refused_.size());
    }
    return made;
  }

  /// Whether it may have failed for the sake of constraints: without quads, or as no constraint may change the topology
  /// of the surface. leftOut: of that run.
  bool fails(const RemeshResult& made, const std::map<int, std::string>& leftOut)
  {
    if (made.failsAsAsked())
    {
      return true;
    }
    const auto isAny = [](const ConstraintContent&) { return true; };
    if (wasStopped_)
    {
      return false;
    }
    if (hasFewerDetails(made) && isLeft(isAny, leftOut) &&
      !hasFewerDetails(without(isAny, withoutAny_, leftOut)))
    {
      return true;
    }
    return !made.withoutMap.empty() && isLeft(asksOfMap, leftOut) &&
      !lostMapText(made.withoutMap, without(asksOfMap, withoutMapConstraints_, leftOut).withoutMap)
         .empty();
  }

  /// Whether some constraint of these kinds is in force.
  bool isLeft(
    bool (*isOne)(const ConstraintContent&), const std::map<int, std::string>& leftOut) const
  {
    return std::any_of(state_.constraints.begin(), state_.constraints.end(),
      [&](const auto& constraint)
      { return isOne(constraint->content) && leftOut.count(constraint->id) == 0; });
  }

  /// What is made without those, but for the quads.
  const RemeshResult& without(bool (*isOne)(const ConstraintContent&),
    std::optional<RemeshResult>& known, const std::map<int, std::string>& leftOut)
  {
    if (!known)
    {
      std::map<int, std::string> others;
      for (const auto& constraint : state_.constraints)
      {
        if (isOne(constraint->content))
        {
          others[constraint->id] = "not tried";
        }
      }
      SymmetricResult mirrored = std::move(mirrored_);
      known = runOnce(others);
      mirrored_ = std::move(mirrored);
      known->quads = {};
      known->framed.reset();
      compose(leftOut);
    }
    return *known;
  }

  std::string reasonOf(const RemeshResult& made) const
  {
    if (!made.status.ok())
    {
      return made.status.message;
    }
    const std::string face = withoutMapConstraints_
      ? lostMapText(made.withoutMap, withoutMapConstraints_->withoutMap)
      : std::string();
    return !face.empty()
      ? face
      : "no attempt has led to quads that keep all handles and boundary loops of "
        "the surface: ask for "
        "smaller quads, or have these simplified (Small Details)";
  }

  void takeIrregular(const RemeshResult& made, SessionResult& result)
  {
    if (made.status.ok() && !options_.preview)
    {
      const MadeSurface surface = made.framed
        ? MadeSurface{ *made.framed, &made.frame, &data_.surface.points }
        : MadeSurface{ made.surface };
      const auto onCurves = data_.onCurvesOf(surface);
      result.irregular = irregularVertices(surface, made.turns, *onCurves,
        composed_.input.drawn.valences, kTakenVertex * made.targetEdgeLength);
      result.fixed = fixedPlaces(surface, *onCurves, made.withoutMap);
      result.onFeatures = featureVertices(surface, made.onFeatures);
      takeJoined(made, result);
    }
  }

  void takeJoined(const RemeshResult& made, SessionResult& result) const
  {
    for (std::size_t i = 0; i < state_.constraints.size(); ++i)
    {
      const std::optional<std::size_t>& curve = composed_.parts[i].curve;
      const CurveOutcome* outcome = curve ? &made.curves[*curve] : nullptr;
      if (outcome != nullptr && outcome->ends)
      {
        const auto& [start, end] = *outcome->ends;
        result.joined.push_back({ state_.constraints[i]->id, state_.constraints[i]->revision,
          outcome->start, outcome->end, start, end });
      }
    }
  }

  /// result: its irregular vertices and sizes are there.
  void takeReport(const RemeshResult& made, SessionResult& result)
  {
    SessionReport& report = result.report;
    report.status = made.status;
    report.stopped = made.stopped;
    report.notices = composed_.notices;
    report.notices.insert(report.notices.end(), made.notices.begin(), made.notices.end());
    report.stages = stages_.all();
    std::copy_if(made.reused.begin(), made.reused.end(), std::back_inserter(report.reused),
      [this](const std::string& name) { return !stages_.has(name); });
    report.runs = runs_;
    report.tries.addTaken(tries_);
    report.tries.addLed(made.tries);
    if (made.status.ok() && composed_.symmetry && !mirrored_.rotation &&
      composed_.input.regularElsewhere)
    {
      tellOtherIrregular(result);
    }
    if (!options_.preview)
    {
      report.constraints = reportConstraints(data_.surface, data_.places(state_.settings).places,
        state_.constraints, composed_, made, result, composed_.symmetry ? &mirrored_ : nullptr,
        options_.quads.has_value());
    }
    for (const ConstraintReport& word : report.constraints)
    {
      if (word.isOffSurface)
      {
        report.notices.push_back(word.text + ": " + withRemark(word.reason, word.remark));
      }
    }
  }

  /// Where that fails, or more faces have no map than without what only a map can have: once more with the faces that
  /// have none without it cut out from the beginning, so that no attempt fails for their sake.
  RemeshResult runWith(const std::map<int, std::string>& leftOut)
  {
    RemeshResult made = runOnce(leftOut);
    if (wasStopped_ || !isLeft(asksOfMap, leftOut) || composed_.symmetry ||
      !composed_.input.withoutMap.empty() || !(made.failsAsAsked() || !made.withoutMap.empty()))
    {
      return made;
    }
    const std::vector<Vector3>& before =
      without(asksOfMap, withoutMapConstraints_, leftOut).withoutMap;
    if (!before.empty() && (made.failsAsAsked() || made.withoutMap.size() > before.size()))
    {
      isCutBefore_ = true;
      made = runOnce(leftOut);
    }
    return made;
  }

  RemeshResult runOnce(const std::map<int, std::string>& leftOut)
  {
    if (wasStopped_)
    {
      RemeshResult none;
      none.becomeStopped();
      return none;
    }
    compose(leftOut);
    mirrored_ = {};
    std::optional<RemeshResult> symmetric;
    while (composed_.symmetry && !symmetric)
    {
      symmetric = runSymmetric(leftOut);
    }
    RemeshResult made = symmetric ? std::move(*symmetric) : runQuads();
    // Where faces were filled, their triangles are beside those of the others and not joined to them.
    data_.keepSurface(made.withoutMap.empty() ? made.framed : nullptr, made.frame);
    wasStopped_ = made.wasStopped();
    stages_.add(made.stages);
    ++runs_;
    tries_.addTaken(made.tries);
    return made;
  }

  RemeshResult runQuads() { return remeshQuads(composed_.input, options_, data_.store); }

  /// In the mirror plane the half has its boundary, where vertices may become irregular that no operation asks for.
  void tellOtherIrregular(SessionResult& result) const
  {
    const double reach = kTakenVertex * result.targetEdgeLength;
    for (const IrregularVertex& vertex : result.irregular)
    {
      const auto asked = std::find_if(composed_.irregular.begin(), composed_.irregular.end(),
        [&](const IrregularVertex& other) { return (other.place - vertex.place).norm() <= reach; });
      const int valence = asked == composed_.irregular.end() ? kRegularValence : asked->valence;
      if (mirrored_.plane.height(vertex.place) >= -kRoundingOfSingle * mirrored_.diagonal &&
        valence != vertex.valence)
      {
        result.report.notices.push_back("the operations leave valence " + std::to_string(valence) +
          " at " + placeText(vertex.place) + ", but the symmetric quads have " +
          std::to_string(vertex.valence) + " there");
      }
    }
  }

  void compose(std::map<int, std::string> leftOut)
  {
    leftOut.insert(refused_.begin(), refused_.end());
    composed_ = composeInput(data_.surface, data_.places(state_.settings), data_.lines,
      state_.constraints, leftOut, whyNotHeld_.empty());
    composed_.whyNotHeld = whyNotHeld_;
    if (isCutBefore_ && isLeft(asksOfMap, leftOut) && composed_.input.withoutMap.empty())
    {
      composed_.input.withoutMap = withoutMapConstraints_->withoutMap;
    }
  }

  /// None where the surface has no such symmetry, whatever else is asked of it: then it is left out of all runs. Were
  /// the input at fault in another way, a run without it would say so.
  std::optional<RemeshResult> runSymmetric(const std::map<int, std::string>& leftOut)
  {
    const SessionConstraint& constraint = *state_.constraints[*composed_.symmetry];
    try
    {
      SymmetryOptions symmetry;
      if (const auto* rotation = std::get_if<RotationalSymmetry>(&constraint.content))
      {
        symmetry.rotation = RotationRequest{ rotation->order, rotation->axis };
      }
      else
      {
        const auto& mirror = std::get<MirrorSymmetry>(constraint.content);
        symmetry.plane = mirror.plane;
        symmetry.planeCurve = mirror.planeCurve;
      }
      mirrored_ = remeshSymmetric(composed_.input, options_, symmetry, &data_.store);
      return std::move(mirrored_.remeshed);
    }
    catch (const InvalidInput& error)
    {
      countTry(Try::WithoutSymmetry);
      refused_[constraint.id] = error.what();
      compose(leftOut);
      return std::nullopt;
    }
  }

  /// Of the constraints that are not left out, in their order, the last one of the shortest row that has no result,
  /// and why. None where there is none, as the surface has no result either.
  std::optional<std::pair<int, std::string>> lastOfShortestFailing(
    const std::map<int, std::string>& leftOut)
  {
    const std::vector<Index> rest = idsWhere(
      state_.constraints.size(), [&](Index i) { return composed_.parts[i].whyNot.empty(); });
    std::map<int, std::string> without = leftOut;
    const auto last = quadrille::lastOfShortestFailing(rest.size(),
      [&](std::size_t count)
      {
        without[state_.constraints[rest[count]]->id] = "not tried";
        countTry(Try::WithoutConstraint, wasStopped_ ? 0 : 1);
        return fails(runWith(without), without);
      });
    if (!last)
    {
      return std::nullopt;
    }
    // The reason is that of the row with it.
    const int id = state_.constraints[rest[*last]]->id;
    without.erase(id);
    const std::string whyNot = reasonOf(runWith(without));
    const auto nameOfRest = [&](std::size_t i) { return state_.constraints[rest[i]]->name(); };
    return std::make_pair(id, cannotBeMet(*last, nameOfRest, whyNot));
  }

  SessionData& data_;
  const SessionState& state_;
  RemeshOptions options_;
  ComposedInput composed_;
  SymmetricResult mirrored_; ///< of the last run, without `remeshed`
  std::string whyNotHeld_;   ///< vertices on features and boundaries; empty while they are
  /// What is made without any constraints, and without those that only a map can have; none: not known.
  std::optional<RemeshResult> withoutAny_, withoutMapConstraints_;
  bool isCutBefore_ =
    false; ///< faces that have no map in the latter are cut out from the beginning
  std::map<int, std::string> refused_; ///< symmetries that the surface has not, and why
  StageRecords stages_;
  bool wasStopped_ = false; ///< no run may follow
  int runs_ = 0;
  TryCounts tries_; ///< of the pipeline's runs, taken
};
} // namespace

MadeState runState(SessionData& data, const SessionState& state, bool isPreview)
{
  return StateRun(data, state, isPreview).run();
}

} // namespace quadrille
