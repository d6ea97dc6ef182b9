// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/FaceDivision.h"

#include "Base/DisjointSets.h"
#include "Base/Lists.h"
#include "Base/PlaceText.h"
#include "Features/FeatureFilter.h"
#include "Filling/FaceCurves.h"
#include "Filling/FilledFaces.h"
#include "Mesh/ContentHash.h"
#include "Mesh/CutOpen.h"
#include "Mesh/NearestTriangle.h"
#include "Mesh/Sizing.h"
#include "Mesh/SurfaceParts.h"
#include "Mesh/Topology.h"
#include "Pipeline/PlannedSurface.h"
#include "Pipeline/RequestsAtCut.h"
#include "Pipeline/Strategies.h"
#include "Quads/QuadMoves.h"
#include "Quads/QuadTopology.h"
#include "Quads/StripInsertion.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iterator>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <sstream>
#include <utility>

namespace quadrille
{
namespace
{

/// Quads get so many strips at most.
constexpr std::size_t kMostStrips = 100;

/// Whether there is no map for the sake of what was asked for, as irregular vertices with a sum that no surface has: no
/// face is at fault.
bool contradictsItself(const MapAttempt& map)
{
  return map.status.code == StatusCode::Infeasible && map.failedAt.empty() &&
    map.failedFaces.empty();
}

/// No attempt has quads, and neither their number nor what was asked for is at fault.
bool hasFailedForMap(const History& history)
{
  return !history.hasResult() && !isTooLarge(history.last()) &&
    !contradictsItself(*history.last().map);
}

/// No part of its boundary has to fit others, which quads without a map do not care for.
bool mayBeFilled(const PreparedSurface& surface, const RemeshOptions& options)
{
  const bool hasToFit = !surface.seams.empty() || !surface.straight.empty();
  return !hasToFit && !options.preview && options.method == MapMethod::ScaleAware;
}

std::vector<Index> faceLabels(const Mesh& mesh)
{
  Mesh opened = mesh;
  cutOpenAtFeatures(opened);
  Index count = 0;
  return faceComponents(opened, count);
}

/// Of the two faces at an edge the one with less area.
std::vector<std::uint8_t> failedLabels(
  const Mesh& mesh, const std::vector<Index>& labels, const FailedFaces& failed)
{
  const std::size_t count = std::size_t{ *std::max_element(labels.begin(), labels.end()) } + 1;
  std::vector<double> area(count, 0);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    area[labels[f]] += sizedArea(mesh, f);
  }
  std::vector<std::uint8_t> isFailed(count, 0);
  for (const Index f : failed.faces)
  {
    isFailed[labels[f]] = 1;
  }
  for (const auto& [one, other] : failed.either)
  {
    const Index a = labels[one], b = labels[other];
    if (isFailed[a] == 0 && isFailed[b] == 0)
    {
      isFailed[area[a] < area[b] ? a : b] = 1;
    }
  }
  return isFailed;
}

/// The boundary of the faces that are cut out where it is that of the rest, by points of the latter.
class SharedBoundary
{
public:
  SharedBoundary(const CutFaces& cut, const Mesh& rest)
    : cut_(cut), rest_(rest), behind_(rest.vertexCount(), kInvalidIndex), before_(behind_)
  {
    TriangleList list;
    list.points = cut.faces.mesh.position.vector();
    for (Index h = 0; h < cut.faces.mesh.halfEdgeCount(); ++h)
    {
      if (cut.isShared[h] != 0)
      {
        const Index a = cut.faces.mesh.origin[h], b = cut.faces.mesh.target(h);
        inwards_.push_back(inwardOf(list.points[b], list.points[a], cut.beyond[halfEdges_.size()]));
        list.corners.push_back({ a, b, a });
        halfEdges_.push_back(h);
      }
    }
    segments_.emplace(std::move(list));
    for (Index h = 0; h < rest.halfEdgeCount(); ++h)
    {
      if (rest.isBoundary(h))
      {
        before_[rest.origin[h]] = h;
        behind_[rest.target(h)] = h;
      }
    }
  }

  /// Where a point of the rest's quads lies: none off the boundary, one inside of an edge. At a vertex one on the edge
  /// before it along the boundary of the rest, and one on the edge behind it: these are not at the same corner of the
  /// faces where the rest meets several of them in a vertex.
  std::vector<CurvePoint> at(const QuadMesh& quads, Index p, double within) const
  {
    std::vector<CurvePoint> places;
    const Vector3& place = quads.points[p];
    if (const std::optional<Index> corner = meshCorner(quads, p))
    {
      const Index v = rest_.origin[*corner];
      if (before_[v] != kInvalidIndex)
      {
        addBeside(before_[v], place, within, places);
        addBeside(behind_[v], place, within, places);
      }
      return places;
    }
    const auto onEdge = locateOnCurve(rest_, { quads.sourceFace[p], quads.sourceWeights[p] });
    if (onEdge && rest_.isBoundary(onEdge->h))
    {
      addBeside(onEdge->h, place, within, places);
    }
    return places;
  }

private:
  /// Across an edge into the face that has a third corner there.
  static Vector3 inwardOf(const Vector3& a, const Vector3& b, const Vector3& third)
  {
    const Vector3 along = (b - a).normalized();
    const Vector3 way = third - a;
    return (way - way.dot(along) * along).normalized();
  }

  /// h: of the rest, with the place on it. The faces have no shorter edges there, and theirs lead the other way. Of
  /// several that lie on each other it is the one beside which the same face of the rest lies.
  void addBeside(
    Index h, const Vector3& place, double within, std::vector<CurvePoint>& places) const
  {
    const Vector3& a = rest_.position[rest_.origin[h]];
    const Vector3& b = rest_.position[rest_.target(h)];
    const Vector3 inward = inwardOf(a, b, rest_.position[rest_.origin[Mesh::previous(h)]]);
    std::optional<Index> best;
    for (const Index i : segments_->within((a + b) / 2, within))
    {
      const Mesh& faces = cut_.faces.mesh;
      const bool isBetter = !best || inwards_[i].dot(inward) > inwards_[*best].dot(inward);
      best = faces.edgeVector(halfEdges_[i]).dot(b - a) < 0 && isBetter ? i : best;
    }
    if (best)
    {
      const double t = segments_->on(*best, place).weights[1];
      places.push_back({ halfEdges_[*best], t < kRounding ? 0 : 1 - t < kRounding ? 1 : t });
    }
  }

  const CutFaces& cut_;
  const Mesh& rest_;
  std::vector<Index> behind_, before_; ///< half-edges on the boundary, per vertex
  std::vector<Index> halfEdges_;       ///< of the faces, that are shared
  std::vector<Vector3> inwards_;       ///< of these, into the rest
  std::optional<NearestTriangle> segments_;
};

/// Copies of points that a strip has left at one place go apart, by a third of the way to their neighbours across.
void spreadStrip(const Mesh& mesh, QuadMesh& quads, const InsertedStrip& strip)
{
  QuadMoves moves(mesh, quads, {});
  for (const auto& [p, way] : waysApart(strip, quads))
  {
    if (const std::optional<SurfacePoint> there = moves.target(p, way))
    {
      moves.move(p, *there, positionOf(mesh, *there));
    }
  }
}

/// A face that is closed, without a curve on it, is filled from a slit on: its longest edge. Returns one side of each.
std::vector<Index> addSlits(Mesh& mesh)
{
  const std::vector<Index> labels = faceLabels(mesh);
  std::map<Index, Index> longest; // half-edge, by label; none where there are curves
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    Index& best = longest.emplace(labels[Mesh::face(h)], h).first->second;
    if (mesh.isBoundary(h) || mesh.isFeature(h))
    {
      best = kInvalidIndex;
    }
    else if (best != kInvalidIndex && mesh.edgeVector(h).norm() > mesh.edgeVector(best).norm())
    {
      best = h;
    }
  }
  std::vector<Index> slits;
  for (const auto& [label, h] : longest)
  {
    if (h != kInvalidIndex)
    {
      mesh.flags.edit()[h] |= kFeatureEdge;
      mesh.flags.edit()[mesh.twin[h]] |= kFeatureEdge;
      slits.push_back(h);
    }
  }
  return slits;
}

/// Fills faces beside quads.
class FillingBeside
{
public:
  FillingBeside(const CutFaces& cut, const Mesh* restMesh, QuadMesh* restQuads, double edgeLength)
    : cut_(cut), mesh_(cut.faces.mesh), slits_(addSlits(mesh_)), restMesh_(restMesh),
      restQuads_(restQuads), edgeLength_(edgeLength), curves_(mesh_, cut.isShared, edgeLength)
  {
    if (restMesh_ != nullptr)
    {
      boundary_.emplace(cut, *restMesh_);
    }
    const Mesh& mesh = cut.faces.mesh;
    beforeOnBoundary_.assign(mesh.halfEdgeCount(), kInvalidIndex);
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      if (mesh.isBoundary(h))
      {
        beforeOnBoundary_[nextOnBoundary(mesh, h)] = h;
      }
    }
  }

  FilledPart make(const QuadsOfFace& quadsOf)
  {
    FilledPart made;
    std::vector<Index> odd;
    for (std::size_t strips = 0; strips <= kMostStrips; ++strips)
    {
      findShared();
      curves_.setGiven(places_);
      odd = curves_.chooseNumbers();
      if (odd.empty() || !insertStrip(odd))
      {
        break;
      }
    }
    if (!odd.empty())
    {
      made.failedAt = alone_;
      for (const Index face : odd)
      {
        made.failedAt.push_back(placeOf(face));
      }
      return made;
    }
    FilledFaces filled = fillFaces(mesh_, curves_, edgeLength_, quadsOf);
    made.quads = std::move(filled.quads);
    eraseIf(made.quads.lines,
      [&](const QuadLine& line)
      {
        return contains(slits_, line.halfEdge) ||
          (!mesh_.isBoundary(line.halfEdge) && contains(slits_, mesh_.twin[line.halfEdge]));
      });
    made.failedAt = std::move(filled.failedAt);
    made.points = std::move(points_);
    made.same = std::move(same_);
    return made;
  }

private:
  Vector3 placeOf(Index face) const
  {
    const auto& faceOf = curves_.faceOf();
    const auto found = std::find(faceOf.begin(), faceOf.end(), face);
    return cut_.faces.mesh.middleOfFace(static_cast<Index>(found - faceOf.begin()));
  }

  /// The points of the rest on the common boundary. Where that ends, and goes on as a boundary of the rest alone, the
  /// rest need not have a point: the nearer one of those on both sides of the end is led there.
  void findShared()
  {
    points_.clear();
    places_.clear();
    same_.clear();
    alone_.clear();
    if (restQuads_ == nullptr)
    {
      return;
    }
    const QuadTopology topology = analyzeQuads(restQuads_->quads, restQuads_->points.size());
    std::map<Index, std::array<Index, 2>> neighbours; // behind and before
    for (Index h = 0; h < topology.twin.size(); ++h)
    {
      if (topology.twin[h] == kInvalidIndex)
      {
        const Index a = restQuads_->origin(h), b = restQuads_->target(h);
        neighbours[a][1] = b;
        neighbours[b][0] = a;
      }
    }
    const std::vector<Vector3>& points = restQuads_->points;
    std::map<Index, std::vector<CurvePoint>> onShared;
    for (const auto& [p, beside] : neighbours)
    {
      const std::vector<CurvePoint> places =
        boundary_->at(*restQuads_, p, kRoundingOfSingle * edgeLength_);
      if (!places.empty())
      {
        onShared.emplace(p, places);
      }
    }
    std::map<Index, std::vector<CurvePoint>> atEnds;
    for (const auto& [p, places] : onShared)
    {
      for (const std::size_t side : { 0, 1 })
      {
        const Index beyond = neighbours[p][side];
        if (onShared.count(beyond) != 0)
        {
          continue;
        }
        const CurvePoint end =
          endOfShared((side == 0 ? places.back() : places.front()).h, side == 0);
        const Vector3 there = positionOf(cut_.faces.mesh, end.onSurface());
        if ((points[beyond] - there).norm() < (points[p] - there).norm())
        {
          atEnds[beyond] = { end };
        }
      }
    }
    onShared.insert(atEnds.begin(), atEnds.end());
    placeShared(onShared);
  }

  /// A place at the end of an edge as one at the beginning of the next.
  CurvePoint fromBegin(const CurvePoint& place) const
  {
    return place.t < 1 ? place : CurvePoint{ nextOnBoundary(cut_.faces.mesh, place.h), 0 };
  }

  /// Points at one corner of the faces are one point, though the rest has several where it meets itself there. Where it
  /// has one on one side of such a corner only, numbers may be odd for it.
  void placeShared(const std::map<Index, std::vector<CurvePoint>>& onShared)
  {
    DisjointSets same(restQuads_->points.size(), 1);
    std::map<Index, Index> atCorner;    // by the half-edge there
    std::set<Index> isBefore, isBehind; // corners with a point on the edge there
    for (const auto& [p, places] : onShared)
    {
      for (const CurvePoint& place : places)
      {
        const CurvePoint there = fromBegin(place);
        if (there.t <= 0)
        {
          (place.t < 1 ? isBehind : isBefore).insert(there.h);
          same.join(p, atCorner.emplace(there.h, p).first->second);
        }
      }
    }
    for (const auto& [h, p] : atCorner)
    {
      const bool isInside = cut_.isShared[h] != 0 && cut_.isShared[beforeOnBoundary_[h]] != 0;
      if (isInside && isBefore.count(h) != isBehind.count(h))
      {
        alone_.push_back(restQuads_->points[p]);
      }
    }
    std::set<Index> done;
    for (const auto& [p, places] : onShared)
    {
      const Index one = same.find(p);
      if (one != p)
      {
        same_.push_back({ p, one });
      }
      for (const CurvePoint& place : places)
      {
        const CurvePoint there = fromBegin(place);
        if (there.t > 0 || done.insert(there.h).second)
        {
          points_.push_back(one);
          places_.push_back(there);
        }
      }
    }
  }

  /// Where the common boundary goes on alone: the end of the shared part that a half-edge lies on.
  CurvePoint endOfShared(Index h, bool forwards) const
  {
    const auto beside = [&](Index at)
    { return forwards ? nextOnBoundary(cut_.faces.mesh, at) : beforeOnBoundary_[at]; };
    const Index first = h;
    for (Index next = beside(h); cut_.isShared[next] != 0 && next != first; next = beside(h))
    {
      h = next;
    }
    return { h, forwards ? 1.0 : 0.0 };
  }

  /// From the first of the odd groups to another one, or to a boundary that is free. False where no path leads there.
  bool insertStrip(const std::vector<Index>& odd)
  {
    if (restQuads_ == nullptr)
    {
      return false;
    }
    const std::vector<Index>& groups = curves_.groupOf();
    std::map<Index, Index> groupOfPoint;
    for (std::size_t i = 0; i < points_.size(); ++i)
    {
      const CurvePoint& place = curves_.given()[i];
      if (place.t > 0) // what ends at a vertex stays there
      {
        groupOfPoint[points_[i]] = groups[curves_.faceOf()[Mesh::face(place.h)]];
      }
    }
    const Index from = groups[odd.front()];
    std::vector<std::pair<Index, double>> starts;
    for (const auto& [p, group] : groupOfPoint)
    {
      if (group == from)
      {
        starts.emplace_back(p, 0);
      }
    }
    const std::set<Index> onShared(points_.begin(), points_.end());
    constexpr double throughEven = 1000;
    constexpr double toBoundary = 100;
    const auto endCost = [&](Index, Index end) -> std::optional<double>
    {
      const auto found = groupOfPoint.find(end);
      if (found == groupOfPoint.end())
      {
        return onShared.count(end) != 0 ? std::nullopt : std::optional<double>(toBoundary);
      }
      if (found->second == from)
      {
        return std::nullopt;
      }
      const bool isOdd =
        std::any_of(odd.begin(), odd.end(), [&](Index f) { return groups[f] == found->second; });
      return isOdd ? 0 : throughEven;
    };
    const std::optional<QuadPath> path = findStripPath(*restQuads_, starts, endCost);
    if (!path)
    {
      return false;
    }
    const InsertedStrip strip = quadrille::insertStrip(*restQuads_, *path);
    spreadStrip(*restMesh_, *restQuads_, strip);
    return true;
  }

  const CutFaces& cut_;
  Mesh mesh_; ///< of the faces that are cut, with slits
  std::vector<Index> slits_;
  const Mesh* restMesh_;
  QuadMesh* restQuads_;
  double edgeLength_;
  FaceCurves curves_;
  std::optional<SharedBoundary> boundary_;
  std::vector<Index> beforeOnBoundary_; ///< #H, as nextOnBoundary the other way
  std::vector<Index> points_;           ///< of the rest, on the common boundary
  std::vector<CurvePoint> places_;
  std::vector<std::array<Index, 2>> same_; ///< see FilledPart
  std::vector<Vector3> alone_;             ///< see placeShared
};

} // namespace

bool mayCutFaces(const PreparedSurface& surface, const RemeshOptions& options)
{
  if (!mayBeFilled(surface, options))
  {
    return false;
  }
  const std::vector<Index> labels = faceLabels(surface.mesh);
  return std::any_of(labels.begin(), labels.end(), [](Index label) { return label > 0; });
}

bool keepsFeatures(const PreparedSurface& surface)
{
  const auto& flags = surface.mesh.flags;
  const bool isAnyAsked = std::any_of(
    flags.begin(), flags.end(), [](std::uint8_t edge) { return (edge & kRequestedFeature) != 0; });
  return surface.facets.isDesigned || (isAnyAsked && !hasDetectedFeature(surface.mesh));
}

bool isCutAtFaces(
  const PreparedSurface& surface, const RemeshOptions& options, const History& history)
{
  return hasFailedForMap(history) && mayCutFaces(surface, options);
}

bool isFilled(const PreparedSurface& surface, const RemeshOptions& options, const History& history)
{
  return isCutAtFaces(surface, options, history) ||
    (hasFailedForMap(history) && surface.facets.isDesigned && mayBeFilled(surface, options));
}

FailedFaces facesAt(const std::vector<Vector3>& places, const Mesh& mesh)
{
  FailedFaces faces;
  if (places.empty())
  {
    return faces;
  }
  const NearestTriangle triangles(trianglesOf(mesh));
  for (const Vector3& place : places)
  {
    faces.faces.push_back(triangles.at(place)->triangle);
  }
  sortUnique(faces.faces);
  return faces;
}

std::vector<std::uint8_t> isInFaces(const Mesh& mesh, const FailedFaces& faces)
{
  const std::vector<Index> labels = faceLabels(mesh);
  const std::vector<std::uint8_t> isOne = failedLabels(mesh, labels, faces);
  std::vector<std::uint8_t> isIn(mesh.faceCount());
  std::transform(
    labels.begin(), labels.end(), isIn.begin(), [&](Index label) { return isOne[label]; });
  return isIn;
}

bool addFacesAt(const std::vector<Vector3>& places, const SizedSurface& whole, FailedFaces& failed)
{
  const Mesh& mesh = whole.surface->mesh;
  const std::vector<Index> labels = faceLabels(mesh);
  std::vector<std::uint8_t> isFailed = failedLabels(mesh, labels, failed);
  const std::size_t before = failed.faces.size();
  const NearestTriangle triangles(trianglesOf(mesh));
  for (const Vector3& place : places)
  {
    for (const Index f : triangles.within(place, kRoundingOfSingle * whole.edgeLength))
    {
      if (isFailed[labels[f]] == 0)
      {
        isFailed[labels[f]] = 1;
        failed.faces.push_back(f);
      }
    }
  }
  const bool isMore = failed.faces.size() > before;
  std::sort(failed.faces.begin(), failed.faces.end());
  return isMore;
}

std::vector<Vector3> gapsIn(const QuadMesh& quads)
{
  const QuadTopology topology = analyzeQuads(quads.quads, quads.points.size());
  std::set<std::pair<Index, Index>> boundary;
  for (const QuadLine& line : quads.lines)
  {
    if (line.boundary)
    {
      boundary.insert(std::minmax(line.a, line.b));
    }
  }
  std::vector<Index> points = topology.defectPoints;
  for (Index h = 0; h < topology.twin.size(); ++h)
  {
    const Index a = quads.origin(h), b = quads.target(h);
    if (topology.twin[h] == kInvalidIndex && boundary.count(std::minmax(a, b)) == 0)
    {
      points.push_back(a);
    }
  }
  sortUnique(points);
  std::vector<Vector3> places;
  std::transform(points.begin(), points.end(), std::back_inserter(places),
    [&](Index p) { return quads.points[p]; });
  return places;
}

std::string filledText(const CutFaces& cut, std::size_t quads, std::size_t all)
{
  const double share = cut.share * static_cast<double>(quads) / static_cast<double>(all);
  std::ostringstream text;
  const bool isAll = cut.count == 1 && !cut.rest;
  text << "ask for more than " << all << " quads: "
       << (isAll               ? "the connected component"
              : cut.count == 1 ? "1 face between sharp edges"
                               : std::to_string(cut.count) + " faces between sharp edges")
       << ", with " << std::setprecision(3) << 100 * share << " % of the area, near "
       << placeText(cut.faces.mesh.middleOfFace(0)) << (cut.count == 1 ? ", has" : ", have")
       << " no map" << (isAll ? "" : " beside the others")
       << " with quads of this size; the edges are kept, and the quads inside have more irregular "
          "points";
  // Lines are edges of what fills the faces.
  const std::vector<ValenceRequest> unmet = elementsWhere(cut.faces.valenceRequests,
    [](const ValenceRequest& request)
    { return !request.mayDrift && request.valence != kRegularValence; });
  if (!unmet.empty())
  {
    text << "; " << unmet.size() << (unmet.size() == 1 ? " valence" : " valences")
         << " there, near " << placeText(cut.faces.mesh.position[unmet.front().vertex])
         << ", cannot be met";
  }
  return text.str();
}

CutFaces cutFaces(const SizedSurface& whole, const FailedFaces& failed, int threads)
{
  const std::vector<Index> labels = faceLabels(whole.surface->mesh);
  const std::vector<std::uint8_t> isFailed = failedLabels(whole.surface->mesh, labels, failed);
  CutFaces cut;
  cut.count =
    static_cast<std::size_t>(std::count(isFailed.begin(), isFailed.end(), std::uint8_t{ 1 }));
  PreparedSurface opened = *whole.surface;
  opened.withoutMap.clear();
  const Mesh& mesh = whole.surface->mesh;
  std::vector<std::uint8_t> isOutFace(mesh.faceCount(), 0);
  const auto isOut = [&](Index h) { return isOutFace[Mesh::face(h)] != 0; };
  std::vector<std::uint8_t> isCut(mesh.halfEdgeCount(), 0);
  std::vector<Index> partOfFace(mesh.faceCount(), 0);
  double all = 0, out = 0;
  std::map<Index, std::pair<double, Index>> largest; // by label
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    isOutFace[f] = isFailed[labels[f]];
    partOfFace[f] = isOutFace[f] != 0 ? 0 : 1;
    const double area = sizedArea(mesh, f);
    all += area;
    if (isOutFace[f] != 0)
    {
      out += area;
      std::pair<double, Index>& known = largest[labels[f]];
      known = known.first <= area ? std::make_pair(area, f) : known;
    }
  }
  for (const auto& [label, triangle] : largest)
  {
    cut.inside.push_back(mesh.middleOfFace(triangle.second));
  }
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (!mesh.isBoundary(h) && isOut(h) != isOut(mesh.twin[h]))
    {
      isCut[h] = 1;
      opened.mesh.flags.edit()[h] = 0;
    }
  }
  moveRequestsToSides(isOutFace, cutOpen(opened.mesh, isCut), opened);
  cut.share = out / all;
  const bool hasRest = cut.count < isFailed.size();
  std::vector<ComponentPart> parts = splitSurface(opened, partOfFace, hasRest ? 2 : 1, threads);
  if (hasRest)
  {
    divideCurves(*whole.surface, isOutFace, kRoundingOfSingle * whole.edgeLength, parts);
  }
  cut.faces = std::move(parts[0].surface);
  cut.curves = std::move(parts[0].curves);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (isOut(h))
    {
      cut.isShared.push_back(isCut[h]);
      if (isCut[h] != 0)
      {
        cut.beyond.push_back(mesh.middleOfFace(Mesh::face(mesh.twin[h])));
      }
    }
  }
  const auto countComponents = [&](PreparedSurface& surface)
  { faceComponents(surface.mesh, surface.components, threads); };
  countComponents(cut.faces);
  if (hasRest)
  {
    countComponents(parts[1].surface);
    cut.rest = partOf(whole, std::move(parts[1]), 1 - cut.share);
    cut.rest->sized.hasBeside = true;
  }
  return cut;
}

SizedSurface faceAlone(const Mesh& face, const SizedSurface& whole, int threads)
{
  PreparedSurface surface;
  surface.mesh = face;
  std::vector<Index> polygons(face.faceCount());
  std::iota(polygons.begin(), polygons.end(), Index{ 0 });
  surface.sourcePolygon = std::move(polygons);
  surface.sourcePoints = std::vector<std::array<Index, 3>>(face.faceCount());
  surface.facets = whole.surface->facets;
  surface.boundingBoxDiagonal = whole.surface->boundingBoxDiagonal;
  surface.components = 1;
  surface.hash = contentHash(face, threads);
  SizedSurface sized;
  sized.edgeLength = whole.edgeLength;
  sized.quadsOfWhole = whole.quadsOfAll();
  sized.targetQuads = predictedQuads(areaOverSizes(surface), whole.edgeLength);
  sized.isTriedOnce = true;
  sized.hasBeside = true;
  sized.key = KeyMaker(whole.key).add(surface.hash).key();
  sized.surface = std::make_shared<const PreparedSurface>(std::move(surface));
  return sized;
}

FilledPart fillCutFaces(const CutFaces& cut, const Mesh* restMesh, QuadMesh* restQuads,
  double edgeLength, const QuadsOfFace& quadsOf)
{
  return FillingBeside(cut, restMesh, restQuads, edgeLength).make(quadsOf);
}

} // namespace quadrille
