// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Evaluation/ConstraintMeasures.h"

#include "Base/Angles.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Mesh/Distance.h"
#include "Quads/QuadShape.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <utility>

namespace quadrille
{

namespace
{

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
/// Places at which all constraints together are measured, at most, and each of many at least: a mean over 2,500 has an
/// error of a fiftieth of the spread, a tenth of a degree. More of them would take longer than the map of a scan.
constexpr std::size_t kMostPlacesOfAll = 20000;
constexpr std::size_t kLeastGuidePlaces = 100;

/// Places on each edge of a curve that is as long as an edge of the quads.
constexpr double kPlacesAnEdge = 8;

Vector3 areaNormalOf(const QuadMesh& mesh, Index quad)
{
  return diagonalNormal(cornersOf(mesh.points, mesh.quads[quad]));
}

/// That of a square of the same area.
double edgeLengthOf(const QuadMesh& mesh, Index quad)
{
  return std::sqrt(0.5 * areaNormalOf(mesh, quad).norm());
}

/// The least value that is not exceeded by this share of the weight.
double quantile(std::vector<WeightedDeviation> values, double share)
{
  std::sort(values.begin(), values.end(),
    [](const WeightedDeviation& a, const WeightedDeviation& b) { return a.value < b.value; });
  double weights = 0;
  for (const WeightedDeviation& m : values)
  {
    weights += m.weight;
  }
  double below = 0;
  for (const WeightedDeviation& m : values)
  {
    below += m.weight;
    if (below >= share * weights)
    {
      return m.value;
    }
  }
  return kUnknown;
}

double angleBetweenLines(const Vector3& a, const Vector3& b)
{
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

} // namespace

std::string shortText(double number)
{
  std::ostringstream text;
  text.precision(3);
  text << number;
  return text.str();
}

std::string percentText(double share)
{
  return shortText(std::round(100 * share)) + " %";
}

ConstraintMeasure ConstraintMeasure::unknown(
  const Vector3& place, const char* unit, std::string reason)
{
  ConstraintMeasure word;
  word.place = place;
  word.unit = unit;
  word.deviation = word.deviation95 = kUnknown;
  word.reason = std::move(reason);
  return word;
}

double meanOf(const std::vector<WeightedDeviation>& values)
{
  double sum = 0, weights = 0;
  for (const WeightedDeviation& m : values)
  {
    sum += m.weight * m.value;
    weights += m.weight;
  }
  return weights > 0 ? sum / weights : kUnknown;
}

double percentile95(std::vector<WeightedDeviation> values)
{
  return quantile(std::move(values), 0.95);
}

std::size_t mostPlacesOf(std::size_t guides)
{
  return std::max(kMostPlacesOfAll / std::max<std::size_t>(guides, 1), kLeastGuidePlaces);
}

std::size_t strideOf(std::size_t count, std::size_t most)
{
  return std::max<std::size_t>((count + most - 1) / most, 1);
}

//------------------------------------------------------------------------------
bool ConstraintMeasures::isAtIrregularVertex(Index quad) const
{
  return std::any_of(mesh_.quads[quad].begin(), mesh_.quads[quad].end(),
    [this](Index p)
    { return mesh_.valence[p] + (mesh_.onBoundary[p] != 0 ? 1 : 0) != kRegularValence; });
}

const NearestQuads& ConstraintMeasures::quads()
{
  if (!quads_)
  {
    quads_.emplace(mesh_);
  }
  return *quads_;
}

const ReachedValences& ConstraintMeasures::valences()
{
  if (!valences_)
  {
    valences_.emplace(mesh_);
  }
  return *valences_;
}

Vector3 ConstraintMeasures::centreOf(Index quad) const
{
  Vector3 centre = Vector3::Zero();
  for (const Index p : mesh_.quads[quad])
  {
    centre += 0.25 * mesh_.points[p];
  }
  return centre;
}

double ConstraintMeasures::edgeLengthAt(const Vector3& p)
{
  const std::optional<NearestQuads::Place> there = quads().at(p);
  return there ? there->edgeLength : 0;
}

ConstraintMeasure ConstraintMeasures::guide(
  const std::vector<GuidedPlace>& measured, std::size_t mostPlaces, double* irregularShare)
{
  ConstraintMeasure word = ConstraintMeasure::unknown(measured.front().place, "degrees", kNoQuads);
  if (mesh_.quads.empty())
  {
    return word;
  }
  std::vector<WeightedDeviation> angles;
  double irregular = 0, area = 0, worst = -1;
  const std::size_t stride = strideOf(measured.size(), mostPlaces);
  for (std::size_t i = 0; i < measured.size(); i += stride)
  {
    pollNowAndThen(i);
    const GuidedPlace& asked = measured[i];
    if (!(asked.area > 0) || asked.direction.isZero(0))
    {
      continue;
    }
    const std::optional<NearestQuads::Place> there = quads().at(asked.place);
    if (!there)
    {
      continue;
    }
    // In the plane of the quad: where the surface bends, that of its triangle is another one.
    const Vector3 normal = areaNormalOf(mesh_, there->quad).stableNormalized();
    const auto inPlane = [&normal](const Vector3& along)
    { return Vector3(along - normal * normal.dot(along)); };
    double angle = kPi / 2;
    for (const Vector3& along : there->along)
    {
      angle = std::min(angle, angleBetweenLines(inPlane(along), inPlane(asked.direction)));
    }
    angles.push_back({ angle * 180 / kPi, asked.area });
    area += asked.area;
    irregular += isAtIrregularVertex(there->quad) ? asked.area : 0;
    if (angle > worst)
    {
      worst = angle;
      word.place = asked.place;
    }
  }
  if (angles.empty())
  {
    word.reason = "its directions are normal to the surface everywhere: give directions along it";
    return word;
  }
  word.deviation = meanOf(angles);
  word.deviation95 = percentile95(std::move(angles));
  word.isMet = word.deviation <= kMetAngle;
  word.reason = word.isMet ? ""
                           : "the quads' edges are " + shortText(word.deviation) +
      " degrees off on average, at most " + shortText(kMetAngle) + " count as met";
  if (irregularShare != nullptr)
  {
    *irregularShare = irregular / area;
  }
  return word;
}

ConstraintMeasure ConstraintMeasures::cleared(const Vector3& place)
{
  ConstraintMeasure word = ConstraintMeasure::unknown(place, "edge lengths", kNoQuads);
  const double edgeLength = edgeLengthAt(place);
  if (!(edgeLength > 0))
  {
    return word;
  }
  word.deviation = kInfinity;
  for (const QuadLine& line : mesh_.lines)
  {
    if (!line.boundary)
    {
      const double distance = distanceToSegment(place, mesh_.points[line.a], mesh_.points[line.b]);
      word.deviation = std::min(word.deviation, distance / edgeLength);
    }
  }
  word.isMet = word.deviation > kMetDistance;
  word.reason = word.isMet ? ""
                           : "a feature of the quads is " + shortText(word.deviation) +
      " edge lengths away, more than " + shortText(kMetDistance) +
      " counts as met: put the point on that curve, away from its ends, or take the curve that was "
      "drawn there away";
  return word;
}

ConstraintMeasure ConstraintMeasures::curve(const std::vector<Vector3>& path)
{
  std::vector<std::array<Vector3, 2>> edges;
  for (std::size_t k = 0; k + 1 < path.size(); ++k)
  {
    edges.push_back({ path[k], path[k + 1] });
  }
  return curve(edges);
}

ConstraintMeasure ConstraintMeasures::curve(const std::vector<std::array<Vector3, 2>>& curve)
{
  ConstraintMeasure word = ConstraintMeasure::unknown(curve.front()[0], "edge lengths", kNoQuads);
  if (mesh_.quads.empty())
  {
    return word;
  }
  if (mesh_.lines.empty())
  {
    word.deviation = kInfinity;
    word.reason = "the quads have no features and no boundary";
    return word;
  }
  if (!nearestLines_)
  {
    nearestLines_.emplace(mesh_);
  }
  double length = 0;
  for (const auto& [a, b] : curve)
  {
    length += (b - a).norm();
  }
  const double step = std::max(
    edgeLengthAt(curve.front()[0]) / kPlacesAnEdge, length / static_cast<double>(mostPlacesOf(1)));
  const std::size_t stride = strideOf(curve.size(), mostPlacesOf(1));
  double farthest = -1;
  for (std::size_t k = 0; k < curve.size(); k += stride)
  {
    pollNowAndThen(k);
    const auto& [a, b] = curve[k];
    const int parts = step > 0 ? static_cast<int>(std::ceil((b - a).norm() / step)) : 1;
    for (int i = 0; i <= parts; ++i)
    {
      const Vector3 p = a + (b - a) * (parts > 0 ? static_cast<double>(i) / parts : 0);
      // Not of the nearest edge alone, which may be a short one between long ones.
      const double edgeLength = edgeLengthAt(p);
      const double distance = edgeLength > 0 ? *nearestLines_->distance(p) / edgeLength : -1;
      if (distance > farthest)
      {
        farthest = distance;
        word.place = p;
      }
    }
  }
  if (farthest < 0)
  {
    word.reason = "no edges of quads were found near it";
    return word;
  }
  word.deviation = farthest;
  word.isMet = word.deviation <= kMetDistance;
  word.reason = word.isMet ? ""
                           : "the features of the quads are up to " + shortText(word.deviation) +
      " edge lengths away from it, at most " + shortText(kMetDistance) + " count as met";
  return word;
}

/// The point that is judged for a place: of those with the valence on its side the nearest one.
std::optional<Index> ConstraintMeasures::pointFor(
  const NearestQuads::Place& there, const Vector3& place, int asked)
{
  const QuadSide side = quads().sideOf(there);
  return asked == kRegularValence ? valences().nearest(place, side)
                                  : valences().nearestOf(asked, place, side);
}

ConstraintMeasure ConstraintMeasures::valence(const Vector3& place, int asked)
{
  ConstraintMeasure word = ConstraintMeasure::unknown(place, "edge lengths", kNoQuads);
  const std::optional<NearestQuads::Place> there =
    mesh_.quads.empty() ? std::nullopt : quads().at(place);
  const double length = there ? there->edgeLength : 0;
  if (!(length > 0))
  {
    return word;
  }
  const std::string wanted = "asked " + std::to_string(asked) + ", got " +
    std::to_string(valences().valence(*pointFor(*there, place, kRegularValence)));
  const std::optional<Index> point = pointFor(*there, place, asked);
  if (!point)
  {
    word.reason = wanted + "; the quads have no point of valence " + std::to_string(asked);
    return word;
  }
  const double distance = (mesh_.points[*point] - place).norm() / length;
  if (asked == kRegularValence)
  {
    word.isMet = valences().valence(*point) == kRegularValence;
    word.deviation = word.isMet ? 0 : distance;
    word.reason = word.isMet ? "" : wanted;
    return word;
  }
  word.deviation = distance;
  word.isMet = distance <= kMetDistance;
  word.reason = word.isMet ? ""
                           : wanted + "; the nearest point of valence " + std::to_string(asked) +
      " is " + shortText(distance) + " edge lengths away, at most " + shortText(kMetDistance) +
      " count as met";
  return word;
}

int ConstraintMeasures::valenceShown(const Vector3& place, int asked)
{
  if (mesh_.quads.empty())
  {
    return 0;
  }
  return valence(place, asked).isMet
    ? asked
    : valences().valence(*pointFor(*quads().at(place), place, kRegularValence));
}

/// An irregular point within an edge length of the place that is none of these; each stands for one point of its
/// valence within two edge lengths.
std::optional<Index> ConstraintMeasures::strangerAt(
  const Vector3& place, const std::vector<ValencePlace>& irregular)
{
  constexpr double kBesideGoal = 1, kReachOfPartner = 2; // edge lengths
  const NearestQuads::Place there = *quads().at(place);
  const QuadSide side = quads().sideOf(there);
  const double length = there.edgeLength;
  std::vector<std::pair<double, Index>> beside;
  for (Index p = 0; p < mesh_.points.size(); ++p)
  {
    const double distance = (mesh_.points[p] - place).norm();
    if (distance <= kBesideGoal * length && valences().valence(p) != kRegularValence && side.has(p))
    {
      beside.emplace_back(distance, p);
    }
  }
  std::sort(beside.begin(), beside.end());
  std::vector<std::uint8_t> isTaken(irregular.size(), 0);
  for (const auto& [distance, p] : beside)
  {
    std::optional<std::size_t> partner;
    double least = kReachOfPartner * length;
    for (std::size_t i = 0; i < irregular.size(); ++i)
    {
      const double away = (irregular[i].place - mesh_.points[p]).norm();
      if (isTaken[i] == 0 && irregular[i].valence == valences().valence(p) && away <= least)
      {
        least = away;
        partner = i;
      }
    }
    if (!partner)
    {
      return p;
    }
    isTaken[*partner] = 1;
  }
  return std::nullopt;
}

ConstraintMeasure ConstraintMeasures::changedValence(
  const Vector3& place, int asked, const std::vector<ValencePlace>* irregular)
{
  ConstraintMeasure word = this->valence(place, asked);
  const bool isRegular = asked == kRegularValence;
  if (irregular == nullptr || mesh_.quads.empty() || word.isMet == isRegular)
  {
    return word;
  }
  const std::optional<Index> stranger = strangerAt(place, *irregular);
  if (isRegular && !stranger)
  {
    word.isMet = true;
    word.deviation = 0;
    word.reason.clear();
  }
  else if (!isRegular && stranger)
  {
    word.isMet = false;
    word.place = mesh_.points[*stranger];
    word.reason = "an irregular vertex of valence " +
      std::to_string(valences().valence(*stranger)) + " is " +
      shortText((word.place - place).norm() / edgeLengthAt(place)) +
      " edge lengths from its new place, where there was to be none: choose a place with more room "
      "between features and other irregular vertices";
  }
  return word;
}

ConstraintMeasure ConstraintMeasures::move(const PlacedConstraint& constraint)
{
  const std::vector<ValencePlace>* const irregular = constraint.irregular.get();
  const Vector3& from = constraint.path.front();
  ConstraintMeasure there = changedValence(constraint.path.back(), constraint.valence, irregular);
  if (there.isMet && !changedValence(from, kRegularValence, irregular).isMet)
  {
    there.isMet = false;
    there.place = from;
    there.reason = "it is at its new place, but where it was another irregular vertex is left";
  }
  if (constraint.otherChange)
  {
    there.place = there.isMet ? constraint.otherChange->place : there.place;
    there.reason += (there.isMet ? "" : "; ") + constraint.otherChange->text;
    there.isMet = false;
  }
  return there;
}

ConstraintMeasure ConstraintMeasures::line(
  const PlacedConstraint& constraint, const std::vector<CurveOutcome>& outcomes)
{
  ConstraintMeasure word =
    ConstraintMeasure::unknown(constraint.path.front(), "edge lengths", kNoQuads);
  const std::string why =
    constraint.curve < outcomes.size() ? outcomes[constraint.curve].why : std::string();
  if (mesh_.quads.empty())
  {
    word.reason = why.empty() ? word.reason : why;
    return word;
  }
  const std::optional<LineInQuads> found = lineInQuads(constraint);
  word.isMet = found && found->isMet();
  if (word.isMet)
  {
    word.deviation = found->distance;
    word.place = found->place;
    word.reason.clear();
    return word;
  }
  const bool isCycle = constraint.kind == ConstraintKind::Cycle;
  if (isCycle || (!found && why.empty()))
  {
    ConstraintMeasure edges = curve(constraint.path);
    if (edges.isMet)
    {
      edges.isMet = false;
      edges.reason = "the quads' edges run along it, but turn at irregular vertices on it: draw it "
                     "farther from others and from corners, or ask for smaller quads";
      return edges;
    }
  }
  if (!why.empty())
  {
    word.reason = why; // a chain that is there without it tells nothing
  }
  else if (found && found->ends <= kMetLine)
  {
    word.deviation = found->distance;
    word.place = found->place;
    word.reason = "the chain of edges is up to " + shortText(found->distance) +
      " edge lengths away from the line, at most " + shortText(kMetLine) + " count as met";
  }
  else if (found)
  {
    word.deviation = found->distance;
    word.place = found->end;
    word.reason = "the chain of edges ends at " + placeText(found->end) + ", " +
      shortText(found->ends) + " edge lengths from an end of the line, at most " +
      shortText(kMetLine) + " count as met: end the line there";
  }
  else
  {
    word.reason = constraint.curve >= outcomes.size()
      ? "the method has no connections and cycles: choose another one"
      : "the quads have no straight chain of edges within " + shortText(kNearLine) +
        " edge lengths of the line";
  }
  return word;
}

std::optional<LineInQuads> ConstraintMeasures::lineInQuads(const PlacedConstraint& constraint)
{
  if (mesh_.quads.empty())
  {
    return std::nullopt;
  }
  if (!lines_)
  {
    lines_.emplace(mesh_, quads());
  }
  return lines_->find(constraint);
}

double lengthOfSizeOne(double targetEdgeLength, std::optional<std::size_t> asked, std::size_t quads)
{
  return asked && quads > 0
    ? targetEdgeLength * std::sqrt(static_cast<double>(*asked) / static_cast<double>(quads))
    : targetEdgeLength;
}

ConstraintMeasure ConstraintMeasures::sizeOf(const std::vector<std::pair<Index, double>>& quads,
  const Vector3& place, const AskedSize& asked) const
{
  ConstraintMeasure word =
    ConstraintMeasure::unknown(place, "factor", "the quads near it have no area");
  std::vector<WeightedDeviation> logarithms, signedLogarithms;
  double worst = -1;
  for (const auto& [quad, weight] : quads)
  {
    const double length = edgeLengthOf(mesh_, quad);
    if (length > 0)
    {
      const double off = std::log(length / (asked.factor * asked.edgeLength));
      logarithms.push_back({ std::abs(off), weight });
      signedLogarithms.push_back({ off, weight });
      if (std::abs(off) > worst)
      {
        worst = std::abs(off);
        word.place = centreOf(quad);
      }
    }
  }
  if (logarithms.empty())
  {
    return word;
  }
  const double middle = quantile(std::move(signedLogarithms), 0.5);
  const double ratio = std::exp(middle);
  word.deviation = std::exp(std::abs(middle));
  word.deviation95 = std::exp(percentile95(std::move(logarithms)));
  word.isMet = word.deviation <= kMetFactor;
  word.reason = word.isMet ? ""
                           : "the sizes of the quads differ from those asked for by a factor of " +
      shortText(word.deviation) + " in the median, at most " + shortText(kMetFactor) +
      " counts as met; they are " + shortText(ratio) + " times as long as asked for" +
      (ratio < 1 ? ", as larger sizes give way to smaller ones beside them"
                 : ", as smaller ones need irregular vertices that find no room");
  return word;
}

ConstraintMeasure ConstraintMeasures::size(
  const Vector3& place, double radius, const AskedSize& asked, std::vector<Index>* measured)
{
  if (mesh_.quads.empty())
  {
    return ConstraintMeasure::unknown(place, "factor", kNoQuads);
  }
  std::vector<std::pair<Index, double>> quads;
  const auto add = [&](Index q)
  {
    const double length = edgeLengthOf(mesh_, q);
    quads.emplace_back(q, length * length);
    if (measured != nullptr)
    {
      measured->push_back(q);
    }
  };
  for (Index q = 0; radius > 0 && q < mesh_.quads.size(); ++q)
  {
    pollNowAndThen(q);
    if ((centreOf(q) - place).norm() <= radius)
    {
      add(q);
    }
  }
  const std::optional<Index> point = quads.empty()
    ? pointFor(*this->quads().at(place), place, kRegularValence)
    : std::optional<Index>();
  for (Index q = 0; point && q < mesh_.quads.size(); ++q)
  {
    const std::array<Index, 4>& corners = mesh_.quads[q];
    if (std::find(corners.begin(), corners.end(), *point) != corners.end())
    {
      add(q);
    }
  }
  return sizeOf(quads, place, asked);
}

ConstraintMeasure ConstraintMeasures::size(
  const std::vector<WeightedPlace>& places, const AskedSize& asked)
{
  if (mesh_.quads.empty())
  {
    return ConstraintMeasure::unknown(places.front().place, "factor", kNoQuads);
  }
  std::vector<std::pair<Index, double>> measured;
  for (const WeightedPlace& place : places)
  {
    pollNowAndThen(measured.size());
    const std::optional<NearestQuads::Place> there = quads().at(place.place);
    if (there)
    {
      measured.emplace_back(there->quad, place.weight);
    }
  }
  return sizeOf(measured, places.front().place, asked);
}

bool ConstraintMeasures::isUnder(const NearestSegments& stroke, double radius, const Vector3& place)
{
  // It guides what is within a quarter of a quad of its radius, see facesOfStrokes.
  return stroke.at(place).distance <= radius + 0.25 * edgeLengthAt(place);
}

double ConstraintMeasures::shareUnder(
  const std::vector<Vector3>& path, double radius, const std::vector<GuidedPlace>& places)
{
  const NearestSegments segments(path);
  double under = 0, all = 0;
  for (const GuidedPlace& place : places)
  {
    under += isUnder(segments, radius, place.place) ? place.area : 0;
    all += place.area;
  }
  return all > 0 ? under / all : 0;
}

std::string ConstraintMeasures::offSurface(const std::vector<Vector3>& given)
{
  if (mesh_.quads.empty())
  {
    return {};
  }
  double farthest = kFarOffSurface;
  std::string text;
  for (std::size_t i = 0; i < given.size(); ++i)
  {
    pollNowAndThen(i);
    const std::optional<NearestQuads::Place> there = quads().at(given[i]);
    const double length = there ? there->edgeLength : 0;
    const double distance = there ? (given[i] - there->point).norm() : 0;
    if (length > 0 && distance > farthest * length)
    {
      farthest = distance / length;
      text = "its point " + placeText(given[i]) + " lies " + shortText(farthest) +
        " edge lengths off the surface, whose nearest place is " + placeText(there->point) +
        ": move the point if that place is not what was meant";
    }
  }
  return text;
}

std::string withRemark(const std::string& reason, const std::string& remark)
{
  return reason + (reason.empty() || remark.empty() ? "" : "; ") + remark;
}

} // namespace quadrille
