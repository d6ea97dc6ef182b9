// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/ConstraintReports.h"

#include "Evaluation/ConstraintMeasures.h"
#include "Session/IrregularMatch.h"
#include "Session/OtherChanges.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>

namespace quadrille
{
namespace
{

/// Places at most at which it is looked whether a later constraint counts.
constexpr std::size_t kPlacesOfOthers = 400;

bool asksForSize(const ConstraintContent& content)
{
  return std::holds_alternative<SizeAt>(content) || std::holds_alternative<SizeRegion>(content);
}

class SessionJudge
{
public:
  SessionJudge(const SurfaceInput& surface, const SurfacePlaces& places,
    const SessionConstraints& constraints, const ComposedInput& composed, const RemeshResult& made,
    const SessionResult& result, const SymmetricResult* symmetric, bool isOfNumber)
    : surface_(surface), places_(places), constraints_(constraints), composed_(composed),
      quads_(made.quads), curves_(made.curves),
      madeEdgeLength_(lengthOfSizeOne(made.targetEdgeLength,
        isOfNumber ? std::optional<std::size_t>(result.targetQuads) : std::nullopt,
        made.quads.quads.size())),
      symmetric_(symmetric), measures_(made.quads),
      withoutMap_(result.fixed, result.targetEdgeLength)
  {
    if (composed.shown)
    {
      irregular_ = expectedIrregular(*composed.shown, isometryOf(symmetric));
    }
    std::size_t guides = 0;
    for (const PlacedPart& part : composed.parts)
    {
      guides += part.guided.empty() ? 0 : 1;
    }
    mostPlaces_ = mostPlacesOf(guides);
  }

  std::vector<ConstraintReport> run()
  {
    std::vector<ConstraintReport> words;
    for (std::size_t i = 0; i < constraints_.size(); ++i)
    {
      part_ = &composed_.parts[i];
      at_ = i;
      const SessionConstraint& constraint = *constraints_[i];
      const ConstraintMeasure measure = measureOf(constraint);
      const std::string off = measures_.offSurface(pointsOf(constraint.content));
      words.push_back({ constraint.id, kindOf(constraint.content), constraint.name(), measure.place,
        measure.isMet, measure.deviation, measure.deviation95, measure.unit, measure.reason,
        withRemark(measure.remark, off), !off.empty() });
    }
    return words;
  }

  ConstraintMeasure operator()(const FeatureLine&)
  {
    ConstraintMeasure measure = measures_.curve(part_->path);
    measure.isMet = measure.isMet && part_->remark.empty(); // it is not there all along
    measure.reason = withRemark(measure.reason, part_->remark);
    return measure;
  }
  ConstraintMeasure operator()(const ClearedAt&) { return measures_.cleared(part_->place); }
  ConstraintMeasure operator()(const GuideStroke& stroke)
  {
    ConstraintMeasure measure = guide(stroke.weight);
    measure.remark = withRemark(measure.remark, part_->remark);
    return measure;
  }
  ConstraintMeasure operator()(const GuideRegion& region) { return guide(region.weight); }
  ConstraintMeasure operator()(const ValenceAt& at)
  {
    return measures_.valence(part_->place, at.valence);
  }
  ConstraintMeasure operator()(const SizeAt& at);
  ConstraintMeasure operator()(const SizeRegion& region);
  ConstraintMeasure operator()(const IrregularEdit&) { return irregularEdit(); }
  ConstraintMeasure operator()(const Connection&) { return line(ConstraintKind::Connection); }
  ConstraintMeasure operator()(const Cycle&) { return line(ConstraintKind::Cycle); }
  ConstraintMeasure operator()(const MirrorSymmetry&)
  {
    return judgeSymmetry("the two sides of the surface are not alike, see the notices: give "
                         "another plane, or turn the normal round");
  }
  ConstraintMeasure operator()(const RotationalSymmetry&)
  {
    return judgeSymmetry(
      "the wedges of the surface are not alike, see the notices: give another axis or order");
  }

private:
  ConstraintMeasure judgeSymmetry(const char* unlike) const;
  ConstraintMeasure irregularEdit();
  std::vector<Vector3> otherChanged();
  std::string whoCounts(const std::vector<WeightedPlace>& places, bool isSize);
  using Cover = std::function<bool(const Vector3&)>;
  Cover coverOf(std::size_t i);

  ConstraintMeasure measureOf(const SessionConstraint& constraint)
  {
    if (!part_->whyNot.empty())
    {
      return ConstraintMeasure::unknown(part_->place, "", part_->whyNot);
    }
    if (quads_.quads.empty())
    {
      return ConstraintMeasure::unknown(part_->place, "", "no quads were made");
    }
    return std::visit(*this, constraint.content);
  }

  ConstraintMeasure guide(double weight)
  {
    if (part_->guided.empty())
    {
      return ConstraintMeasure::unknown(part_->place, "degrees", "it runs over no face");
    }
    double irregularShare = 0;
    ConstraintMeasure measure = measures_.guide(part_->guided, mostPlaces_, &irregularShare);
    if (!measure.isMet && irregularShare > kNotableShare)
    {
      measure.reason +=
        "; " + percentText(irregularShare) + " of its area is in quads at irregular vertices";
    }
    if (!measure.isMet && weight < 1)
    {
      measure.reason +=
        "; its weight is " + shortText(weight) + ", a larger one is followed more closely";
    }
    if (!measure.isMet)
    {
      std::vector<WeightedPlace> places;
      for (const GuidedPlace& guided : part_->guided)
      {
        places.push_back({ guided.place, guided.area });
      }
      measure.reason += whoCounts(places, false);
    }
    return measure;
  }

  ConstraintMeasure line(ConstraintKind kind);
  /// All that the quads are to have; null: not known.
  const std::vector<ValencePlace>* irregular() const { return irregular_ ? &*irregular_ : nullptr; }

  const SurfaceInput& surface_;
  const SurfacePlaces& places_;
  const SessionConstraints& constraints_;
  const ComposedInput& composed_;
  const QuadMesh& quads_;
  const std::vector<CurveOutcome>& curves_;
  double madeEdgeLength_;            ///< of quads of size 1, by how many there are
  const SymmetricResult* symmetric_; ///< null: the quads were not made so
  ConstraintMeasures measures_;
  std::optional<std::vector<ValencePlace>> irregular_;
  FacesWithoutMap withoutMap_;
  std::size_t mostPlaces_ = 0;
  const PlacedPart* part_ = nullptr;
  std::size_t at_ = 0; ///< of the constraint
};

/// The vertices that it changed last have their valences in the quads; and of the last operation: all others are
/// where they were. The deviation is that of the vertices.
ConstraintMeasure SessionJudge::irregularEdit()
{
  ConstraintMeasure measure;
  measure.place = part_->place;
  measure.unit = "edge lengths";
  measure.deviation95 = std::numeric_limits<double>::quiet_NaN();
  measure.isMet = true;
  for (const auto& [place, asked] : part_->valences)
  {
    const ConstraintMeasure there = measures_.changedValence(place, asked, irregular());
    const bool isFarther = !(there.deviation <= measure.deviation); // or there is none
    if (isFarther || (measure.isMet && !there.isMet))
    {
      measure.place = place;
      measure.deviation = isFarther ? there.deviation : measure.deviation;
    }
    measure.reason = there.isMet ? measure.reason : there.reason;
    measure.isMet = measure.isMet && there.isMet;
  }
  if (!measure.isMet && symmetric_ != nullptr && !symmetric_->rotation &&
    symmetric_->plane.height(measure.place) < 0)
  {
    measure.reason += "; with a symmetry the operations in front of the mirror plane count: make "
                      "it at the mirror image";
  }
  if (constraints_[at_]->id == composed_.lastOperation && symmetric_ == nullptr &&
    composed_.input.regularElsewhere && composed_.shown)
  {
    const std::vector<Vector3> others = otherChanged();
    if (!others.empty())
    {
      measure.place = measure.isMet ? others.front() : measure.place;
      measure.reason +=
        (measure.isMet ? "" : "; ") + otherChangesText(others, composed_.whyNotHeld);
      measure.isMet = false;
    }
  }
  return measure;
}

/// Places where irregular points of the quads came, went or moved though no constraint asks for it.
std::vector<Vector3> SessionJudge::otherChanged()
{
  JudgedElsewhere judged = judgedOf(composed_.parts, measures_, irregular());
  bool isLater = false;
  for (std::size_t i = 0; i < constraints_.size(); ++i)
  {
    const PlacedPart& part = composed_.parts[i];
    const ConstraintContent& content = constraints_[i]->content;
    isLater = isLater || constraints_[i]->id == composed_.lastOperation;
    if (isLater &&
      (std::holds_alternative<FeatureLine>(content) ||
        std::holds_alternative<Connection>(content) || std::holds_alternative<Cycle>(content)))
    {
      judged.drawn.insert(judged.drawn.end(), part.path.begin(), part.path.end());
    }
    if (std::holds_alternative<ValenceAt>(content))
    {
      judged.told.push_back(part.place);
    }
  }
  return otherChanges(*composed_.shown, quads_, measures_, judged, withoutMap_);
}

/// Connectivity is symmetric whenever there are quads, so that it is the surface that deviates; where its two sides
/// differ, what is made of the one behind is not what it was.
ConstraintMeasure SessionJudge::judgeSymmetry(const char* unlike) const
{
  if (symmetric_ == nullptr)
  {
    return ConstraintMeasure::unknown(part_->place, "diagonals", "the quads are not symmetric");
  }
  ConstraintMeasure measure;
  measure.place = symmetric_->deviation.place;
  measure.unit = "diagonals";
  measure.deviation = symmetric_->deviation.rms / symmetric_->diagonal;
  measure.deviation95 = std::numeric_limits<double>::quiet_NaN();
  measure.isMet = symmetric_->isAlike;
  measure.reason = measure.isMet ? "" : unlike;
  return measure;
}

ConstraintMeasure SessionJudge::line(ConstraintKind kind)
{
  PlacedConstraint placed;
  placed.kind = kind;
  placed.curve = *part_->curve;
  placed.path = part_->path;
  return measures_.line(placed, curves_);
}

ConstraintMeasure SessionJudge::operator()(const SizeAt& at)
{
  std::vector<Index> quads;
  ConstraintMeasure measure =
    measures_.size(part_->place, at.radius, { at.factor, madeEdgeLength_ }, &quads);
  if (!measure.isMet)
  {
    std::vector<WeightedPlace> places;
    const std::size_t stride = strideOf(quads.size(), mostPlacesOf(1));
    for (std::size_t i = 0; i < quads.size(); i += stride)
    {
      places.push_back({ measures_.centreOf(quads[i]), 1 });
    }
    measure.reason += whoCounts(places, true);
  }
  return measure;
}

/// At places spread over the polygons, about one a quad.
ConstraintMeasure SessionJudge::operator()(const SizeRegion& region)
{
  constexpr double kStepsAlongSide = 16; // along a triangle's side
  std::vector<WeightedPlace> places;
  for (const Index polygon : region.polygons)
  {
    const Index first = surface_.polygonOffsets[polygon];
    for (Index k = first + 2; k < surface_.polygonOffsets[polygon + 1]; ++k)
    {
      const Vector3& a = surface_.points[surface_.polygonPoints[first]];
      const Vector3 u = surface_.points[surface_.polygonPoints[k - 1]] - a;
      const Vector3 v = surface_.points[surface_.polygonPoints[k]] - a;
      const double longest = std::max({ u.norm(), v.norm(), (v - u).norm() });
      const double wanted = longest / (region.factor * madeEdgeLength_);
      const int steps = static_cast<int>(std::ceil(std::clamp(wanted, 1.0, kStepsAlongSide)));
      const double area = 0.5 * u.cross(v).norm() / (steps * steps);
      for (int i = 0; i < steps; ++i)
      {
        for (int j = 0; i + j < steps; ++j)
        {
          // Of the small triangles the one at this corner, and the one beyond.
          places.push_back({ a + (i + 1 / 3.0) / steps * u + (j + 1 / 3.0) / steps * v, area });
          if (i + j + 1 < steps)
          {
            places.push_back({ a + (i + 2 / 3.0) / steps * u + (j + 2 / 3.0) / steps * v, area });
          }
        }
      }
    }
  }
  ConstraintMeasure measure = measures_.size(places, { region.factor, madeEdgeLength_ });
  if (!measure.isMet)
  {
    measure.reason += whoCounts(places, true);
  }
  return measure;
}

/// Whether a guide, or a size, asks for something at a place; null for all others, and where it is left out.
SessionJudge::Cover SessionJudge::coverOf(std::size_t i)
{
  const PlacedPart& part = composed_.parts[i];
  const ConstraintContent& content = constraints_[i]->content;
  const auto isIn = [this](const std::vector<Index>& polygons) -> Cover
  {
    return [this, &polygons](const Vector3& place)
    {
      const Index polygon = places_.nearestPlace(place).polygon;
      return std::find(polygons.begin(), polygons.end(), polygon) != polygons.end();
    };
  };
  if (!part.whyNot.empty())
  {
    return nullptr;
  }
  if (const auto* region = std::get_if<GuideRegion>(&content))
  {
    return isIn(region->polygons);
  }
  if (const auto* region = std::get_if<SizeRegion>(&content))
  {
    return isIn(region->polygons);
  }
  if (const auto* size = std::get_if<SizeAt>(&content))
  {
    return [&part, size](const Vector3& place)
    { return (place - part.place).norm() <= size->radius; };
  }
  if (const auto* stroke = std::get_if<GuideStroke>(&content))
  {
    const auto segments = std::make_shared<NearestSegments>(part.path);
    return [this, segments, stroke](const Vector3& place)
    { return measures_.isUnder(*segments, stroke->radius, place); };
  }
  return nullptr;
}

/// On which share of the places a later constraint counts in place of this one.
std::string SessionJudge::whoCounts(const std::vector<WeightedPlace>& places, bool isSize)
{
  const std::size_t stride = strideOf(places.size(), kPlacesOfOthers);
  for (std::size_t later = constraints_.size(); later-- > at_ + 1;)
  {
    const Cover covers =
      isSize == asksForSize(constraints_[later]->content) ? coverOf(later) : nullptr;
    if (!covers)
    {
      continue;
    }
    double under = 0, all = 0;
    for (std::size_t i = 0; i < places.size(); i += stride)
    {
      all += places[i].weight;
      under += covers(places[i].place) ? places[i].weight : 0;
    }
    if (under > 0)
    {
      return "; on " + percentText(under / all) + " of it " + constraints_[later]->name() +
        ", which is later, counts";
    }
  }
  return {};
}

} // namespace

std::vector<ConstraintReport> reportConstraints(const SurfaceInput& surface,
  const SurfacePlaces& places, const SessionConstraints& constraints, const ComposedInput& composed,
  const RemeshResult& made, const SessionResult& result, const SymmetricResult* symmetric,
  bool isOfNumber)
{
  return SessionJudge(surface, places, constraints, composed, made, result, symmetric, isOfNumber)
    .run();
}

} // namespace quadrille
