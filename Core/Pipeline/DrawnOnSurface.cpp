// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/DrawnOnSurface.h"

#include "Base/PlaceText.h"
#include "Features/FeatureFilter.h"
#include "Mesh/ContentHash.h"
#include "Prepare/Refine.h"
#include "Requests/CycleSectors.h"
#include "Requests/InsertPlaces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace quadrille
{
namespace
{

/// Edge lengths between a place and the feature curve that it clears, at most.
constexpr double kNearCleared = 0.5;
/// The same to curves that go with one that is cleared: nearer ones would be taken for it, see kMetDistance.
constexpr double kBesideCleared = 0.3;

/// Orders of sizes of points, at the vertices that they became.
std::vector<int> sizingOrdersOf(const std::vector<int>& orders, const PreparedSurface& surface)
{
  std::vector<int> result;
  if (!orders.empty())
  {
    result.assign(surface.mesh.vertexCount(), 0);
    for (Index h = 0; h < surface.mesh.halfEdgeCount(); ++h)
    {
      int& order = result[surface.mesh.origin[h]];
      order = std::max(order, orders[surface.sourcePoints[Mesh::face(h)][h % 3]]);
    }
  }
  return result;
}

/// The surface has more vertices than before.
void noteAdded(
  PreparedSurface& surface, Index before, int threads, std::vector<std::string>& notices)
{
  surface.hash = contentHash(surface.mesh, threads);
  const Index added = surface.mesh.vertexCount() - before;
  if (added > 0)
  {
    notices.push_back(std::to_string(added) +
      " vertices were added to the triangles where constraints lie; the shape stays as it is");
  }
}

} // namespace

ResultKey drawnKey(ResultKey prepared, const SurfaceInput& input, double edgeLength)
{
  KeyMaker key(prepared);
  key.add(edgeLength, input.sizingOrders);
  for (const SizeRequest& size : input.drawn.sizes)
  {
    key.add(size.place, size.radius, size.factor, size.order);
  }
  return key.key();
}

void drawSizes(PreparedSurface& surface, const SurfaceInput& input, double edgeLength, int threads,
  std::vector<std::string>& notices)
{
  const Index before = surface.mesh.vertexCount();
  insertSizes(surface, input.drawn.sizes, sizingOrdersOf(input.sizingOrders, surface),
    { edgeLength, threads });
  noteAdded(surface, before, threads, notices);
}

void clearDrawn(PreparedSurface& surface, const std::vector<Vector3>& places, double edgeLength,
  std::vector<std::string>& notices)
{
  if (places.empty())
  {
    return;
  }
  const std::vector<ClearedFeature> cleared =
    clearFeatures(surface.mesh, places, kNearCleared * edgeLength, kBesideCleared * edgeLength);
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    const ClearedFeature& found = cleared[i];
    const std::string where = placeText(places[i]);
    if (found.length > 0)
    {
      notices.push_back("the feature curve at " + where + ", " +
        inEdgeLengths(found.length / edgeLength) + " edge lengths long, is cleared, as asked" +
        (found.beside > 0 ? ", with " + std::to_string(found.beside) + " beside it" : ""));
    }
    else if (std::isfinite(found.distance))
    {
      notices.push_back("no feature was cleared at " + where + ": the nearest is " +
        inEdgeLengths(found.distance / edgeLength) + " edge lengths away, at " +
        placeText(found.nearest) + "; put the point on the curve that is to go");
    }
    else
    {
      notices.push_back("no feature was cleared at " + where + ": the surface has none");
    }
  }
}

void drawFeatures(PreparedSurface& surface, const std::vector<FeatureRequest>& drawn,
  double edgeLength, int threads, std::vector<std::string>& notices)
{
  const std::vector<FeatureRequest> features = featuresWithCycles(drawn, surface.curves);
  if (features.empty())
  {
    return;
  }
  const Index before = surface.mesh.vertexCount();
  std::vector<std::vector<Vector3>> paths =
    insertFeatures(surface, features, { edgeLength, threads }, notices);
  std::size_t next = drawn.size();
  for (CurveRequest& curve : surface.curves)
  {
    if (curve.kind == CurveKind::Cycle)
    {
      curve.points = std::move(paths[next++]);
    }
  }
  noteAdded(surface, before, threads, notices);
}

bool drawValences(PreparedSurface& surface, const std::vector<ValencePlace>& valences,
  double edgeLength, int threads, std::vector<std::string>& notices)
{
  if (valences.empty())
  {
    return false;
  }
  const Index before = surface.mesh.vertexCount();
  const InsertedValences inserted = insertValences(surface, valences, { edgeLength, threads });
  notices.insert(notices.end(), inserted.notices.begin(), inserted.notices.end());
  if (inserted.splitConstraint)
  {
    splitChords(surface);
  }
  if (surface.mesh.vertexCount() == before)
  {
    return false;
  }
  noteAdded(surface, before, threads, notices);
  return true;
}

} // namespace quadrille
