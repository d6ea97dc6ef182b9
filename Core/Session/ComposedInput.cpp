// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/ComposedInput.h"

#include "Base/PlaceText.h"
#include "Base/Refuse.h"
#include "Requests/CurveRequests.h"
#include "Session/IrregularEdits.h"

#include <algorithm>

namespace quadrille
{
namespace
{

/// Lines that are remembered; a stroke of ten thousand polygons takes a megabyte.
constexpr std::size_t kMostPlacements = 256;

class Composition
{
public:
  Composition(const SurfaceInput& surface, const SurfacePlaces& places, LinePlacements& lines,
    const SessionConstraints& constraints, bool holdFeatures)
    : surface_(surface), places_(places), lines_(lines), constraints_(constraints),
      holdFeatures_(holdFeatures)
  {
    composed_.input = surface;
    composed_.parts.resize(constraints.size());
    for (std::size_t p = 0; p < surface.targetValences.size(); ++p)
    {
      if (surface.targetValences[p] != 0)
      {
        asked_[static_cast<Index>(p)] = { surface.targetValences[p], "the array of valences" };
      }
    }
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
    setEdits();
    return std::move(composed_);
  }

  void operator()(const FeatureLine&)
  {
    const LinePlacements::Placed& placed = takePlaced();
    if (part().whyNot.empty())
    {
      part().path = placed.line.path;
      addFeatureMarks(composed_.input, polygons(), placed.features);
    }
  }

  void operator()(const GuideStroke&)
  {
    const LinePlacements::Placed& placed = takePlaced();
    if (part().whyNot.empty())
    {
      part().guided = placed.line.guided;
      takeGuides(placed.guides);
    }
  }

  void operator()(const GuideRegion& region)
  {
    std::vector<Index> polygons = region.polygons;
    std::sort(polygons.begin(), polygons.end());
    polygons.erase(std::unique(polygons.begin(), polygons.end()), polygons.end());
    std::vector<GuideMark> marks;
    for (const Index polygon : polygons)
    {
      if (surface_.polygonOffsets[polygon] == surface_.polygonOffsets[polygon + 1])
      {
        continue;
      }
      marks.push_back({ polygon, region.direction.stableNormalized(), region.weight });
      part().guided.push_back(guidedPolygon(surface_, polygon, region.direction, region.weight));
    }
    if (marks.empty())
    {
      part().whyNot = "its polygons have no corners";
      return;
    }
    part().place = part().guided.front().centre;
    takeGuides(marks);
  }

  void operator()(const ValenceAt& at)
  {
    const Index point = places_.nearestCorner(at.point);
    part().place = surface_.points[point];
    if (at.valence == kLeastValence && places_.isOnBoundary(point))
    {
      refuse("valence ", at.valence, " is asked for at ", placeText(surface_.points[point]),
        ", on the boundary, where the least is 3, a corner with one quad: ask for 3 or more");
    }
    const int by = list_.changedBy(point);
    if (by != 0 && list_.valenceAt(point) != at.valence)
    {
      refuse("it asks for valence ", at.valence, " at ", placeText(surface_.points[point]),
        ", where ", nameOf(by), " has made one of ", list_.valenceAt(point),
        ": remove one of the two");
    }
    const auto [found, isNew] = asked_.emplace(point, Asked{ at.valence, name() });
    if (!isNew && found->second.valence != at.valence)
    {
      refuse("it asks for valence ", at.valence, " at ", placeText(surface_.points[point]),
        ", where ", found->second.by, " asks for ", found->second.valence,
        ": remove one of the two");
    }
  }

  void operator()(const SizeAt& at)
  {
    const Index nearest = places_.nearestCorner(at.point);
    part().place = surface_.points[nearest];
    std::vector<Index> points{ nearest };
    for (std::size_t p = 0; at.radius > 0 && p < surface_.points.size(); ++p)
    {
      if (p != nearest && (surface_.points[p] - at.point).norm() <= at.radius)
      {
        points.push_back(static_cast<Index>(p));
      }
    }
    takeSizes(std::move(points), at.factor);
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
    takeSizes(std::move(points), region.factor);
  }

  void operator()(const IrregularEdit& edit)
  {
    IrregularList next = list_;
    for (const IrregularEdit::Change& change : edit.changes)
    {
      part().place = surface_.points[change.point];
    }
    part().whyNot = next.apply(id(), constraints_[at_]->revision, edit, surface_);
    if (!part().whyNot.empty())
    {
      return;
    }
    for (const IrregularEdit::Change& change : edit.changes)
    {
      const auto found = asked_.find(change.point);
      if (found != asked_.end() && found->second.valence != change.after)
      {
        refuse("it would make a vertex of valence ", change.after, " at ",
          placeText(surface_.points[change.point]), ", where ", found->second.by, " asks for ",
          found->second.valence, ": remove one of the two");
      }
    }
    list_ = std::move(next);
  }

  void operator()(const Connection& connection)
  {
    addCurve({ CurveKind::Connection, connection.points });
  }
  void operator()(const Cycle& cycle) { addCurve({ CurveKind::Cycle, cycle.points }); }
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
    int valence = 0;
    std::string by;
  };

  std::size_t polygons() const { return surface_.polygonOffsets.size() - 1; }
  PlacedPart& part() { return composed_.parts[at_]; }
  int id() const { return constraints_[at_]->id; }
  std::string name() const { return constraints_[at_]->name(); }
  std::string nameOf(int id) const
  {
    const auto found = std::find_if(constraints_.begin(), constraints_.end(),
      [id](const auto& constraint) { return constraint->id == id; });
    return (*found)->name();
  }

  void addCurve(CurveRequest curve)
  {
    std::vector<CurveRequest>& curves = composed_.input.curves;
    checkCurve(curve, curves.size());
    part().curve = curves.size();
    curves.push_back(std::move(curve));
  }

  const LinePlacements::Placed& takePlaced()
  {
    const LinePlacements::Placed& placed = lines_.of(constraints_[at_], surface_, places_);
    part().whyNot = placed.line.whyNot;
    part().place = placed.line.path.empty() ? part().place : placed.line.path.front();
    composed_.notices.insert(composed_.notices.end(), placed.notices.begin(), placed.notices.end());
    return placed;
  }

  void overrule(std::map<Index, std::size_t>& owners, Index element)
  {
    const auto [found, isNew] = owners.emplace(element, at_);
    if (!isNew && found->second != at_)
    {
      PlacedPart& earlier = composed_.parts[found->second];
      ++earlier.overruled;
      earlier.overruledBy = id();
      found->second = at_;
    }
  }

  void takeGuides(const std::vector<GuideMark>& marks)
  {
    addGuideMarks(composed_.input, polygons(), marks);
    for (const GuideMark& mark : marks)
    {
      overrule(guideOf_, mark.polygon);
    }
  }

  void takeSizes(std::vector<Index> points, double factor)
  {
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    composed_.input.sizing.resize(surface_.points.size(), 1.0F);
    for (const Index point : points)
    {
      composed_.input.sizing[point] = static_cast<float>(factor);
      overrule(sizeOf_, point);
    }
    part().points = std::move(points);
  }

  /// Where the valences that are asked for keep the sum of indices, all vertices that no one names stay regular.
  void setValences()
  {
    SurfaceInput& input = composed_.input;
    if (asked_.empty() && !list_.isInForce())
    {
      return;
    }
    input.targetValences.assign(surface_.points.size(), 0);
    for (const auto& [point, valence] : list_.valences())
    {
      input.targetValences[point] = valence;
    }
    int off = 0;
    std::size_t others = 0;
    for (const auto& [point, asked] : asked_)
    {
      input.targetValences[point] = asked.valence;
      const int missing = list_.valenceAt(point) - asked.valence;
      others += missing != 0 ? 1 : 0;
      if (list_.isInForce() && missing != 0 && !places_.isOnBoundary(point))
      {
        off += missing;
      }
    }
    input.regularElsewhere = surface_.regularElsewhere || (list_.isInForce() && off == 0);
    if (list_.isInForce())
    {
      setIrregular();
      composed_.lastOperation = list_.links().back().id;
      hold(others == 0 && off == 0);
    }
  }

  /// Those that operations lead to, and the others that are asked for.
  void setIrregular()
  {
    composed_.irregular = list_.irregular(surface_);
    std::vector<IrregularVertex>& all = composed_.irregular;
    all.erase(std::remove_if(all.begin(), all.end(),
                [this](const IrregularVertex& vertex)
                {
                  const auto found = asked_.find(vertex.point);
                  return found != asked_.end() && found->second.valence != vertex.valence;
                }),
      all.end());
    for (const auto& [point, asked] : asked_)
    {
      if (asked.valence != kRegularValence && list_.valenceAt(point) != asked.valence)
      {
        all.push_back({ point, surface_.points[point], asked.valence });
      }
    }
    std::sort(all.begin(), all.end(),
      [](const IrregularVertex& a, const IrregularVertex& b) { return a.point < b.point; });
  }

  /// The vertices that operations lead to, at their places; and on features, where nothing else is asked of the
  /// irregular vertices. A half of the surface has a boundary of its own, so that with a symmetry points have to do.
  void hold(bool onFeatures)
  {
    SurfaceInput& input = composed_.input;
    if (composed_.symmetry)
    {
      return;
    }
    for (const IrregularVertex& vertex : composed_.irregular)
    {
      if (asked_.count(vertex.point) == 0 && vertex.place != surface_.points[vertex.point])
      {
        input.held.push_back({ vertex.point, vertex.place, {} });
      }
    }
    if (onFeatures)
    {
      composed_.onFeatures = list_.onFeatures();
    }
    if (onFeatures && holdFeatures_)
    {
      input.held.insert(input.held.end(), list_.onFeatures().begin(), list_.onFeatures().end());
      input.regularOnFeatures = true;
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
        const Index point = edit->changes[k].point;
        if (list_.changedBy(point) == constraints_[i]->id)
        {
          placed.valences.emplace_back(point, list_.valenceAt(point));
        }
      }
    }
  }

  const SurfaceInput& surface_;
  const SurfacePlaces& places_;
  LinePlacements& lines_;
  const SessionConstraints& constraints_;
  bool holdFeatures_;
  std::size_t at_ = 0;
  ComposedInput composed_;
  std::map<Index, Asked> asked_;
  std::map<Index, std::size_t> guideOf_, sizeOf_; ///< the constraint that counts
  IrregularList list_;
};

} // namespace

const LinePlacements::Placed& LinePlacements::of(
  const std::shared_ptr<const SessionConstraint>& constraint, const SurfaceInput& surface,
  const SurfacePlaces& places)
{
  const auto found = known_.find(constraint);
  if (found != known_.end())
  {
    return found->second;
  }
  ConstraintPlacement placement(surface, places);
  if (const auto* stroke = std::get_if<GuideStroke>(&constraint->content))
  {
    placement.addStroke({ constraint->id, stroke->points }, stroke->weight, stroke->radius);
  }
  else
  {
    const auto& line = std::get<FeatureLine>(constraint->content);
    placement.addFeature({ constraint->id, line.points });
  }
  const PlacedConstraints& result = placement.result();
  if (known_.size() >= kMostPlacements)
  {
    known_.clear();
  }
  return known_[constraint] = { result.placed.front(), result.notices, placement.guideMarks(),
    placement.featureMarks() };
}

ComposedInput composeInput(const SurfaceInput& surface, const SurfacePlaces& places,
  LinePlacements& lines, const SessionConstraints& constraints,
  const std::map<int, std::string>& leftOut, bool holdFeatures)
{
  return Composition(surface, places, lines, constraints, holdFeatures).run(leftOut);
}

} // namespace quadrille
