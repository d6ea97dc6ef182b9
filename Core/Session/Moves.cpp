// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/Moves.h"

#include "Base/Error.h"
#include "Mesh/ContentHash.h"
#include "Pipeline/RequestKeys.h"
#include "Session/ComposedInput.h"
#include "Session/IrregularEdits.h"
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

/// The same failure would come without the constraints.
bool isForOtherReasons(const Status& status)
{
  return status.ok() || status.code == StatusCode::Cancelled || status.code == StatusCode::TooLarge;
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
  std::vector<IrregularVertex> irregular;
  FixedPlaces fixed;
  std::vector<HeldVertex> onFeatures;
  double edgeLength = 0; ///< that was asked for
};

QuadsBefore quadsBefore(const SurfaceInput& surface, const RemeshResult& without, int threads)
{
  const MadeSurface made{ without.surface };
  const OnCurves onCurves = findOnCurves(made, threads);
  return { irregularVertices(made, without.turns, onCurves, surface.drawn.valences,
             kTakenVertex * without.targetEdgeLength),
    fixedPlaces(made, onCurves, without.withoutMap), featureVertices(made, without.onFeatures),
    without.targetEdgeLength };
}

std::size_t bytesOfQuadsBefore(const QuadsBefore& before)
{
  return sizeof(before) + bytesOf(before.irregular) + bytesOf(before.fixed.edges) +
    bytesOf(before.fixed.withoutMap) + bytesOf(before.onFeatures);
}

/// Moves as the operations of a session, resolved one after the other.
class MoveList
{
public:
  MoveList(const PlacesOfSession& where, const QuadsBefore& before)
    : where_(where), irregular_(before.irregular), fixed_(before.fixed),
      onFeatures_(before.onFeatures)
  {
  }

  /// id: above 0. Fills the move's path and valence, or whyNot.
  void add(int id, PlacedConstraint& move)
  {
    IrregularEdit edit;
    edit.operation = IrregularOperation::Move;
    edit.points = move.path;
    try
    {
      resolveEdit(edit, "move " + std::to_string(move.source),
        { where_.places, fixed_, where_.sameWithin }, irregular_);
    }
    catch (const InvalidInput& error)
    {
      move.whyNot = error.what();
      return;
    }
    // Of the two changes that to a regular vertex is at the begin, but where it comes to another irregular vertex.
    const Vector3 from = nearest(move.path[0]).place;
    move.valence = nearest(move.path[0]).valence;
    Vector3 to = where_.places.nearestPlace(move.path[1]).point;
    move.distance = (move.path[1] - to).norm();
    edit.upon = list_.links();
    edit.onFeatures = onFeatures_;
    edit.withoutMap = fixed_.insideOfFaces;
    list_.apply(id, 0, edit);
    change(irregular_, edit.changes);
    to = list_.sameAs(to, where_.sameWithin);
    move.path = { from, to };
    move.valence = list_.valenceAt(to);
    auto constraint = std::make_shared<SessionConstraint>();
    constraint->id = id;
    constraint->content = std::move(edit);
    constraints_.push_back(std::move(constraint));
  }

  const SessionConstraints& constraints() const { return constraints_; }

private:
  const IrregularVertex& nearest(const Vector3& place) const
  {
    return *std::min_element(irregular_.begin(), irregular_.end(),
      [&](const IrregularVertex& a, const IrregularVertex& b)
      { return (a.place - place).squaredNorm() < (b.place - place).squaredNorm(); });
  }

  const PlacesOfSession& where_;
  std::vector<IrregularVertex> irregular_;
  const FixedPlaces& fixed_;
  const std::vector<HeldVertex>& onFeatures_;
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

/// Of what the quads without moves depend on.
ResultKey keyOfQuadsBefore(const SurfaceInput& input, const RemeshOptions& options)
{
  KeyMaker key(contentHash(input, options.threads));
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
    // Quads without the moves are none that were asked for.
    made = {};
    made.remeshed.status = { StatusCode::Cancelled, "stopped on request; no quads were made" };
  }
  return made;
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
  bool holdsFeatures = true;
  while (true)
  {
    ComposedInput composed =
      composeInput(input, where, lines, list.constraints(), leftOut, holdsFeatures);
    const bool isHeld = composed.input.regularOnFeatures;
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
    const std::string whyNot = isForOtherReasons(made.remeshed.status)
      ? lostMapText(made.remeshed.withoutMap, before.fixed.insideOfFaces)
      : made.remeshed.status.message;
    if (!whyNot.empty() && isHeld)
    {
      notices.push_back(
        "moves may change irregular vertices on features, as these cannot be held: " + whyNot);
      holdsFeatures = false;
      continue;
    }
    if (whyNot.empty() || !last)
    {
      tellLeftOut(placed, notices);
      return made;
    }
    leftOut[*last] = whyNot;
  }
}

} // namespace

bool asksForMoves(const std::vector<PlacedConstraint>& placed)
{
  return std::any_of(placed.begin(), placed.end(), isMove);
}

UncutResult remeshWithMoves(const SurfaceInput& input, const RemeshOptions& options,
  const RemeshRun& run, const KnownOfMoves& known, std::vector<PlacedConstraint>& placed,
  std::vector<std::string>& notices)
{
  const ResultKey key = known.store != nullptr ? keyOfQuadsBefore(input, options) : 0;
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
  return makeMoves(input, options, run,
    { places.places, places.paths, kOnePlace * before->edgeLength }, *before, placed, notices);
}

} // namespace quadrille
