// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/MidLine.h"

#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "GridMap/Certificate.h"
#include "GridMap/RelaxMap.h"
#include "Mesh/SurfaceParts.h"
#include "Mesh/Topology.h"
#include "Requests/Guides.h"
#include "Symmetry/CutBorder.h"
#include "Symmetry/SymmetryRun.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

namespace quadrille
{

namespace
{

/// Rows of quads beside the plane that move along.
constexpr double kRows = 8;

/// Inside the parts in the plane two turns, one at their ends: then they can move by half a quad.
Status checkStraight(
  const Mesh& mesh, const std::vector<std::uint8_t>& isGlued, const std::vector<int>& turns)
{
  std::vector<std::uint8_t> ends(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (isGlued[h] != 0)
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
        "choose an isoline for the plane's curve: the map of the half in front of the mirror plane "
        "has a corner in the plane, at " +
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
    : mesh_(mesh), rows_(rows), distance_(mesh.vertexCount(), kInfinity)
  {
    walk(isGlued, uv);
  }

  Band build() const
  {
    Band band;
    band.face = idsWhere(mesh_.faceCount(), [this](Index f) { return isInside(f); });
    TrianglesOfMesh part = partOf(mesh_, band.face);
    band.mesh = std::move(part.mesh);
    band.vertex = std::move(part.vertices);
    for (Index h = 0; h < band.mesh.halfEdgeCount(); ++h)
    {
      band.mesh.flags.edit()[h] = mesh_.flags[3 * band.face[h / 3] + h % 3];
    }
    std::vector<std::uint8_t> isBeside(mesh_.vertexCount(), 0); // a face outside
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      isBeside[mesh_.origin[h]] |= isInside(Mesh::face(h)) ? 0 : 1;
    }
    for (const Index v : band.vertex)
    {
      band.isCut.push_back(isBeside[v]);
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
      forEachInFan(mesh_, outgoing[v],
        [&, from = distance](Index h)
        {
          const Index last = Mesh::previous(h);
          reach(mesh_.target(h), from + toDouble(uv[Mesh::next(h)] - uv[h]).norm());
          reach(mesh_.origin[last], from + toDouble(uv[last] - uv[h]).norm());
        });
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

/// Half-edges, one of each edge, of the features of a surface that lie in the plane between its two sides. Ascending.
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

/// The half's map (#H, changed in place) with its boundary in the plane half a quad inside.
Status insetPlane(const RemeshResult& half, const std::vector<std::uint8_t>& isGlued,
  const RemeshOptions& options, std::vector<FixedVec2>& uv)
{
  const Mesh& mesh = half.surface.mesh;
  if (std::find(isGlued.begin(), isGlued.end(), 1) == isGlued.end())
  {
    return {};
  }
  Status straight = checkStraight(mesh, isGlued, half.turns);
  if (!straight.ok())
  {
    return straight;
  }
  std::vector<std::uint8_t> fixed = irregularOf(mesh, half.turns);
  for (const SectorRequest& request : half.onFeatures)
  {
    fixed[request.vertex] = 1;
  }
  for (double rows = kRows;; rows /= 2)
  {
    const bool isNarrower = rows < kRows;
    countTry(Try::NarrowerBand, isNarrower ? 1 : 0);
    const Band band = BandBuilder(mesh, isGlued, uv, rows).build();
    RelaxOptions relax;
    relax.maximumBytes = options.memoryLimit.value_or(freeMemory());
    relax.guides = guidesIn(band, half.surface, options.threads);
    relax.threads = options.threads;
    relax.progress = subProgress(options.progress, 0.95, 0.97);
    std::vector<FixedVec2> bandUv;
    for (const Index f : band.face)
    {
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        relax.inset.push_back(isGlued[h]);
        bandUv.push_back(uv[h]);
      }
    }
    std::vector<std::uint8_t> bandFixed = band.isCut;
    for (std::size_t v = 0; v < bandFixed.size(); ++v)
    {
      bandFixed[v] |= fixed[band.vertex[v]];
    }
    const RelaxResult relaxed = relaxMap(band.mesh, bandFixed, relax, bandUv);
    if (relaxed.status.code == StatusCode::TooLarge && rows > 1) // half as many are tried
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

} // namespace

void askMidLine(SurfacePart& half, double tolerance)
{
  const Mesh mesh = connectTriangles(half.input);
  const std::vector<std::uint8_t> inPlane = edgesInPlane(mesh, half.planes.front(), tolerance);
  std::vector<Index> features(mesh.vertexCount(), 0); // inside, that end there
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    features[mesh.origin[h]] += mesh.isFeature(h) && !mesh.isBoundary(h) ? 1 : 0;
  }
  for (const BorderChain& chain : borderChains(mesh, inPlane))
  {
    const std::size_t count = chain.edges.size();
    const Index from = chain.vertex(mesh, 0), to = mesh.target(chain.edges.back());
    for (std::size_t i = 0; i <= count; ++i)
    {
      const Index p = i < count ? chain.vertex(mesh, i) : to;
      const bool isEnd = from != to && (p == from || p == to);
      if (features[p] > (isEnd ? 0U : 1U))
      {
        throw InvalidInput(
          std::string(isEnd ? "a feature meets the boundary" : "several features meet") +
          " in the mirror plane, at " + placeText(mesh.position[p]) +
          ", where a mid-line of quads has no point: choose an isoline for the plane's curve, or "
          "leave one of these features out");
      }
    }
    const Vector3& start = mesh.position[from];
    const Vector3& end = mesh.position[to];
    const Vector3 via = count == 1 ? Vector3((start + end) / 2) : chain.place(mesh, count / 2);
    half.input.straight.push_back({ start, via, end, -half.planes.front().normal });
  }
}

double midLineLength(const SurfacePart& half, double tolerance)
{
  const std::vector<float>& sizing = half.input.sizing;
  const Mesh mesh = connectTriangles(half.input);
  const std::vector<std::uint8_t> inPlane = edgesInPlane(mesh, half.planes.front(), tolerance);
  double length = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (inPlane[h] != 0)
    {
      const Index a = mesh.origin[h], b = mesh.target(h);
      const double size = sizing.empty() ? 1 : (double{ sizing[a] } + double{ sizing[b] }) / 2;
      length += (mesh.position[a] - mesh.position[b]).norm() / size;
    }
  }
  return length;
}

std::vector<GivenUpCurve> giveUpInPlane(Mesh& mesh, const MirrorPlane& plane, double tolerance,
  double edgeLength, std::vector<std::string>& notices)
{
  const std::vector<Index> inPlane = featuresInPlane(mesh, plane, tolerance);
  for (const Index h : inPlane)
  {
    for (const Index side : { h, mesh.twin[h] })
    {
      mesh.flags.edit()[side] &= static_cast<std::uint8_t>(~(kFeatureEdge | kRequestedFeature));
    }
  }
  std::vector<GivenUpCurve> givenUp =
    givenUpCurves(mesh, inPlane, edgeLength, FeatureLoss::MidLine);
  if (givenUp.empty())
  {
    return givenUp;
  }
  double length = 0;
  for (const GivenUpCurve& curve : givenUp)
  {
    length += curve.length;
  }
  const auto longest = std::max_element(givenUp.begin(), givenUp.end(),
    [](const GivenUpCurve& a, const GivenUpCurve& b) { return a.length < b.length; });
  notices.push_back("features of the length " + shareText(length) +
    " lie in the mirror plane, which quads straddle, and are not followed; the longest one, of " +
    shareText(longest->lengthInQuads) + " edge lengths, is near " + placeText(longest->place) +
    ": choose an isoline for the plane's curve to keep them");
  return givenUp;
}

std::vector<std::uint8_t> irregularOf(const Mesh& mesh, const std::vector<int>& turns)
{
  const std::vector<int> regular = regularTurns(mesh);
  std::vector<std::uint8_t> irregular(regular.size(), 0);
  for (std::size_t v = 0; v < regular.size(); ++v)
  {
    irregular[v] = turns[v] != regular[v] ? 1 : 0;
  }
  return irregular;
}

CopiedQuads quadsAcross(
  const RemeshResult& half, const RemeshOptions& options, const Isometry& mirror, CopiedMesh& whole)
{
  CopiedQuads failed;
  std::vector<FixedVec2> uv = half.uv;
  failed.status = insetPlane(half, whole.isGlued, options, uv);
  if (!failed.status.ok())
  {
    return failed;
  }
  whole.uv = copyMap(whole, mirror, std::move(uv));
  const Certificate& before = half.certificate;
  const Certificate after = certify(
    whole.mesh, whole.uv, whole.turns, irregularOf(whole.mesh, whole.turns), options.threads);
  if (after.notPositive > 2 * before.notPositive || after.wrongTurns > 2 * before.wrongTurns ||
    !after.whole())
  {
    failed.status = { StatusCode::NotConverged,
      "the map with a mid-line in the mirror plane is no integer-grid map: " + after.text() };
    return failed;
  }
  ExtractionOptions extraction;
  extraction.maximumNumberOfQuads = options.maximumNumberOfQuads;
  extraction.smoothingSteps = options.smoothingSteps;
  extraction.replacesBad = false; // on both sides alike
  extraction.fixedVertices = heldIndexVertices(half.surface);
  for (const Index v : heldIndexVertices(half.surface))
  {
    extraction.fixedVertices.push_back(whole.image[v]);
  }
  std::sort(extraction.fixedVertices.begin(), extraction.fixedVertices.end());
  extraction.mapIsCertified = after.valid();
  extraction.threads = options.threads;
  extraction.progress = subProgress(options.progress, 0.97, 0.98);
  const ExtractionResult extracted = extractQuads(whole.mesh, whole.uv, extraction);
  if (!extracted.status.ok())
  {
    failed.status = { extracted.status.code,
      "no quads across the mirror plane: " + extracted.status.message };
    return failed;
  }
  return foldQuads(extracted.mesh, whole, mirror);
}

} // namespace quadrille
