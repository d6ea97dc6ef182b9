// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Evaluation/ConstraintMeasures.h"

#include "Base/Angles.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace quadrille
{

namespace
{

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
/// Places at which a constraint is measured, and all of them together, at most: a mean over so many has an error of a
/// fiftieth of the spread, a tenth of a degree. More of them would take longer than the map of a scan.
constexpr std::size_t kMostGuidePlaces = 2500;
constexpr std::size_t kMostPlacesOfAll = 20000;
constexpr std::size_t kLeastGuidePlaces = 100;

/// Places on each edge of a curve that is as long as an edge of the quads.
constexpr double kPlacesAnEdge = 8;

/// The mean of the four edges of a quad.
double edgeLengthOf(const QuadMesh& mesh, Index quad)
{
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i)
  {
    sum += (mesh.points[mesh.quads[quad][i]] - mesh.points[mesh.quads[quad][(i + 1) % 4]]).norm();
  }
  return sum / 4;
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

/// The least value that is not exceeded by 95 % of the weight.
double percentile95(std::vector<WeightedDeviation> values)
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
    if (below >= 0.95 * weights)
    {
      return m.value;
    }
  }
  return kUnknown;
}

std::size_t mostPlacesOf(std::size_t guides)
{
  return std::clamp(
    kMostPlacesOfAll / std::max<std::size_t>(guides, 1), kLeastGuidePlaces, kMostGuidePlaces);
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

ConstraintMeasure ConstraintMeasures::guide(
  const std::vector<GuidedPolygon>& measured, std::size_t mostPlaces, double* irregularShare)
{
  ConstraintMeasure word =
    ConstraintMeasure::unknown(measured.front().centre, "degrees", "no quads were made");
  if (mesh_.quads.empty())
  {
    return word;
  }
  if (!quads_)
  {
    quads_.emplace(mesh_);
  }
  std::vector<WeightedDeviation> angles;
  double irregular = 0, area = 0, worst = -1;
  const std::size_t stride = strideOf(measured.size(), mostPlaces);
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
                           : "the quads' edges are " + shortText(word.deviation) +
      " degrees off on average, at most " + shortText(kMetAngle) + " count as met";
  if (irregularShare != nullptr)
  {
    *irregularShare = irregular / area;
  }
  return word;
}

ConstraintMeasure ConstraintMeasures::curve(const std::vector<std::array<Vector3, 2>>& curve)
{
  ConstraintMeasure word =
    ConstraintMeasure::unknown(curve.front()[0], "edge lengths", "no quads were made");
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
                           : "the quads' edges are up to " + shortText(word.deviation) +
      " edge lengths away from it, at most " + shortText(kMetDistance) + " count as met";
  return word;
}

ConstraintMeasure ConstraintMeasures::valence(const Vector3& place, int asked)
{
  ConstraintMeasure word = ConstraintMeasure::unknown(place, "valence", "no quads were made");
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

std::string ConstraintMeasures::offSurface(const std::vector<Vector3>& given)
{
  if (mesh_.quads.empty())
  {
    return {};
  }
  if (!quads_)
  {
    quads_.emplace(mesh_);
  }
  double farthest = kFarOffSurface;
  std::string text;
  for (std::size_t i = 0; i < given.size(); ++i)
  {
    pollNowAndThen(i);
    const std::optional<NearestQuads::Place> there = quads_->at(given[i]);
    const double length = there ? edgeLengthOf(mesh_, there->quad) : 0;
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
