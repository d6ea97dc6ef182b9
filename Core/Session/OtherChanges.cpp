// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/OtherChanges.h"

#include "Base/PlaceText.h"
#include "Prepare/ConstraintPlacement.h"
#include "Quads/QuadSmoothing.h"
#include "Session/IrregularMatch.h"

#include <algorithm>
#include <array>
#include <utility>

namespace quadrille
{
namespace
{

TriangleList trianglesOf(const FixedPlaces& fixed)
{
  TriangleList list;
  for (const std::array<Vector3, 3>& triangle : fixed.withoutMap)
  {
    list.add(triangle[0], triangle[1], triangle[2]);
  }
  return list;
}

bool isNear(const std::vector<Vector3>& all, const Vector3& p, double distance)
{
  return std::any_of(
    all.begin(), all.end(), [&](const Vector3& q) { return (p - q).norm() <= distance; });
}

} // namespace

FacesWithoutMap::FacesWithoutMap(const FixedPlaces& fixed, double edgeLength)
  : within_(kOnePlace * edgeLength)
{
  if (!fixed.withoutMap.empty())
  {
    triangles_.emplace(trianglesOf(fixed));
  }
}

bool FacesWithoutMap::has(const Vector3& place) const
{
  return triangles_ && triangles_->at(place, Vector3::Zero(), within_);
}

JudgedElsewhere judgedOf(const std::vector<PlacedPart>& parts, ConstraintMeasures& measures,
  const std::vector<ValencePlace>* irregular)
{
  JudgedElsewhere judged;
  for (const PlacedPart& part : parts)
  {
    for (const auto& [place, valence] : part.valences)
    {
      judged.told.push_back(place);
      if (!measures.changedValence(place, valence, irregular).isMet)
      {
        judged.failed.push_back(place);
      }
    }
  }
  return judged;
}

std::vector<Vector3> otherChanges(const std::vector<IrregularVertex>& expected,
  const QuadMesh& quads, ConstraintMeasures& measures, const JudgedElsewhere& judged,
  const FacesWithoutMap& withoutMap)
{
  const auto reachAt = [&measures](const Vector3& place)
  { return kReachOfSmoothing * measures.edgeLengthAt(place); };
  std::vector<double> reach;
  reach.reserve(expected.size());
  for (const IrregularVertex& vertex : expected)
  {
    reach.push_back(reachAt(vertex.place));
  }
  const std::vector<IrregularVertex> actual = irregularPoints(quads);
  const IrregularMatch match = matchIrregular(expected, actual, reach);
  std::vector<Vector3> places;
  for (std::size_t i = 0; i < expected.size(); ++i)
  {
    const Vector3& place = expected[i].place;
    if (!match.actual[i] && !isNear(judged.told, place, 0) &&
      !isNear(judged.drawn, place, reach[i]) && !withoutMap.has(place))
    {
      places.push_back(place);
    }
  }
  for (const std::size_t k : match.unexpected)
  {
    const Vector3& place = actual[k].place;
    if (!isNear(judged.failed, place, reachAt(place)) &&
      !isNear(judged.drawn, place, reachAt(place)) && !withoutMap.has(place))
    {
      places.push_back(place);
    }
  }
  return places;
}

std::string otherChangesText(const std::vector<Vector3>& places, const std::string& whyNotHeld)
{
  return std::to_string(places.size()) + " other irregular vertices are not as they were, one at " +
    placeText(places.front()) +
    (whyNotHeld.empty()
        ? ": choose places with more room between features and other irregular vertices"
        : ", as those on features and boundaries could not be held: " + whyNotHeld);
}

} // namespace quadrille
