// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Sizes/AdaptiveSizing.h"

#include "Base/Angles.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Sizes/OppositeSheets.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadrille
{
namespace
{

/// Of an edge length: radius over which curvatures are averaged. A disk of that radius is one edge wide.
constexpr double kCurvatureRadius = 0.5;
constexpr double kMetTolerance = 1.05;
/// Of a bisection for the edge length, and for the factor of the lengths.
constexpr double kLengthTolerance = 1 + 1e-4;
constexpr double kMostFactor = 1e4;
/// The share of the area that may be held at the smallest size before lengths are multiplied instead.
constexpr double kMostStopped = 0.05;
/// Of lengths, by their logarithm: each is less than a hundredth wide for lengths from 1 to 10^8.
constexpr std::size_t kLengthBins = 4096;

/// The smallest value of the patches round each vertex.
std::vector<float> toVertices(
  const Mesh& mesh, const SurfacePatches& patches, const std::vector<float>& ofPatch)
{
  std::vector<float> result(mesh.vertexCount(), kInfinityOfSingle);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    float& value = result[mesh.origin[h]];
    value = std::min(value, ofPatch[patches.patchOf[Mesh::face(h)]]);
  }
  return result;
}

/// #V: the largest curvature that the vertex has in one of its faces, or along a feature or boundary there.
std::vector<double> vertexCurvatures(const Mesh& mesh, const SurfacePatches& patches,
  const CornerCurvatures& known, double edgeLength, int threads)
{
  const std::vector<PatchCurvature> estimated =
    patchCurvatures(mesh, patches, kCurvatureRadius * edgeLength, threads);
  std::vector<double> result(mesh.vertexCount(), 0);
  const auto raise = [&](Index v, double value) { result[v] = std::max(result[v], value); };
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    const PatchCurvature& patch = estimated[patches.patchOf[Mesh::face(h)]];
    if (!known.isKnownAt(h))
    {
      raise(mesh.origin[h], std::max(std::abs(patch.largest), patch.curve));
      continue;
    }
    raise(mesh.origin[h], known.atCorner[h]);
    if (mesh.isConstrained(h))
    {
      const double curve = std::isnan(known.along[h]) ? patch.curve : double{ known.along[h] };
      raise(mesh.origin[h], curve);
      raise(mesh.target(h), curve);
    }
  }
  return result;
}

/// The smaller one of what chord error and turn allow.
float lengthByCurvature(double curvature, const AdaptiveSizes& sizes)
{
  if (!(curvature > 0))
  {
    return kInfinityOfSingle;
  }
  const double byChord =
    sizes.chordError ? std::sqrt(8 * *sizes.chordError / curvature) : double{ kInfinityOfSingle };
  const double byTurn = sizes.turn ? *sizes.turn / curvature : double{ kInfinityOfSingle };
  return static_cast<float>(std::min(byChord, byTurn));
}

std::vector<float> patchLengthsByGap(
  const Mesh& mesh, const SurfacePatches& patches, double quads, double reach, int threads)
{
  std::vector<float> lengths = distancesToOpposite(mesh, patches, reach, threads);
  for (float& length : lengths)
  {
    length = static_cast<float>(length / quads);
  }
  return lengths;
}

double adaptedSize(float asked, float length, const AdaptiveSizes& sizes, double edgeLength)
{
  return std::min(double{ asked }, std::clamp(length / edgeLength, sizes.smallest, sizes.largest));
}

/// A third of the area of the faces at each vertex.
std::vector<double> vertexAreas(const Mesh& mesh)
{
  std::vector<double> areas(mesh.vertexCount(), 0);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    const double third = mesh.doubleAreaNormal(f).norm() / 6;
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      areas[mesh.origin[h]] += third;
    }
  }
  return areas;
}

/// How many quads the lengths make, and where the smallest size stops them.
class Distribution
{
public:
  Distribution(const Mesh& mesh, const std::vector<float>& asked, const std::vector<float>& lengths,
    const AdaptiveSizes& sizes)
    : sizes_(sizes)
  {
    const std::vector<double> areas = vertexAreas(mesh);
    for (const double area : areas)
    {
      area_ += area;
    }
    if (asked.empty())
    {
      addBins(areas, lengths);
      return;
    }
    for (std::size_t v = 0; v < areas.size(); ++v)
    {
      entries_.push_back({ areas[v], lengths[v], asked[v] });
    }
  }

  /// The longer s is, the fewer quads there are: each size times s grows with it, or stays. So s follows by bisection.
  double edgeLength(double factor, double quads) const
  {
    double low = std::sqrt(area_ / quads), high = low;
    while (quadsOf(factor, high) > quads)
    {
      high *= 2;
    }
    while (quadsOf(factor, low) < quads)
    {
      low /= 2;
    }
    while (high > kLengthTolerance * low)
    {
      const double middle = (low + high) / 2;
      (quadsOf(factor, middle) > quads ? low : high) = middle;
    }
    return high;
  }

  /// The share of the area whose lengths are below the smallest size.
  double stoppedShare(double factor, double edgeLength) const
  {
    double stopped = 0;
    for (const Entry& entry : entries_)
    {
      const bool isBelow =
        factor * entry.length < (1 - kRoundingOfSingle) * sizes_.smallest * edgeLength;
      stopped += isBelow ? entry.area : 0;
    }
    return stopped / area_;
  }

private:
  struct Entry
  {
    double area = 0;
    float length = kInfinityOfSingle;
    float asked = kInfinityOfSingle;
  };

  /// Millions of vertices are few different lengths.
  void addBins(const std::vector<double>& areas, const std::vector<float>& lengths)
  {
    float least = kInfinityOfSingle, most = 0;
    for (const float length : lengths)
    {
      least = std::min(least, length);
      most = length < kInfinityOfSingle ? std::max(most, length) : most;
    }
    const double scale =
      most > least ? kLengthBins / std::log(double{ most } / double{ least }) : 0;
    std::vector<double> area(kLengthBins + 1, 0), sum(kLengthBins + 1, 0);
    double withoutLength = 0;
    for (std::size_t v = 0; v < lengths.size(); ++v)
    {
      if (!(lengths[v] < kInfinityOfSingle))
      {
        withoutLength += areas[v];
        continue;
      }
      const auto bin = static_cast<std::size_t>(scale * std::log(double{ lengths[v] } / least));
      area[std::min<std::size_t>(bin, kLengthBins)] += areas[v];
      sum[std::min<std::size_t>(bin, kLengthBins)] += areas[v] * lengths[v];
    }
    for (std::size_t bin = 0; bin <= kLengthBins; ++bin)
    {
      if (area[bin] > 0)
      {
        entries_.push_back(
          { area[bin], static_cast<float>(sum[bin] / area[bin]), kInfinityOfSingle });
      }
    }
    entries_.push_back({ withoutLength, kInfinityOfSingle, kInfinityOfSingle });
  }

  double quadsOf(double factor, double edgeLength) const
  {
    double sum = 0;
    for (const Entry& entry : entries_)
    {
      const double length = edgeLength *
        adaptedSize(entry.asked, static_cast<float>(factor * entry.length), sizes_, edgeLength);
      sum += entry.area / (length * length);
    }
    return sum;
  }

  const AdaptiveSizes& sizes_;
  std::vector<Entry> entries_;
  double area_ = 0;
};

} // namespace

void checkAdaptiveSizes(const AdaptiveSizes& sizes)
{
  refuseIf(sizes.chordError && !(*sizes.chordError > 0 && std::isfinite(*sizes.chordError)),
    "the chord error must be a positive number");
  refuseIf(sizes.turn && !(*sizes.turn > 0 && *sizes.turn <= kPi),
    "the angle a quad must be above 0 and at most 180 degrees");
  refuseIf(!(sizes.gapQuads >= 0 && std::isfinite(sizes.gapQuads)),
    "the number of quads across a gap must be 0 or a positive number");
  refuseIf(!(sizes.smallest > 0 && sizes.smallest <= 1),
    "the smallest size must be above 0 and at most 1");
  refuseIf(!(sizes.largest >= 1 && std::isfinite(sizes.largest)),
    "the largest size must be a number from 1 on");
}

std::vector<float> adaptiveLengths(const Mesh& mesh, const AdaptiveSizes& sizes, double edgeLength,
  double reach, int threads, const CornerCurvatures& known)
{
  const SurfacePatches patches = findPatches(mesh, kCurvatureRadius / 2 * edgeLength, threads);
  std::vector<float> lengths(mesh.vertexCount(), kInfinityOfSingle);
  if (sizes.gapQuads > 0)
  {
    lengths = toVertices(mesh, patches,
      patchLengthsByGap(
        mesh, patches, sizes.gapQuads, sizes.gapQuads * reach * edgeLength, threads));
  }
  if (sizes.byCurvature())
  {
    const std::vector<double> curvatures =
      vertexCurvatures(mesh, patches, known, edgeLength, threads);
    for (std::size_t v = 0; v < lengths.size(); ++v)
    {
      lengths[v] = std::min(lengths[v], lengthByCurvature(curvatures[v], sizes));
    }
  }
  return lengths;
}

void setAdaptiveSizes(Mesh& mesh, const std::vector<float>& asked,
  const std::vector<float>& lengths, const AdaptiveSizes& sizes, double edgeLength)
{
  mesh.sizing.resize(mesh.vertexCount());
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    mesh.sizing.edit()[v] = static_cast<float>(
      adaptedSize(asked.empty() ? kInfinityOfSingle : asked[v], lengths[v], sizes, edgeLength));
  }
}

DistributedSizes distributeSizes(const Mesh& mesh, const std::vector<float>& asked,
  const std::vector<float>& lengths, const AdaptiveSizes& sizes, double quads)
{
  const Distribution distribution(mesh, asked, lengths, sizes);
  DistributedSizes result;
  result.edgeLength = distribution.edgeLength(1, quads);
  if (distribution.stoppedShare(1, result.edgeLength) <= kMostStopped)
  {
    return result;
  }
  double low = 1, high = 2;
  while (high < kMostFactor &&
    distribution.stoppedShare(high, distribution.edgeLength(high, quads)) > kMostStopped)
  {
    low = high;
    high *= 2;
  }
  while (high > kLengthTolerance * low)
  {
    const double middle = std::sqrt(low * high);
    const bool isEnough =
      distribution.stoppedShare(middle, distribution.edgeLength(middle, quads)) <= kMostStopped;
    (isEnough ? high : low) = middle;
  }
  result.lengthFactor = high;
  result.edgeLength = distribution.edgeLength(high, quads);
  return result;
}

double shareOfLengthsMet(const Mesh& mesh, const std::vector<float>& lengths, double edgeLength)
{
  const std::vector<double> areas = vertexAreas(mesh);
  double area = 0, met = 0;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    area += areas[v];
    met += edgeLength * double{ mesh.sizing[v] } <= kMetTolerance * lengths[v] ? areas[v] : 0;
  }
  return area > 0 ? met / area : 1;
}

} // namespace quadrille
