// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/Guides.h"

#include "Base/Error.h"
#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Mesh/AskedVertices.h"
#include "Mesh/Topology.h"
#include "Requests/CurveRequests.h"
#include "Requests/SeamRequests.h"
#include "Requests/StraightRequests.h"
#include "Requests/StrokeGuides.h"

#include <algorithm>
#include <limits>

namespace quadrille
{

namespace
{

/// Sine of the angle to the normal below which a direction says nothing about the plane: half a degree.
constexpr double kLeastTangent = 0.01;

bool isGiven(const Vector3& direction)
{
  return direction.cwiseAbs().maxCoeff() > 0;
}

void requireGuideSize(const char* name, std::size_t size, std::size_t wanted, const char* elements)
{
  if (size != 0 && size != wanted)
  {
    throw InvalidInput(std::string(name) + " has " + std::to_string(size) + " values for " +
      std::to_string(wanted) + " " + elements + ": give one value each, or none.");
  }
}

void checkGuides(const SurfaceInput& input)
{
  for (std::size_t i = 0; i < input.guideDirections.size(); ++i)
  {
    const Vector3& direction = input.guideDirections[i];
    if (!direction.allFinite())
    {
      throw InvalidInput("the guiding direction of polygon " + std::to_string(i) +
        " is not finite: correct it, or set it to zero to leave the polygon free.");
    }
    if (!input.guideWeights.empty() && isGiven(direction))
    {
      const double weight = input.guideWeights[i];
      if (!(weight > 0 && weight <= 1))
      {
        throw InvalidInput("the guiding weight of polygon " + std::to_string(i) + " is " +
          std::to_string(weight) +
          ", but must be above 0 and at most 1; set the direction to zero to leave the polygon "
          "free.");
      }
    }
  }
}

void checkValences(const SurfaceInput& input)
{
  for (std::size_t i = 0; i < input.targetValences.size(); ++i)
  {
    const int valence = input.targetValences[i];
    if (valence != 0 && (valence < kLeastValence || valence > kMostValence))
    {
      throw InvalidInput("point " + std::to_string(i) + " asks for valence " +
        std::to_string(valence) + ", but only 0 (free) and " + std::to_string(kLeastValence) +
        " to " + std::to_string(kMostValence) + " can be asked for.");
    }
  }
}

std::vector<PolygonGuide> guidesOf(const SurfaceInput& input)
{
  std::vector<PolygonGuide> guides;
  for (std::size_t i = 0; i < input.guideDirections.size(); ++i)
  {
    const Vector3& direction = input.guideDirections[i];
    if (isGiven(direction))
    {
      const double weight = input.guideWeights.empty() ? 1.0 : input.guideWeights[i];
      guides.push_back({ static_cast<Index>(i), direction.stableNormalized(),
        std::max(static_cast<float>(weight), std::numeric_limits<float>::min()),
        input.guideOrders.empty() ? 0 : input.guideOrders[i] });
    }
  }
  return guides;
}

/// One entry per corner whose point asks for a valence, by vertex.
std::vector<ValenceRequest> cornerRequests(
  const SurfaceInput& input, const PreparedSurface& surface, int threads)
{
  const Mesh& mesh = surface.mesh;
  std::vector<std::uint8_t> isHeld(input.targetValences.size(), 0);
  for (const HeldVertex& held : input.held)
  {
    isHeld[held.point] |= held.sectors.empty() ? 1 : 0;
  }
  auto requests = parallelGather<ValenceRequest>(mesh.halfEdgeCount(), kLightChunk, threads,
    [&](Index h, std::vector<ValenceRequest>& found)
    {
      const Index point = surface.inputPointAt(h);
      if (point != kInvalidIndex && input.targetValences[point] != 0 && isHeld[point] == 0)
      {
        found.push_back({ mesh.origin[h], input.targetValences[point], point });
      }
    });
  std::sort(requests.begin(), requests.end(),
    [](const ValenceRequest& a, const ValenceRequest& b)
    { return a.vertex != b.vertex ? a.vertex < b.vertex : a.point < b.point; });
  return requests;
}

void requireFit(const ValenceRequest& request, const Vector3& place, bool boundary)
{
  if (boundary && request.valence < kLeastOnBoundary)
  {
    throw InvalidInput("point " + std::to_string(request.point) + " at " + placeText(place) +
      " asks for valence " + std::to_string(request.valence) +
      ", but lies on the boundary, where the least is 3, a corner with one quad.");
  }
}

} // namespace

void checkRequests(const SurfaceInput& input)
{
  const std::size_t polygons = input.polygonOffsets.size() - 1;
  requireGuideSize(
    "the array of guiding directions", input.guideDirections.size(), polygons, "polygons");
  requireGuideSize("the array of guiding weights", input.guideWeights.size(), polygons, "polygons");
  requireGuideSize("the orders of guides", input.guideOrders.size(), polygons, "polygons");
  requireGuideSize(
    "the array of target valences", input.targetValences.size(), input.points.size(), "points");
  checkGuides(input);
  checkValences(input);
  checkCurves(input);
}

void collectRequests(const SurfaceInput& input, PreparedSurface& surface, int threads)
{
  surface.polygonGuides = guidesOf(input);
  surface.strokes = input.drawn.strokes;
  surface.strokeFaces.clear();
  surface.curves = input.curves;
  surface.regularElsewhere = input.regularElsewhere;
  surface.sizes = input.drawn.sizes;
  surface.localSizes = !input.drawn.sizes.empty() || !input.sizingOrders.empty();
  surface.regularOnFeatures = input.regularOnFeatures;
  surface.withoutMap = input.withoutMap;
  surface.seams = input.seams;
  surface.straight = input.straight;
  if (input.targetValences.empty())
  {
    return;
  }
  const std::vector<ValenceRequest> requests = cornerRequests(input, surface, threads);
  const bool anyForInside = std::any_of(requests.begin(), requests.end(),
    [](const ValenceRequest& request) { return request.valence < kLeastOnBoundary; });
  const std::vector<std::uint8_t> boundary =
    anyForInside ? boundaryVertices(surface.mesh) : std::vector<std::uint8_t>{};
  std::vector<std::uint8_t> used(input.targetValences.size(), 0);
  for (const ValenceRequest& request : requests)
  {
    const Vector3& place = surface.mesh.position[request.vertex];
    requireFit(request, place, anyForInside && boundary[request.vertex] != 0);
    used[request.point] = 1;
    if (surface.valenceRequests.empty() || surface.valenceRequests.back().vertex != request.vertex)
    {
      surface.valenceRequests.push_back(request);
      continue;
    }
    const ValenceRequest& first = surface.valenceRequests.back();
    if (first.valence != request.valence)
    {
      throw InvalidInput("points " + std::to_string(first.point) + " and " +
        std::to_string(request.point) + " at " + placeText(place) +
        " are one after repair, but ask for valences " + std::to_string(first.valence) + " and " +
        std::to_string(request.valence) + ": give both the same.");
    }
  }
  for (const HeldVertex& held : input.held)
  {
    used[held.point] |= held.sectors.empty() ? 1 : 0;
  }
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    surface.unusedValences += input.targetValences[i] != 0 && used[i] == 0;
  }
}

namespace
{

/// The polygon's guide of each face; null: none.
class GuideOfFace
{
public:
  explicit GuideOfFace(const PreparedSurface& surface) : surface_(surface)
  {
    const std::vector<PolygonGuide>& guides = surface.polygonGuides;
    guideOf_.resize(guides.empty() ? 0 : guides.back().polygon + std::size_t{ 1 }, kInvalidIndex);
    for (std::size_t i = 0; i < guides.size(); ++i)
    {
      guideOf_[guides[i].polygon] = static_cast<Index>(i);
    }
  }

  const PolygonGuide* operator()(Index f) const
  {
    const Index polygon = surface_.sourcePolygon[f];
    return polygon >= guideOf_.size() || guideOf_[polygon] == kInvalidIndex
      ? nullptr
      : &surface_.polygonGuides[guideOf_[polygon]];
  }

private:
  const PreparedSurface& surface_;
  std::vector<Index> guideOf_;
};

} // namespace

void placeStrokes(PreparedSurface& surface, double edgeLength, int threads)
{
  surface.strokeFaces = facesOfStrokes(surface.mesh, surface.strokes, edgeLength, threads);
}

SurfaceGuides surfaceGuides(const PreparedSurface& surface, int threads)
{
  SurfaceGuides result;
  if (surface.polygonGuides.empty() && surface.strokeFaces.empty())
  {
    return result;
  }
  const GuideOfFace guideOf(surface);
  const Mesh& mesh = surface.mesh;
  const auto parts = parallelParts<SurfaceGuides>(mesh.faceCount(), kLightChunk, threads,
    [&](Index begin, Index end, SurfaceGuides& part)
    {
      auto stroke = std::lower_bound(surface.strokeFaces.begin(), surface.strokeFaces.end(), begin,
        [](const StrokeFace& guided, Index face) { return guided.face < face; });
      const auto add = [&](Index f, const Vector3& direction, float weight)
      {
        const Vector3 normal =
          mesh.edgeVector(3 * f).cross(mesh.edgeVector(3 * f + 1)).stableNormalized();
        const Vector3 tangent = direction - normal * normal.dot(direction);
        if (tangent.norm() > kLeastTangent)
        {
          part.faces.push_back({ f, { tangent.normalized(), weight } });
        }
        else
        {
          ++part.dropped;
        }
      };
      for (Index f = begin; f < end; ++f)
      {
        const PolygonGuide* polygon = guideOf(f);
        const bool hasStroke = stroke != surface.strokeFaces.end() && stroke->face == f;
        if (hasStroke && (polygon == nullptr || polygon->order <= stroke->order))
        {
          add(f, stroke->direction, stroke->weight);
        }
        else if (polygon != nullptr)
        {
          add(f, polygon->direction, polygon->weight);
        }
        stroke += hasStroke ? 1 : 0;
      }
    });
  for (const SurfaceGuides& part : parts)
  {
    result.faces.insert(result.faces.end(), part.faces.begin(), part.faces.end());
    result.dropped += part.dropped;
  }
  return result;
}

std::vector<Index> heldIndexVertices(const PreparedSurface& surface)
{
  std::vector<Index> vertices;
  for (const ValenceRequest& request : surface.valenceRequests)
  {
    if (request.valence != kRegularValence && !request.mayDrift)
    {
      vertices.push_back(request.vertex);
    }
  }
  return vertices;
}

std::vector<Index> keptVertices(const PreparedSurface& surface)
{
  std::vector<Index> vertices;
  for (const ValenceRequest& request : surface.valenceRequests)
  {
    if (request.valence != kRegularValence)
    {
      vertices.push_back(request.vertex);
    }
  }
  for (const SectorRequest& request : surface.sectorRequests)
  {
    // Junctions of features stay by themselves.
    constexpr std::size_t kPassing = 2;
    if (request.sectors.size() <= kPassing)
    {
      vertices.push_back(request.vertex);
    }
  }
  append(vertices, seamVertices(surface.mesh, surface.seams));
  append(vertices, straightVertices(surface.mesh, surface.straight));
  sortUnique(vertices);
  return vertices;
}

std::vector<int> levelValences(
  const PreparedSurface& surface, const Mesh& level, const std::vector<Index>& fineVertex)
{
  std::vector<int> valences;
  if (surface.valenceRequests.empty() && !surface.regularElsewhere)
  {
    return valences;
  }
  valences.assign(fineVertex.size(), surface.regularElsewhere ? kRegularValence : 0);
  for (Index h = 0; h < level.halfEdgeCount(); ++h)
  {
    if (level.isConstrained(h))
    {
      valences[level.origin[h]] = valences[level.target(h)] = 0;
    }
  }
  for (std::size_t i = 0; i < fineVertex.size(); ++i)
  {
    if (const ValenceRequest* asked = requestAt(surface.valenceRequests, fineVertex[i]))
    {
      valences[i] = asked->valence;
    }
  }
  return valences;
}

std::vector<std::string> requestNotices(const PreparedSurface& surface, const SurfaceGuides& guides)
{
  std::vector<std::string> notices;
  if (guides.dropped > 0)
  {
    notices.push_back(std::to_string(guides.dropped) +
      " faces have a guiding direction that is normal to them and are left free");
  }
  if (surface.unusedValences > 0)
  {
    notices.push_back(std::to_string(surface.unusedValences) +
      " points ask for a valence but are on no face that is left after repair");
  }
  return notices;
}

} // namespace quadrille
