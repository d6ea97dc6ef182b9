// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/DrawnOnSurface.h"

#include "Base/Lists.h"
#include "Base/PlaceText.h"
#include "Evaluation/ConstraintMeasures.h"
#include "Evaluation/LinesInQuads.h"
#include "Features/FeatureFilter.h"
#include "Mesh/ContentHash.h"
#include "Mesh/Distance.h"
#include "Prepare/FlatFlips.h"
#include "Prepare/Refine.h"
#include "Requests/DrawnLines.h"
#include "Requests/InsertPlaces.h"
#include "Requests/MeshPlaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace quadrille
{
namespace
{

/// Edge lengths between a place and the feature curve that it clears, at most.
constexpr double kNearCleared = 0.5;

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

/// Where a surface is flat beside vertices that were added, edges are flipped: needles at irregular vertices have to be
/// untangled in the map that is carried to them. before: vertices are older below.
void flipBeside(PreparedSurface& surface, Index before)
{
  const Mesh& mesh = surface.mesh;
  std::vector<Index> edges;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const auto isNew = [&](Index corner) { return mesh.origin[corner] >= before; };
    if (!mesh.isConstrained(h) && h < mesh.twin[h] &&
      (isNew(h) || isNew(Mesh::next(h)) || isNew(Mesh::previous(h)) ||
        isNew(Mesh::previous(mesh.twin[h]))))
    {
      edges.push_back(h);
    }
  }
  FlatFlips flips(surface, edges);
  flips.flip(edges, [](Index) {});
  flips.finish();
}

/// A connection's ends that are to lie on features or boundaries, where the quads' edges have them.
void leadToCurves(const Mesh& mesh, double within, CurveRequest& connection)
{
  std::vector<Vector3>& points = connection.points;
  if ((*connection.ends)[0] == 0)
  {
    points.front() = nearestOnCurves(mesh, points.front(), within).value_or(points.front());
  }
  if ((*connection.ends)[1] == 0)
  {
    points.back() = nearestOnCurves(mesh, points.back(), within).value_or(points.back());
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
  // Curves beside one that is cleared would be taken for it where they are as near as what is met.
  const std::vector<ClearedFeature> cleared =
    clearFeatures(surface.mesh, places, kNearCleared * edgeLength, kMetDistance * edgeLength);
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
  if (drawn.empty() && !hasLines(surface.curves))
  {
    return;
  }
  const Index before = surface.mesh.vertexCount();
  std::vector<FeatureRequest> features = drawn;
  addFeatures(surface.curves, CurveKind::Cycle, features);
  const InsertionOptions options{ edgeLength, threads };
  std::vector<std::vector<Vector3>> paths;
  if (!features.empty())
  {
    const double near = kMetDistance * edgeLength;
    std::vector<std::array<double, 2>> toCurves(features.size(), { 0, 0 });
    for (std::size_t i = 0; i < drawn.size(); ++i)
    {
      const bool isClosed = drawn[i].points.front() == drawn[i].points.back();
      toCurves[i] = isClosed ? toCurves[i] : std::array<double, 2>{ near, near };
    }
    paths = insertFeatures(surface, features, options, notices, toCurves);
  }
  std::size_t next = drawn.size();
  for (CurveRequest& curve : surface.curves)
  {
    if (curve.kind == CurveKind::Cycle)
    {
      curve.points = std::move(paths[next++]);
    }
  }
  // One by one, as one may end on another.
  for (CurveRequest& curve : surface.curves)
  {
    if (curve.ends)
    {
      leadToCurves(surface.mesh, kReachOfCurve * edgeLength, curve);
      const double near = kMetLine * edgeLength;
      const auto [begin, end] = *curve.ends;
      const std::array<double, 2> toCurves{ begin == 0 ? near : 0, end == 0 ? near : 0 };
      curve.points =
        insertFeatures(surface, { { curve.points } }, options, notices, { toCurves }).front();
    }
  }
  noteAdded(surface, before, threads, notices);
}

std::vector<ValencePlace> withEnds(const PreparedSurface& surface,
  std::vector<ValencePlace> valences, double edgeLength, int threads)
{
  const Mesh& mesh = surface.mesh;
  const auto normalAt = [&](const Vector3& place)
  {
    const MeshPlace there = placesOnMesh(mesh, { place }, threads).front();
    return Vector3(mesh.doubleAreaNormal(there.face).stableNormalized());
  };
  for (const CurveRequest& curve : surface.curves)
  {
    for (std::size_t i = 0; curve.ends && i < 2; ++i)
    {
      const Vector3& place = i == 0 ? curve.points.front() : curve.points.back();
      const int valence = (*curve.ends)[i];
      if (valence != 0)
      {
        eraseIf(valences,
          [&](const ValencePlace& asked)
          {
            return asked.valence == valence &&
              (asked.place - place).norm() <= kMetDistance * edgeLength &&
              areOnOneSide(normalAt(asked.place), normalAt(place));
          });
        valences.push_back({ place, valence });
      }
    }
  }
  return valences;
}

const ValencePlace* nearestOf(const std::vector<ValencePlace>& valences, int valence,
  const Vector3& p, double within, const std::function<bool(const ValencePlace&)>& counts)
{
  const ValencePlace* nearest = nullptr;
  for (const ValencePlace& asked : valences)
  {
    const double distance = (asked.place - p).norm();
    if (asked.valence == valence &&
      (nearest == nullptr ? distance <= within : distance < (nearest->place - p).norm()) &&
      (!counts || counts(asked)))
    {
      nearest = &asked;
    }
  }
  return nearest;
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
  flipBeside(surface, before);
  noteAdded(surface, before, threads, notices);
  return true;
}

} // namespace quadrille
