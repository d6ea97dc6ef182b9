// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/RequestKeys.h"

namespace quadrille
{
namespace
{

void addSectors(const std::vector<HeldSector>& sectors, KeyMaker& key)
{
  key.add(sectors.size());
  for (const HeldSector& sector : sectors)
  {
    key.add(sector.middle, sector.turns);
  }
}

/// What both have under the same names.
template <typename Requests>
void addShared(const Requests& requests, KeyMaker& key)
{
  key.add(requests.regularElsewhere, requests.regularOnFeatures);
  key.add(requests.curves.size(), requests.seams.size(), requests.straight.size());
  for (const CurveRequest& curve : requests.curves)
  {
    key.add(curve.kind, curve.points, curve.ends.value_or(std::array<int, 2>{ -1, -1 }));
  }
  for (const SeamRequest& seam : requests.seams)
  {
    key.add(seam.from, seam.to, seam.imageFrom, seam.imageTo);
  }
  for (const StraightRequest& part : requests.straight)
  {
    key.add(part.from, part.via, part.to, part.outward);
  }
  key.add(requests.withoutMap);
}

} // namespace

ResultKey requestsKey(const SurfaceInput& input)
{
  KeyMaker key;
  addShared(input, key);
  key.add(input.guideDirections, input.guideWeights, input.guideOrders, input.targetValences);
  for (const ValencePlace& asked : input.drawn.valences)
  {
    key.add(asked.place, asked.valence, asked.mayDrift);
  }
  for (const StrokeRequest& stroke : input.drawn.strokes)
  {
    key.add(stroke.points, stroke.weight, stroke.radius, stroke.order);
  }
  for (const HeldVertex& vertex : input.held)
  {
    key.add(vertex.point, vertex.place);
    addSectors(vertex.sectors, key);
  }
  return key.key();
}

ResultKey requestsKey(const SurfaceRequests& requests)
{
  KeyMaker key;
  addShared(requests, key);
  key.add(requests.polygonGuides.size(), requests.valenceRequests.size(), requests.localSizes);
  for (const StrokeFace& guided : requests.strokeFaces)
  {
    key.add(guided.face, guided.weight, guided.direction);
  }
  for (const PolygonGuide& guide : requests.polygonGuides)
  {
    key.add(guide.polygon, guide.weight, guide.direction);
  }
  for (const ValenceRequest& request : requests.valenceRequests)
  {
    key.add(request.vertex, request.valence, request.mayDrift);
  }
  for (const SectorRequest& request : requests.sectorRequests)
  {
    key.add(request.vertex);
    addSectors(request.sectors, key);
  }
  return key.key();
}

} // namespace quadrille
