// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/PlaceText.h"
#include "Repair/SoupRepair.h"

#include <sstream>

namespace quadrille
{

namespace
{

/// "1 face is", "3 faces are".
std::string counted(std::size_t count, const std::string& one, const std::string& many)
{
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string placesText(const std::vector<SoupPlace>& places, std::size_t all, const char* elements)
{
  std::string text;
  for (const SoupPlace& place : places)
  {
    text += (text.empty() ? "" : ", ") + placeText(place.at) + " with " +
      std::to_string(place.faces) + " " + elements;
    if (place.length > 0)
    {
      std::ostringstream length;
      length << place.length;
      text += " of length " + length.str();
    }
  }
  const std::size_t more = all - places.size();
  return text + (more > 0 ? ", and " + std::to_string(more) + " more" : "");
}

} // namespace

std::vector<std::string> SoupReport::sentences() const
{
  std::vector<std::string> result;
  const auto add = [&](std::size_t count, const std::string& one, const std::string& many)
  {
    if (count > 0)
    {
      result.push_back(counted(count, one, many));
    }
  };
  add(mergedPoints, "point lay at the place of another one and was merged",
    "points lay at the place of others and were merged");
  add(degenerateFaces, "face without three different corners was removed",
    "faces without three different corners were removed");
  add(zeroAreaFaces, "face has no area and stays", "faces have no area and stay");
  add(duplicateFaces, "face stood there twice and was removed",
    "faces stood there twice and were removed");
  add(isolatedPoints, "point of no face was removed", "points of no face were removed");
  add(reorientedFaces, "face was turned round to agree with its neighbours",
    "faces were turned round to agree with their neighbours");
  add(nonManifoldEdges, "edge had more than two faces and was parted",
    "edges had more than two faces and were parted");
  add(copiedPoints, "point was copied to part what no manifold has",
    "points were copied to part what no manifold has");
  add(filledHoles, "hole was filled", "holes were filled");
  add(unfilledHoles, "hole could not be filled and stays open",
    "holes could not be filled and stay open");
  if (openBoundaries > 0)
  {
    result.push_back(
      counted(openBoundaries, "boundary loop is left: ", "boundary loops are left: ") +
      placesText(boundaries, openBoundaries, "edges"));
  }
  if (intersectingPairs > 0)
  {
    result.push_back(counted(intersectingPairs, "pair of faces crosses", "pairs of faces cross") +
      " each other, at " + counted(intersectionPlaces, "place: ", "places: ") +
      placesText(intersections, intersectionPlaces, "faces") + "; Surface Wrap removes them");
  }
  return result;
}

bool SoupReport::isHopeless(std::size_t faces) const
{
  constexpr std::size_t kSeveral = 8; // below, single faces may be meant
  const bool crossEachOther = 2 * intersectingFaces > faces;
  const bool standAlone = components >= kSeveral && 2 * components > faces;
  return crossEachOther != standAlone;
}

} // namespace quadrille
