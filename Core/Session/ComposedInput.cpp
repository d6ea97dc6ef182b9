// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/ComposedInput.h"

#include "Base/Lists.h"
#include "Base/PlaceText.h"
#include "Base/Refuse.h"
#include "Session/IrregularEdits.h"
#include "Session/IrregularMatch.h"

#include <algorithm>

namespace quadrille
{
namespace
{

/// Lines that are remembered; one across ten thousand polygons takes a megabyte.
constexpr std::size_t kMostPlacements = 256;

class Composition
{
public:
  Composition(const SurfaceInput& surface, const PlacesOfSession& where, LinePlacements& lines,
    const SessionConstraints& constraints, bool holdFeatures)
    : surface_(surface), where_(where), lines_(lines), constraints_(constraints),
      holdFeatures_(holdFeatures)
  {
    composed_.input = surface;
    composed_.parts.resize(constraints.size());
    for (std::size_t p = 0; p < surface.targetValences.size(); ++p)
    {
      if (surface.targetValences[p] != 0)
      {
        asked_.push_back({ surface.points[p], surface.targetValences[p], "the array of valences" });
      }
    }
    for (const ValencePlace& asked : surface.drawn.valences)
    {
      asked_.push_back({ asked.place, asked.valence, "a valence point" });
    }
    ofSurface_ = asked_.size();
  }

  ComposedInput run(const std::map<int, std::string>& leftOut)
  {
    for (std::size_t i = 0; i < constraints_.size(); ++i)
    {
      const SessionConstraint& constraint = *constraints_[i];
      at_ = i;
      part().place = placeOf(constraint.content).value_or(Vector3::Zero());
      const auto found = leftOut.find(constraint.id);
      if (found != leftOut.end())
      {
        part().whyNot = found->second;
        continue;
      }
      try
      {
        std::visit(*this, constraint.content);
      }
      catch (const InvalidInput& error)
      {
        part().whyNot = error.what();
      }
    }
    setValences();
    setJoined();
    setEdits();
    return std::move(composed_);
  }

  void operator()(const FeatureLine&)
  {
    const LinePlacements::Placed& placed = takePlaced();
    if (part().whyNot.empty())
    {
      composed_.input.drawn.features.push_back(placed.requests.features.front());
    }
  }

  void operator()(const ClearedAt& at)
  {
    part().place = where_.places.nearestPlace(at.point).point;
    composed_.input.drawn.cleared.push_back(part().place);
  }

  void operator()(const GuideStroke&)
  {
    const LinePlacements::Placed& placed = takePlaced();
    if (part().whyNot.empty())
    {
      part().guided = placed.line.guided;
      composed_.input.drawn.strokes.push_back(placed.requests.strokes.front());
      composed_.input.drawn.strokes.back().order = order();
    }
  }

  void operator()(const GuideRegion& region)
  {
    std::vector<Index> polygons = region.polygons;
    sortUnique(polygons);
    for (const Index polygon : polygons)
    {
      if (surface_.polygonOffsets[polygon] != surface_.polygonOffsets[polygon + 1])
      {
        part().guided.push_back(guidedPolygon(surface_, polygon, region.direction, region.weight));
      }
    }
    if (part().guided.empty())
    {
      part().whyNot = "its polygons have no corners";
      return;
    }
    part().place = part().guided.front().place;
    takeGuides(region);
  }

  void operator()(const ValenceAt& at)
  {
    const SurfacePlaces::Place place = where_.places.nearestPlace(at.point);
    part().place = place.point;
    if (at.valence < kLeastOnBoundary && where_.places.isOnBoundary(place))
    {
      refuse("valence ", at.valence, " is asked for at ", placeText(place.point),
        ", on the boundary, where the least is 3, a corner with one quad: ask for 3 or more");
    }
    const Vector3 same = list_.sameAs(place.point, where_.sameWithin);
    const int by = list_.changedBy(same);
    if (by != 0 && list_.valenceAt(same) != at.valence)
    {
      refuse("it asks for valence ", at.valence, " at ", placeText(place.point), ", where ",
        nameOf(by), " has made one of ", list_.valenceAt(same), ": remove one of the two");
    }
    const Asked* other = askedAt(place.point);
    if (other != nullptr && other->valence != at.valence)
    {
      refuse("it asks for valence ", at.valence, " at ", placeText(place.point), ", where ",
        other->by, " asks for ", other->valence, ": remove one of the two");
    }
    if (other == nullptr)
    {
      asked_.push_back({ same, at.valence, name() });
      part().place = same;
    }
  }

  void operator()(const SizeAt& at)
  {
    part().place = where_.places.nearestPlace(at.point).point;
    composed_.input.drawn.sizes.push_back({ part().place, at.radius, at.factor, order() });
  }

  void operator()(const SizeRegion& region)
  {
    std::vector<Index> points;
    for (const Index polygon : region.polygons)
    {
      points.insert(points.end(), surface_.polygonPoints.begin() + surface_.polygonOffsets[polygon],
        surface_.polygonPoints.begin() + surface_.polygonOffsets[polygon + 1]);
    }
    if (points.empty())
    {
      part().whyNot = "its polygons have no corners";
      return;
    }
    part().place = surface_.points[points.front()];
    takeSizes(points, region.factor);
  }

  void operator()(const IrregularEdit& edit)
  {
    IrregularList next = list_;
    for (const IrregularEdit::Change& change : edit.changes)
    {
      part().place = change.place;
    }
    part().whyNot = next.apply(id(), constraints_[at_]->revision, edit);
    if (!part().whyNot.empty())
    {
      return;
    }
    for (const IrregularEdit::Change& change : edit.changes)
    {
      const Asked* asked = askedAt(change.place);
      if (asked != nullptr && asked->valence != change.after)
      {
        refuse("it would make a vertex of valence ", change.after, " at ", placeText(change.place),
          ", where ", asked->by, " asks for ", asked->valence, ": remove one of the two");
      }
    }
    list_ = std::move(next);
  }

  void operator()(const Connection&) { addCurve(); }
  void operator()(const Cycle&) { addCurve(); }
  void operator()(const MirrorSymmetry&) { takeSymmetry(); }
  void operator()(const RotationalSymmetry&) { takeSymmetry(); }

private:
  void takeSymmetry()
  {
    if (composed_.symmetry)
    {
      const std::string earlier = constraints_[*composed_.symmetry]->name();
      refuse("there is ", earlier, " already, and quads have one symmetry: remove ", earlier,
        " or ", name());
    }
    composed_.symmetry = at_;
  }

  struct Asked
  {
    Vector3 place = Vector3::Zero();
    int valence = 0;
    std::string by;
  };

  /// Of what is asked for at the same place the first one; null: nothing.
  const Asked* askedAt(const Vector3& place) const
  {
    const auto found = std::find_if(asked_.begin(), asked_.end(),
      [&](const Asked& asked) { return (asked.place - place).norm() <= where_.sameWithin; });
    return found == asked_.end() ? nullptr : &*found;
  }

  std::size_t polygons() const { return surface_.polygonOffsets.size() - 1; }
  PlacedPart& part() { return composed_.parts[at_]; }
  int id() const { return constraints_[at_]->id; }
  int order() const { return static_cast<int>(at_) + 1; }
  std::string name() const { return constraints_[at_]->name(); }
  std::string nameOf(int id) const
  {
    const auto found = std::find_if(constraints_.begin(), constraints_.end(),
      [id](const auto& constraint) { return constraint->id == id; });
    return (*found)->name();
  }

  void addCurve()
  {
    const LinePlacements::Placed& placed = takePlaced();
    part().curve = composed_.input.curves.size();
    composed_.input.curves.push_back(placed.curves.front());
  }

  const LinePlacements::Placed& takePlaced()
  {
    const LinePlacements::Placed& placed = lines_.of(constraints_[at_], surface_, where_);
    part().whyNot = placed.line.whyNot;
    part().path = placed.line.path;
    part().remark = placed.line.remark;
    part().place = placed.line.path.empty() ? part().place : placed.line.path.front();
    composed_.notices.insert(composed_.notices.end(), placed.notices.begin(), placed.notices.end());
    return placed;
  }

  void takeGuides(const GuideRegion& region)
  {
    SurfaceInput& input = composed_.input;
    input.guideDirections.resize(polygons(), Vector3::Zero());
    input.guideWeights.resize(polygons(), 1);
    input.guideOrders.resize(polygons(), 0);
    for (const GuidedPlace& guided : part().guided)
    {
      input.guideDirections[guided.polygon] = region.direction.stableNormalized();
      input.guideWeights[guided.polygon] = region.weight;
      input.guideOrders[guided.polygon] = order();
    }
  }

  void takeSizes(const std::vector<Index>& points, double factor)
  {
    SurfaceInput& input = composed_.input;
    input.sizing.resize(surface_.points.size(), 1.0F);
    input.sizingOrders.resize(surface_.points.size(), 0);
    for (const Index point : points)
    {
      input.sizing[point] = static_cast<float>(factor);
      input.sizingOrders[point] = order();
    }
  }

  /// Where the valences that are asked for keep the sum of indices, all vertices that no one names stay regular.
  void setValences()
  {
    SurfaceInput& input = composed_.input;
    std::vector<ValencePlace>& valences = input.drawn.valences;
    for (std::size_t i = ofSurface_; i < asked_.size(); ++i)
    {
      valences.push_back({ asked_[i].place, asked_[i].valence });
    }
    if (!list_.isInForce())
    {
      return;
    }
    int off = 0;
    std::size_t others = 0;
    for (const Asked& asked : asked_)
    {
      const int missing = valenceInList(asked) - asked.valence;
      others += missing != 0 ? 1 : 0;
      if (missing != 0 && !where_.places.isOnBoundary(where_.places.nearestPlace(asked.place)))
      {
        off += missing;
      }
    }
    input.regularElsewhere = surface_.regularElsewhere || off == 0;
    for (const auto& [place, valence] : list_.valences())
    {
      // What operations have made regular has to stay so, unless everything has to.
      const bool isNeeded = valence != kRegularValence ||
        (!input.regularElsewhere && list_.changedBy(place) != 0 && !isIrregularInList(place));
      if (isNeeded && askedAt(place) == nullptr)
      {
        valences.push_back({ place, valence, list_.changedBy(place) == 0 });
      }
    }
    setIrregular();
    composed_.lastOperation = list_.links().back().id;
    if (!composed_.symmetry)
    {
      append(input.withoutMap, list_.withoutMap());
    }
    hold(others == 0 && off == 0);
  }

  /// At the same place, that is.
  bool isIrregularInList(const Vector3& place) const
  {
    return std::any_of(list_.valences().begin(), list_.valences().end(),
      [&](const auto& entry) {
        return entry.second != kRegularValence && (entry.first - place).norm() <= where_.sameWithin;
      });
  }
  int valenceInList(const Asked& asked) const
  {
    return list_.valenceAt(list_.sameAs(asked.place, where_.sameWithin));
  }

  /// Those that operations lead to, and the others that are asked for.
  void setIrregular()
  {
    composed_.shown = list_.shown();
    composed_.irregular = list_.irregular();
    std::vector<IrregularVertex>& all = composed_.irregular;
    eraseIf(all,
      [this](const IrregularVertex& vertex)
      {
        const Asked* asked = askedAt(vertex.place);
        return asked != nullptr && asked->valence != vertex.valence;
      });
    for (const Asked& asked : asked_)
    {
      if (asked.valence != kRegularValence && valenceInList(asked) != asked.valence)
      {
        all.push_back({ asked.place, asked.valence });
      }
      if (composed_.shown && valenceInList(asked) != asked.valence)
      {
        change(*composed_.shown, { asked.place, valenceInList(asked), asked.valence });
      }
    }
    std::sort(all.begin(), all.end(),
      [](const IrregularVertex& a, const IrregularVertex& b)
      { return PlaceOrder()(a.place, b.place); });
  }

  /// The vertices on features, where nothing else is asked of the irregular vertices. A half of the surface has a
  /// boundary of its own, so that with a symmetry they are free.
  void hold(bool onFeatures)
  {
    SurfaceInput& input = composed_.input;
    if (onFeatures && holdFeatures_ && !composed_.symmetry)
    {
      input.held.insert(input.held.end(), list_.onFeatures().begin(), list_.onFeatures().end());
      input.regularOnFeatures = true;
    }
  }

  /// Connections that operations have found there stay what they are: their ends are in no list of irregular vertices.
  /// Where such a connection is gone, or another one now, these are irregular all the same.
  void setJoined()
  {
    for (const JoinedEnds& joined : list_.joined())
    {
      const auto isIt = [&](const auto& constraint)
      { return constraint->id == joined.id && constraint->revision == joined.revision; };
      const auto found = std::find_if(constraints_.begin(), constraints_.end(), isIt);
      const std::optional<std::size_t> curve = found == constraints_.end()
        ? std::nullopt
        : composed_.parts[static_cast<std::size_t>(found - constraints_.begin())].curve;
      if (curve)
      {
        composed_.input.curves[*curve].setEnds(
          joined.start, joined.end, { joined.startValence, joined.endValence });
        continue;
      }
      for (const auto& [place, valence] :
        { std::pair(joined.start, joined.startValence), std::pair(joined.end, joined.endValence) })
      {
        if (valence != 0 && askedAt(place) == nullptr)
        {
          composed_.input.drawn.valences.push_back({ place, valence, true });
        }
      }
    }
  }

  void setEdits()
  {
    for (std::size_t i = 0; i < constraints_.size(); ++i)
    {
      const auto* edit = std::get_if<IrregularEdit>(&constraints_[i]->content);
      PlacedPart& placed = composed_.parts[i];
      for (std::size_t k = 0; edit && placed.whyNot.empty() && k < edit->changes.size(); ++k)
      {
        const Vector3& place = edit->changes[k].place;
        if (list_.changedBy(place) == constraints_[i]->id)
        {
          placed.valences.emplace_back(place, list_.valenceAt(place));
        }
      }
    }
  }

  const SurfaceInput& surface_;
  const PlacesOfSession& where_;
  LinePlacements& lines_;
  const SessionConstraints& constraints_;
  bool holdFeatures_;
  std::size_t at_ = 0;
  ComposedInput composed_;
  std::vector<Asked> asked_; ///< those of the surface first
  std::size_t ofSurface_ = 0;
  IrregularList list_;
};

} // namespace

const LinePlacements::Placed& LinePlacements::of(
  const std::shared_ptr<const SessionConstraint>& constraint, const SurfaceInput& surface,
  const PlacesOfSession& where)
{
  const auto found = known_.find(constraint);
  if (found != known_.end())
  {
    return found->second;
  }
  ConstraintPlacement placement(surface, where.places, where.paths, where.sameWithin);
  if (const auto* stroke = std::get_if<GuideStroke>(&constraint->content))
  {
    placement.addStroke({ constraint->id, stroke->points }, stroke->weight, stroke->radius);
  }
  else if (const auto* line = std::get_if<FeatureLine>(&constraint->content))
  {
    placement.addFeature({ constraint->id, line->points });
  }
  else if (const auto* cycle = std::get_if<Cycle>(&constraint->content))
  {
    placement.addCurve(constraint->id, CurveKind::Cycle, cycle->points);
  }
  else
  {
    placement.addCurve(
      constraint->id, CurveKind::Connection, std::get<Connection>(constraint->content).points);
  }
  const PlacedConstraints& result = placement.result();
  if (known_.size() >= kMostPlacements)
  {
    known_.clear();
  }
  return known_[constraint] = { result.placed.front(), result.notices, placement.requests(),
    placement.curves() };
}

ComposedInput composeInput(const SurfaceInput& surface, const PlacesOfSession& where,
  LinePlacements& lines, const SessionConstraints& constraints,
  const std::map<int, std::string>& leftOut, bool holdFeatures)
{
  return Composition(surface, where, lines, constraints, holdFeatures).run(leftOut);
}

} // namespace quadrille
