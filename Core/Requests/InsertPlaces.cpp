// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/InsertPlaces.h"

#include "Base/Parallel.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Mesh/Distance.h"
#include "Mesh/Sizing.h"
#include "Mesh/SurfaceEdit.h"
#include "Requests/MeshPaths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <string>
#include <unordered_map>
#include <utility>

namespace quadrille
{
namespace
{

/// A path takes a vertex in place of a point of a shorter edge than this, in s: it is straight to a tenth of s.
constexpr double kFineForPaths = 0.2;

class Insertion
{
public:
  Insertion(PreparedSurface& surface, const InsertionOptions& options)
    : surface_(surface), mesh_(surface.mesh), s_(options.edgeLength), threads_(options.threads)
  {
  }

  /// A vertex for each point, in their order.
  std::vector<Index> vertices(const std::vector<Vector3>& points)
  {
    const std::vector<Index> near = halfEdgesNear(points);
    std::vector<Index> result;
    for (const MeshPlace& place : placesOnMesh(mesh_, points, threads_))
    {
      const Index h = near[result.size()];
      result.push_back(h == kInvalidIndex ? vertexAt(place) : take(h));
    }
    return result;
  }

  /// Edges from one vertex to another, as a chain of vertices; empty where there is no way.
  std::vector<Index> connect(Index from, Index to)
  {
    const auto path = pathOnMesh(mesh_, placeOf(from), placeOf(to));
    if (!path)
    {
      return {};
    }
    const std::vector<EdgeCrossing>& crossings = path->crossings;
    std::vector<Index> chain(crossings.size() + 2);
    chain.front() = from;
    chain.back() = to;
    // Backwards: a split gives the edges of the faces beside it other names, and those before it are left by half-edges
    // of faces that come earlier.
    for (std::size_t i = crossings.size(); i-- > 0;)
    {
      chain[i + 1] = vertexOn(crossings[i]);
    }
    straighten(chain);
    return chain;
  }

  /// The edges of a chain become features; those that chains after it have crossed are cut in parts.
  void mark(const std::vector<Index>& chain)
  {
    for (std::size_t i = 0; i + 1 < chain.size(); ++i)
    {
      if (!markEdge(chain[i], chain[i + 1]))
      {
        const std::vector<Index> parts = connect(chain[i], chain[i + 1]);
        for (std::size_t k = 0; k + 1 < parts.size(); ++k)
        {
          markEdge(parts[k], parts[k + 1]);
        }
      }
    }
  }

  /// Takes off the end of a chain what lies beyond a feature or boundary, and all of it within so far from where the
  /// chain passes that.
  void cutBeyondCurve(std::vector<Index>& chain, double within)
  {
    std::size_t last = chain.size(); // of the chain
    bool leaves = false;
    for (std::size_t i = chain.size(); i-- > 1;)
    {
      const auto isNear = [&](Index v)
      { return (mesh_.position[v] - mesh_.position[chain[i]]).norm() <= within; };
      if (!std::all_of(chain.begin() + static_cast<std::ptrdiff_t>(i), chain.end(), isNear))
      {
        break;
      }
      const bool isOn = isOnConstraint(halfEdgeFrom(chain[i]));
      last = isOn && leaves ? i : last;
      leaves = leaves || !isOn;
    }
    chain.resize(std::min(last + 1, chain.size()));
  }

  /// Adds the way to the nearest feature or boundary to a chain that ends so near to it.
  void leadToCurve(std::vector<Index>& chain, double within)
  {
    const Index end = chain.back();
    const std::optional<Vector3> place = isOnConstraint(halfEdgeFrom(end))
      ? std::nullopt
      : nearestOnCurves(mesh_, mesh_.position[end], within);
    const std::vector<Index> way =
      place ? connect(end, vertices({ *place }).front()) : std::vector<Index>{};
    double length = 0;
    for (std::size_t i = 0; i + 1 < way.size(); ++i)
    {
      length += (mesh_.position[way[i + 1]] - mesh_.position[way[i]]).norm();
    }
    if (way.size() > 1 && length <= within) // else it is on the other side of a thin wall
    {
      chain.insert(chain.end(), way.begin() + 1, way.end());
    }
  }

  /// Of the pieces of a line, see insertFeatures.
  void endOnCurves(std::vector<std::vector<Index>>& chains, const std::array<double, 2>& toCurves)
  {
    const auto finish = [this](std::vector<Index>& chain, double within)
    {
      if (within > 0 && chain.size() > 1)
      {
        cutBeyondCurve(chain, within);
        leadToCurve(chain, within);
      }
    };
    finish(chains.back(), toCurves[1]);
    std::reverse(chains.front().begin(), chains.front().end());
    finish(chains.front(), toCurves[0]);
    std::reverse(chains.front().begin(), chains.front().end());
  }

  bool splitConstraint() const { return splitConstraint_; }

  /// Splits edges near places until sizes that are linear on triangles pass to those around as they are to.
  void refineAround(const std::vector<SizeRequest>& sizes)
  {
    std::vector<Index> open;
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      pollNowAndThen(h);
      if (isTooLong(h, sizes))
      {
        open.push_back(h);
      }
    }
    while (!open.empty())
    {
      const Index h = open.back();
      open.pop_back();
      if (!isTooLong(h, sizes))
      {
        continue;
      }
      const Index longest = endOfLongest(h);
      const Index first = mesh_.faceCount();
      const Index twin = mesh_.twin[longest];
      split(longest, 0.5);
      for (Index f = first; f < mesh_.faceCount(); ++f)
      {
        open.insert(open.end(), { 3 * f, 3 * f + 1, 3 * f + 2 });
      }
      for (const Index side : { longest, twin })
      {
        if (side != kInvalidIndex)
        {
          const Index f = Mesh::face(side);
          open.insert(open.end(), { 3 * f, 3 * f + 1, 3 * f + 2 });
        }
      }
      open.push_back(h);
    }
  }

  bool isOnBoundary(Index v)
  {
    bool on = false;
    forEachInFan(mesh_, halfEdgeFrom(v),
      [&](Index h) { on = on || mesh_.isBoundary(h) || mesh_.isBoundary(Mesh::previous(h)); });
    return on;
  }

private:
  bool isTooLong(Index h, const std::vector<SizeRequest>& sizes) const
  {
    const Vector3& a = mesh_.position[mesh_.origin[h]];
    const Vector3& b = mesh_.position[mesh_.target(h)];
    return (b - a).norm() > s_ &&
      std::any_of(sizes.begin(), sizes.end(),
        [&](const SizeRequest& size)
        {
          const double reach = std::abs(size.factor - 1) / kSizeGrowth * s_;
          return distanceToSegment(size.place, a, b) < size.radius + reach;
        });
  }

  /// The end of the way from an edge to the longest one of the faces beside it, and so on, as in longest-edge bisection
  /// [Rivara 1984]: to split it keeps angles large.
  Index endOfLongest(Index h) const
  {
    for (Index next = longestBeside(h); next != h; next = longestBeside(h))
    {
      h = next;
    }
    return h;
  }

  /// Of the faces beside an edge.
  Index longestBeside(Index h) const
  {
    Index longest = h;
    double most = mesh_.edgeVector(h).squaredNorm();
    for (const Index side : { h, Index{ mesh_.twin[h] } })
    {
      for (Index k = 3 * Mesh::face(side); side != kInvalidIndex && k < 3 * Mesh::face(side) + 3;
           ++k)
      {
        const double squared = mesh_.edgeVector(k).squaredNorm();
        if (squared > most * (1 + kRounding))
        {
          most = squared;
          longest = k;
        }
      }
    }
    return longest;
  }

  /// For each point a half-edge that leaves the vertex which takes it; kInvalidIndex: none does. Where parts of the
  /// surface touch, the vertex may lie on one and the nearest face on another.
  std::vector<Index> halfEdgesNear(const std::vector<Vector3>& points) const
  {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
      [&](std::size_t a, std::size_t b) { return points[a].x() < points[b].x(); });
    const double reach = kOnePlace * s_;
    const auto firstInReach = [&](const Vector3& p)
    {
      return std::lower_bound(order.begin(), order.end(), p.x() - reach,
        [&](std::size_t i, double x) { return points[i].x() < x; });
    };
    // Six half-edges leave a vertex.
    std::vector<std::uint8_t> mayTake(mesh_.vertexCount());
    parallelForEach(mayTake.size(), kMediumChunk, threads_,
      [&](std::size_t v)
      {
        const Vector3& p = mesh_.position[v];
        for (auto at = firstInReach(p); at != order.end() && points[*at].x() <= p.x() + reach; ++at)
        {
          mayTake[v] |= (points[*at] - p).norm() <= reach ? 1 : 0;
        }
      });
    std::vector<Index> near(points.size(), kInvalidIndex);
    std::vector<double> least(points.size(), reach);
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      if (mayTake[mesh_.origin[h]] == 0)
      {
        continue;
      }
      const Vector3& p = mesh_.position[mesh_.origin[h]];
      for (auto at = firstInReach(p); at != order.end() && points[*at].x() <= p.x() + reach; ++at)
      {
        const double distance = (points[*at] - p).norm();
        if (distance < least[*at] || (near[*at] == kInvalidIndex && distance == least[*at]))
        {
          near[*at] = h;
          least[*at] = distance;
        }
      }
    }
    return near;
  }

  MeshPlace placeOf(Index v) { return { Mesh::face(halfEdgeFrom(v)), mesh_.position[v] }; }

  /// A half-edge that leaves the vertex: of those that were there the one that was found, of new ones that of their
  /// split, which later splits may have renamed.
  Index halfEdgeFrom(Index v)
  {
    const auto known = out_.find(v);
    if (known != out_.end() && mesh_.origin[known->second] == v)
    {
      return known->second;
    }
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      if (mesh_.origin[h] == v)
      {
        out_[v] = h;
        return h;
      }
    }
    return kInvalidIndex;
  }

  Index take(Index h)
  {
    out_[mesh_.origin[h]] = h;
    return mesh_.origin[h];
  }

  bool isOnConstraint(Index h) const
  {
    bool on = false;
    forEachInFan(mesh_, h,
      [&](Index g)
      { on = on || mesh_.isConstrained(g) || mesh_.isConstrained(Mesh::previous(g)); });
    return on;
  }

  bool isFine(Index f) const
  {
    double longest = 0;
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      longest = std::max(longest, mesh_.edgeVector(h).norm());
    }
    return longest < kFineForPlaces * s_;
  }

  /// Of the faces that the one where the place was found has been split into.
  Index faceNow(const MeshPlace& place) const
  {
    Index best = place.face;
    double least = (nearestOnFace(mesh_, best, place.point) - place.point).squaredNorm();
    const auto parts = partsOf_.find(place.face);
    for (std::size_t i = 0; parts != partsOf_.end() && i < parts->second.size(); ++i)
    {
      const Index f = parts->second[i];
      const double squared = (nearestOnFace(mesh_, f, place.point) - place.point).squaredNorm();
      if (squared < least)
      {
        least = squared;
        best = f;
      }
    }
    return best;
  }

  Index vertexAt(const MeshPlace& place)
  {
    const Index f = faceNow(place);
    const bool fine = isFine(f);
    Index nearest = kInvalidIndex;
    double least = 0;
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      const double distance = (mesh_.position[mesh_.origin[h]] - place.point).norm();
      const bool isTaken = distance <= kOnePlace * s_ || (fine && !isOnConstraint(h));
      if (isTaken && (nearest == kInvalidIndex || distance < least))
      {
        nearest = h;
        least = distance;
      }
    }
    return nearest != kInvalidIndex ? take(nearest) : newVertexAt(f, place.point);
  }

  Index newVertexAt(Index f, const Vector3& point)
  {
    Index edge = kInvalidIndex;
    double least = kOnePlace * s_;
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      const double distance =
        distanceToSegment(point, mesh_.position[mesh_.origin[h]], mesh_.position[mesh_.target(h)]);
      if (distance < least)
      {
        least = distance;
        edge = h;
      }
    }
    if (edge != kInvalidIndex)
    {
      const Vector3 along = mesh_.edgeVector(edge);
      const double share =
        (point - mesh_.position[mesh_.origin[edge]]).dot(along) / along.squaredNorm();
      return split(edge, std::clamp(share, kRounding, 1 - kRounding));
    }
    const Index first = mesh_.faceCount();
    const Index v = splitFace(surface_, f, weightsIn(f, point));
    noteParts(first, f, f);
    out_[v] = 3 * f + 2;
    return v;
  }

  std::array<double, 3> weightsIn(Index f, const Vector3& point) const
  {
    const Vector3 a = mesh_.position[mesh_.origin[3 * f]];
    const Vector3 normal = mesh_.edgeVector(3 * f).cross(mesh_.edgeVector(3 * f + 1));
    const double v =
      normal.dot((point - a).cross(-mesh_.edgeVector(3 * f + 2))) / normal.squaredNorm();
    const double w = normal.dot(mesh_.edgeVector(3 * f).cross(point - a)) / normal.squaredNorm();
    return { 1 - v - w, v, w };
  }

  Index vertexOn(const EdgeCrossing& crossing)
  {
    const Index h = crossing.halfEdge;
    const double length = mesh_.edgeVector(h).norm();
    const double before = crossing.share * length;
    const double after = length - before;
    if (std::min(before, after) <= kOnePlace * s_ || length < kFineForPaths * s_)
    {
      return take(before <= after ? h : Mesh::next(h));
    }
    return split(h, crossing.share);
  }

  Index split(Index h, double share)
  {
    const Index g = mesh_.twin[h];
    splitConstraint_ = splitConstraint_ || mesh_.isConstrained(h);
    const Index first = mesh_.faceCount();
    const Index v = splitEdge(surface_, h, share);
    noteParts(first, Mesh::face(h), g == kInvalidIndex ? kInvalidIndex : Mesh::face(g));
    out_[v] = Mesh::next(h);
    return v;
  }

  /// Faces from `first` on are parts of one face, and then of another one.
  void noteParts(Index first, Index face, Index other)
  {
    for (Index f = first; f < mesh_.faceCount(); ++f)
    {
      const Index of = f == first ? face : other;
      const auto root = rootOf_.find(of);
      const Index whole = root == rootOf_.end() ? of : root->second;
      rootOf_[f] = whole;
      partsOf_[whole].push_back(f);
    }
  }

  /// Vertices that come twice, one after the other or round another one, were taken for several crossings.
  static void straighten(std::vector<Index>& chain)
  {
    std::vector<Index> result;
    for (const Index v : chain)
    {
      if (!result.empty() && result.back() == v)
      {
        continue;
      }
      if (result.size() >= 2 && result[result.size() - 2] == v)
      {
        result.pop_back();
        continue;
      }
      result.push_back(v);
    }
    chain = std::move(result);
  }

  /// Whether there is such an edge.
  bool markEdge(Index a, Index b)
  {
    bool isThere = false;
    forEachInFan(mesh_, halfEdgeFrom(a),
      [&](Index h)
      {
        for (const Index edge : { h, Mesh::previous(h) })
        {
          if (mesh_.target(edge) == b || mesh_.origin[edge] == b)
          {
            setFeature(edge);
            isThere = true;
          }
        }
      });
    return isThere;
  }

  void setFeature(Index h)
  {
    for (const Index side : { h, Index{ mesh_.twin[h] } })
    {
      if (side != kInvalidIndex)
      {
        mesh_.flags.edit()[side] |= kFeatureEdge | kRequestedFeature;
      }
    }
  }

  PreparedSurface& surface_;
  Mesh& mesh_;
  double s_;
  int threads_;
  bool splitConstraint_ = false;
  std::unordered_map<Index, Index> out_;    ///< half-edges that leave vertices
  std::unordered_map<Index, Index> rootOf_; ///< of new faces: the face that they are parts of
  std::unordered_map<Index, std::vector<Index>> partsOf_;
};

/// Those that no later one goes before at their places. orders: of vertices. centres: the vertices of the places.
std::vector<SizeRequest> sizesThatCount(const std::vector<SizeRequest>& sizes,
  const std::vector<Index>& centres, const std::vector<int>& orders)
{
  std::vector<SizeRequest> counting;
  for (std::size_t i = 0; i < sizes.size(); ++i)
  {
    const bool isCovered = orders[centres[i]] > sizes[i].order ||
      std::any_of(sizes.begin(), sizes.end(),
        [&](const SizeRequest& other) {
          return other.order > sizes[i].order &&
            (other.place - sizes[i].place).norm() <= other.radius;
        });
    if (!isCovered)
    {
      counting.push_back(sizes[i]);
    }
  }
  return counting;
}

/// The size of a vertex outside of all radii where nothing else is asked for. Beyond a radius sizes pass to those
/// around, larger ones and smaller ones alike; where a larger one and a smaller one pass it is the smaller one.
double sizeBeyond(const std::vector<SizeRequest>& sizes, const Vector3& p, double s)
{
  double larger = 1, most = kInfinity;
  for (const SizeRequest& asked : sizes)
  {
    const double change = kSizeGrowth * ((p - asked.place).norm() - asked.radius) / s;
    larger = std::max(larger, asked.factor - change);
    most = std::min(most, asked.factor + change);
  }
  return std::min(larger, most);
}

template <typename Asked>
std::vector<Vector3> placesAsked(const std::vector<Asked>& requests)
{
  std::vector<Vector3> places;
  places.reserve(requests.size());
  for (const Asked& request : requests)
  {
    places.push_back(request.place);
  }
  return places;
}

} // namespace

std::optional<Vector3> nearestOnCurves(const Mesh& mesh, const Vector3& p, double within)
{
  std::optional<Vector3> best;
  double least = within;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isConstrained(h))
    {
      const Vector3 q =
        nearestOnSegment(p, mesh.position[mesh.origin[h]], mesh.position[mesh.target(h)]);
      const double distance = (q - p).norm();
      if (distance < least)
      {
        best = q;
        least = distance;
      }
    }
  }
  return best;
}

std::vector<std::vector<Vector3>> insertFeatures(PreparedSurface& surface,
  const std::vector<FeatureRequest>& features, const InsertionOptions& options,
  std::vector<std::string>& notices, const std::vector<std::array<double, 2>>& toCurves)
{
  Insertion insertion(surface, options);
  std::vector<Vector3> points;
  for (const FeatureRequest& feature : features)
  {
    points.insert(points.end(), feature.points.begin(), feature.points.end());
  }
  const std::vector<Index> vertices = insertion.vertices(points);
  std::vector<std::vector<Vector3>> paths;
  std::size_t at = 0;
  for (const FeatureRequest& feature : features)
  {
    std::vector<std::vector<Index>> chains{ { vertices[at] } };
    for (std::size_t i = 0; i + 1 < feature.points.size(); ++i, ++at)
    {
      if (vertices[at] == vertices[at + 1])
      {
        continue;
      }
      const std::vector<Index> chain = insertion.connect(vertices[at], vertices[at + 1]);
      if (chain.empty())
      {
        notices.push_back("a feature curve is not followed from " + placeText(feature.points[i]) +
          " to " + placeText(feature.points[i + 1]) +
          ": the places lie on parts of the surface that are not joined; draw one line for each");
        chains.push_back({ vertices[at + 1] });
        continue;
      }
      chains.back().insert(chains.back().end(), chain.begin() + 1, chain.end());
    }
    ++at;
    if (!toCurves.empty())
    {
      insertion.endOnCurves(chains, toCurves[paths.size()]);
    }
    paths.emplace_back();
    for (const std::vector<Index>& chain : chains)
    {
      insertion.mark(chain);
      for (const Index v : chain)
      {
        paths.back().push_back(surface.mesh.position[v]);
      }
    }
  }
  return paths;
}

void insertSizes(PreparedSurface& surface, const std::vector<SizeRequest>& sizes,
  std::vector<int> orders, const InsertionOptions& options)
{
  if (sizes.empty())
  {
    return;
  }
  Mesh& mesh = surface.mesh;
  mesh.sizing.resize(mesh.vertexCount(), 1.0F);
  Insertion insertion(surface, options);
  const std::vector<Index> centres = insertion.vertices(placesAsked(sizes));
  insertion.refineAround(sizes);
  orders.resize(mesh.vertexCount(), 0);
  const std::vector<SizeRequest> passing = sizesThatCount(sizes, centres, orders);
  float* const sizing = mesh.sizing.edit();
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    pollNowAndThen(v);
    bool isFree = orders[v] == 0 && sizing[v] == 1;
    for (std::size_t i = 0; i < sizes.size(); ++i)
    {
      const SizeRequest& size = sizes[i];
      const bool isNear = v == centres[i] ||
        (mesh.position[v] - size.place).squaredNorm() <= size.radius * size.radius;
      isFree = isFree && !isNear;
      if (isNear && orders[v] <= size.order)
      {
        sizing[v] = static_cast<float>(size.factor);
        orders[v] = size.order;
      }
    }
    if (isFree)
    {
      sizing[v] = static_cast<float>(sizeBeyond(passing, mesh.position[v], options.edgeLength));
    }
  }
}

InsertedValences insertValences(PreparedSurface& surface, const std::vector<ValencePlace>& valences,
  const InsertionOptions& options)
{
  Insertion insertion(surface, options);
  const std::vector<Vector3> places = placesAsked(valences);
  const std::vector<Index> vertices = insertion.vertices(places);
  InsertedValences inserted;
  inserted.splitConstraint = insertion.splitConstraint();
  std::map<Index, ValenceRequest> byVertex;
  for (const ValenceRequest& request : surface.valenceRequests)
  {
    byVertex.emplace(request.vertex, request);
  }
  for (std::size_t i = 0; i < valences.size(); ++i)
  {
    const Index v = vertices[i];
    const auto leaveOut = [&](const std::string& why)
    {
      inserted.notices.push_back("valence " + std::to_string(valences[i].valence) + " at " +
        placeText(places[i]) + " is left out: " + why);
    };
    const auto found = byVertex.find(v);
    if (found != byVertex.end() && found->second.valence != valences[i].valence)
    {
      leaveOut("valence " + std::to_string(found->second.valence) +
        " is asked for there already; give both the same, or take one away");
    }
    else if (valences[i].valence < kLeastOnBoundary && insertion.isOnBoundary(v))
    {
      leaveOut("the place is on the boundary, where the least is 3, a corner with one quad; ask "
               "for 3 or more, or move the place inside");
    }
    else
    {
      const bool mayDrift =
        valences[i].mayDrift && (found == byVertex.end() || found->second.mayDrift);
      const Index point = found == byVertex.end() ? kInvalidIndex : found->second.point;
      byVertex[v] = { v, valences[i].valence, point, mayDrift };
    }
  }
  surface.valenceRequests.clear();
  for (const auto& [v, request] : byVertex)
  {
    surface.valenceRequests.push_back(request);
  }
  return inserted;
}

} // namespace quadrille
