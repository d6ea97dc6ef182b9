// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/Refine.h"

#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Mesh/ComponentSizes.h"
#include "Mesh/ContentHash.h"
#include "Mesh/Sizing.h"
#include "Mesh/SpaceFillingOrder.h"
#include "Mesh/SurfaceEdit.h"
#include "Mesh/Topology.h"
#include "Prepare/FlatFlips.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

namespace quadrille
{

namespace
{

/// Of a large surface so few new faces stay at its end: where they lie costs nothing then, and to order it anew does.
constexpr Index kLargeSurface = Index{ 1 } << 18;
constexpr Index kFewAmong = 256;

struct LongEdge
{
  double squaredLength;
  Index halfEdge;

  bool operator<(const LongEdge& other) const
  {
    return squaredLength != other.squaredLength ? squaredLength < other.squaredLength
                                                : halfEdge > other.halfEdge;
  }
};

/// Long edges, longest first, as one heap would have them: in buckets by length, of which only the topmost is a heap,
/// so that a push into a million others writes one place.
class LongEdgeBuckets
{
public:
  explicit LongEdgeBuckets(double squaredLimit) : limit_(squaredLimit), buckets_(kLengthBuckets) {}

  void push(const LongEdge& edge)
  {
    const std::size_t bucket = bucketOf(edge.squaredLength);
    if (bucket >= current_)
    {
      top_.push(edge);
    }
    else
    {
      buckets_[bucket].push_back(edge);
    }
  }
  /// Whether there is one; it is in `edge` then.
  bool pop(LongEdge& edge)
  {
    while (top_.empty() && current_ > 0)
    {
      --current_;
      top_ = std::priority_queue<LongEdge>(std::less<LongEdge>(), std::move(buckets_[current_]));
      buckets_[current_] = {};
    }
    if (top_.empty())
    {
      return false;
    }
    edge = top_.top();
    top_.pop();
    return true;
  }

private:
  /// 32 buckets for each power of two of the squared length over the limit, by the bits of the ratio.
  static constexpr int kRatioShift = 23 - 5;
  static constexpr std::size_t kLengthBuckets = 2048;

  std::size_t bucketOf(double squaredLength) const
  {
    const float ratio = static_cast<float>(squaredLength / limit_);
    std::uint32_t bits = 0, one = 0;
    constexpr float kUnitRatio = 1;
    std::memcpy(&bits, &ratio, sizeof(bits));
    std::memcpy(&one, &kUnitRatio, sizeof(one));
    return bits <= one ? 0 : std::min<std::size_t>((bits - one) >> kRatioShift, kLengthBuckets - 1);
  }

  double limit_;
  std::vector<std::vector<LongEdge>> buckets_;
  std::priority_queue<LongEdge> top_;
  std::size_t current_ = kLengthBuckets; ///< those from here on are in top_
};

class LongEdgeQueue
{
public:
  LongEdgeQueue(const PreparedSurface& surface, double maximumLength, int threads)
    : mesh_(surface.mesh), limit_(maximumLength * maximumLength), faces_(mesh_.faceCount()),
      queue_(limit_)
  {
    findScales(surface, maximumLength, threads);
    const auto longEdges = parallelGather<LongEdge>(faces_, kLightChunk, threads,
      [&](Index f, std::vector<LongEdge>& found)
      {
        const std::array<double, 3> lengths = squaredLengths(f);
        for (Index i = 0; i < 3; ++i)
        {
          // The twin of a boundary half-edge is above all others.
          if (lengths[i] > limit_ && 3 * f + i < mesh_.twin[3 * f + i])
          {
            found.push_back({ lengths[i], 3 * f + i });
          }
        }
      });
    for (const LongEdge& edge : longEdges)
    {
      queue_.push(edge);
    }
  }

  /// The edges that the split of h made, or gave another name; g: its twin before, or kInvalidIndex.
  void pushSplit(Index h, Index g)
  {
    const Index added = faces_;
    faces_ = mesh_.faceCount();
    if (!scale_.empty())
    {
      scale_.resize(faces_, scale_[Mesh::face(h)]);
    }
    const Index other = 3 * added + h % 3;
    for (const Index k : { h, Mesh::next(h), other, Mesh::next(other) })
    {
      pushEdge(k);
    }
    if (g != kInvalidIndex)
    {
      pushEdge(Mesh::next(g));
      pushEdge(Mesh::next(3 * (added + 1) + g % 3));
    }
  }

  /// An edge that got another name or place.
  void pushChanged(Index h) { pushEdge(h); }

  /// One half-edge of each edge inside, of the faces that have one that is too long.
  std::vector<Index> edgesBesideLong() const
  {
    std::vector<Index> edges;
    for (Index f = 0; f < faces_; ++f)
    {
      const std::array<double, 3> lengths = squaredLengths(f);
      if (*std::max_element(lengths.begin(), lengths.end()) > limit_)
      {
        for (Index h = 3 * f; h < 3 * f + 3; ++h)
        {
          if (!mesh_.isBoundary(h))
          {
            edges.push_back(std::min(h, mesh_.twin[h]));
          }
        }
      }
    }
    sortUnique(edges);
    return edges;
  }

  /// The longest edge; kInvalidIndex when none is too long. Splits rename and shorten half-edges, so what
  /// has not the length it was queued with is old.
  Index pop()
  {
    LongEdge top{};
    while (queue_.pop(top))
    {
      if (squaredLength(top.halfEdge) == top.squaredLength)
      {
        return top.halfEdge;
      }
    }
    return kInvalidIndex;
  }

private:
  void pushEdge(Index h)
  {
    const double length = squaredLength(h);
    if (length > limit_)
    {
      queue_.push({ length, mesh_.isBoundary(h) ? h : std::min(h, mesh_.twin[h]) });
    }
  }

  void findScales(const PreparedSurface& surface, double maximumLength, int threads)
  {
    if (surface.components == 1 && mesh_.sizing.empty() &&
      surface.area > kQuadsOfSmallTriangulation * maximumLength * maximumLength)
    {
      return;
    }
    const ComponentSizes sizes = measureComponents(mesh_, threads);
    const auto scale = [&](Index c) { return triangulationScale(sizes.area[c], maximumLength); };
    std::vector<double> ofComponent;
    bool anySmall = false;
    for (Index c = 0; c < sizes.area.size(); ++c)
    {
      ofComponent.push_back(scale(c) * scale(c));
      anySmall = anySmall || ofComponent.back() < 1;
    }
    for (Index f = 0; f < mesh_.faceCount() && anySmall; ++f)
    {
      scale_.push_back(ofComponent[sizes.componentOfFace[f]]);
    }
  }

  /// Of the three edges of a face.
  std::array<double, 3> squaredLengths(Index f) const
  {
    if (!mesh_.sizing.empty() || !scale_.empty())
    {
      return { squaredLength(3 * f), squaredLength(3 * f + 1), squaredLength(3 * f + 2) };
    }
    const auto [a, b, c] = mesh_.cornersOfFace(f);
    return { (b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm() };
  }

  /// In sizes, the same from both sides.
  double squaredLength(Index h) const
  {
    const double length = mesh_.edgeVector(h).squaredNorm();
    const double sized = mesh_.sizing.empty()
      ? length
      : length / (sizeAt(mesh_, mesh_.origin[h]) * sizeAt(mesh_, mesh_.target(h)));
    return scale_.empty() ? sized : sized / scale_[Mesh::face(h)];
  }

  const Mesh& mesh_;
  double limit_;
  Index faces_;
  std::vector<double> scale_; ///< #F, squared; empty where no component is small
  LongEdgeBuckets queue_;
};

/// Whether features or boundaries are anywhere.
bool anyConstraint(const Mesh& mesh, int threads)
{
  const std::size_t faces = mesh.faceCount();
  return firstRefused(faces, kLightChunk, threads,
           [&](std::size_t f)
           {
             const Index h = static_cast<Index>(3 * f);
             return !mesh.isConstrained(h) && !mesh.isConstrained(h + 1) &&
               !mesh.isConstrained(h + 2);
           }) < faces;
}

/// Faces that refinement may end with: so many for each square of the maximum edge length, and for each input face; a
/// small surface may grow more.
std::size_t faceLimit(const PreparedSurface& surface, double maximumLength)
{
  constexpr double kFacesPerSquare = 20;
  constexpr double kFacesPerFace = 16;
  constexpr double kFacesPerFaceOfSmall = 160;
  constexpr double kSmallEnd = 4e6;
  const double faces = surface.mesh.faceCount();
  const double area = surface.mesh.sizing.empty() ? surface.area : sizedArea(surface.mesh);
  const double growth =
    std::max(kFacesPerFace * faces, std::min(kFacesPerFaceOfSmall * faces, kSmallEnd));
  return static_cast<std::size_t>(
    growth + kFacesPerSquare * area / (maximumLength * maximumLength));
}

/// Faces among the first `count` that had no weights before and have some now.
std::size_t countRefined(
  const PreparedSurface& surface, const std::vector<Index>& entriesBefore, Index count)
{
  std::size_t refined = 0;
  for (Index f = 0; f < count && !surface.refinedEntry.empty(); ++f)
  {
    const bool before = !entriesBefore.empty() && entriesBefore[f] != kInvalidIndex;
    refined += !before && surface.refinedEntry[f] != kInvalidIndex ? 1 : 0;
  }
  return refined;
}

/// Edges inside of two faces, the second of which may be none, and of those that were added from `added` on.
std::vector<Index> edgesOf(const Mesh& mesh, Index f, Index g, Index added)
{
  std::vector<Index> faces{ f };
  if (g != kInvalidIndex)
  {
    faces.push_back(g);
  }
  for (Index other = added; other < mesh.faceCount(); ++other)
  {
    faces.push_back(other);
  }
  std::vector<Index> edges;
  for (const Index face : faces)
  {
    for (Index h = 3 * face; h < 3 * face + 3; ++h)
    {
      if (!mesh.isBoundary(h))
      {
        edges.push_back(h);
      }
    }
  }
  return edges;
}

} // namespace

bool splitLongEdges(PreparedSurface& surface, double maximumLength, std::size_t mostFaces,
  const ProgressCallback& progress, int threads)
{
  const Mesh& mesh = surface.mesh;
  LongEdgeQueue queue(surface, maximumLength, threads);
  const double firstFaces = mesh.faceCount();
  std::size_t splits = 0;
  const std::vector<Index> first = queue.edgesBesideLong();
  FlatFlips flips(surface, first);
  const auto push = [&queue](Index h) { queue.pushChanged(h); };
  flips.flip(first, push);
  bool areAllShort = true;
  for (Index h = queue.pop(); h != kInvalidIndex; h = queue.pop())
  {
    if (mesh.faceCount() + std::size_t{ 2 } > mostFaces)
    {
      areAllShort = false;
      break;
    }
    const Index g = mesh.twin[h];
    const Index added = mesh.faceCount();
    splitEdge(surface, h);
    queue.pushSplit(h, g);
    if (flips.any())
    {
      flips.flip(edgesOf(mesh, Mesh::face(h), g == kInvalidIndex ? g : Mesh::face(g), added), push);
    }
    if (++splits % kLightChunk == 0)
    {
      report(progress, 0.8 * (mesh.faceCount() - firstFaces) / (mostFaces - firstFaces),
        "Splitting long edges");
    }
  }
  flips.finish();
  return areAllShort;
}

void splitEnclosedFaces(PreparedSurface& surface)
{
  const Mesh& mesh = surface.mesh;
  const Index count = mesh.faceCount();
  for (Index f = 0; f < count; ++f)
  {
    pollNowAndThen(f);
    if (mesh.isConstrained(3 * f) && mesh.isConstrained(3 * f + 1) && mesh.isConstrained(3 * f + 2))
    {
      splitFace(surface, f);
    }
  }
}

void splitChords(PreparedSurface& surface)
{
  const Mesh& mesh = surface.mesh;
  const std::vector<std::uint8_t> onConstraint = constrainedVertices(mesh);
  // Vertices made here are on no constraint and have ids past the end of onConstraint.
  const auto isOn = [&](Index v) { return v < onConstraint.size() && onConstraint[v] != 0; };
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    if (!mesh.isConstrained(h) && isOn(mesh.origin[h]) && isOn(mesh.target(h)))
    {
      splitEdge(surface, h); // what it moves comes later in the list, or is seen from its twin
    }
  }
}

void refineSurface(
  PreparedSurface& surface, double maximumEdgeLength, const ProgressCallback& progress, int threads)
{
  refuseIf(!(maximumEdgeLength > 0) || !std::isfinite(maximumEdgeLength),
    "the maximum edge length must be positive and finite.");
  const Index facesBefore = surface.mesh.faceCount();
  const std::vector<Index> entriesBefore = surface.refinedEntry;
  report(progress, 0, "Splitting long edges");
  const std::size_t limit = faceLimit(surface, maximumEdgeLength);
  if (!splitLongEdges(surface, maximumEdgeLength, limit, progress, threads))
  {
    surface.notice = "Refinement stopped at " + std::to_string(limit) +
      " faces with edges longer than " + std::to_string(maximumEdgeLength) +
      " left: the surface has many long thin triangles. Remesh it into better shaped triangles for "
      "better quads.";
  }
  report(progress, 0.8, "Splitting chords between features");
  if (anyConstraint(surface.mesh, threads))
  {
    splitEnclosedFaces(surface);
    splitChords(surface);
  }
  if (surface.mesh.faceCount() != facesBefore)
  {
    surface.repair.refinedFaces += countRefined(surface, entriesBefore, facesBefore);
    report(progress, 0.9, "Ordering the refined surface");
    if (facesBefore < kLargeSurface ||
      surface.mesh.faceCount() - facesBefore > facesBefore / kFewAmong)
    {
      orderSurface(surface, threads);
    }
  }
  surface.hash = contentHash(surface.mesh, threads); // the caller may have changed features before
  report(progress, 1, "Surface refined");
}

} // namespace quadrille
