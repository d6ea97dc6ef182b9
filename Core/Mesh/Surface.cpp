// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Surface.h"

#include "Base/Lists.h"
#include "Base/PlaceText.h"
#include "Mesh/FlatSources.h"

#include <algorithm>

namespace quadrille
{
namespace
{

/// A flipped face of which nobody knows what was before reaches beyond the triangle that it names.
void keepInside(std::array<double, 3>& weights)
{
  if (std::all_of(weights.begin(), weights.end(), [](double weight) { return weight >= 0; }))
  {
    return;
  }
  double sum = 0;
  for (double& weight : weights)
  {
    weight = std::max(weight, 0.0);
    sum += weight;
  }
  for (double& weight : weights)
  {
    weight /= sum;
  }
}

} // namespace

std::string RepairReport::text() const
{
  std::string text;
  appendCount(text, triangulatedPolygons, "polygon triangulated", "polygons triangulated");
  appendCount(text, mergedPoints, "coincident point merged", "coincident points merged");
  appendCount(text, degenerateFaces, "degenerate face removed", "degenerate faces removed");
  appendCount(text, flippedCaps, "vertex put onto the edge it lies on",
    "vertices put onto the edges they lie on");
  appendCount(text, duplicateFaces, "duplicate face removed", "duplicate faces removed");
  appendCount(text, isolatedPoints, "isolated point dropped", "isolated points dropped");
  appendCount(text, nonManifoldEdges, "non-manifold edge split", "non-manifold edges split");
  appendCount(
    text, nonManifoldVertices, "non-manifold vertex split", "non-manifold vertices split");
  appendCount(text, reorientedFaces, "face reoriented", "faces reoriented");
  appendCount(text, removedComponents, "component too small to mesh removed",
    "components too small to mesh removed");
  appendCount(text, refinedFaces, "large face refined", "large faces refined");
  appendCount(text, closedHandles, "small handle cut and closed", "small handles cut and closed");
  appendCount(text, filledHoles, "small hole filled", "small holes filled");
  return text;
}

std::string FacetReport::text() const
{
  if (edges == 0)
  {
    return {};
  }
  return std::to_string(edges) + " sharp edges, one of them near " + placeText(place) +
    ", do not stand out from their surroundings, as the facets of a coarse or noisy surface do "
    "not: they were not used as features "
    "(mark edges to have them followed: Feature Edges, Curves)";
}

Index PreparedSurface::inputPointAt(Index h) const
{
  const Index f = Mesh::face(h), corner = h % 3;
  const Index entry = refinedEntry.empty() ? kInvalidIndex : refinedEntry[f];
  if (entry == kInvalidIndex)
  {
    return sourcePoints[f][corner];
  }
  if (isFlipped(f))
  {
    return flipped[entry].points[corner];
  }
  const std::array<double, 3>& weights = cornerWeights[entry][corner];
  const auto* whole = std::find(weights.begin(), weights.end(), 1.0);
  return whole == weights.end()
    ? kInvalidIndex
    : sourcePoints[f][static_cast<std::size_t>(whole - weights.begin())];
}

SourceLocation PreparedSurface::locate(Index f, const std::array<double, 3>& weights) const
{
  const Index entry = refinedEntry.empty() ? kInvalidIndex : refinedEntry[f];
  if (beforeFlips && isFlipped(f))
  {
    return beforeFlips->locate(flipped[entry], weights);
  }
  SourceLocation location;
  location.polygon = sourcePolygon[f];
  location.points = sourcePoints[f];
  location.weights = weights;
  if (entry != kInvalidIndex)
  {
    const auto& corners = cornerWeights[entry];
    for (std::size_t k = 0; k < 3; ++k)
    {
      location.weights[k] =
        weights[0] * corners[0][k] + weights[1] * corners[1][k] + weights[2] * corners[2][k];
    }
    keepInside(location.weights);
  }
  return location;
}

} // namespace quadrille
