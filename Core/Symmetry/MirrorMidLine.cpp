// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/MirrorMidLine.h"

#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "GridMap/RelaxMap.h"
#include "Mesh/Topology.h"
#include "Prepare/Frame.h"
#include "Requests/Guides.h"
#include "Symmetry/CopiedRun.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <queue>
#include <utility>

namespace quadrille
{

namespace
{

/// Rows of quads beside the plane that move along.
constexpr double kRows = 8;
/// Fewer, halved each time, where the system for them would be too large.
constexpr double kLeastRows = 1;

/// The boundary of a half in the plane, on its triangles as they are given.
class PlaneBoundary
{
public:
  PlaneBoundary(const MirrorHalf& half, const MirrorPlane& plane, double tolerance)
    : input_(half.input)
  {
    inPlane_.reserve(input_.points.size());
    for (const Vector3& p : input_.points)
    {
      inPlane_.push_back(std::abs(plane.height(p)) <= tolerance ? 1 : 0);
    }
    findEdges();
  }

  /// Corners whose edge, to the next one, is on the boundary in the plane.
  const std::vector<Index>& edges() const { return inside_; }

  /// Chains of them in the order of the boundary; a closed one ends where it begins.
  std::vector<std::vector<Index>> chains() const
  {
    std::vector<std::uint8_t> hasBefore(input_.polygonPoints.size(), 0), done(hasBefore);
    for (const Index edge : inside_)
    {
      const std::optional<Index> next = after(edge);
      if (next)
      {
        hasBefore[*next] = 1;
      }
    }
    std::vector<std::vector<Index>> chains;
    for (const bool open : { true, false })
    {
      for (const Index first : inside_)
      {
        if (done[first] != 0 || (open && hasBefore[first] != 0))
        {
          continue;
        }
        chains.emplace_back();
        for (std::optional<Index> edge = first; edge && done[*edge] == 0; edge = after(*edge))
        {
          done[*edge] = 1;
          chains.back().push_back(*edge);
        }
      }
    }
    return chains;
  }

  Index from(Index edge) const { return input_.polygonPoints[edge]; }
  Index to(Index edge) const { return input_.polygonPoints[Mesh::next(edge)]; }

  /// Per point in the plane: the features inside the half that end there.
  std::vector<Index> featuresAt() const
  {
    std::vector<Index> count(input_.points.size(), 0);
    for (const auto& [ends, edge] : edgeBetween_)
    {
      const bool isFeature =
        !input_.featureEdges.empty() && (input_.featureEdges[edge / 3] >> edge % 3 & 1U) != 0;
      if (isFeature && ends.first < ends.second && twin(edge))
      {
        count[ends.first] += inPlane_[ends.first];
        count[ends.second] += inPlane_[ends.second];
      }
    }
    return count;
  }

private:
  /// Only triangles with a corner in the plane count.
  void findEdges()
  {
    for (Index edge = 0; edge < input_.polygonPoints.size(); ++edge)
    {
      const Index first = edge / 3 * 3;
      pollNowAndThen(edge);
      const bool touches =
        (inPlane_[from(first)] | inPlane_[from(first + 1)] | inPlane_[from(first + 2)]) != 0;
      if (touches)
      {
        edgeBetween_[{ from(edge), to(edge) }] = edge;
      }
    }
    for (const auto& [ends, edge] : edgeBetween_)
    {
      if (inPlane_[ends.first] != 0 && inPlane_[ends.second] != 0 && !twin(edge))
      {
        inside_.push_back(edge);
      }
    }
    std::sort(inside_.begin(), inside_.end());
  }

  std::optional<Index> twin(Index edge) const
  {
    const auto found = edgeBetween_.find({ to(edge), from(edge) });
    return found == edgeBetween_.end() ? std::nullopt : std::optional<Index>(found->second);
  }

  /// The next edge of the boundary, where it is in the plane.
  std::optional<Index> after(Index edge) const
  {
    Index next = Mesh::next(edge);
    for (std::optional<Index> across = twin(next); across; across = twin(next))
    {
      next = Mesh::next(*across);
    }
    return inPlane_[to(next)] != 0 ? std::optional<Index>(next) : std::nullopt;
  }

  const SurfaceInput& input_;
  std::vector<std::uint8_t> inPlane_;
  std::map<std::pair<Index, Index>, Index> edgeBetween_;
  std::vector<Index> inside_;
};

/// Inside the parts in the plane two turns, one at their ends: then they can move by half a quad.
Status checkStraight(const Mesh& mesh, const DoubledMesh& doubled, const std::vector<int>& turns)
{
  std::vector<std::uint8_t> ends(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (doubled.isGlued[h] != 0)
    {
      ++ends[mesh.origin[h]];
      ++ends[mesh.target(h)];
    }
  }
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    if (ends[v] > 0 && turns[v] != ends[v])
    {
      return { StatusCode::NotConverged,
        "the map of the half in front of the mirror plane has a corner in the plane, at " +
          placeText(mesh.position[v]) + ", where a mid-line of quads has no point" };
    }
  }
  return {};
}

/// Part of a mesh with its map.
struct Band
{
  Mesh mesh;
  std::vector<Index> face;         ///< per face of it
  std::vector<Index> vertex;       ///< per vertex of it
  std::vector<std::uint8_t> isCut; ///< per vertex: some of its faces are missing
};

/// Faces that are within so many quads of the boundary in the plane, along edges.
class BandBuilder
{
public:
  BandBuilder(const Mesh& mesh, const std::vector<std::uint8_t>& isGlued,
    const std::vector<FixedVec2>& uv, double rows)
    : mesh_(mesh), rows_(rows),
      distance_(mesh.vertexCount(), std::numeric_limits<double>::infinity())
  {
    walk(isGlued, uv);
  }

  Band build() const
  {
    Band band;
    std::vector<Index> faceIn(mesh_.faceCount(), kInvalidIndex);
    std::vector<Index> vertexIn(mesh_.vertexCount(), kInvalidIndex);
    for (Index f = 0; f < mesh_.faceCount(); ++f)
    {
      if (isInside(f))
      {
        faceIn[f] = static_cast<Index>(band.face.size());
        band.face.push_back(f);
      }
    }
    for (const Index f : band.face)
    {
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        Index& v = vertexIn[mesh_.origin[h]];
        if (v == kInvalidIndex)
        {
          v = static_cast<Index>(band.vertex.size());
          band.vertex.push_back(mesh_.origin[h]);
        }
        const Index twin = mesh_.twin[h];
        const Index across = twin == kInvalidIndex ? twin : faceIn[Mesh::face(twin)];
        band.mesh.origin.push_back(v);
        band.mesh.twin.push_back(across == kInvalidIndex ? across : 3 * across + twin % 3);
        band.mesh.flags.push_back(mesh_.flags[h]);
      }
    }
    band.isCut.assign(band.vertex.size(), 0);
    for (const Index v : band.vertex)
    {
      band.mesh.position.push_back(mesh_.position[v]);
      if (!mesh_.sizing.empty())
      {
        band.mesh.sizing.push_back(mesh_.sizing[v]);
      }
    }
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      const Index v = vertexIn[mesh_.origin[h]];
      if (v != kInvalidIndex && faceIn[Mesh::face(h)] == kInvalidIndex)
      {
        band.isCut[v] = 1;
      }
    }
    return band;
  }

private:
  void walk(const std::vector<std::uint8_t>& isGlued, const std::vector<FixedVec2>& uv)
  {
    using Reached = std::pair<double, Index>;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
    const auto reach = [&](Index v, double distance)
    {
      if (distance < distance_[v] && distance <= rows_)
      {
        distance_[v] = distance;
        open.push({ distance, v });
      }
    };
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      if (isGlued[h] != 0)
      {
        reach(mesh_.origin[h], 0);
        reach(mesh_.target(h), 0);
      }
    }
    const std::vector<Index> outgoing = outgoingHalfEdges(mesh_);
    while (!open.empty())
    {
      const auto [distance, v] = open.top();
      open.pop();
      if (distance > distance_[v])
      {
        continue;
      }
      pollNowAndThen(v);
      Index h = outgoing[v];
      do
      {
        const Index last = Mesh::previous(h);
        reach(mesh_.target(h), distance + toDouble(uv[Mesh::next(h)] - uv[h]).norm());
        reach(mesh_.origin[last], distance + toDouble(uv[last] - uv[h]).norm());
        h = mesh_.rotateCounterclockwise(h);
      } while (h != kInvalidIndex && h != outgoing[v]);
    }
  }

  bool isInside(Index f) const
  {
    return std::min({ distance_[mesh_.origin[3 * f]], distance_[mesh_.origin[3 * f + 1]],
             distance_[mesh_.origin[3 * f + 2]] }) <= rows_;
  }

  const Mesh& mesh_;
  double rows_;
  std::vector<double> distance_; ///< per vertex, in quads; infinite beyond the rows
};

/// The guides of a band's faces; empty without any.
std::vector<Guide> guidesIn(const Band& band, const PreparedSurface& half, int threads)
{
  const SurfaceGuides found = surfaceGuides(half, threads);
  std::vector<Guide> guides;
  if (found.faces.empty())
  {
    return guides;
  }
  std::vector<Guide> all(half.mesh.faceCount());
  for (const FaceGuide& guide : found.faces)
  {
    all[guide.face] = guide.guide;
  }
  for (const Index f : band.face)
  {
    guides.push_back(all[f]);
  }
  return guides;
}

/// Quads of the doubled map sorted by sides.
class QuadFolding
{
public:
  QuadFolding(const QuadMesh& extracted, const DoubledMesh& doubled, const MirrorPlane& plane)
    : given_(extracted), doubled_(doubled), plane_(plane),
      image_(extracted.points.size(), kInvalidIndex),
      imageOfQuad_(extracted.quads.size(), kInvalidIndex)
  {
  }

  DoubledQuads run()
  {
    DoubledQuads result;
    findEdges();
    pairAcross();
    spread();
    pairRest();
    const Index lost = unpaired();
    if (crowded_ != kInvalidIndex || lost != kInvalidIndex)
    {
      result.status = { StatusCode::NotConverged,
        "the half in front of the mirror plane is too narrow near " +
          placeText(given_.points[crowded_ != kInvalidIndex ? crowded_ : lost]) +
          " for quads across the plane and their neighbours: it needs more quads" };
      return result;
    }
    number(result);
    takePoints(result);
    takeQuads(result);
    takeLines(result);
    return result;
  }

private:
  bool isFront(Index p) const { return given_.sourceFace[p] < doubled_.halfFaces; }
  std::size_t frontCorners(const std::array<Index, 4>& quad) const
  {
    return static_cast<std::size_t>(
      std::count_if(quad.begin(), quad.end(), [&](Index p) { return isFront(p); }));
  }

  void findEdges()
  {
    for (Index q = 0; q < given_.quads.size(); ++q)
    {
      const std::array<Index, 4>& quad = given_.quads[q];
      for (Index i = 0; i < 4; ++i)
      {
        edges_.push_back({ { quad[i], quad[(i + 1) % 4] }, 4 * q + i });
      }
    }
    std::sort(edges_.begin(), edges_.end());
  }

  /// 4 q + i: the edge of quad q from its corner i on.
  Index edge(Index from, Index to) const
  {
    const auto found =
      std::lower_bound(edges_.begin(), edges_.end(), std::pair(std::pair(from, to), Index{ 0 }));
    return found != edges_.end() && found->first == std::pair(from, to) ? found->second
                                                                        : kInvalidIndex;
  }

  Index corner(Index q, Index i) const { return given_.quads[q][i % 4]; }

  void pair(Index a, Index b)
  {
    const bool isNew = image_[a] == kInvalidIndex && image_[b] == kInvalidIndex;
    crowded_ = isNew || image_[a] == b ? crowded_ : a;
    image_[a] = b;
    image_[b] = a;
  }

  /// The quads across the plane, and the points at their corners.
  void pairAcross()
  {
    for (Index q = 0; q < given_.quads.size(); ++q)
    {
      const std::array<Index, 4>& quad = given_.quads[q];
      const std::size_t front = frontCorners(quad);
      if (front == 0 || front == 4)
      {
        continue;
      }
      Index i = 0;
      while (i < 4 && !(isFront(quad[i]) && isFront(corner(q, i + 1)) && front == 2))
      {
        ++i;
      }
      if (i == 4)
      {
        crowded_ = quad[0];
        continue;
      }
      pair(quad[i], corner(q, i + 3));
      pair(corner(q, i + 1), corner(q, i + 2));
      imageOfQuad_[q] = q;
      const Index inside = edge(corner(q, i + 1), quad[i]);
      if (inside != kInvalidIndex)
      {
        next_.push_back(inside);
      }
    }
  }

  /// From edges of quads in front whose ends have images.
  void spread()
  {
    while (!next_.empty())
    {
      const Index at = next_.back();
      next_.pop_back();
      const Index q = at / 4;
      if (imageOfQuad_[q] != kInvalidIndex)
      {
        continue;
      }
      const Index a = corner(q, at), b = corner(q, at + 1);
      const Index other = edge(image_[b], image_[a]);
      if (other == kInvalidIndex || imageOfQuad_[other / 4] != kInvalidIndex || !isFront(a))
      {
        crowded_ = a;
        continue;
      }
      imageOfQuad_[q] = other / 4;
      imageOfQuad_[other / 4] = q;
      pair(corner(q, at + 3), corner(other / 4, other + 2));
      pair(corner(q, at + 2), corner(other / 4, other + 3));
      for (Index i = 1; i < 4; ++i)
      {
        const Index across = edge(corner(q, at + i + 1), corner(q, at + i));
        if (across != kInvalidIndex)
        {
          next_.push_back(across);
        }
      }
    }
  }

  /// Components without a part in the plane: a quad in front and the nearest one that may be its image begin.
  void pairRest()
  {
    for (Index q = 0; q < given_.quads.size() && crowded_ == kInvalidIndex; ++q)
    {
      if (imageOfQuad_[q] != kInvalidIndex || frontCorners(given_.quads[q]) != 4)
      {
        continue;
      }
      std::array<Vector3, 4> images;
      for (Index i = 0; i < 4; ++i)
      {
        images[i] = plane_.image(given_.points[corner(q, i)]);
      }
      double nearest = std::numeric_limits<double>::infinity();
      Index best = kInvalidIndex;
      for (Index other = 0; other < given_.quads.size(); ++other)
      {
        for (Index i = 0; i < 4 && imageOfQuad_[other] == kInvalidIndex; ++i)
        {
          double sum = 0;
          for (Index k = 0; k < 4; ++k)
          {
            sum += (given_.points[corner(other, i + 4 - k)] - images[k]).squaredNorm();
          }
          if (sum < nearest && frontCorners(given_.quads[other]) == 0)
          {
            nearest = sum;
            best = 4 * other + i;
          }
        }
      }
      if (best == kInvalidIndex)
      {
        return;
      }
      pair(corner(q, 0), corner(best / 4, best));
      pair(corner(q, 1), corner(best / 4, best + 3));
      next_.push_back(4 * q);
      spread();
    }
  }

  Index unpaired() const
  {
    for (const std::array<Index, 4>& quad : given_.quads)
    {
      for (const Index p : quad)
      {
        if (image_[p] == kInvalidIndex)
        {
          return p;
        }
      }
    }
    const auto none = std::find(imageOfQuad_.begin(), imageOfQuad_.end(), kInvalidIndex);
    return none == imageOfQuad_.end()
      ? kInvalidIndex
      : given_.quads[static_cast<std::size_t>(none - imageOfQuad_.begin())][0];
  }

  /// Points in front in their order, then their images in the same.
  void number(DoubledQuads& result)
  {
    number_.assign(image_.size(), kInvalidIndex);
    for (Index p = 0; p < image_.size(); ++p)
    {
      if (isFront(p))
      {
        number_[p] = result.halfPoints++;
        old_.push_back(p);
      }
    }
    for (Index p = 0; p < result.halfPoints; ++p)
    {
      number_[image_[old_[p]]] = result.halfPoints + p;
      result.image.push_back(result.halfPoints + p);
    }
    for (Index p = 0; p < result.halfPoints; ++p)
    {
      result.image.push_back(p);
    }
  }

  void takePoints(DoubledQuads& result) const
  {
    QuadMesh& quads = result.quads;
    for (const Index p : old_)
    {
      quads.points.push_back(given_.points[p]);
      quads.sourceFace.push_back(given_.sourceFace[p]);
      quads.sourceWeights.push_back(given_.sourceWeights[p]);
    }
    for (const Index p : old_)
    {
      quads.points.push_back(plane_.image(given_.points[p]));
      quads.sourceFace.push_back(doubled_.halfFaces + given_.sourceFace[p]);
      quads.sourceWeights.push_back(imageWeights(given_.sourceWeights[p]));
    }
  }

  void takeQuads(DoubledQuads& result) const
  {
    QuadMesh& quads = result.quads;
    const auto take = [&](Index q)
    {
      std::array<Index, 4> quad = given_.quads[q];
      for (Index& p : quad)
      {
        p = number_[p];
      }
      quads.quads.push_back(quad);
      quads.quadSourceFace.push_back(given_.quadSourceFace[q]);
      quads.quadSourceWeights.push_back(given_.quadSourceWeights[q]);
    };
    for (Index q = 0; q < given_.quads.size(); ++q)
    {
      if (frontCorners(given_.quads[q]) == 4)
      {
        take(q);
      }
    }
    result.halfQuads = static_cast<Index>(quads.quads.size());
    for (Index q = 0; q < result.halfQuads; ++q)
    {
      const std::array<Index, 4> quad = quads.quads[q];
      const std::vector<Index>& image = result.image;
      quads.quads.push_back({ image[quad[0]], image[quad[3]], image[quad[2]], image[quad[1]] });
      quads.quadSourceFace.push_back(doubled_.halfFaces + quads.quadSourceFace[q]);
      quads.quadSourceWeights.push_back(imageWeights(quads.quadSourceWeights[q]));
    }
    for (Index q = 0; q < given_.quads.size(); ++q)
    {
      if (imageOfQuad_[q] == q)
      {
        take(q);
      }
    }
    const Index crowded = countEdges(quads);
    if (crowded != kInvalidIndex)
    {
      result.status = { StatusCode::NotConverged,
        "the half in front of the mirror plane is two quads wide from plane to plane near " +
          placeText(quads.points[crowded]) +
          ", so that the quads across it would be the same: it needs more quads" };
    }
  }

  void takeLines(DoubledQuads& result) const
  {
    std::vector<QuadLine> images;
    for (QuadLine line : given_.lines)
    {
      const bool front = isFront(line.a), other = isFront(line.b);
      if (!front && !other)
      {
        continue;
      }
      line.a = number_[line.a];
      line.b = number_[line.b];
      result.quads.lines.push_back(line);
      if (front && other)
      {
        images.push_back({ result.image[line.b], result.image[line.a],
          3 * doubled_.halfFaces + reversedEdge(line.halfEdge), line.boundary });
      }
    }
    result.quads.lines.insert(result.quads.lines.end(), images.begin(), images.end());
  }

  static std::array<double, 3> imageWeights(const std::array<double, 3>& weights)
  {
    return { weights[0], weights[2], weights[1] };
  }

  const QuadMesh& given_;
  const DoubledMesh& doubled_;
  const MirrorPlane& plane_;
  std::vector<std::pair<std::pair<Index, Index>, Index>> edges_;
  std::vector<Index> image_, imageOfQuad_; ///< per point, per quad
  std::vector<Index> next_;                ///< edges of quads in front
  std::vector<Index> number_, old_;        ///< of points
  Index crowded_ = kInvalidIndex;          ///< a point with two images
};

} // namespace

void askMidLine(MirrorHalf& half, const MirrorPlane& plane, double tolerance)
{
  SurfaceInput& input = half.input;
  const PlaneBoundary boundary(half, plane, tolerance);
  const std::vector<Index> features = boundary.featuresAt();
  const auto& points = input.points;
  for (const std::vector<Index>& chain : boundary.chains())
  {
    const Index from = boundary.from(chain.front()), to = boundary.to(chain.back());
    const bool closed = from == to;
    for (const Index edge : chain)
    {
      for (const Index p : { boundary.from(edge), boundary.to(edge) })
      {
        const bool isEnd = !closed && (p == from || p == to);
        if (features[p] > (isEnd ? 0U : 1U))
        {
          throw InvalidInput(
            std::string(isEnd ? "a feature meets the boundary" : "several features meet") +
            " in the mirror plane, at " + placeText(points[p]) +
            ", where a mid-line of quads has no point: choose an isoline for the plane's curve, or "
            "leave one of these features out");
        }
      }
    }
    const Index middle = chain[chain.size() / 2];
    const Vector3 via =
      chain.size() == 1 ? Vector3((points[from] + points[to]) / 2) : points[boundary.from(middle)];
    input.straight.push_back({ points[from], via, points[to], -plane.normal });
  }
}

std::vector<Index> featuresInPlane(const Mesh& mesh, const MirrorPlane& plane, double tolerance)
{
  std::vector<double> heights;
  heights.reserve(mesh.position.size());
  for (const Vector3& p : mesh.position)
  {
    heights.push_back(plane.height(p));
  }
  std::vector<Index> features;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (!mesh.isFeature(h) || mesh.isBoundary(h) || h > mesh.twin[h])
    {
      continue;
    }
    const double here = heights[mesh.target(Mesh::next(h))];
    const double across = heights[mesh.target(Mesh::next(mesh.twin[h]))];
    const bool inPlane = std::abs(heights[mesh.origin[h]]) <= tolerance &&
      std::abs(heights[mesh.target(h)]) <= tolerance;
    if (inPlane && std::min(here, across) < -tolerance && std::max(here, across) > tolerance)
    {
      features.push_back(h);
    }
  }
  return features;
}

double midLineLength(const MirrorHalf& half, const MirrorPlane& plane, double tolerance)
{
  const SurfaceInput& input = half.input;
  const PlaneBoundary boundary(half, plane, tolerance);
  double length = 0;
  for (const Index edge : boundary.edges())
  {
    const Index a = boundary.from(edge), b = boundary.to(edge);
    const double size =
      input.sizing.empty() ? 1 : (double{ input.sizing[a] } + double{ input.sizing[b] }) / 2;
    length += (input.points[a] - input.points[b]).norm() / size;
  }
  return length;
}

Status insetPlane(const PreparedSurface& half, const DoubledMesh& doubled,
  const std::vector<int>& turns, const std::vector<Index>& onFeatures,
  const MidLineOptions& options, std::vector<FixedVec2>& uv)
{
  const Mesh& mesh = half.mesh;
  if (std::find(doubled.isGlued.begin(), doubled.isGlued.end(), 1) == doubled.isGlued.end())
  {
    return {};
  }
  Status straight = checkStraight(mesh, doubled, turns);
  if (!straight.ok())
  {
    return straight;
  }
  std::vector<std::uint8_t> fixed = irregularOf(mesh, turns);
  for (const Index v : onFeatures)
  {
    fixed[v] = 1;
  }
  for (double rows = kRows;; rows /= 2)
  {
    const bool isNarrower = rows < kRows;
    countTry(Try::NarrowerBand, isNarrower ? 1 : 0);
    const Band band = BandBuilder(mesh, doubled.isGlued, uv, rows).build();
    RelaxOptions relax;
    relax.maximumBytes = options.maximumBytes;
    relax.guides = guidesIn(band, half, options.threads);
    relax.threads = options.threads;
    relax.progress = options.progress;
    std::vector<FixedVec2> bandUv;
    for (const Index f : band.face)
    {
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        relax.inset.push_back(doubled.isGlued[h]);
        bandUv.push_back(uv[h]);
      }
    }
    std::vector<std::uint8_t> bandFixed = band.isCut;
    for (std::size_t v = 0; v < bandFixed.size(); ++v)
    {
      bandFixed[v] |= fixed[band.vertex[v]];
    }
    const RelaxResult relaxed = relaxMap(band.mesh, bandFixed, relax, bandUv);
    if (relaxed.status.code == StatusCode::TooLarge && rows > kLeastRows)
    {
      continue;
    }
    countTryLed(Try::NarrowerBand, isNarrower && relaxed.status.ok() ? 1 : 0);
    for (std::size_t h = 0; h < bandUv.size() && relaxed.status.ok(); ++h)
    {
      uv[3 * std::size_t{ band.face[h / 3] } + h % 3] = bandUv[h];
    }
    return relaxed.status;
  }
}

DoubledQuads foldQuads(
  const QuadMesh& extracted, const DoubledMesh& doubled, const MirrorPlane& plane)
{
  return QuadFolding(extracted, doubled, plane).run();
}

} // namespace quadrille
