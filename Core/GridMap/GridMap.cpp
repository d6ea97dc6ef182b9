// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/GridMap.h"

#include "Base/Clock.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "Base/WorkCount.h"
#include "GridMap/Embed.h"
#include "GridMap/GuidesInMap.h"
#include "GridMap/MapShape.h"
#include "GridMap/MeshParts.h"
#include "GridMap/RoundedMap.h"
#include "GridMap/SeamlessMap.h"
#include "Integers/Quantize.h"
#include "Mesh/ComponentSizes.h"
#include "Requests/SeamRequests.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <sstream>
#include <utility>

namespace quadrille
{
namespace
{

constexpr int kMaximumScalings = 4;
/// How often other integers are tried where embedding fails.
constexpr std::size_t kMaximumEmbeddings = 4;
/// The number of quads is accepted when it is this close to the target (relative).
constexpr double kCountTolerance = 0.06;
/// However many blocks there are, the other components have this part of the quads that they would have alone.
constexpr double kLeastBesideBlocks = 0.5;
/// A map with a component missing is none. That many failures in one stage have a common cause, which more work in
/// later stages does not mend: the caller hears of them at once.
constexpr std::size_t kHopeless = 4;
/// Newton steps of the seamless map where other curves, or other ways of theirs, can still be tried: maps that hold
/// take some 20, with strokes 200, those that never hold take 340.
constexpr int kStepsOfTry = 140;
constexpr int kStepsOfFirstTry = 220;
/// How many times the steps of the map without curves that one with curves may need.
constexpr int kStepsOverPlain = 5;

/// Area of the map in quads.
double mapArea(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  double area = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Vector2 p = toDouble(uv[3 * f + 1] - uv[3 * f]);
    const Vector2 q = toDouble(uv[3 * f + 2] - uv[3 * f]);
    area += 0.5 * (p.x() * q.y() - p.y() * q.x());
  }
  return area;
}

std::vector<Index> cornerVertices(const Mesh& mesh, const std::vector<Index>& faces)
{
  std::vector<Index> vertices;
  for (const Index f : faces)
  {
    for (Index corner = 0; corner < 3; ++corner)
    {
      vertices.push_back(mesh.origin[3 * f + corner]);
    }
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

std::vector<Index> join(std::vector<Index> a, const std::vector<Index>& b)
{
  a.insert(a.end(), b.begin(), b.end());
  std::sort(a.begin(), a.end());
  a.erase(std::unique(a.begin(), a.end()), a.end());
  return a;
}

/// One connected component on its way to its map.
struct Component
{
  MeshPart part;
  CarriedMap previous;                          ///< empty where there is none
  double share = 1;                             ///< of the area of the surface over its sizes
  double block = 0;                             ///< quads that it has at least, see quadsOfBlock
  bool hasIntegers = false;                     ///< of an earlier scale
  Eigen::VectorXd solution;                     ///< of its seamless map, for the next scale
  std::vector<FixedVec2> seamlessUv, integerUv; ///< of the scale that is tried
  std::unique_ptr<RoundedMap> rounded;          ///< of the methods that round
  std::vector<FixedVec2> startUv;               ///< the seamless map that uv was quantized from
  std::vector<FixedVec2> uv;
  double triedRefinement = 1, refinement = 1;
  bool seamlessReused = false, integersReused = false, embedReused = false;
  Status status;
  std::vector<Index> offenders; ///< vertices of the part

  const CarriedMap* earlier() const { return previous.knownFaces > 0 ? &previous : nullptr; }

  void fail(const Status& why, std::vector<FixedVec2> best, std::vector<Index> where)
  {
    status = why;
    uv = std::move(best);
    offenders = std::move(where);
  }
};

/// How a map is made that has to have curves.
struct CurveTry
{
  /// Empty, or for each curve why it is no equation; empty texts for those that are.
  std::vector<std::string> leftOut;
  /// Empty, or in place of the ways of the curves where there are some.
  std::vector<std::optional<Isoline>> ways;
  /// Whether all irregular vertices of the field without curves stay, or only those at ends of connections.
  bool holdsIrregular = true;
  int maximumSteps = 0; ///< of the seamless map; 0: as many as it takes
};

class MapMaker
{
public:
  MapMaker(const Mesh& mesh, const GridMapOptions& options, CurveTry howto)
    : mesh_(mesh), options_(options), try_(std::move(howto))
  {
  }

  GridMapResult run()
  {
    if (!findSeams())
    {
      return std::move(result_);
    }
    computeField();
    if (!result_.field.status.ok())
    {
      result_.status = result_.field.status;
      result_.offenders = result_.field.offenders;
      return std::move(result_);
    }
    addLines();
    split();
    if (options_.method == MapMethod::Seamless)
    {
      keepSeamless();
    }
    else
    {
      chooseScale();
    }
    if (options_.method == MapMethod::ScaleAware)
    {
      embed();
    }
    collect();
    return std::move(result_);
  }

  /// Of the field that the last run led along the curves.
  bool holdsIrregular() const { return holdsIrregular_; }

private:
  ProgressCallback progressOf(std::size_t i, double begin, double end) const
  {
    const double step = (end - begin) / static_cast<double>(components_.size());
    return subProgress(options_.progress, begin + step * static_cast<double>(i),
      begin + step * static_cast<double>(i + 1));
  }

  void computeField()
  {
    const TimedScope timed(result_.secondsField, result_.processorField);
    CrossFieldOptions fieldOptions;
    fieldOptions.targetEdgeLength = options_.edgeLength;
    fieldOptions.progress = subProgress(options_.progress, 0.0, 0.1);
    fieldOptions.guides = options_.guides;
    fieldOptions.targetValences = options_.targetValences;
    fieldOptions.regular.assign(options_.fewIrregular ? mesh_.vertexCount() : 0, 1);
    fieldOptions.sectorTurns =
      straightSectors(mesh_, straight_, seamSectors(mesh_, seams_, options_.sectorTurns));
    result_.field = computeCrossField(mesh_, fieldOptions);
    if (!options_.curves.empty() && makesLines() && result_.field.status.ok())
    {
      followCurves(fieldOptions);
    }
    result_.field.stretch = options_.stretch;
    result_.field.seams = seams_;
  }

  /// False where the mesh lacks one of them.
  bool findSeams()
  {
    seams_ = quadrille::findSeams(mesh_, options_.seams);
    if (std::any_of(seams_.begin(), seams_.end(), [](const SeamEdges& s) { return s.empty(); }))
    {
      result_.status = { StatusCode::Infeasible,
        "the coarse mesh does not have the two sides of the cut" };
      return false;
    }
    straight_ = findStraightParts(mesh_, options_.straight);
    if (std::any_of(
          straight_.begin(), straight_.end(), [](const auto& part) { return part.empty(); }))
    {
      result_.status = { StatusCode::Infeasible,
        "the coarse mesh does not have a part of the boundary that is to be straight" };
      return false;
    }
    return true;
  }

  /// The field once more, led along the curves. All its irregular vertices stay, as they are those that the user has
  /// seen; where a cycle cannot close between them, and where no map has the lines so, those at the ends of connections
  /// only.
  void followCurves(CrossFieldOptions fieldOptions)
  {
    std::vector<FollowedCurve> curves;
    for (std::size_t i = 0; i < options_.curves.size(); ++i)
    {
      if (!isLeftOut(i))
      {
        curves.push_back({ options_.curves[i], wayOf(i) });
      }
    }
    if (curves.empty())
    {
      return;
    }
    CurvesInField followed =
      followedCurves(mesh_, result_.field, curves, options_.edgeLength, options_.guides);
    fieldOptions.guides = std::move(followed.guides);
    fieldOptions.lines = std::move(followed.lines);
    fieldOptions.regular = std::move(followed.regular);
    for (const bool all : { true, false })
    {
      if (all && !try_.holdsIrregular)
      {
        continue;
      }
      const bool again = !all && try_.holdsIrregular;
      if (again)
      {
        countTry(Try::IrregularAtEnds);
      }
      fieldOptions.targetValences = all ? valencesOf(mesh_, result_.field, options_.targetValences)
                                        : valencesWithEnds(mesh_, result_.field, curves,
                                            options_.edgeLength, options_.targetValences);
      CrossField led = computeCrossField(mesh_, fieldOptions);
      if (led.status.ok() && (!all || cyclesClose(led, curves)))
      {
        if (again)
        {
          countTryLed(Try::IrregularAtEnds);
        }
        holdsIrregular_ = all;
        result_.field = std::move(led);
        return;
      }
      result_.curveOffenders = std::move(led.offenders);
    }
  }

  /// The others round, or have no integers at all.
  bool makesLines() const { return options_.method == MapMethod::ScaleAware; }

  bool isLeftOut(std::size_t curve) const
  {
    return !try_.leftOut.empty() && !try_.leftOut[curve].empty();
  }
  std::optional<Isoline> wayOf(std::size_t curve) const
  {
    return try_.ways.empty() ? std::nullopt : try_.ways[curve];
  }

  bool cyclesClose(const CrossField& field, const std::vector<FollowedCurve>& curves) const
  {
    return std::all_of(curves.begin(), curves.end(),
      [&](const FollowedCurve& followed)
      {
        return followed.curve.kind != CurveKind::Cycle ||
          lineOf(mesh_, field, followed.curve, options_.edgeLength).hasLine;
      });
  }

  void addLines()
  {
    for (std::size_t i = 0; i < options_.curves.size(); ++i)
    {
      lines_.push_back(lineOf(mesh_, result_.field, options_.curves[i], options_.edgeLength));
      RequestedLine& line = lines_.back();
      if (isLeftOut(i))
      {
        line.outcome.why = try_.leftOut[i];
      }
      else if (line.hasLine && makesLines())
      {
        if (const std::optional<Isoline> way = wayOf(i))
        {
          line.line = *way;
          line.line.axis = axisAlong(mesh_, result_.field, line.line);
        }
        result_.field.isolines.push_back(line.line);
      }
    }
  }

  /// In the map as it came out, whatever was asked of it.
  void judgeLines()
  {
    for (RequestedLine& line : lines_)
    {
      if (result_.status.ok() && line.isWanted() && makesLines())
      {
        line.outcome.met = hasGridLine(mesh_, result_.field, result_.uv, line, options_.edgeLength);
        if (!line.outcome.met && line.outcome.why.empty())
        {
          line.outcome.why =
            "an irregular vertex stands in the way of the line: move it aside, or draw another way";
        }
      }
      if (!makesLines())
      {
        line.outcome.why = std::string("the method '") + nameOf(options_.method) +
          "' makes no connections and cycles: choose scale aware";
      }
      if (line.outcome.met)
      {
        line.outcome.why.clear();
      }
      result_.curves.push_back(line.outcome);
    }
  }

  void split()
  {
    std::optional<MapCarrier> carrier;
    if (options_.previous != nullptr && options_.method == MapMethod::ScaleAware)
    {
      carrier.emplace(*options_.previous);
    }
    const double area = stretchedArea(mesh_, result_.field);
    for (MeshPart& part : splitIntoParts(mesh_, result_.field))
    {
      components_.emplace_back();
      components_.back().share = area > 0 ? stretchedArea(part.mesh, part.field) / area : 0;
      components_.back().block = measureComponents(part.mesh).block.front();
      components_.back().part = std::move(part);
      if (carrier)
      {
        carryOver(*carrier, components_.back());
      }
    }
  }

  void carryOver(const MapCarrier& carrier, Component& component)
  {
    std::vector<Index> ids;
    for (const Index v : component.part.vertex)
    {
      ids.push_back(options_.vertexIds[v]);
    }
    component.previous = carrier.carry(component.part.mesh, component.part.field, ids);
    result_.reuse.faces += component.previous.knownFaces;
  }

  std::size_t failures() const
  {
    return static_cast<std::size_t>(std::count_if(
      components_.begin(), components_.end(), [](const Component& c) { return !c.status.ok(); }));
  }

  /// Integers at the scale whose number of quads comes nearest to the target. Scales change together, so
  /// that quads stay alike on all components.
  void chooseScale()
  {
    double wanted = besideBlocks(options_.targetQuads);
    double bestDeviation = std::numeric_limits<double>::infinity();
    int kept = 0;
    for (int scaling = 0; scaling < kMaximumScalings; ++scaling)
    {
      if (scaling > 0)
      {
        countTry(Try::OtherScale);
      }
      if (!makeIntegers(wanted))
      {
        break; // an earlier scale may have integers
      }
      const double ratio = options_.targetQuads > 0 ? ratioToTarget(wanted) : 1;
      const double deviation = std::abs(std::log(ratio));
      if (deviation < bestDeviation)
      {
        bestDeviation = deviation;
        kept = scaling;
        keepTried();
      }
      // With a component missing there will be no quads to count.
      // Integers that are to be small do not follow the scale.
      if (deviation <= kCountTolerance || failures() > 0 || options_.pull < 1)
      {
        break;
      }
      wanted /= ratio;
    }
    if (kept > 0)
    {
      countTryLed(Try::OtherScale);
    }
  }

  /// A component whose share is less than a block of quads gets that block. With no number wanted all follow the edge
  /// length.
  static bool isBlock(const Component& component, double wanted)
  {
    return wanted > 0 && wanted * component.share < component.block;
  }
  static double quadsOf(const Component& component, double wanted)
  {
    return isBlock(component, wanted) ? component.block : wanted * component.share;
  }

  /// The number of quads of which the others get their shares, so that with the blocks there are as many as asked for.
  /// Where blocks would take more than half of the quads, the others keep half of what they would have alone.
  double besideBlocks(double target) const
  {
    double wanted = target;
    for (bool changed = true; changed;)
    {
      double blocks = 0, shares = 0;
      for (const Component& component : components_)
      {
        blocks += isBlock(component, wanted) ? component.block : 0;
        shares += isBlock(component, wanted) ? 0 : component.share;
      }
      const double left = blocks > 0 && shares > 0
        ? std::max(kLeastBesideBlocks * target, (target - blocks) / shares)
        : target;
      changed = left < wanted;
      wanted = std::min(left, wanted); // fewer quads make more blocks
    }
    return wanted;
  }

  /// Quads of the components that are no blocks over what they should have. Those without integers are as if they had
  /// their share.
  double ratioToTarget(double wanted) const
  {
    double quads = 0, shares = 0, blocks = 0, shareOfBlocks = 0;
    for (const Component& component : components_)
    {
      const bool block = isBlock(component, wanted);
      const double made = component.status.ok() && !component.integerUv.empty()
        ? mapArea(component.part.mesh, component.integerUv)
        : component.block;
      blocks += block ? made : 0;
      shareOfBlocks += block ? component.share : 0;
      if (!block && component.status.ok())
      {
        quads += made;
        shares += component.share;
      }
    }
    if (!(quads > 0 && shares > 0))
    {
      return 1;
    }
    const double target = shareOfBlocks > 0
      ? std::max(kLeastBesideBlocks * options_.targetQuads,
          (options_.targetQuads - blocks) / (1 - shareOfBlocks))
      : options_.targetQuads;
    return quads / shares / target;
  }

  /// Components fail at the first scale only; at a later one the first failure ends the try.
  bool makeIntegers(double wanted)
  {
    if (options_.method != MapMethod::ScaleAware)
    {
      roundIntegers(wanted);
      return true;
    }
    for (std::size_t i = 0; i < components_.size(); ++i)
    {
      Component& component = components_[i];
      if (component.status.ok() && !mapSeamlessly(component, wanted, progressOf(i, 0.1, 0.4)) &&
        component.hasIntegers)
      {
        return false;
      }
    }
    for (std::size_t i = 0; i < components_.size() && failures() < kHopeless; ++i)
    {
      Component& component = components_[i];
      if (component.status.ok() && !makeIntegers(component, progressOf(i, 0.4, 0.7)) &&
        component.hasIntegers)
      {
        return false;
      }
    }
    return failures() < kHopeless;
  }

  /// No integers: the map as it is.
  void keepSeamless()
  {
    for (std::size_t i = 0; i < components_.size(); ++i)
    {
      Component& component = components_[i];
      if (mapSeamlessly(component, besideBlocks(options_.targetQuads), progressOf(i, 0.1, 1.0)))
      {
        component.uv = std::move(component.seamlessUv);
      }
    }
  }

  /// Whatever becomes of the triangles: that is a property of these methods.
  void roundIntegers(double wanted)
  {
    for (std::size_t i = 0; i < components_.size(); ++i)
    {
      Component& component = components_[i];
      if (!component.status.ok())
      {
        continue;
      }
      report(progressOf(i, 0.1, 1.0), 0.0, "rounding the map");
      if (!component.rounded)
      {
        const TimedScope timed(result_.secondsSeamless, result_.processorSeamless);
        component.rounded = std::make_unique<RoundedMap>(
          component.part.mesh, component.part.field, options_.edgeLength);
      }
      if (!component.rounded->status().ok())
      {
        const Status& why = component.rounded->status();
        component.fail(
          { why.code, std::string(nameOf(options_.method)) + ": " + why.message }, {}, {});
        continue;
      }
      const TimedScope timed(result_.secondsQuantize, result_.processorQuantize);
      component.integerUv = component.rounded->make(quadsOf(component, wanted),
        options_.method == MapMethod::QuadCover ? RoundingOrder::AllAtOnce
                                                : RoundingOrder::OneAtATime);
    }
  }

  void keepTried()
  {
    for (Component& component : components_)
    {
      if (component.status.ok())
      {
        component.uv = std::move(component.integerUv);
        component.startUv = std::move(component.seamlessUv);
        component.refinement = component.triedRefinement;
      }
    }
  }

  /// The seamless map that has its share of `wanted`.
  bool mapSeamlessly(Component& component, double wanted, const ProgressCallback& progress)
  {
    const TimedScope timed(result_.secondsSeamless, result_.processorSeamless);
    const MeshPart& part = component.part;
    SeamlessOptions seamlessOptions;
    seamlessOptions.edgeLength = options_.edgeLength;
    seamlessOptions.targetQuads = quadsOf(component, wanted);
    seamlessOptions.solution = component.hasIntegers ? &component.solution : nullptr;
    seamlessOptions.previous = component.earlier();
    seamlessOptions.anisotropyLimit = options_.anisotropyLimit;
    seamlessOptions.maximumSteps = try_.maximumSteps;
    seamlessOptions.progress = progress;
    SeamlessResult seamless = computeSeamlessMap(part.mesh, part.field, seamlessOptions);
    result_.seamlessSteps += seamless.newtonSteps;
    component.seamlessReused = component.seamlessReused || seamless.startedFromPrevious;
    if (!seamless.status.ok())
    {
      if (!component.hasIntegers)
      {
        result_.collapsedFaces += seamless.collapsed;
        component.fail(seamless.status, std::move(seamless.uv),
          join(cornerVertices(part.mesh, seamless.inverted), seamless.offenders));
      }
      return false;
    }
    component.solution = std::move(seamless.solution);
    component.seamlessUv = std::move(seamless.uv);
    return true;
  }

  bool makeIntegers(Component& component, const ProgressCallback& progress)
  {
    QuantizeResult quantized = quantize(component, component.seamlessUv, {}, progress);
    if (!quantized.status.ok())
    {
      if (!component.hasIntegers)
      {
        component.fail(quantized.status, std::move(quantized.uv), {});
      }
      return false;
    }
    component.hasIntegers = true;
    component.integersReused = quantized.startedFromPrevious;
    component.integerUv = std::move(quantized.uv);
    component.triedRefinement = quantized.refinement;
    return true;
  }

  QuantizeResult quantize(const Component& component, const std::vector<FixedVec2>& seamlessUv,
    const std::vector<Index>& watched, const ProgressCallback& progress)
  {
    const TimedScope timed(result_.secondsQuantize, result_.processorQuantize);
    QuantizeOptions quantizeOptions;
    quantizeOptions.watched = watched;
    quantizeOptions.pull = options_.pull;
    // Other integers are asked for where some vertices are watched, or where those of the first scale were too many or
    // too few.
    const bool again = component.hasIntegers || !watched.empty();
    quantizeOptions.previousUv =
      !again && component.previous.isMap ? &component.previous.uv : nullptr;
    quantizeOptions.progress = progress;
    return quantizeMap(component.part.mesh, component.part.field, seamlessUv, quantizeOptions);
  }

  void embed()
  {
    for (std::size_t i = 0; i < components_.size() && failures() < kHopeless; ++i)
    {
      if (components_[i].status.ok())
      {
        embedOne(components_[i], progressOf(i, 0.7, 1.0));
      }
    }
  }

  /// Where embedding fails, other integers leave room round the places of the failure; integers that were tried before
  /// would fail again. Where another component has no map, all that counts is where this one would fail, too: one try
  /// tells.
  void embedOne(Component& component, const ProgressCallback& progress)
  {
    const MeshPart& part = component.part;
    std::vector<Index> watched;
    std::vector<std::vector<FixedVec2>> tried;
    EmbedResult embedded;
    while (true)
    {
      EmbedOptions embedOptions;
      embedOptions.edgeLength = options_.edgeLength;
      embedOptions.seamlessUv = failures() == 0 ? &component.startUv : nullptr;
      embedOptions.previous = component.earlier();
      embedOptions.anisotropyLimit = options_.anisotropyLimit;
      embedOptions.failedBefore = embedded.offenders;
      embedOptions.progress = progress;
      {
        const TimedScope timed(result_.secondsEmbed, result_.processorEmbed);
        embedded = embedMap(part.mesh, part.field, component.uv, embedOptions);
        result_.embedSteps += embedded.newtonSteps;
      }
      component.embedReused = embedded.startedFromPrevious;
      tried.push_back(std::move(component.uv));
      if (embedded.status.ok())
      {
        if (tried.size() > 1)
        {
          countTryLed(Try::OtherIntegers);
        }
        component.uv = std::move(embedded.uv);
        return;
      }
      if (failures() > 0 || tried.size() >= kMaximumEmbeddings)
      {
        break;
      }
      countTry(Try::OtherIntegers);
      watched = join(std::move(watched), embedded.offenders);
      QuantizeResult quantized = quantize(component, component.startUv, watched, progress);
      if (!quantized.status.ok() ||
        std::find(tried.begin(), tried.end(), quantized.uv) != tried.end())
      {
        break;
      }
      component.refinement = quantized.refinement;
      component.integersReused = false;
      component.uv = std::move(quantized.uv);
    }
    component.fail(embedded.status, std::move(embedded.uv),
      join(cornerVertices(part.mesh, embedded.inverted), embedded.offenders));
  }

  /// The maps of the components become one.
  void collect()
  {
    result_.components = components_.size();
    result_.uv.assign(mesh_.halfEdgeCount(), {});
    result_.seamlessUv.assign(mesh_.halfEdgeCount(), {});
    for (std::size_t i = 0; i < components_.size(); ++i)
    {
      const Component& component = components_[i];
      // What a block grows by is a few quads.
      result_.refinement = std::max(
        result_.refinement, isBlock(component, options_.targetQuads) ? 1.0 : component.refinement);
      const auto place = [&](Index h) { return 3 * component.part.face[Mesh::face(h)] + h % 3; };
      for (Index h = 0; h < component.uv.size(); ++h)
      {
        result_.uv[place(h)] = component.uv[h];
      }
      for (Index h = 0; h < component.startUv.size(); ++h)
      {
        result_.seamlessUv[place(h)] = component.startUv[h];
      }
      result_.reuse.seamless += component.seamlessReused ? 1 : 0;
      result_.reuse.integers += component.integersReused ? 1 : 0;
      result_.reuse.embedded += component.embedReused ? 1 : 0;
      for (const Index v : component.offenders)
      {
        result_.offenders.push_back(component.part.vertex[v]);
      }
      if (!component.status.ok() && result_.failedComponents++ == 0)
      {
        result_.status = { component.status.code, explain(i) };
      }
    }
    std::sort(result_.offenders.begin(), result_.offenders.end());
    result_.certificate =
      certify(mesh_, result_.uv, result_.field.turns, integerVertices(mesh_, result_.field));
    if (result_.status.ok() && !hasPromised(result_.certificate, options_.method))
    {
      result_.status = { StatusCode::NotConverged,
        "the coarse map does not pass its certificate: " + result_.certificate.text() };
      result_.offenders = cornerVertices(mesh_, result_.certificate.worstFaces);
    }
    judgeLines();
    if (options_.anisotropyLimit > 0 && result_.status.ok())
    {
      result_.beyondAnisotropyLimit = shareBeyondRatio(mesh_, result_.uv, options_.anisotropyLimit);
    }
  }

  /// Where and why a component has no map, and what helps: the stages count, as numbers of the coarse mesh say nothing
  /// to users.
  std::string explain(std::size_t i) const
  {
    const Component& component = components_[i];
    const Index v = component.offenders.empty() ? 0 : component.offenders.front();
    std::ostringstream text;
    if (components_.size() > 1)
    {
      text << "at least " << failures() << " of " << components_.size()
           << " connected components have no map, one of them ";
    }
    text << "near " << placeText(component.part.mesh.position[v]) << ": "
         << component.status.message
         << "; ask for smaller quads, for fewer features there (a larger "
         << "feature angle, or none) or for more coarse vertices";
    return text.str();
  }

  const Mesh& mesh_;
  const GridMapOptions& options_;
  CurveTry try_;
  GridMapResult result_;
  bool holdsIrregular_ = false;
  std::vector<RequestedLine> lines_;
  std::vector<SeamEdges> seams_;
  std::vector<std::vector<Index>> straight_;
  std::vector<Component> components_;
};

std::size_t countUnmet(const GridMapResult& map)
{
  return static_cast<std::size_t>(std::count_if(
    map.curves.begin(), map.curves.end(), [](const CurveOutcome& curve) { return !curve.met; }));
}

/// A map with as many of the curves as it can have, the earlier ones before the later ones. Where there is no map even
/// without them, it is not they that are in the way.
class CurvedMap
{
public:
  CurvedMap(const Mesh& mesh, const GridMapOptions& options) : mesh_(mesh), options_(options) {}

  GridMapResult run()
  {
    const bool hasCurves = !options_.curves.empty() && options_.method == MapMethod::ScaleAware;
    GridMapResult first = make({ {}, {}, true, hasCurves ? kStepsOfFirstTry : 0 });
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
    const std::vector<Index> offenders = first.status.ok() ? first.curveOffenders : first.offenders;
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
        best = std::move(other);
        bestTry = howto;
        hasOtherWays_ = true;
      }
    }
    if (!isWhole(best))
    {
      best = withFewer(std::move(best), std::move(bestTry), std::move(plain), leftOut, ways);
      best.curveOffenders = offenders;
    }
    if (hasOtherWays_)
    {
      countTryLed(Try::StraightWays);
    }
    return finish(std::move(best));
  }

private:
  using Ways = std::vector<std::optional<Isoline>>;

  GridMapResult make(const CurveTry& howto)
  {
    const WorkScope work;
    MapMaker maker(mesh_, options_, howto);
    GridMapResult map = maker.run();
    map.work = work.done();
    holdsIrregular_ = maker.holdsIrregular();
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

  static bool isWhole(const GridMapResult& map) { return map.status.ok() && countUnmet(map) == 0; }

  /// With what all tries have taken.
  GridMapResult finish(GridMapResult map) const
  {
    map.takeWork(taken_);
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
        if (hasMore(best, plain))
        {
          return best;
        }
        countTryLed(Try::WithoutCurves);
        hasOtherWays_ = false;
        return plain;
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
      if (hasMore(best, some) || !some.status.ok())
      {
        return best;
      }
      countTryLed(Try::WithoutUnmet);
      return some;
    }
    std::vector<std::size_t> all(leftOut.size());
    std::iota(all.begin(), all.end(), std::size_t(0));
    Adding adding{ std::move(plain), { std::move(leftOut), ways, true, maximumSteps_ },
      all.size() };
    if (all.size() > 1)
    {
      addHalves(all, adding);
    }
    countTryLed(adding.isPlain ? Try::WithoutCurves : Try::CurvesByHalves);
    return std::move(adding.map);
  }

  /// A map to which curves are added.
  struct Adding
  {
    GridMapResult map;
    CurveTry howto;   ///< that led to it
    std::size_t left; ///< how many maps may still be made
    bool isPlain = true;
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
        // Those that it lacks are no equations of the next one.
        for (const std::size_t i : half)
        {
          howto.leftOut[i] = next.curves[i].met ? std::string() : next.curves[i].why;
        }
        to.map = std::move(next);
        to.howto = std::move(howto);
        to.isPlain = false;
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
  bool hasOtherWays_ = false;   ///< the map that is kept, or the one that it comes from
  GridMapResult taken_;
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
  switch (method)
  {
    case MapMethod::ScaleAware:
      return "scale aware";
    case MapMethod::MixedInteger:
      return "mixed integer";
    case MapMethod::QuadCover:
      return "QuadCover";
    default:
      return "seamless";
  }
}

void GridMapResult::addWork(const GridMapResult& other)
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

void GridMapResult::takeWork(const GridMapResult& other)
{
  work = other.work;
  secondsField = other.secondsField;
  secondsSeamless = other.secondsSeamless;
  secondsQuantize = other.secondsQuantize;
  secondsEmbed = other.secondsEmbed;
  processorField = other.processorField;
  processorSeamless = other.processorSeamless;
  processorQuantize = other.processorQuantize;
  processorEmbed = other.processorEmbed;
  seamlessSteps = other.seamlessSteps;
  embedSteps = other.embedSteps;
}

GridMapResult computeGridMap(const Mesh& mesh, const GridMapOptions& options)
{
  if (!(options.edgeLength > 0) || !std::isfinite(options.edgeLength))
  {
    throw InvalidInput("the target edge length must be a positive number");
  }
  checkAnisotropyLimit(options.anisotropyLimit);
  if (options.anisotropyLimit > 0 &&
    (options.method == MapMethod::MixedInteger || options.method == MapMethod::QuadCover))
  {
    throw InvalidInput("an anisotropy limit needs the scale aware or the seamless method");
  }
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
  if (options.previous != nullptr && options.vertexIds.size() != mesh.vertexCount())
  {
    throw InvalidInput("grid map: " + std::to_string(options.vertexIds.size()) +
      " vertex ids for " + std::to_string(mesh.vertexCount()) + " vertices");
  }
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
    if (again.status.ok())
    {
      countTryLed(Try::WithoutEarlier);
    }
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

} // namespace quadrille
