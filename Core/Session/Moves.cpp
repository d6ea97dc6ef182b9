// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/Moves.h"

#include "Base/Error.h"
#include "Session/ComposedInput.h"
#include "Session/IrregularEdits.h"

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

/// Moves as the operations of a session, resolved one after the other.
class MoveList
{
public:
  MoveList(const SurfaceInput& surface, const PlacesOfSession& where, const RemeshResult& without,
    int threads)
    : where_(where)
  {
    const MadeSurface made{ without.surface };
    const OnCurves onCurves = findOnCurves(made, threads);
    irregular_ = irregularVertices(made, without.turns, onCurves, surface.drawn.valences,
      kTakenVertex * without.targetEdgeLength);
    fixed_ = fixedPlaces(made, onCurves, without.withoutMap);
    onFeatures_ = featureVertices(made, without.onFeatures);
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
  FixedPlaces fixed_;
  std::vector<HeldVertex> onFeatures_;
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

} // namespace

bool asksForMoves(const std::vector<PlacedConstraint>& placed)
{
  return std::any_of(placed.begin(), placed.end(), isMove);
}

SymmetricResult remeshWithMoves(const SurfaceInput& input, const RemeshOptions& options,
  const RemeshRun& run, std::vector<PlacedConstraint>& placed, std::vector<std::string>& notices)
{
  RemeshOptions first = options;
  first.preview = false; // it has no places on the surface
  first.mergeCharts = false;
  first.knownMap = 0;
  SymmetricResult made = run(input, first);
  if (!made.remeshed.stopped.empty())
  {
    // Quads without the moves are none that were asked for.
    made = {};
    made.remeshed.status = { StatusCode::Cancelled, "stopped on request; no quads were made" };
  }
  if (!made.remeshed.status.ok())
  {
    return made;
  }
  const SurfacePlaces places(input, options.threads);
  const SurfacePaths paths(input, options.threads);
  const PlacesOfSession where{ places, paths, kOnePlace * made.remeshed.targetEdgeLength };
  MoveList list(input, where, made.remeshed, options.threads);
  for (std::size_t i = 0; i < placed.size(); ++i)
  {
    if (isMove(placed[i]))
    {
      list.add(static_cast<int>(i) + 1, placed[i]);
    }
  }
  const std::vector<Vector3> before = made.remeshed.withoutMap;
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
    made = run(std::move(composed.input), options);
    const std::string whyNot = isForOtherReasons(made.remeshed.status)
      ? lostMapText(made.remeshed.withoutMap, before)
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

} // namespace quadrille
