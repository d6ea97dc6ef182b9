// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/MirrorMidLine.h"

#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "GridMap/RelaxMap.h"
#include "Mesh/Topology.h"
#include "Requests/Guides.h"
#include "Symmetry/CopiedRun.h"
#include "Symmetry/PlaneBoundary.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
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

} // namespace quadrille
