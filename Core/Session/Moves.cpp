// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/Moves.h"

#include "Base/Error.h"
#include "Evaluation/ConstraintMeasures.h"
#include "Mesh/ContentHash.h"
#include "Pipeline/RequestKeys.h"
#include "Session/ComposedInput.h"
#include "Session/IrregularEdits.h"
#include "Session/IrregularMatch.h"
#include "Session/OtherChanges.h"
#include "Session/SessionText.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <utility>

namespace quadrille
{
namespace
{

bool isMove(const PlacedConstraint& constraint)
{
  return constraint.kind == ConstraintKind::Move;
}

/// The list of irregular vertices as an operation leaves it; in the order of places.
void change(
  std::vector<IrregularVertex>& irregular, const std::vector<IrregularEdit::Change>& changes)
{
  std::map<Vector3, int, PlaceOrder> valences;
  for (const IrregularVertex& vertex : irregular)
  {
    valences[vertex.place] = vertex.valence;
  }
  for (const IrregularEdit::Change& made : changes)
  {
    valences[made.place] = made.after;
  }
  irregular.clear();
  for (const auto& [place, valence] : valences)
  {
    if (valence != kRegularValence)
    {
      irregular.push_back({ place, valence });
    }
  }
}

/// What moves find in the quads without them.
struct QuadsBefore
{
  std::vector<IrregularVertex> irregular; ///< that can be moved
  std::unique_ptr<const QuadMesh> quads;  ///< their points and corners
  NearestQuads nearest;                   ///< of these
  ShownPlaces shown;                      ///< where irregular vertices are seen
  std::vector<IrregularVertex> points;    ///< all irregular points of the quads
  FixedPlaces fixed;
  std::vector<HeldVertex> onFeatures;
  std::vector<CurveOutcome> curves; ///< of the surface's
  double edgeLength = 0;            ///< that was asked for
  std::size_t withoutQuads = 0;     ///< connected components
};

QuadsBefore quadsBefore(const SurfaceInput& surface, const RemeshResult& without, int threads)
{
  const MadeSurface made{ without.surface };
  const OnCurves onCurves = findOnCurves(made, threads);
  std::vector<IrregularVertex> irregular = irregularVertices(
    made, without.turns, onCurves, surface.drawn.valences, kTakenVertex * without.targetEdgeLength);
  auto quads = std::make_unique<QuadMesh>();
  quads->points = without.quads.points;
  quads->quads = without.quads.quads;
  NearestQuads nearest(*quads);
  ShownPlaces shown = shownPlaces(irregular, without.quads, nearest);
  return { std::move(irregular), std::move(quads), std::move(nearest), std::move(shown),
    irregularPoints(without.quads), fixedPlaces(made, onCurves, without.withoutMap),
    featureVertices(made, without.onFeatures), without.curves, without.targetEdgeLength,
    without.failed.components };
}

std::size_t bytesOfQuadsBefore(const QuadsBefore& before)
{
  return sizeof(before) + bytesOf(before.irregular) + bytesOf(before.quads->points) +
    bytesOf(before.quads->quads) + before.nearest.bytes() +
    before.shown.size() * sizeof(ShownPlaces::value_type) + bytesOf(before.points) +
    bytesOf(before.fixed.edges) + bytesOf(before.fixed.withoutMap) + bytesOf(before.onFeatures) +
    bytesOf(before.curves);
}

/// Moves as the operations of a session, resolved one after the other.
class MoveList
{
public:
  MoveList(const PlacesOfSession& where, const QuadsBefore& before)
    : where_(where), irregular_(before.irregular), quads_(before.nearest), shown_(before.shown),
      points_(before.points), fixed_(before.fixed), onFeatures_(before.onFeatures),
      edgeLength_(before.edgeLength)
  {
  }

  /// id: above 0. Fills the move's path and valence, or whyNot.
  void add(int id, PlacedConstraint& move)
  {
    IrregularEdit edit;
    edit.operation = IrregularOperation::Move;
    edit.points = move.path;
    std::vector<Vector3> way;
    try
    {
      way = resolveEdit(edit, "move " + std::to_string(move.source),
        { where_.places, fixed_, where_.sameWithin, &shown_, &quads_ }, irregular_);
    }
    catch (const InvalidInput& error)
    {
      move.whyNot = error.what();
      return;
    }
    move.distance = (move.path[1] - where_.places.nearestPlace(move.path[1]).point).norm();
    move.path = way;
    edit.upon = list_.links();
    edit.onFeatures = onFeatures_;
    edit.withoutMap = fixed_.insideOfFaces;
    edit.shown = points_;
    list_.apply(id, 0, edit);
    change(irregular_, edit.changes);
    for (const IrregularEdit::Change& made : edit.changes)
    {
      quadrille::change(points_, made);
      // What was moved is not smoothed.
      shown_[made.place] = { made.place, edgeLength_, quads_.normalAt(made.place) };
    }
    move.valence = list_.valenceAt(move.path[1]);
    auto constraint = std::make_shared<SessionConstraint>();
    constraint->id = id;
    constraint->content = std::move(edit);
    constraints_.push_back(std::move(constraint));
  }

  const SessionConstraints& constraints() const { return constraints_; }

private:
  const PlacesOfSession& where_;
  std::vector<IrregularVertex> irregular_;
  const NearestQuads& quads_;
  ShownPlaces shown_;
  std::vector<IrregularVertex> points_;
  const FixedPlaces& fixed_;
  const std::vector<HeldVertex>& onFeatures_;
  double edgeLength_;
  IrregularList list_;
  SessionConstraints constraints_;
};

void tellLeftOut(const std::vector<PlacedConstraint>& placed, std::vector<std::string>& notices)
{
  for (const PlacedConstraint& constraint : placed)
  {
    if (isMove(constraint) && !constraint.whyNot.empty())
    {
      notices.push_back("an irregular vertex is not moved: " + constraint.whyNot);
    }
  }
}

/// Of what the quads without moves depend on; first: what is kept of them.
ResultKey keyOfQuads(const char* first, const SurfaceInput& input, const RemeshOptions& options)
{
  KeyMaker key(contentHash(input, options.threads));
  key.add(std::string(first));
  key.add(requestsKey(input), input.sizingOrders, input.drawn.cleared);
  for (const FeatureRequest& feature : input.drawn.features)
  {
    key.add(feature.points);
  }
  for (const SizeRequest& size : input.drawn.sizes)
  {
    key.add(size.place, size.radius, size.factor, size.order);
  }
  return key.add(settingsText(options), options.decimationCost, options.leavesOutFailed).key();
}

UncutResult runWithoutMoves(
  const SurfaceInput& input, const RemeshOptions& options, const RemeshRun& run)
{
  RemeshOptions first = options;
  first.preview = false; // it has no places on the surface
  first.mergeCharts = false;
  first.knownMap = 0;
  UncutResult made = run(input, first);
  if (!made.remeshed.stopped.empty())
  {
    made = {}; // its quads are none that were asked for
    made.remeshed.becomeStopped();
  }
  return made;
}

/// Why the last run is not what the moves ask for; empty where it is.
std::string whyNotMoved(const RemeshResult& made, const QuadsBefore& before)
{
  if (made.failsAsAsked())
  {
    return made.status.message;
  }
  const std::string lost = made.failed.lostText(before.withoutQuads);
  return lost.empty() ? lostMapText(made.withoutMap, before.fixed.insideOfFaces) : lost;
}

/// To those that are done, all irregular vertices of the quads with them.
void tellIrregular(const std::optional<std::vector<IrregularVertex>>& shown,
  const UncutResult& made, std::vector<PlacedConstraint>& placed)
{
  const auto irregular = shown ? std::make_shared<const std::vector<ValencePlace>>(
                                   expectedIrregular(*shown, isometryOf(&made)))
                               : nullptr;
  for (PlacedConstraint& constraint : placed)
  {
    if (isMove(constraint) && constraint.whyNot.empty())
    {
      constraint.irregular = irregular;
    }
  }
}

/// To the last move that is done, what else has changed. Which those are on each side of a symmetry is not known.
void tellOtherChange(const ComposedInput& composed, const UncutResult& made,
  const QuadsBefore& before, PlacedConstraint& move)
{
  if (!composed.shown || isometryOf(&made))
  {
    return;
  }
  const QuadMesh& quads = made.remeshed.quads;
  ConstraintMeasures measures(quads);
  const std::vector<Vector3> places = otherChanges(*composed.shown, quads, measures,
    judgedOf(composed.parts, measures, move.irregular.get()),
    FacesWithoutMap(before.fixed, before.edgeLength));
  if (!places.empty())
  {
    move.otherChange = { places.front(), otherChangesText(places, composed.whyNotHeld) };
  }
}

/// Connections stay what they are: their ends are in no list of irregular vertices.
SurfaceInput withEnds(SurfaceInput input, const std::vector<CurveOutcome>& curves)
{
  for (std::size_t i = 0; i < input.curves.size() && i < curves.size(); ++i)
  {
    if (curves[i].ends)
    {
      input.curves[i].setEnds(curves[i].start, curves[i].end, *curves[i].ends);
    }
  }
  return input;
}

UncutResult makeMoves(const SurfaceInput& input, const RemeshOptions& options, const RemeshRun& run,
  const PlacesOfSession& where, const QuadsBefore& before, std::vector<PlacedConstraint>& placed,
  std::vector<std::string>& notices)
{
  MoveList list(where, before);
  for (std::size_t i = 0; i < placed.size(); ++i)
  {
    if (isMove(placed[i]))
    {
      list.add(static_cast<int>(i) + 1, placed[i]);
    }
  }
  std::map<int, std::string> leftOut;
  LinePlacements lines;
  std::string whyNotHeld; // irregular vertices on features
  while (true)
  {
    ComposedInput composed =
      composeInput(input, where, lines, list.constraints(), leftOut, whyNotHeld.empty());
    composed.whyNotHeld = whyNotHeld;
    const bool isHeld = composed.input.regularOnFeatures;
    const bool areOthersHeld = composed.input.regularElsewhere;
    composed.input.points = input.points;
    composed.input.polygonOffsets = input.polygonOffsets;
    composed.input.polygonPoints = input.polygonPoints;
    std::optional<int> last;
    for (std::size_t c = 0; c < list.constraints().size(); ++c)
    {
      const int id = list.constraints()[c]->id;
      placed[static_cast<std::size_t>(id) - 1].whyNot = composed.parts[c].whyNot;
      last = composed.parts[c].whyNot.empty() ? id : last;
    }
    UncutResult made = run(std::move(composed.input), options);
    const bool wasStopped = !made.remeshed.stopped.empty();
    const std::string whyNot = wasStopped ? std::string() : whyNotMoved(made.remeshed, before);
    if (!whyNot.empty() && isHeld)
    {
      whyNotHeld = whyNot;
      continue;
    }
    if (whyNot.empty() || !last)
    {
      if (!whyNotHeld.empty())
      {
        made.remeshed.notices.push_back(
          "moves may change irregular vertices on features, as these cannot be held: " +
          whyNotHeld);
      }
      tellIrregular(composed.shown, made, placed);
      if (last && areOthersHeld && made.remeshed.status.ok() && !options.preview)
      {
        tellOtherChange(composed, made, before, placed[static_cast<std::size_t>(*last) - 1]);
      }
      tellLeftOut(placed, notices);
      return made;
    }
    leftOut[*last] = whyNot;
  }
}

} // namespace

ResultKey keyOfFailed(const SurfaceInput& input, const RemeshOptions& options)
{
  return keyOfQuads("failed components", input, options);
}

bool asksForMoves(const std::vector<PlacedConstraint>& placed)
{
  return std::any_of(placed.begin(), placed.end(), isMove);
}

UncutResult remeshWithMoves(const SurfaceInput& input, const RemeshOptions& options,
  const RemeshRun& run, const KnownOfMoves& known, std::vector<PlacedConstraint>& placed,
  std::vector<std::string>& notices)
{
  const ResultKey key = known.store != nullptr ? keyOfQuads("moves", input, options) : 0;
  std::shared_ptr<QuadsBefore> before = findIn<QuadsBefore>(known.store, key);
  if (!before)
  {
    UncutResult without = runWithoutMoves(input, options, run);
    if (!without.remeshed.status.ok())
    {
      return without;
    }
    before = std::make_shared<QuadsBefore>(quadsBefore(input, without.remeshed, options.threads));
    if (known.store != nullptr)
    {
      known.store->put(key, before, bytesOfQuadsBefore(*before));
    }
  }
  std::optional<InputPlaces> made;
  const InputPlaces& places =
    known.places != nullptr ? *known.places : made.emplace(input, options.threads);
  return makeMoves(withEnds(input, before->curves), options, run,
    { places.places, places.paths, kOnePlace * before->edgeLength }, *before, placed, notices);
}

} // namespace quadrille
