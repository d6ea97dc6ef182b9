// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/GridMap.h"

#include "Base/DisjointSets.h"
#include "Base/Refuse.h"
#include "Base/TryCount.h"
#include "Base/WorkCount.h"
#include "GridMap/FieldOfMap.h"
#include "GridMap/MapShape.h"
#include "Integers/CurveIsolines.h"
#include "Requests/CycleSectors.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

/// Between the guide of a face and the nearer of the two families of isolines, in its plane.
double angleToIsolines(
  const Mesh& mesh, const std::vector<FixedVec2>& uv, Index f, const Vector3& direction)
{
  const Vector3 e1 = mesh.edgeVector(3 * f), e2 = -mesh.edgeVector(3 * f + 2);
  const Vector3 x = e1.stableNormalized();
  const Vector3 y = x.cross(e2).stableNormalized().cross(x);
  Eigen::Matrix2d edges, images;
  edges << e1.dot(x), e2.dot(x), e1.dot(y), e2.dot(y);
  images << toDouble(uv[3 * f + 1] - uv[3 * f]), toDouble(uv[3 * f + 2] - uv[3 * f]);
  const Eigen::Matrix2d gradients = images * edges.inverse();
  const Vector2 guide = Vector2(direction.dot(x), direction.dot(y)).stableNormalized();
  double sine = 1;
  for (Eigen::Index coordinate = 0; coordinate < 2; ++coordinate)
  {
    const Vector2 gradient = gradients.row(coordinate).transpose();
    sine = std::min(sine, std::abs(gradient.stableNormalized().dot(guide)));
  }
  return std::asin(sine);
}

/// Newton steps of the seamless map where other curves, or other ways of theirs, can still be tried: maps that hold
/// take some 20, with strokes 200, those that never hold take 340.
constexpr int kStepsOfTry = 140;
constexpr int kStepsOfFirstTry = 220;
/// How many times the steps of the map without curves that one with curves may need.
constexpr int kStepsOverPlain = 5;

/// A map with as many of the curves as it can have, the earlier ones before the later ones. Where there is no map even
/// without them, it is not they that are in the way.
class CurvedMap
{
public:
  CurvedMap(const Mesh& mesh, const GridMapOptions& options) : mesh_(mesh), options_(options) {}

  GridMapResult run()
  {
    const bool hasCurves = options_.method == MapMethod::ScaleAware &&
      std::any_of(options_.curves.begin(), options_.curves.end(),
        [](const CurveRequest& curve) { return curve.kind == CurveKind::Connection; });
    GridMapResult first = make({ {}, {}, true, hasCurves ? kStepsOfFirstTry : 0 });
    if (!first.status.ok() && hasCycles(options_.curves))
    {
      countTry(Try::BentCycles);
      straightCycles_ = false;
      first = make({ {}, {}, true, hasCurves ? kStepsOfFirstTry : 0 });
      countTryLed(Try::BentCycles, first.status.ok() ? 1 : 0);
    }
    const bool firstHolds = holdsIrregular_;
    if (!hasCurves || (isWhole(first) && countUnfollowed(first) == 0))
    {
      return first;
    }
    // What is left out does not lead the field either.
    std::vector<std::string> leftOut = reasons(first);
    countTry(Try::WithoutCurves);
    GridMapResult plain = make({ leftOut, {}, true, 0 });
    if (!plain.status.ok())
    {
      return finish(first.status.ok() ? std::move(first) : std::move(plain));
    }
    maximumSteps_ = std::max(kStepsOfTry, kStepsOverPlain * plain.seamlessSteps);
    const std::size_t unfollowed = countUnfollowed(plain); // whatever the curves are
    const std::vector<Index> failedAt = first.status.ok() ? first.curvesFailedAt : first.failedAt;
    Ways ways = straightWays(plain, first.curves);
    if (first.status.ok())
    {
      // Its equations have brought the ends nearer to an axis, if only for a way beside the one asked for.
      const Ways bent = straightWays(first, first.curves);
      std::transform(ways.begin(), ways.end(), bent.begin(), ways.begin(),
        [](const auto& way, const auto& other) { return way ? way : other; });
    }
    const bool hasWays =
      std::any_of(ways.begin(), ways.end(), [](const auto& way) { return way.has_value(); });
    GridMapResult best = std::move(first);
    CurveTry bestTry;
    std::vector<CurveTry> tries;
    if (hasWays)
    {
      tries.push_back({ {}, ways, true, maximumSteps_ });
    }
    if (firstHolds)
    {
      tries.push_back({ {}, {}, false, maximumSteps_ });
    }
    if (hasWays)
    {
      tries.push_back({ {}, ways, false, maximumSteps_ });
    }
    for (const CurveTry& howto : tries)
    {
      if (isWhole(best) && countUnfollowed(best) <= unfollowed)
      {
        break;
      }
      countTry(Try::StraightWays);
      GridMapResult other = make(howto);
      if (hasMore(other, best))
      {
        countTryLed(Try::StraightWays);
        best = std::move(other);
        bestTry = howto;
      }
    }
    if (!isWhole(best))
    {
      best = withFewer(std::move(best), std::move(bestTry), std::move(plain), leftOut, ways);
      best.curvesFailedAt = failedAt;
    }
    return finish(std::move(best));
  }

private:
  using Ways = std::vector<std::optional<Isoline>>;

  GridMapResult make(CurveTry howto)
  {
    const WorkScope work;
    howto.straightCycles = straightCycles_;
    TriedMap tried = mapInOneTry(mesh_, options_, howto);
    GridMapResult map = std::move(tried.map);
    map.work = work.done();
    holdsIrregular_ = tried.holdsIrregular;
    taken_.addWork(map);
    return map;
  }

  std::size_t countUnfollowed(const GridMapResult& map) const
  {
    return map.status.ok() ? unfollowedRegions(mesh_, options_.guides, map.uv) : 0;
  }
  std::size_t countMissed(const GridMapResult& map) const
  {
    return countUnmet(map) + countUnfollowed(map);
  }
  /// Of two maps of the same mesh.
  bool hasMore(const GridMapResult& map, const GridMapResult& other) const
  {
    return map.status.ok() && (!other.status.ok() || countMissed(map) < countMissed(other));
  }

  /// Of the connections; cycles are features of the mesh.
  std::size_t countUnmet(const GridMapResult& map) const
  {
    std::size_t count = 0;
    for (std::size_t i = 0; i < map.curves.size(); ++i)
    {
      const bool connects = options_.curves[i].kind == CurveKind::Connection;
      count += connects && !map.curves[i].met ? 1 : 0;
    }
    return count;
  }

  bool isWhole(const GridMapResult& map) const { return map.status.ok() && countUnmet(map) == 0; }

  /// With what all tries have taken.
  GridMapResult finish(GridMapResult map) const
  {
    static_cast<MapWork&>(map) = taken_;
    return map;
  }

  /// Why each curve may be left out.
  std::vector<std::string> reasons(const GridMapResult& map) const
  {
    std::vector<std::string> why;
    for (const CurveOutcome& curve : map.curves)
    {
      why.push_back(!curve.met && !curve.why.empty() ? curve.why
          : map.status.ok()
          ? std::string("no map has it beside the others: move it, or take another one away")
          : "no map without inverted triangles has it beside the others (" + map.status.message +
            ")");
    }
    return why;
  }

  /// Other ways for the connections that have failed.
  Ways straightWays(const GridMapResult& map, const std::vector<CurveOutcome>& told) const
  {
    Ways ways(options_.curves.size());
    for (std::size_t i = 0; i < ways.size(); ++i)
    {
      const CurveOutcome& ends = told[i];
      const bool connects = options_.curves[i].kind == CurveKind::Connection &&
        ends.from != kInvalidIndex && ends.to != kInvalidIndex && ends.from != ends.to;
      if (!ends.met && connects)
      {
        ways[i] = straightWay(
          mesh_, map.field, map.seamlessUv, options_.curves[i], ends, options_.edgeLength);
      }
    }
    return ways;
  }

  /// A map that lacks some curves gives way to one without the equations of these, which would only bend it, where
  /// that one holds. Where there is no map, the curves come to the plain one bit by bit.
  GridMapResult withFewer(GridMapResult best, CurveTry bestTry, GridMapResult plain,
    std::vector<std::string> leftOut, const Ways& ways)
  {
    if (best.status.ok())
    {
      const std::size_t unmet = countUnmet(best);
      if (unmet == best.curves.size())
      {
        const bool isPlain = !hasMore(best, plain);
        countTryLed(Try::WithoutCurves, isPlain ? 1 : 0);
        return isPlain ? std::move(plain) : std::move(best);
      }
      bestTry.leftOut = reasons(best);
      for (std::size_t i = 0; i < best.curves.size(); ++i)
      {
        if (best.curves[i].met)
        {
          bestTry.leftOut[i].clear();
        }
      }
      bestTry.maximumSteps = maximumSteps_;
      countTry(Try::WithoutUnmet);
      GridMapResult some = make(bestTry);
      const bool isOther = !hasMore(best, some) && some.status.ok();
      countTryLed(Try::WithoutUnmet, isOther ? 1 : 0);
      return isOther ? std::move(some) : std::move(best);
    }
    countTryLed(Try::WithoutCurves); // the others, if any, come to it
    std::vector<std::size_t> all(leftOut.size());
    std::iota(all.begin(), all.end(), std::size_t(0));
    Adding adding{ std::move(plain), { std::move(leftOut), ways, true, maximumSteps_ },
      all.size() };
    if (all.size() > 1)
    {
      addHalves(all, adding);
    }
    return std::move(adding.map);
  }

  /// A map to which curves are added.
  struct Adding
  {
    GridMapResult map;
    CurveTry howto;   ///< that led to it
    std::size_t left; ///< how many maps may still be made
  };

  /// Adds as many of the curves as it can, the earlier half before the later one: with all of them there was no map.
  void addHalves(const std::vector<std::size_t>& curves, Adding& to)
  {
    const auto middle = curves.begin() + static_cast<std::ptrdiff_t>((curves.size() + 1) / 2);
    for (const std::vector<std::size_t>& half : { std::vector<std::size_t>(curves.begin(), middle),
           std::vector<std::size_t>(middle, curves.end()) })
    {
      if (half.empty() || to.left == 0)
      {
        continue;
      }
      --to.left;
      CurveTry howto = to.howto;
      for (const std::size_t i : half)
      {
        howto.leftOut[i].clear();
      }
      countTry(Try::CurvesByHalves);
      GridMapResult next = make(howto);
      if (hasMore(next, to.map))
      {
        countTryLed(Try::CurvesByHalves);
        // Those that it lacks are no equations of the next one.
        for (const std::size_t i : half)
        {
          howto.leftOut[i] = next.curves[i].met ? std::string() : next.curves[i].why;
        }
        to.map = std::move(next);
        to.howto = std::move(howto);
      }
      else if (half.size() > 1)
      {
        addHalves(half, to);
      }
    }
  }

  const Mesh& mesh_;
  const GridMapOptions& options_;
  int maximumSteps_ = 0;        ///< of the seamless map of a try
  bool holdsIrregular_ = false; ///< of the last one that was made
  bool straightCycles_ = true;
  MapWork taken_;
};

} // namespace

bool hasPromised(const Certificate& certificate, MapMethod method)
{
  switch (method)
  {
    case MapMethod::ScaleAware:
      return certificate.valid();
    case MapMethod::Seamless:
      return certificate.seamless();
    default:
      return certificate.whole();
  }
}

const char* nameOf(MapMethod method)
{
  constexpr std::array<const char*, 4> kNames{ "scale aware", "mixed integer", "QuadCover",
    "seamless" };
  return kNames[static_cast<std::size_t>(method)];
}

void MapWork::addWork(const MapWork& other)
{
  work += other.work;
  secondsField += other.secondsField;
  secondsSeamless += other.secondsSeamless;
  secondsQuantize += other.secondsQuantize;
  secondsEmbed += other.secondsEmbed;
  processorField += other.processorField;
  processorSeamless += other.processorSeamless;
  processorQuantize += other.processorQuantize;
  processorEmbed += other.processorEmbed;
  seamlessSteps += other.seamlessSteps;
  embedSteps += other.embedSteps;
}

GridMapResult computeGridMap(const Mesh& mesh, const GridMapOptions& options)
{
  refuseIf(!(options.edgeLength > 0) || !std::isfinite(options.edgeLength),
    "the target edge length must be a positive number");
  checkAnisotropyLimit(options.anisotropyLimit);
  refuseIf(options.anisotropyLimit > 0 &&
      (options.method == MapMethod::MixedInteger || options.method == MapMethod::QuadCover),
    "an anisotropy limit needs the scale aware or the seamless method");
  if (mesh.vertexCount() > options.maximumVertices)
  {
    GridMapResult result;
    result.status = { StatusCode::TooLarge,
      "the coarse level has " + std::to_string(mesh.vertexCount()) + " vertices, more than " +
        std::to_string(options.maximumVertices) +
        "; folds, noise or features hold them: smooth or repair the surface, raise the feature "
        "angle, or ask for longer "
        "edges" };
    return result;
  }
  refuseIf(options.previous != nullptr && options.vertexIds.size() != mesh.vertexCount(),
    "grid map: ", options.vertexIds.size(), " vertex ids for ", mesh.vertexCount(), " vertices");
  if (!options.stretch.empty() && options.stretch.size() != mesh.faceCount())
  {
    throw InvalidInput("grid map: " + std::to_string(options.stretch.size()) + " stretches for " +
      std::to_string(mesh.faceCount()) + " faces");
  }
  GridMapResult result = CurvedMap(mesh, options).run();
  if (!result.status.ok() && !options.seams.empty() && !options.fewIrregular)
  {
    GridMapOptions fewer = options;
    fewer.fewIrregular = true;
    countTry(Try::SeamsFewer);
    GridMapResult again = CurvedMap(mesh, fewer).run();
    if (again.status.ok())
    {
      countTryLed(Try::SeamsFewer);
      again.addWork(result);
      return again;
    }
  }
  if (result.reuse.any() && !result.status.ok())
  {
    GridMapOptions cold = options;
    cold.previous = nullptr;
    countTry(Try::WithoutEarlier);
    GridMapResult again = CurvedMap(mesh, cold).run();
    countTryLed(Try::WithoutEarlier, again.status.ok() ? 1 : 0);
    again.addWork(result);
    return again;
  }
  return result;
}

PreviousMap previousMap(
  const Mesh& mesh, const GridMapResult& map, const std::vector<Index>& vertexIds)
{
  assert(map.status.ok());
  return { mesh, vertexIds, map.field, map.seamlessUv, map.uv };
}

std::size_t unfollowedRegions(
  const Mesh& mesh, const std::vector<Guide>& guides, const std::vector<FixedVec2>& uv)
{
  DisjointSets regions(guides.size(), 1);
  for (Index h = 0; h < 3 * guides.size(); ++h)
  {
    const Index f = Mesh::face(h), g = mesh.isBoundary(h) ? f : Mesh::face(mesh.twin[h]);
    if (!guides[f].isFree() && !guides[g].isFree())
    {
      regions.join(f, g);
    }
  }
  std::vector<double> excess(guides.size(), 0.0); // of the area times the angle, by root
  for (Index f = 0; f < guides.size(); ++f)
  {
    const double area = mesh.edgeVector(3 * f).cross(mesh.edgeVector(3 * f + 1)).norm();
    if (!guides[f].isFree() && area > 0)
    {
      excess[regions.find(f)] +=
        area * (angleToIsolines(mesh, uv, f, guides[f].direction) - kFollowedAngle);
    }
  }
  return static_cast<std::size_t>(
    std::count_if(excess.begin(), excess.end(), [](double sum) { return sum > 0; }));
}

} // namespace quadrille
