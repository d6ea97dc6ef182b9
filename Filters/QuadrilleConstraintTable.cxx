// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleConstraintTable.h"

#include "Base/Angles.h"
#include "Base/Progress.h"
#include "QuadrilleLinesInQuads.h"
#include "QuadrilleNewArray.h"
#include "QuadrilleQuadPlaces.h"

#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

namespace quadrille
{

namespace
{

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
/// Degrees on average, edge lengths at most, and the factor on average, up to which a constraint counts as met.
constexpr double kMetAngle = 5;
constexpr double kMetDistance = 0.1;
constexpr double kMetFactor = 1.25;
/// A share of a guided region above this is worth a word.
constexpr double kNotableShare = 0.1;
/// Places on each edge of a curve that is as long as an edge of the quads.
constexpr double kPlacesAnEdge = 8;

std::string textOf(double number)
{
  std::ostringstream text;
  text.precision(3);
  text << number;
  return text.str();
}

std::string percentText(double share)
{
  return textOf(std::round(100 * share)) + " %";
}

ConstraintWord unknownWord(const char* kind, vtkIdType source, const char* unit, std::string reason)
{
  ConstraintWord word;
  word.kind = kind;
  word.source = source;
  word.unit = unit;
  word.deviation = word.deviation95 = kUnknown;
  word.reason = std::move(reason);
  return word;
}

/// A deviation, and how much it counts.
struct Measured
{
  double value = 0;
  double weight = 0;
};

double meanOf(const std::vector<Measured>& values)
{
  double sum = 0, weights = 0;
  for (const Measured& m : values)
  {
    sum += m.weight * m.value;
    weights += m.weight;
  }
  return weights > 0 ? sum / weights : kUnknown;
}

/// The least value that is not exceeded by 95 % of the weight.
double percentile95(std::vector<Measured> values)
{
  std::sort(values.begin(), values.end(),
    [](const Measured& a, const Measured& b) { return a.value < b.value; });
  double weights = 0;
  for (const Measured& m : values)
  {
    weights += m.weight;
  }
  double below = 0;
  for (const Measured& m : values)
  {
    below += m.weight;
    if (below >= 0.95 * weights)
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

class Judge
{
public:
  Judge(const AskedConstraints& asked, const QuadMesh& mesh) : asked_(asked), mesh_(mesh)
  {
    std::size_t guides = asked.arrays.guides.size();
    for (std::size_t i = 0; i < asked.placed.size(); ++i)
    {
      guides += asked.placed[i].guided.empty() ? 0 : 1;
      for (const GuidedPolygon& guided : asked.placed[i].guided)
      {
        strokeOf_[guided.polygon] = i; // the later one goes before
      }
    }
    mostPlaces_ = mostPlacesOf(guides);
  }

  ConstraintWord guideArray(const ArrayConstraints::Region& region)
  {
    return guide("guide array", region.firstCell, region.measured, region.polygons, std::nullopt);
  }
  ConstraintWord featureEdges(const ArrayConstraints::Curve& curve)
  {
    return feature(curve.firstPoint, curve.edges);
  }
  ConstraintWord valence(const ArrayConstraints::Valence& asked)
  {
    return asked.isUsed
      ? valenceAt(asked.point, asked.place, asked.asked)
      : placed(
          unknownWord("valence", asked.point, "valence", "no face uses the point"), asked.place);
  }
  ConstraintWord sizes(vtkDataArray* sizes) const;
  ConstraintWord drawn(std::size_t i);

private:
  static ConstraintWord placed(ConstraintWord word, const Vector3& place)
  {
    word.place = place;
    return word;
  }
  ConstraintWord guide(const char* kind, vtkIdType source,
    const std::vector<GuidedPolygon>& measured, const std::vector<Index>& polygons,
    std::optional<std::size_t> stroke);
  ConstraintWord feature(vtkIdType source, const std::vector<std::array<Vector3, 2>>& edges);
  ConstraintWord valenceAt(vtkIdType source, const Vector3& place, int asked);
  ConstraintWord line(const PlacedConstraint& constraint);
  std::string whyNotAlong(const std::vector<GuidedPolygon>& measured,
    const std::vector<Index>& polygons, std::optional<std::size_t> stroke,
    double irregularShare) const;
  bool isAtIrregularVertex(Index quad) const;

  const AskedConstraints& asked_;
  const QuadMesh& mesh_;
  std::map<Index, std::size_t> strokeOf_; ///< polygons under strokes
  std::size_t mostPlaces_ = mostPlacesOf(1);
  std::optional<ReachedValences> valences_; ///< these are made when they are needed first
  std::optional<NearestQuads> quads_;
  std::optional<NearestEdges> edges_;
  std::optional<LinesInQuads> lines_;
};

bool Judge::isAtIrregularVertex(Index quad) const
{
  return std::any_of(mesh_.quads[quad].begin(), mesh_.quads[quad].end(),
    [this](Index p)
    { return mesh_.valence[p] + (mesh_.onBoundary[p] != 0 ? 1 : 0) != kRegularValence; });
}

ConstraintWord Judge::guide(const char* kind, vtkIdType source,
  const std::vector<GuidedPolygon>& measured, const std::vector<Index>& polygons,
  std::optional<std::size_t> stroke)
{
  ConstraintWord word =
    placed(unknownWord(kind, source, "degrees", "no quads were made"), measured.front().centre);
  if (mesh_.quads.empty())
  {
    return word;
  }
  if (!quads_)
  {
    quads_.emplace(mesh_);
  }
  std::vector<Measured> angles;
  double irregular = 0, area = 0, worst = -1;
  const std::size_t stride = strideOf(measured.size(), mostPlaces_);
  for (std::size_t i = 0; i < measured.size(); i += stride)
  {
    pollNowAndThen(i);
    const GuidedPolygon& asked = measured[i];
    if (!(asked.area > 0) || asked.direction.isZero(0))
    {
      continue;
    }
    const std::optional<NearestQuads::Place> there = quads_->at(asked.centre);
    if (!there)
    {
      continue;
    }
    double angle = kPi / 2;
    for (const Vector3& along : there->along)
    {
      const Vector3 inPlane = along - asked.normal * asked.normal.dot(along);
      angle = std::min(angle, angleBetweenLines(inPlane, asked.direction));
    }
    angles.push_back({ angle * 180 / kPi, asked.area });
    area += asked.area;
    irregular += isAtIrregularVertex(there->quad) ? asked.area : 0;
    if (angle > worst)
    {
      worst = angle;
      word.place = asked.centre;
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
                           : "the quads' edges are " + textOf(word.deviation) +
      " degrees off on average, at most " + textOf(kMetAngle) + " count as met" +
      whyNotAlong(measured, polygons, stroke, irregular / area);
  return word;
}

std::string Judge::whyNotAlong(const std::vector<GuidedPolygon>& measured,
  const std::vector<Index>& polygons, std::optional<std::size_t> stroke,
  double irregularShare) const
{
  std::ostringstream text;
  std::size_t overruled = 0, by = 0;
  double least = 1;
  for (const Index polygon : polygons)
  {
    const auto found = strokeOf_.find(polygon);
    if (found != strokeOf_.end() && found->second != stroke)
    {
      ++overruled;
      by = found->second;
    }
  }
  for (const GuidedPolygon& asked : measured)
  {
    least = std::min(least, asked.weight);
  }
  if (overruled > 0)
  {
    text << "; " << overruled << " of its " << polygons.size() << " cells are under guiding stroke "
         << asked_.placed[by].source << ", which goes before it";
  }
  if (irregularShare > kNotableShare)
  {
    text << "; " << percentText(irregularShare) << " of its area is in quads at irregular vertices";
  }
  if (least < 1)
  {
    text << "; its weight is " << textOf(least) << (stroke ? "" : " at least")
         << ", a larger one is followed more closely";
  }
  return text.str();
}

ConstraintWord Judge::feature(vtkIdType source, const std::vector<std::array<Vector3, 2>>& curve)
{
  ConstraintWord word = placed(
    unknownWord("feature curve", source, "edge lengths", "no quads were made"), curve.front()[0]);
  if (mesh_.quads.empty())
  {
    return word;
  }
  if (!edges_)
  {
    edges_.emplace(mesh_);
  }
  double length = 0;
  for (const auto& [a, b] : curve)
  {
    length += (b - a).norm();
  }
  const auto first = edges_->at(curve.front()[0]);
  const double step = std::max(
    (first ? first->length : 0) / kPlacesAnEdge, length / static_cast<double>(mostPlacesOf(1)));
  const std::size_t stride = strideOf(curve.size(), mostPlacesOf(1));
  double farthest = -1, lengths = 0;
  std::size_t places = 0;
  for (std::size_t k = 0; k < curve.size(); k += stride)
  {
    pollNowAndThen(k);
    const auto& [a, b] = curve[k];
    const int parts = step > 0 ? static_cast<int>(std::ceil((b - a).norm() / step)) : 1;
    for (int i = 0; i <= parts; ++i)
    {
      const Vector3 p = a + (b - a) * (parts > 0 ? static_cast<double>(i) / parts : 0);
      const std::optional<NearestEdges::Place> there = edges_->at(p);
      lengths += there ? there->length : 0;
      places += there ? 1 : 0;
      if (there && there->distance > farthest)
      {
        farthest = there->distance;
        word.place = p;
      }
    }
  }
  if (places == 0 || !(lengths > 0))
  {
    word.reason = "no edges of quads were found near it";
    return word;
  }
  word.deviation = farthest / (lengths / static_cast<double>(places));
  word.isMet = word.deviation <= kMetDistance;
  word.reason = word.isMet ? ""
                           : "the quads' edges are up to " + textOf(word.deviation) +
      " edge lengths away from it, at most " + textOf(kMetDistance) + " count as met";
  return word;
}

ConstraintWord Judge::valenceAt(vtkIdType source, const Vector3& place, int asked)
{
  ConstraintWord word =
    placed(unknownWord("valence", source, "valence", "no quads were made"), place);
  if (mesh_.quads.empty())
  {
    return word;
  }
  if (!valences_)
  {
    valences_.emplace(mesh_);
  }
  const int got = valences_->at(place);
  word.deviation = got - asked;
  word.isMet = got == asked;
  word.reason = word.isMet ? "" : "asked " + std::to_string(asked) + ", got " + std::to_string(got);
  return word;
}

/// By how much the sizes of the quads differ, against each other, from those asked for: the logarithms of the ratios
/// against their median.
ConstraintWord Judge::sizes(vtkDataArray* sizes) const
{
  ConstraintWord word = unknownWord("size", -1, "factor", "no quads were made");
  if (mesh_.quads.empty() || !sizes)
  {
    return word;
  }
  std::vector<Measured> ratios;
  std::vector<double> logarithms;
  std::vector<std::size_t> quadOf;
  for (std::size_t q = 0; q < mesh_.quads.size(); ++q)
  {
    const std::array<Index, 4>& quad = mesh_.quads[q];
    double asked = 0;
    for (const Index p : quad)
    {
      asked += 0.25 * sizes->GetComponent(p, 0);
    }
    const double area = 0.5 *
      (mesh_.points[quad[2]] - mesh_.points[quad[0]])
        .cross(mesh_.points[quad[3]] - mesh_.points[quad[1]])
        .norm();
    if (area > 0 && asked > 0)
    {
      ratios.push_back({ std::log(std::sqrt(area) / asked), area });
      logarithms.push_back(ratios.back().value);
      quadOf.push_back(q);
    }
  }
  if (ratios.empty())
  {
    word.reason = "the quads have no area";
    return word;
  }
  const auto middle = logarithms.begin() + static_cast<std::ptrdiff_t>(logarithms.size() / 2);
  std::nth_element(logarithms.begin(), middle, logarithms.end());
  double worst = -1;
  for (std::size_t i = 0; i < ratios.size(); ++i)
  {
    ratios[i].value = std::abs(ratios[i].value - *middle);
    if (ratios[i].value > worst)
    {
      worst = ratios[i].value;
      const std::array<Index, 4>& quad = mesh_.quads[quadOf[i]];
      word.place = 0.25 *
        (mesh_.points[quad[0]] + mesh_.points[quad[1]] + mesh_.points[quad[2]] +
          mesh_.points[quad[3]]);
    }
  }
  word.deviation = std::exp(meanOf(ratios));
  word.deviation95 = std::exp(percentile95(std::move(ratios)));
  word.isMet = word.deviation <= kMetFactor;
  word.reason = word.isMet ? ""
                           : "the sizes of the quads differ from those asked for by a factor of " +
      textOf(word.deviation) + " on average, at most " + textOf(kMetFactor) + " counts as met";
  return word;
}

/// A connection or a cycle: the chain of edges that it became, and how far that is from what was drawn.
ConstraintWord Judge::line(const PlacedConstraint& constraint)
{
  ConstraintWord word = placed(
    unknownWord(nameOf(constraint.kind), constraint.source, "edge lengths", "no quads were made"),
    constraint.path.front());
  if (mesh_.quads.empty() || constraint.curve >= asked_.curves.size())
  {
    return word;
  }
  if (!lines_)
  {
    lines_.emplace(mesh_);
  }
  const CurveOutcome& outcome = asked_.curves[constraint.curve];
  const std::vector<Vector3> chain = lines_->chainOf(constraint, outcome);
  word.isMet = !chain.empty();
  word.reason = word.isMet ? ""
    : outcome.why.empty()  ? "the quads have no straight chain of edges there"
                           : outcome.why;
  if (!chain.empty())
  {
    const auto [distance, place] = farthestFrom(constraint.path, chain);
    word.deviation = distance / lines_->edgeLength();
    word.place = place;
  }
  return word;
}

ConstraintWord Judge::drawn(std::size_t i)
{
  const PlacedConstraint& constraint = asked_.placed[i];
  const bool isStroke = constraint.kind == ConstraintKind::Stroke;
  const Vector3 place =
    constraint.path.empty() ? Vector3(Vector3::Zero()) : constraint.path.front();
  if (constraint.kind == ConstraintKind::Valence)
  {
    return valenceAt(constraint.source, place, constraint.valence);
  }
  if (constraint.kind == ConstraintKind::Connection || constraint.kind == ConstraintKind::Cycle)
  {
    return line(constraint);
  }
  if (!constraint.whyNot.empty() || (isStroke && constraint.guided.empty()))
  {
    return placed(unknownWord(isStroke ? "guide stroke" : "feature curve", constraint.source,
                    isStroke ? "degrees" : "edge lengths",
                    constraint.whyNot.empty() ? "it runs over no face" : constraint.whyNot),
      place);
  }
  if (isStroke)
  {
    std::vector<Index> polygons;
    for (const GuidedPolygon& guided : constraint.guided)
    {
      polygons.push_back(guided.polygon);
    }
    return guide("guide stroke", constraint.source, constraint.guided, polygons, i);
  }
  std::vector<std::array<Vector3, 2>> edges;
  for (std::size_t k = 0; k + 1 < constraint.path.size(); ++k)
  {
    edges.push_back({ constraint.path[k], constraint.path[k + 1] });
  }
  return feature(constraint.source, edges);
}

} // namespace

//------------------------------------------------------------------------------
std::vector<ConstraintWord> judgeConstraints(
  const AskedConstraints& asked, const QuadMesh& mesh, vtkDataArray* sizes)
{
  std::vector<ConstraintWord> words;
  Judge judge(asked, mesh);
  for (const ArrayConstraints::Region& region : asked.arrays.guides)
  {
    words.push_back(judge.guideArray(region));
  }
  for (const ArrayConstraints::Curve& curve : asked.arrays.curves)
  {
    words.push_back(judge.featureEdges(curve));
  }
  for (const ArrayConstraints::Valence& valence : asked.arrays.valences)
  {
    words.push_back(judge.valence(valence));
  }
  if (asked.arrays.sizes)
  {
    words.push_back(judge.sizes(sizes));
  }
  for (std::size_t i = 0; i < asked.placed.size(); ++i)
  {
    words.push_back(judge.drawn(i));
  }
  return words;
}

vtkSmartPointer<vtkTable> writeConstraintTable(const std::vector<ConstraintWord>& words)
{
  auto id = newArray<vtkIdTypeArray>("Id");
  auto kind = newArray<vtkStringArray>("Kind");
  auto source = newArray<vtkIdTypeArray>("SourceId");
  auto x = newArray<vtkDoubleArray>("X");
  auto y = newArray<vtkDoubleArray>("Y");
  auto z = newArray<vtkDoubleArray>("Z");
  auto met = newArray<vtkIntArray>("Met");
  auto deviation = newArray<vtkDoubleArray>("Deviation");
  auto deviation95 = newArray<vtkDoubleArray>("Deviation95");
  auto unit = newArray<vtkStringArray>("Unit");
  auto reason = newArray<vtkStringArray>("Reason");
  for (std::size_t i = 0; i < words.size(); ++i)
  {
    const ConstraintWord& word = words[i];
    id->InsertNextValue(static_cast<vtkIdType>(i));
    kind->InsertNextValue(word.kind);
    source->InsertNextValue(word.source);
    x->InsertNextValue(word.place.x());
    y->InsertNextValue(word.place.y());
    z->InsertNextValue(word.place.z());
    met->InsertNextValue(word.isMet ? 1 : 0);
    deviation->InsertNextValue(word.deviation);
    deviation95->InsertNextValue(word.deviation95);
    unit->InsertNextValue(word.unit);
    reason->InsertNextValue(word.reason);
  }
  auto table = vtkSmartPointer<vtkTable>::New();
  for (vtkAbstractArray* column : std::initializer_list<vtkAbstractArray*>{
         id, kind, source, x, y, z, met, deviation, deviation95, unit, reason })
  {
    table->AddColumn(column);
  }
  return table;
}

} // namespace quadrille
