// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/ConnectionEnds.h"

#include "Base/Lists.h"
#include "Base/PlaceText.h"
#include "Base/TryCount.h"
#include "Evaluation/ConstraintMeasures.h"
#include "Evaluation/LinesInQuads.h"
#include "Mesh/Distance.h"
#include "Pipeline/DrawnOnSurface.h"
#include "Pipeline/Notices.h"
#include "Quads/QuadSmoothing.h"
#include "Requests/CurveRequests.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <set>

namespace quadrille
{
namespace
{

/// Progress of the run with other irregular vertices free.
const std::string kSecondText =
  "Attempt 2 of at most 2, others free (connections that are not met)";

/// Points inside, off features.
std::vector<Index> irregularInside(const QuadMesh& quads)
{
  const std::vector<std::uint8_t> isOnCurve = pointsOnCurves(quads);
  return idsWhere(quads.points.size(),
    [&](Index p)
    {
      const int valence = quads.valence[p];
      return isOnCurve[p] == 0 && valence != kRegularValence && valence >= kLeastValence &&
        valence <= kMostValence;
    });
}

/// #points: whether the map has quads there, and not all fill a face or took the place of bad ones.
std::vector<std::uint8_t> pointsOfMap(const QuadMesh& quads)
{
  const bool areKnown =
    !quads.quads.empty() && quads.quadSourceWeights.size() == quads.quads.size();
  std::vector<std::uint8_t> isOfMap(quads.points.size(), areKnown ? 0 : 1);
  for (std::size_t q = 0; areKnown && q < quads.quads.size(); ++q)
  {
    const std::array<double, 3>& weights = quads.quadSourceWeights[q];
    for (const Index p : quads.quads[q])
    {
      isOfMap[p] |= weights[0] != 0 || weights[1] != 0 || weights[2] != 0 ? 1 : 0;
    }
  }
  return isOfMap;
}

/// What an end can join.
struct End
{
  Index point = kInvalidIndex; ///< that is irregular; none: on a curve
  int valence = 0;
  Vector3 place = Vector3::Zero(); ///< in the quads
};

/// The nearest in reach on the same side of a thin wall. nearest: of the quads.
std::optional<End> endAt(
  const QuadMesh& quads, const NearestQuads& nearest, double edgeLength, const Vector3& place)
{
  const QuadSide side = nearest.sideAt(place);
  std::optional<End> end;
  double least = kReachOfEnds * edgeLength;
  for (const Index p : irregularInside(quads))
  {
    const double distance = (quads.points[p] - place).norm();
    if (distance <= least && side.has(p))
    {
      least = distance;
      end = End{ p, quads.valence[p], quads.points[p] };
    }
  }
  least = std::min(least, kReachOfCurve * edgeLength);
  for (const QuadLine& line : quads.lines)
  {
    const Vector3 there = nearestOnSegment(place, quads.points[line.a], quads.points[line.b]);
    const double distance = (there - place).norm();
    if (distance <= least && (side.has(line.a) || side.has(line.b)))
    {
      least = distance;
      end = End{ kInvalidIndex, 0, there };
    }
  }
  return end;
}

/// Valences that are asked for at places and points, but for those that may drift.
std::vector<ValencePlace> fixedValences(const SurfaceInput& input)
{
  std::vector<ValencePlace> fixed =
    elementsWhere(input.drawn.valences, [](const ValencePlace& asked) { return !asked.mayDrift; });
  for (Index p = 0; p < input.targetValences.size(); ++p)
  {
    if (input.targetValences[p] != 0)
    {
      fixed.push_back({ input.points[p], input.targetValences[p] });
    }
  }
  return fixed;
}

/// Of the places with the valence of what a point of the quads is, on its side of a thin wall, the nearest one.
const ValencePlace* nearestTo(const End& end, const std::vector<ValencePlace>& valences,
  const NearestQuads& nearest, double within)
{
  return nearestOf(valences, end.valence, end.place, within,
    [&](const ValencePlace& asked) { return nearest.sideAt(asked.place).has(end.point); });
}

/// The end of a connection that joins an irregular vertex of the quads. Where a valence is asked for there, that is the
/// place; otherwise the vertex comes to the end.
void leadTo(const End& joined, const NearestQuads& nearest, double edgeLength, SurfaceInput& input,
  Vector3& end)
{
  const std::vector<ValencePlace> fixed = fixedValences(input);
  if (const ValencePlace* asked = nearestTo(joined, fixed, nearest, kMetDistance * edgeLength))
  {
    end = asked->place;
    return;
  }
  std::vector<ValencePlace>& valences = input.drawn.valences;
  const std::vector<ValencePlace> drifting =
    elementsWhere(valences, [](const ValencePlace& asked) { return asked.mayDrift; });
  if (const ValencePlace* kept =
        nearestTo(joined, drifting, nearest, kReachOfSmoothing * edgeLength))
  {
    valences.erase(std::find(valences.begin(), valences.end(), *kept));
  }
}

std::size_t countMet(const RemeshResult& made)
{
  return static_cast<std::size_t>(std::count_if(
    made.curves.begin(), made.curves.end(), [](const CurveOutcome& curve) { return curve.met; }));
}

} // namespace

ConnectionEnds::ConnectionEnds(SurfaceInput& input, const RemeshOptions& options)
  : input_(input), options_(options), whyNot_(input.curves.size())
{
  checkCurves(input);
  for (std::size_t i = 0; i < input.curves.size(); ++i)
  {
    if (!input.curves[i].isDrawn() && options.method != MapMethod::ScaleAware)
    {
      whyNot_[i] = std::string("the method '") + nameOf(options.method) +
        "' makes no connections: choose scale aware";
    }
    isMissing_ = isMissing_ || (!input.curves[i].isDrawn() && whyNot_[i].empty());
  }
}

RemeshOptions ConnectionEnds::optionsOfQuads() const
{
  RemeshOptions options = options_;
  options.preview = false; // its quads are not those that are seen
  options.progress = subProgress(options_.progress, 0, 0.5, "Without connections: ");
  return options;
}

SurfaceInput ConnectionEnds::drawn() const
{
  SurfaceInput input = input_;
  eraseIf(input.curves, [](const CurveRequest& curve) { return !curve.isDrawn(); });
  append(input.drawn.valences, held_);
  input.regularElsewhere = input.regularElsewhere || !held_.empty();
  return input;
}

bool ConnectionEnds::findIn(RemeshResult& without)
{
  isMissing_ = false;
  if (!without.stopped.empty())
  {
    without.becomeStopped(); // its quads are none that were asked for
  }
  if (!without.status.ok())
  {
    return false;
  }
  bool isAny = false;
  std::set<Index> joined;
  const NearestQuads nearest(without.quads);
  for (std::size_t i = 0; i < input_.curves.size(); ++i)
  {
    CurveRequest& curve = input_.curves[i];
    if (!curve.isDrawn())
    {
      join(curve, without, nearest, whyNot_[i], joined);
      isAny = isAny || curve.isDrawn();
      isMissing_ = isMissing_ || !curve.isDrawn();
    }
  }
  isMissing_ = isMissing_ && isAny;
  if (isAny)
  {
    hold(without, nearest, joined);
    take(without);
  }
  return isAny;
}

void ConnectionEnds::join(CurveRequest& connection, const RemeshResult& without,
  const NearestQuads& nearest, std::string& whyNot, std::set<Index>& joined)
{
  const double edgeLength = without.targetEdgeLength;
  const std::array<Vector3*, 2> places{ &connection.points.front(), &connection.points.back() };
  std::array<std::optional<End>, 2> ends;
  for (std::size_t i = 0; i < 2; ++i)
  {
    ends[i] = endAt(without.quads, nearest, edgeLength, *places[i]);
    if (!ends[i])
    {
      whyNot = "no irregular vertex, feature or boundary lies within " +
        std::to_string(static_cast<int>(kReachOfEnds)) + " quads of " + placeText(*places[i]) +
        ": draw to one, or ask for a valence there";
      return;
    }
  }
  if (ends[0]->point != kInvalidIndex && ends[0]->point == ends[1]->point)
  {
    whyNot = "both ends are nearest to the same vertex, at " + placeText(ends[0]->place) +
      ": draw between two";
    return;
  }
  whyNot.clear();
  connection.ends = { ends[0]->valence, ends[1]->valence };
  for (std::size_t i = 0; i < 2; ++i)
  {
    if (ends[i]->point != kInvalidIndex)
    {
      joined.insert(ends[i]->point);
      leadTo(*ends[i], nearest, edgeLength, input_, *places[i]);
    }
  }
  std::vector<Vector3>& points = connection.points;
  if (ends[0]->point == kInvalidIndex)
  {
    points.insert(points.begin(), ends[0]->place);
  }
  if (ends[1]->point == kInvalidIndex)
  {
    points.push_back(ends[1]->place);
  }
}

void ConnectionEnds::hold(
  const RemeshResult& without, const NearestQuads& nearest, const std::set<Index>& joined)
{
  held_.clear();
  if (input_.regularElsewhere)
  {
    return; // who asks for that has named them
  }
  const std::vector<ValencePlace> fixed = fixedValences(input_);
  const std::vector<std::uint8_t> isOfMap = pointsOfMap(without.quads);
  for (const Index p : irregularInside(without.quads))
  {
    const End vertex{ p, without.quads.valence[p], without.quads.points[p] };
    const bool isAsked = joined.count(p) != 0 ||
      nearestTo(vertex, fixed, nearest, kMetDistance * without.targetEdgeLength) != nullptr;
    if (!isAsked && isOfMap[p] != 0)
    {
      held_.push_back({ vertex.place, vertex.valence, true });
    }
  }
}

bool ConnectionEnds::mayFreeOthers(const RemeshResult& made) const
{
  const bool isOver = made.wasStopped() || made.status.code == StatusCode::TooLarge;
  return !held_.empty() && !isOver && (!made.status.ok() || countMet(made) < made.curves.size());
}

RemeshOptions ConnectionEnds::freeOthers()
{
  held_.clear();
  RemeshOptions options = options_;
  options.progress = subProgress(options_.progress, 0.5, 1, kSecondText + ": ");
  return options;
}

bool ConnectionEnds::isBetter(RemeshResult& free, RemeshResult& held)
{
  const bool isBetter = free.status.ok() && (!held.status.ok() || countMet(free) > countMet(held));
  RemeshResult& made = isBetter ? free : held;
  take(isBetter ? held : free);
  std::vector<std::string> attempts = held.attempts;
  append(attempts, free.attempts);
  made.attempts = std::move(attempts);
  ++taken_.tries.taken[static_cast<std::size_t>(Try::OthersFree)];
  made.tries.led[static_cast<std::size_t>(Try::OthersFree)] += isBetter ? 1 : 0;
  if (!isBetter && free.wasStopped() && held.status.ok())
  {
    held.stopped = kSecondText;
    held.notices.push_back(stoppedText(held.stopped));
  }
  return isBetter;
}

void ConnectionEnds::take(const RemeshResult& made)
{
  stages_.add(made.stages);
  taken_.tries.addTaken(made.tries);
  taken_.work += made.work;
  taken_.decimations += made.decimations;
  taken_.replays += made.replays;
}

void ConnectionEnds::tell(RemeshResult& result) const
{
  eraseIf(result.reused, [this](const std::string& stage) { return stages_.has(stage); });
  StageRecords stages = stages_;
  stages.add(result.stages);
  result.stages = stages.all();
  result.tries.addTaken(taken_.tries);
  result.work += taken_.work;
  result.decimations += taken_.decimations;
  result.replays += taken_.replays;
  std::vector<CurveOutcome> all;
  std::size_t next = 0;
  for (std::size_t i = 0; i < input_.curves.size(); ++i)
  {
    const CurveRequest& curve = input_.curves[i];
    if (curve.isDrawn())
    {
      all.push_back(next < result.curves.size() ? result.curves[next] : CurveOutcome{});
      ++next;
      continue;
    }
    all.push_back({ false, whyNot_[i], curve.points.front(), curve.points.back() });
  }
  result.curves = std::move(all);
}

} // namespace quadrille
