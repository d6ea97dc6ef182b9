// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/ConstraintReports.h"

#include "Base/PlaceText.h"
#include "Evaluation/ConstraintMeasures.h"
#include "Evaluation/LinesInQuads.h"
#include "Session/IrregularMatch.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <sstream>

namespace quadrille
{
namespace
{

/// Edge lengths within which a vertex is the one that was meant.
constexpr double kReachOfOperation = 2;

class SessionJudge
{
public:
  SessionJudge(const SurfaceInput& surface, const SessionConstraints& constraints,
    const ComposedInput& composed, const RemeshResult& made, const SessionResult& result,
    const SymmetricResult* symmetric)
    : surface_(surface), constraints_(constraints), composed_(composed), made_(made),
      irregular_(result.irregular), onFeatures_(result.onFeatures), symmetric_(symmetric),
      measures_(made.quads),
      mostPlaces_(mostPlacesOf(static_cast<std::size_t>(std::count_if(composed.parts.begin(),
        composed.parts.end(), [](const PlacedPart& part) { return !part.guided.empty(); }))))
  {
  }

  std::vector<ConstraintReport> run()
  {
    std::vector<ConstraintReport> words;
    for (at_ = 0; at_ < constraints_.size(); ++at_)
    {
      const SessionConstraint& constraint = *constraints_[at_];
      const ConstraintMeasure measure = measureOf(constraint);
      const std::string off = measures_.offSurface(pointsOf(constraint.content));
      words.push_back({ constraint.id, kindOf(constraint.content), constraint.name(), measure.place,
        measure.isMet, measure.deviation, measure.deviation95, measure.unit,
        withRemark(measure.reason, off), !off.empty() });
    }
    return words;
  }

  ConstraintMeasure operator()(const FeatureLine&)
  {
    std::vector<std::array<Vector3, 2>> edges;
    for (std::size_t k = 0; k + 1 < part().path.size(); ++k)
    {
      edges.push_back({ part().path[k], part().path[k + 1] });
    }
    return measures_.curve(edges);
  }
  ConstraintMeasure operator()(const GuideStroke& stroke) { return guide(stroke.weight); }
  ConstraintMeasure operator()(const GuideRegion& region) { return guide(region.weight); }
  ConstraintMeasure operator()(const ValenceAt& at)
  {
    return measures_.valence(part().place, at.valence);
  }
  ConstraintMeasure operator()(const SizeAt& at) { return size(at.factor); }
  ConstraintMeasure operator()(const SizeRegion& region) { return size(region.factor); }
  ConstraintMeasure operator()(const IrregularEdit&) { return irregularEdit(); }
  ConstraintMeasure operator()(const Connection& connection)
  {
    return line(ConstraintKind::Connection, connection.points);
  }
  ConstraintMeasure operator()(const Cycle& cycle)
  {
    std::vector<Vector3> closed = cycle.points;
    closed.push_back(closed.front());
    return line(ConstraintKind::Cycle, std::move(closed));
  }
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
  Vector3 placeOfPoint(Index point) const;
  int valenceNear(const Vector3& place, int asked);
  std::vector<Vector3> otherChanges();
  const IrregularMatch& irregularMatch();

  ConstraintMeasure measureOf(const SessionConstraint& constraint)
  {
    if (!part().whyNot.empty())
    {
      return ConstraintMeasure::unknown(part().place, "", part().whyNot);
    }
    if (made_.quads.quads.empty())
    {
      return ConstraintMeasure::unknown(part().place, "", "no quads were made");
    }
    ConstraintMeasure measure = std::visit(*this, constraint.content);
    if (!measure.isMet && part().overruled > 0)
    {
      std::ostringstream text;
      text << "; on " << part().overruled << " of its places constraint " << part().overruledBy
           << ", which is later, counts";
      measure.reason += text.str();
    }
    return measure;
  }

  ConstraintMeasure guide(double weight)
  {
    if (part().guided.empty())
    {
      return ConstraintMeasure::unknown(part().place, "degrees", "it runs over no face");
    }
    double irregularShare = 0;
    ConstraintMeasure measure = measures_.guide(part().guided, mostPlaces_, &irregularShare);
    constexpr double kNotableShare = 0.1;
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
    return measure;
  }

  const PlacedPart& part() const { return composed_.parts[at_]; }
  bool isLastOperation(std::size_t i) const
  {
    return constraints_[i]->id == composed_.lastOperation;
  }

  ConstraintMeasure size(double factor);

  ConstraintMeasure line(ConstraintKind kind, std::vector<Vector3> path);

  const SurfaceInput& surface_;
  const SessionConstraints& constraints_;
  const ComposedInput& composed_;
  const RemeshResult& made_;
  const std::vector<IrregularVertex>& irregular_;
  const std::vector<HeldVertex>& onFeatures_;
  const SymmetricResult* symmetric_; ///< null: the quads were not made so
  ConstraintMeasures measures_;
  std::size_t mostPlaces_;
  std::optional<IrregularMatch> match_; ///< and this
  std::optional<LinesInQuads> lines_;   ///< made when they are needed first
  std::size_t at_ = 0;                  ///< the constraint
};

/// The vertices that it changed last have their valences in the quads; and of the last operation: all others are
/// where they were. deviation counts those that have not, or are not.
ConstraintMeasure SessionJudge::irregularEdit()
{
  ConstraintMeasure measure;
  measure.place = part().place;
  measure.unit = "valence";
  measure.deviation95 = std::numeric_limits<double>::quiet_NaN();
  std::size_t wrong = 0;
  for (const auto& [point, asked] : part().valences)
  {
    const Vector3 place = placeOfPoint(point);
    const int got = valenceNear(place, asked);
    if (got != asked)
    {
      measure.place = place;
      measure.reason = "asked " + std::to_string(asked) + ", got " + std::to_string(got);
      ++wrong;
    }
  }
  if (wrong > 0 && symmetric_ != nullptr && !symmetric_->rotation &&
    symmetric_->plane.height(measure.place) < 0)
  {
    measure.reason += "; with a symmetry the operations in front of the mirror plane count: make "
                      "it at the mirror image";
  }
  if (isLastOperation(at_) && symmetric_ == nullptr && composed_.input.regularElsewhere)
  {
    const std::vector<Vector3> others = otherChanges();
    if (!others.empty())
    {
      measure.place = wrong > 0 ? measure.place : others.front();
      measure.reason += (wrong > 0 ? "; " : "") + std::to_string(others.size()) +
        " other irregular vertices are not as they were, one at " + placeText(others.front()) +
        (composed_.whyNotHeld.empty()
            ? ": choose places with more room between features and other irregular vertices"
            : ", as those on features and boundaries could not be held: " + composed_.whyNotHeld);
      wrong += others.size();
    }
  }
  measure.deviation = static_cast<double>(wrong);
  measure.isMet = wrong == 0;
  return measure;
}

/// Where the vertex is that operations have put at a point of the input.
Vector3 SessionJudge::placeOfPoint(Index point) const
{
  const auto found = std::lower_bound(composed_.irregular.begin(), composed_.irregular.end(), point,
    [](const IrregularVertex& vertex, Index p) { return vertex.point < p; });
  return found != composed_.irregular.end() && found->point == point ? found->place
                                                                     : surface_.points[point];
}

/// Of the irregular vertex there, in the map and in the quads; regular where there is none. Another size of quads moves
/// a vertex that lies in a triangle of the input to another place in it.
int SessionJudge::valenceNear(const Vector3& place, int asked)
{
  const IrregularMatch& match = irregularMatch();
  const IrregularVertex* best = nullptr;
  for (std::size_t i = 0; i < composed_.irregular.size(); ++i)
  {
    if (match.actual[i] && composed_.irregular[i].place == place)
    {
      best = &irregular_[*match.actual[i]];
    }
  }
  if (best)
  {
    return measures_.valence(best->place, asked).isMet ? best->valence : kRegularValence;
  }
  for (const std::size_t k : match.unexpected)
  {
    const double distance = (irregular_[k].place - place).norm();
    if (distance <= kReachOfOperation * made_.targetEdgeLength &&
      (!best || distance < (best->place - place).norm()))
    {
      best = &irregular_[k];
    }
  }
  return best ? best->valence : kRegularValence;
}

/// Places where irregular vertices came, went or moved though no constraint asks for it.
std::vector<Vector3> SessionJudge::otherChanges()
{
  const IrregularMatch& match = irregularMatch();
  const double reach = kReachOfOperation * made_.targetEdgeLength;
  const auto isNear = [&](const std::vector<Vector3>& all, const Vector3& p, double distance)
  {
    return std::any_of(
      all.begin(), all.end(), [&](const Vector3& q) { return (p - q).norm() <= distance; });
  };
  std::vector<Vector3> told;   // of vertices with a word of their own
  std::vector<Vector3> failed; // where that says what is there instead
  std::vector<Vector3> drawn;  // on features
  bool isLater = false;
  for (std::size_t i = 0; i < constraints_.size(); ++i)
  {
    const PlacedPart& part = composed_.parts[i];
    isLater = isLater || isLastOperation(i);
    if (isLater) // a feature has ends, and corners with others
    {
      drawn.insert(drawn.end(), part.path.begin(), part.path.end());
    }
    for (const auto& [point, valence] : part.valences)
    {
      const Vector3 place = placeOfPoint(point);
      told.push_back(place);
      if (valenceNear(place, valence) != valence)
      {
        failed.push_back(place);
      }
    }
    if (std::holds_alternative<ValenceAt>(constraints_[i]->content))
    {
      told.push_back(part.place);
      drawn.push_back(part.place);
    }
  }
  std::vector<Vector3> places;
  for (std::size_t i = 0; i < composed_.irregular.size(); ++i)
  {
    const Vector3& place = composed_.irregular[i].place;
    if (!match.actual[i] && !isNear(told, place, 0))
    {
      places.push_back(place);
    }
  }
  for (const std::size_t k : match.unexpected)
  {
    if (!isNear(failed, irregular_[k].place, reach))
    {
      places.push_back(irregular_[k].place);
    }
  }
  if (composed_.onFeatures)
  {
    for (const Vector3& p : differencesOnFeatures(*composed_.onFeatures, onFeatures_, reach))
    {
      if (!isNear(drawn, p, reach))
      {
        places.push_back(p);
      }
    }
  }
  return places;
}

const IrregularMatch& SessionJudge::irregularMatch()
{
  if (!match_)
  {
    match_ =
      matchIrregular(composed_.irregular, irregular_, kReachOfOperation * made_.targetEdgeLength);
  }
  return *match_;
}

/// Connectivity is symmetric whenever there are quads, so that it is the surface that deviates; where its two sides
/// differ, what is made of the one behind is not what it was.
ConstraintMeasure SessionJudge::judgeSymmetry(const char* unlike) const
{
  if (symmetric_ == nullptr)
  {
    return ConstraintMeasure::unknown(part().place, "diagonals", "the quads are not symmetric");
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

/// Met where there is a straight chain of edges; how far it runs from what was drawn is told.
ConstraintMeasure SessionJudge::line(ConstraintKind kind, std::vector<Vector3> path)
{
  if (!part().curve || *part().curve >= made_.curves.size())
  {
    return ConstraintMeasure::unknown(
      part().place, "edge lengths", "the method has no connections and cycles: choose another one");
  }
  if (!lines_)
  {
    lines_.emplace(made_.quads);
  }
  const CurveOutcome& outcome = made_.curves[*part().curve];
  PlacedConstraint placed;
  placed.kind = kind;
  placed.curve = *part().curve;
  placed.path = std::move(path);
  const std::vector<Vector3> chain = lines_->chainOf(placed, outcome);
  if (chain.empty())
  {
    return ConstraintMeasure::unknown(part().place, "edge lengths",
      outcome.why.empty() ? "the quads have no straight chain of edges there" : outcome.why);
  }
  const auto [distance, place] = farthestFrom(placed.path, chain);
  ConstraintMeasure measure;
  measure.place = place;
  measure.unit = "edge lengths";
  measure.deviation = distance / lines_->edgeLength();
  measure.deviation95 = std::numeric_limits<double>::quiet_NaN();
  measure.isMet = true;
  return measure;
}

/// By which factor the edge lengths at the places, from the areas of the quads there, differ from those asked for.
ConstraintMeasure SessionJudge::size(double factor)
{
  const NearestQuads nearest(made_.quads);
  const auto lengthOf = [this](Index q)
  {
    const std::array<Index, 4>& quad = made_.quads.quads[q];
    return std::sqrt(0.5 *
      (made_.quads.points[quad[2]] - made_.quads.points[quad[0]])
        .cross(made_.quads.points[quad[3]] - made_.quads.points[quad[1]])
        .norm());
  };
  ConstraintMeasure measure =
    ConstraintMeasure::unknown(part().place, "factor", "the quads near it have no area");
  std::vector<WeightedDeviation> logarithms;
  double worst = -1;
  const std::size_t stride = strideOf(part().points.size(), mostPlacesOf(1));
  for (std::size_t i = 0; i < part().points.size(); i += stride)
  {
    const Vector3& p = surface_.points[part().points[i]];
    const auto there = nearest.at(p);
    const double length = there ? lengthOf(there->quad) : 0;
    if (length > 0)
    {
      const double off = std::abs(std::log(length / (factor * made_.targetEdgeLength)));
      logarithms.push_back({ off, 1 });
      if (off > worst)
      {
        worst = off;
        measure.place = p;
      }
    }
  }
  if (logarithms.empty())
  {
    return measure;
  }
  measure.deviation = std::exp(meanOf(logarithms));
  measure.deviation95 = std::exp(percentile95(std::move(logarithms)));
  measure.isMet = measure.deviation <= kMetFactor;
  measure.reason = measure.isMet
    ? ""
    : "the sizes of the quads differ from those asked for by a factor of " +
      shortText(measure.deviation) + " on average, at most " + shortText(kMetFactor) +
      " counts as met; sizes change only gradually from one place to the next";
  return measure;
}

} // namespace

std::vector<ConstraintReport> reportConstraints(const SurfaceInput& surface,
  const SessionConstraints& constraints, const ComposedInput& composed, const RemeshResult& made,
  const SessionResult& result, const SymmetricResult* symmetric)
{
  return SessionJudge(surface, constraints, composed, made, result, symmetric).run();
}

} // namespace quadrille
