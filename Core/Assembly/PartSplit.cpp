// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Assembly/PartSplit.h"

#include "Assembly/FaceParts.h"
#include "Assembly/PartSurface.h"
#include "Base/DisjointSets.h"
#include "Base/Progress.h"
#include "Mesh/Distance.h"
#include "Quads/QuadTopology.h"
#include "Quads/SurfaceWalk.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <utility>

namespace quadrille
{

namespace
{

/// Where a point of the quads lies in the faces of one part.
class PartPlaces
{
public:
  PartPlaces(const CutSource& source, const FaceParts& faceParts)
    : mesh_(source.result.surface.mesh), quads_(source.quads), faceParts_(faceParts)
  {
  }

  /// On the whole surface. near: a face of the part that is not far.
  SurfacePoint in(Index part, Index point, Index near) const
  {
    const Index f = quads_.sourceFace[point];
    if (faceParts_.has(part, f))
    {
      return { f, quads_.sourceWeights[point] };
    }
    // On the border of two parts: in one of the faces round the corners, the nearest one.
    SurfacePoint best = placeOn(near, quads_.points[point]);
    double least = distance(best, point);
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      forEachInFan(mesh_, h,
        [&](Index k)
        {
          const Index g = Mesh::face(k);
          if (faceParts_.has(part, g))
          {
            const SurfacePoint place = placeOn(g, quads_.points[point]);
            const double found = distance(place, point);
            if (found < least || (found == least && place.face < best.face))
            {
              best = place;
              least = found;
            }
          }
        });
    }
    return best;
  }

  Index twin(Index h) const { return mesh_.twin[h]; }

private:
  SurfacePoint placeOn(Index f, const Vector3& p) const
  {
    const auto [a, b, c] = mesh_.cornersOfFace(f);
    const Vector3 at = nearestOnTriangle(p, a, b, c);
    const Vector3 normal = (b - a).cross(c - a);
    const double area = normal.squaredNorm();
    if (!(area > 0))
    {
      return { f, { 1, 0, 0 } };
    }
    const double u = std::clamp(normal.dot((c - b).cross(at - b)) / area, 0.0, 1.0);
    const double v = std::clamp(normal.dot((a - c).cross(at - c)) / area, 0.0, 1.0 - u);
    return { f, { u, v, std::max(0.0, 1 - u - v) } };
  }

  double distance(const SurfacePoint& place, Index point) const
  {
    Vector3 at = Vector3::Zero();
    for (Index i = 0; i < 3; ++i)
    {
      at += place.weights[i] * mesh_.position[mesh_.origin[3 * place.face + i]];
    }
    return (at - quads_.points[point]).norm();
  }

  const Mesh& mesh_;
  const QuadMesh& quads_;
  const FaceParts& faceParts_;
};

/// Whether the polygon under a face of the part has its corners the other way round; 0 where repair has changed them.
int orientationIn(const JoinedParts::Part& part, const PreparedSurface& surface, Index face)
{
  const Index polygon = surface.sourcePolygon[face];
  const Index* begin = part.polygonPoints.data() + part.polygonOffsets[polygon];
  const Index* end = part.polygonPoints.data() + part.polygonOffsets[polygon + 1];
  std::array<std::ptrdiff_t, 3> at{};
  for (std::size_t i = 0; i < 3; ++i)
  {
    const Index* found = std::find(begin, end, surface.sourcePoints[face][i]);
    if (found == end)
    {
      return 0;
    }
    at[i] = found - begin;
  }
  const int rises = (at[0] < at[1] ? 1 : 0) + (at[1] < at[2] ? 1 : 0) + (at[2] < at[0] ? 1 : 0);
  return rises == 2 ? 1 : -1;
}

/// Per quad, by most of the faces under its connected component.
std::vector<std::uint8_t> reversedQuads(const JoinedParts::Part& part, const RemeshResult& result)
{
  const QuadMesh& quads = result.quads;
  const QuadTopology topology = analyzeQuads(quads.quads, quads.points.size());
  DisjointSets components(quads.quads.size(), 1);
  for (Index h = 0; h < topology.twin.size(); ++h)
  {
    if (topology.twin[h] != kInvalidIndex)
    {
      components.join(h / 4, topology.twin[h] / 4);
    }
  }
  std::vector<long long> votes(quads.quads.size(), 0);
  for (Index q = 0; q < quads.quads.size(); ++q)
  {
    votes[components.find(q)] += orientationIn(part, result.surface, quads.quadSourceFace[q]);
  }
  std::vector<std::uint8_t> reversed;
  for (Index q = 0; q < quads.quads.size(); ++q)
  {
    reversed.push_back(votes[components.find(q)] < 0 ? 1 : 0);
  }
  return reversed;
}

/// The quads of one part as a mesh of its own.
class PartQuads
{
public:
  PartQuads(
    const CutSource& source, const FaceParts& faceParts, const PartPlaces& places, Index part)
    : source_(source), whole_(source.quads), faceParts_(faceParts), places_(places), part_(part)
  {
  }

  /// to: with its surface.
  void write(const std::vector<Index>& quads, RemeshResult& to)
  {
    QuadMesh& own = to.quads;
    for (const Index q : quads)
    {
      own.quads.push_back(whole_.quads[q]);
      own.quadSourceFace.push_back(faceParts_.ownFace(part_, whole_.quadSourceFace[q]));
      own.quadSourceWeights.push_back(whole_.quadSourceWeights[q]);
    }
    if (source_.met != nullptr)
    {
      orientSheets(to);
    }
    namePoints(own);
    const QuadTopology topology = analyzeQuads(own.quads, own.points.size());
    own.valence = topology.valence;
    own.onBoundary = topology.onBoundary;
    writeLines(topology, own);
  }

private:
  /// Each sheet as the part's own polygons run, as only then its quads fit to those of other sheets.
  void orientSheets(RemeshResult& to) const
  {
    to.quads.points.resize(whole_.points.size());
    const std::vector<std::uint8_t> reversed = reversedQuads(source_.joined.parts[part_], to);
    to.quads.points.clear();
    for (std::size_t q = 0; q < reversed.size(); ++q)
    {
      if (reversed[q] != 0)
      {
        std::array<Index, 4>& quad = to.quads.quads[q];
        quad = { quad[1], quad[0], quad[3], quad[2] };
      }
    }
  }

  /// Points of this part, in the order of the whole mesh; one for each fan.
  void namePoints(QuadMesh& to)
  {
    const auto corners = static_cast<Index>(4 * to.quads.size());
    std::vector<Index> wholeCorner(corners); // before points that are the same became one
    for (Index h = 0; h < corners; ++h)
    {
      wholeCorner[h] = to.quads[h / 4][h % 4];
      to.quads[h / 4][h % 4] = source_.same(wholeCorner[h]);
    }
    const QuadTopology topology = analyzeQuads(to.quads, whole_.points.size());
    DisjointSets fans(corners, 1);
    for (Index h = 0; h < corners; ++h)
    {
      if (topology.twin[h] != kInvalidIndex)
      {
        fans.join(h, nextInQuad(topology.twin[h]));
      }
    }
    std::vector<std::pair<Index, Index>> points; // of the whole mesh, a corner
    for (Index h = 0; h < corners; ++h)
    {
      if (fans.find(h) == h)
      {
        points.emplace_back(to.quads[h / 4][h % 4], h);
      }
    }
    std::sort(points.begin(), points.end());
    std::vector<Index> name(corners);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      const auto [point, corner] = points[i];
      name[corner] = static_cast<Index>(i);
      wholePoint_.push_back(point);
      to.points.push_back(whole_.points[point]);
      const SurfacePoint place = places_.in(part_, wholeCorner[corner], faceOf(to, corner / 4));
      to.sourceFace.push_back(faceParts_.ownFace(part_, place.face));
      to.sourceWeights.push_back(place.weights);
    }
    for (Index h = 0; h < corners; ++h)
    {
      to.quads[h / 4][h % 4] = name[fans.find(h)];
    }
  }

  /// Of the whole surface, under a quad of this part.
  Index faceOf(const QuadMesh& to, Index quad) const
  {
    return faceParts_.faces(part_)[to.quadSourceFace[quad]];
  }

  /// Features and boundary: lines of the whole mesh, and what its features did not follow.
  void writeLines(const QuadTopology& topology, QuadMesh& to) const
  {
    using Edge = std::pair<Index, Index>;
    std::vector<std::pair<Edge, Index>> edges; // by points of the whole mesh, with a half-edge
    for (Index h = 0; h < 4 * to.quads.size(); ++h)
    {
      if (topology.twin[h] == kInvalidIndex || h < topology.twin[h])
      {
        const Index a = wholePoint_[to.quads[h / 4][h % 4]];
        const Index b = wholePoint_[to.quads[h / 4][(h + 1) % 4]];
        edges.push_back({ { std::min(a, b), std::max(a, b) }, h });
      }
    }
    std::sort(edges.begin(), edges.end());
    std::vector<std::uint8_t> hasLine(4 * to.quads.size(), 0);
    const auto add = [&](Index h, Index halfEdge)
    {
      if (hasLine[h] != 0)
      {
        return; // of another sheet
      }
      hasLine[h] = 1;
      to.lines.push_back({ to.quads[h / 4][h % 4], to.quads[h / 4][(h + 1) % 4], halfEdge,
        topology.twin[h] == kInvalidIndex });
    };
    for (const QuadLine& line : whole_.lines)
    {
      const Index a = source_.same(line.a), b = source_.same(line.b);
      const Edge edge{ std::min(a, b), std::max(a, b) };
      for (auto found =
             std::lower_bound(edges.begin(), edges.end(), std::make_pair(edge, Index{ 0 }));
           found != edges.end() && found->first == edge; ++found)
      {
        add(found->second, ownHalfEdge(line.halfEdge, to.quadSourceFace[found->second / 4]));
      }
    }
    for (const auto& [edge, h] : edges)
    {
      if (topology.twin[h] == kInvalidIndex && hasLine[h] == 0)
      {
        add(h, 3 * to.quadSourceFace[h / 4]);
      }
    }
  }

  /// On the side of this part; where the line is on none of its faces, of the face under the quad.
  Index ownHalfEdge(Index h, Index face) const
  {
    for (const Index side : { h, places_.twin(h) })
    {
      if (side != kInvalidIndex && faceParts_.has(part_, Mesh::face(side)))
      {
        return faceParts_.ownHalfEdge(part_, side);
      }
    }
    return 3 * face;
  }

  const CutSource& source_;
  const QuadMesh& whole_;
  const FaceParts& faceParts_;
  const PartPlaces& places_;
  Index part_;
  std::vector<Index> wholePoint_; ///< per point of the part
};

/// What a run tells as a whole.
void copyReport(const RemeshResult& from, RemeshResult& to)
{
  to.status = from.status;
  to.stopped = from.stopped;
  to.frame = from.frame;
  to.coarseCertificate = from.coarseCertificate;
  to.certificate = from.certificate;
  to.extraction = from.extraction;
  to.finalQuality = from.finalQuality;
  to.beyondAnisotropyLimit = from.beyondAnisotropyLimit;
  to.smallParts = from.smallParts;
  to.attempts = from.attempts;
  to.tries = from.tries;
  to.stages = from.stages;
  to.reused = from.reused;
  to.estimate = from.estimate;
  to.decimations = from.decimations;
  to.replays = from.replays;
  to.targetEdgeLength = from.targetEdgeLength;
  to.notices = from.notices;
  to.surface.repair = from.surface.repair;
}

/// The part whose faces lie nearest to a place.
class NearestPart
{
public:
  NearestPart(const Mesh& mesh, const FaceParts& faceParts) : mesh_(mesh), faceParts_(faceParts) {}

  std::size_t to(const Vector3& place) const
  {
    Index nearest = 0;
    double least = kInfinity;
    for (Index f = 0; f < mesh_.faceCount(); ++f)
    {
      pollNowAndThen(f);
      const auto [a, b, c] = mesh_.cornersOfFace(f);
      const double distance = (nearestOnTriangle(place, a, b, c) - place).squaredNorm();
      if (distance < least)
      {
        least = distance;
        faceParts_.forEachOwner(f, [&](const FaceParts::Owner& owner) { nearest = owner.part; });
      }
    }
    return nearest;
  }

private:
  const Mesh& mesh_;
  const FaceParts& faceParts_;
};

std::vector<PartResult> cutUp(CutSource source)
{
  const RemeshResult& result = source.result;
  const JoinedParts& joined = source.joined;
  const FaceParts faceParts(source);
  std::vector<std::vector<Index>> quads(joined.parts.size());
  for (std::size_t q = 0; q < source.quads.quads.size(); ++q)
  {
    faceParts.forEachOwner(source.quads.quadSourceFace[q],
      [&](const FaceParts::Owner& owner) { quads[owner.part].push_back(static_cast<Index>(q)); });
  }
  const PartPlaces places(source, faceParts);
  std::vector<PartResult> parts(joined.parts.size());
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    poll();
    RemeshResult& own = parts[p].result;
    copyReport(result, own);
    writePartSurface(source, faceParts, p, own);
    PartQuads(source, faceParts, places, static_cast<Index>(p)).write(quads[p], own);
    parts[p].reversed = source.met == nullptr ? reversedQuads(joined.parts[p], own)
                                              : std::vector<std::uint8_t>(quads[p].size(), 0);
    if (!result.curves.empty())
    {
      const auto first = result.curves.begin();
      own.curves.assign(first + static_cast<std::ptrdiff_t>(joined.firstCurve[p]),
        first + static_cast<std::ptrdiff_t>(joined.firstCurve[p + 1]));
    }
  }
  const NearestPart nearest(result.surface.mesh, faceParts);
  for (const SmallDetail& detail : result.details)
  {
    parts[nearest.to(detail.place)].result.details.push_back(detail);
  }
  for (const GivenUpCurve& curve : result.givenUpFeatures)
  {
    parts[nearest.to(curve.place)].result.givenUpFeatures.push_back(curve);
  }
  return parts;
}

} // namespace

std::vector<PartResult> splitParts(const RemeshResult& result, const JoinedParts& joined)
{
  return cutUp({ result, joined, nullptr, nullptr, result.quads });
}

std::vector<PartResult> splitSheets(const RemeshResult& result, const JoinedParts& joined,
  const JointSheets& sheets, const MetSheets& met)
{
  return cutUp({ result, joined, &sheets, &met, result.quads });
}

} // namespace quadrille
