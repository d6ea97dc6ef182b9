// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What can be asked of places of a surface: directions of the quads' edges (guides), valences of vertices (index
/// constraints) and lines of edges (layout constraints) [Ebke et al. 2016, Section 4], and what runs ask of each other:
/// irregular vertices that stay, and parts of the boundary that fit together or are straight. The functions of each are
/// in the folder Requests.
#pragma once

#include "Base/Types.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

/// Smallest and largest valence that can be asked for.
constexpr int kLeastValence = 2;
constexpr int kMostValence = 8;
constexpr int kRegularValence = 4;
/// On a boundary: a corner with one quad.
constexpr int kLeastOnBoundary = 3;
/// Quarter turns of a sector in which the quads' edges go straight on.
constexpr int kStraightTurns = 2;
/// Sizes are met up to this factor: of the median; of an array of sizes, on average.
constexpr double kMetFactor = 1.25;
/// Quads' edge lengths within which two places are one for all that a user would see.
constexpr double kOnePlace = 0.01;

/// The direction that one family of the quads' edges should have in a face.
struct Guide
{
  Vector3 direction = Vector3::Zero(); ///< unit vector in the plane of the face; zero: free
  float weight = 0;                    ///< in (0, 1]; 0 where free

  bool isFree() const { return !(weight > 0); }
  bool operator==(const Guide& other) const
  {
    return direction == other.direction && weight == other.weight;
  }
};

/// The guide of a polygon of the input, as it was given.
struct PolygonGuide
{
  Index polygon = kInvalidIndex;
  Vector3 direction = Vector3::Zero(); ///< unit vector
  float weight = 1;
  int order = 0; ///< see StrokeRequest
};

/// The guide of a face of a mesh.
struct FaceGuide
{
  Index face = kInvalidIndex;
  Guide guide;

  bool operator==(const FaceGuide& other) const
  {
    return face == other.face && guide == other.guide;
  }
};

/// A vertex is to have this valence. On a boundary it is what the vertex would have if the quads went on beyond, so
/// that 4 is regular everywhere: 3 is a corner with one quad, 5 one with three.
struct ValenceRequest
{
  Index vertex = kInvalidIndex;
  int valence = kRegularValence;
  Index point = kInvalidIndex; ///< of the input
  bool mayDrift = false;       ///< see ValencePlace
};

/// What becomes of a curve.
enum class CurveKind : std::uint8_t
{
  Connection, ///< joins the irregular vertex, or the feature or boundary, nearest to each end
  Cycle       ///< closes on itself, from the last point back to the first
};

/// A curve that a user draws where a line of the quads' edges should run.
struct CurveRequest
{
  CurveKind kind = CurveKind::Connection;
  std::vector<Vector3> points; ///< a polyline on or near the surface; at least 2, of a cycle 3
  /// Of a connection the valences of what it joins, 0 for a feature or boundary; none: it is not known yet, and there
  /// is no line of it.
  std::optional<std::array<int, 2>> ends = {};

  bool isDrawn() const { return kind == CurveKind::Cycle || ends.has_value(); }

  /// Its ends, as a run found them.
  void setEnds(const Vector3& start, const Vector3& end, const std::array<int, 2>& valences)
  {
    points.front() = start;
    points.back() = end;
    ends = valences;
  }
};

/// What became of a curve.
struct CurveOutcome
{
  bool met = false;
  std::string why;                 ///< where it is not met: the reason and what helps
  Vector3 start = Vector3::Zero(); ///< of its course on the surface
  Vector3 end = Vector3::Zero();
  std::optional<std::array<int, 2>>
    ends = {}; ///< of a connection: what it was found to join, see CurveRequest
};

/// A sector at a vertex: from one feature or boundary edge counterclockwise to the next.
struct HeldSector
{
  Vector3 middle = Vector3::Zero(); ///< the direction that halves its angle, of length 1
  int turns = 2;                    ///< quarter turns of the map, >= 1

  bool operator==(const HeldSector& other) const
  {
    return middle == other.middle && turns == other.turns;
  }
};

/// A vertex on features or the boundary that stays, by a point of the input near it.
struct HeldVertex
{
  Index point = kInvalidIndex; ///< a corner of the input's triangle that the vertex lies in
  Vector3 place = Vector3::Zero();
  /// Counterclockwise; at the boundary from its first one on. One or more.
  std::vector<HeldSector> sectors;

  bool operator==(const HeldVertex& other) const
  {
    return point == other.point && place == other.place && sectors == other.sectors;
  }
};

/// The same at a vertex of a surface.
struct SectorRequest
{
  Index vertex = kInvalidIndex;
  std::vector<HeldSector> sectors; ///< see HeldVertex
};

/// Of requests that name a vertex each.
template <typename Request>
void sortByVertex(std::vector<Request>& requests)
{
  std::sort(requests.begin(), requests.end(),
    [](const Request& a, const Request& b) { return a.vertex < b.vertex; });
}

/// Two parts of the boundary that are images of each other, by the places of boundary vertices at their ends. One
/// runs along the boundary from `from` to `to` without another end between them, the other from the image of `to` to
/// that of `from`. from == to: both are closed.
struct SeamRequest
{
  Vector3 from = Vector3::Zero();
  Vector3 to = Vector3::Zero();
  Vector3 imageFrom = Vector3::Zero();
  Vector3 imageTo = Vector3::Zero();
};

/// A part of the boundary that is one straight side of the map, by places of boundary vertices: that between `from` and
/// `to` that passes `via`, or, where from == to, all of the loop there. At its ends, where another part of the boundary
/// begins, the map has a corner of one quarter turn.
struct StraightRequest
{
  Vector3 from = Vector3::Zero();
  Vector3 via = Vector3::Zero();
  Vector3 to = Vector3::Zero();
  /// Unit: where the surface would go on beyond the part; zero where it ends there.
  Vector3 outward = Vector3::Zero();

  bool isClosed() const { return from == to; }
};

/// A polyline on the surface that becomes edges of the quads: straight across faces, from one point to the next.
struct FeatureRequest
{
  std::vector<Vector3> points; ///< 2 or more

  bool operator==(const FeatureRequest& other) const { return points == other.points; }
};

/// A polyline on the surface that edges of the quads follow, in the faces that it crosses and in those that are joined
/// to these by others and have their centre within the radius of it.
struct StrokeRequest
{
  std::vector<Vector3> points; ///< 2 or more
  double weight = 1;           ///< in (0, 1]
  double radius = 0;           ///< >= 0, in units of the points
  /// Where guides overlap the one of the highest order counts, of the same order the later one; of guides of polygons
  /// see SurfaceInput::guideOrders.
  int order = 0;

  bool operator==(const StrokeRequest& other) const
  {
    return points == other.points && weight == other.weight && radius == other.radius &&
      order == other.order;
  }
};

/// What a stroke asks of a face of a surface.
struct StrokeFace
{
  Index face = kInvalidIndex;
  Vector3 direction = Vector3::Zero(); ///< unit
  float weight = 1;
  int order = 0; ///< of the stroke
};

/// A point of the surface is to be a vertex of this valence, see ValenceRequest.
struct ValencePlace
{
  Vector3 place = Vector3::Zero();
  int valence = kRegularValence;
  /// The vertex of the quads may be smoothed away from the place, as vertices are that nobody asked for.
  bool mayDrift = false;

  bool operator==(const ValencePlace& other) const
  {
    return place == other.place && valence == other.valence && mayDrift == other.mayDrift;
  }
};

/// Quads near a point of the surface have another size.
struct SizeRequest
{
  Vector3 place = Vector3::Zero();
  double radius =
    0; ///< >= 0, in units of the points: straight distance within which the size is asked for
  double factor = 1; ///< > 0: the edge length there as a multiple of the target edge length
  int order = 0;     ///< as of strokes; of sizes of points see SurfaceInput::sizingOrders

  bool operator==(const SizeRequest& other) const
  {
    return place == other.place && radius == other.radius && factor == other.factor &&
      order == other.order;
  }
};

/// What is asked for at points and along paths of the surface, whatever its triangles are. All points lie on the
/// surface, up to rounding; those that do not mean the nearest point of it.
struct DrawnRequests
{
  std::vector<FeatureRequest> features;
  std::vector<StrokeRequest> strokes;
  std::vector<ValencePlace> valences;
  std::vector<SizeRequest> sizes;
  std::vector<Vector3> cleared; ///< the feature curves there are no features, see clearFeatures

  bool empty() const
  {
    return features.empty() && strokes.empty() && valences.empty() && sizes.empty() &&
      cleared.empty();
  }
  void append(const DrawnRequests& other)
  {
    features.insert(features.end(), other.features.begin(), other.features.end());
    strokes.insert(strokes.end(), other.strokes.begin(), other.strokes.end());
    valences.insert(valences.end(), other.valences.begin(), other.valences.end());
    sizes.insert(sizes.end(), other.sizes.begin(), other.sizes.end());
    cleared.insert(cleared.end(), other.cleared.begin(), other.cleared.end());
  }
  /// Calls place(Vector3&) for each point and length(double&) for each radius.
  template <class PlaceVisitor, class LengthVisitor>
  void visit(PlaceVisitor place, LengthVisitor length)
  {
    for (FeatureRequest& feature : features)
    {
      std::for_each(feature.points.begin(), feature.points.end(), place);
    }
    for (StrokeRequest& stroke : strokes)
    {
      std::for_each(stroke.points.begin(), stroke.points.end(), place);
      length(stroke.radius);
    }
    for (ValencePlace& asked : valences)
    {
      place(asked.place);
    }
    for (SizeRequest& size : sizes)
    {
      place(size.place);
      length(size.radius);
    }
    std::for_each(cleared.begin(), cleared.end(), place);
  }
};

/// Calls place(Vector3&) for each place of the curves, seams and straight parts that are asked for, and
/// direction(Vector3&) for each direction.
template <typename Requests, typename PlaceVisitor, typename DirectionVisitor>
void visitPaths(Requests& requests, PlaceVisitor place, DirectionVisitor direction)
{
  for (CurveRequest& curve : requests.curves)
  {
    std::for_each(curve.points.begin(), curve.points.end(), place);
  }
  for (SeamRequest& seam : requests.seams)
  {
    for (Vector3* p : { &seam.from, &seam.to, &seam.imageFrom, &seam.imageTo })
    {
      place(*p);
    }
  }
  for (StraightRequest& part : requests.straight)
  {
    for (Vector3* p : { &part.from, &part.via, &part.to })
    {
      place(*p);
    }
    direction(part.outward);
  }
}

/// What a prepared surface was asked for. The finest level does not depend on it, so it is not part of its hash.
struct SurfaceRequests
{
  std::vector<PolygonGuide> polygonGuides;     ///< ascending by polygon; see surfaceGuides
  std::vector<ValenceRequest> valenceRequests; ///< ascending by vertex, one a vertex
  std::size_t unusedValences = 0;              ///< requests of points that no face uses
  std::vector<StrokeRequest> strokes;          ///< as they were given, in the frame
  std::vector<StrokeFace> strokeFaces;         ///< ascending by face; see placeStrokes
  std::vector<CurveRequest> curves;            ///< as they were given, in the frame
  bool regularElsewhere = false;               ///< as it was given
  bool localSizes = false; ///< sizes are asked for at places or in regions, see CrossFieldOptions
  std::vector<SizeRequest> sizes;            ///< as they were given, in the frame
  std::vector<SectorRequest> sectorRequests; ///< ascending by vertex
  bool regularOnFeatures = false;            ///< as it was given
  std::vector<Vector3> withoutMap;           ///< as they were given, in the frame
  std::vector<SeamRequest> seams;            ///< as they were given, in the frame
  std::vector<StraightRequest> straight;     ///< as they were given, in the frame
};

} // namespace quadrille
