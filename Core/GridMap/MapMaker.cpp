// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/FieldOfMap.h"
#include "GridMap/FieldUntangling.h"

#include "Base/Clock.h"
#include "Base/Lists.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "Base/WorkCount.h"
#include "GridMap/Embed.h"
#include "GridMap/MapCheck.h"
#include "GridMap/MapShape.h"
#include "GridMap/MeshParts.h"
#include "GridMap/RoundedMap.h"
#include "GridMap/SeamlessMap.h"
#include "Integers/Quantize.h"
#include "Mesh/ComponentSizes.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

/// Numbers of quads that are wanted one after the other.
constexpr int kMostNumbers = 6;
/// No fewer than this part of the quads asked for are wanted: quads twice as long. Where features need more quads, that
/// does not change by larger ones beside them.
constexpr double kLeastWanted = 0.25;
/// By which part in proportion the number of quads at least follows what is wanted.
constexpr double kLeastSlope = 0.5;
/// How many integers are tried where embedding fails; three were enough on most parts.
constexpr int kMostEmbeddings = 6;
/// The number of quads is accepted when it is this close to the target (relative).
constexpr double kCountTolerance = 0.06;
/// However many blocks there are, the other components have this part of the quads that they would have alone.
constexpr double kLeastBesideBlocks = 0.5;
/// A map with a component missing is none. That many failures in one stage have a common cause, which more work in
/// later stages does not mend: the caller hears of them at once.
constexpr std::size_t kHopeless = 4;
/// What users can do where there is no map; messages begin with it, as windows cut what is long.
constexpr const char* kMapRemedy =
  "ask for smaller quads, a larger feature angle or more coarse vertices";

/// Area of the map in quads.
double mapArea(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  double area = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    area += mappedArea(uv, f);
  }
  return area;
}

std::vector<Index> join(std::vector<Index> a, const std::vector<Index>& b)
{
  append(a, b);
  sortUnique(a);
  return a;
}

/// One connected component on its way to its map.
struct Component
{
  MeshPart part;
  CarriedMap previous;      ///< empty where there is none
  double share = 1;         ///< of the area of the surface over its sizes
  double block = 0;         ///< quads that it has at least, see quadsOfBlock
  bool isBlock = false;     ///< gets these, as its share of what is asked for is less
  bool isTriedOnce = false; ///< as others had failed before
  std::vector<FixedVec2> seamlessUv;
  double seamlessQuads = 0; ///< that this is scaled to
  std::unique_ptr<Quantizer> quantizer;
  std::unique_ptr<RoundedMap> rounded; ///< of the methods that round
  std::vector<FixedVec2> roundedUv;    ///< for the number of quads that is tried
  double triedPull = 1, pull = 1;      ///< of the integers to the seamless map
  std::vector<FixedVec2> uv;
  double refinement = 1;
  bool seamlessReused = false, integersReused = false;
  Status status;
  std::vector<Index> failedAt; ///< vertices of the part
  FailedFaces failedFaces;     ///< of the part

  const CarriedMap* earlier() const { return previous.knownFaces > 0 ? &previous : nullptr; }

  void fail(const Status& why, std::vector<FixedVec2> best, std::vector<Index> where,
    FailedFaces faces = {})
  {
    status = why;
    uv = std::move(best);
    failedAt = std::move(where);
    failedFaces = std::move(faces);
  }
};

double quadsOf(const Component& component, double wanted)
{
  return component.isBlock ? component.block : wanted * component.share;
}

/// A component whose share is less than a block of quads gets that block; with no number wanted all follow the edge
/// length. Returns the number of quads of which the others get their shares, so that with the blocks there are as many
/// as asked for. Where blocks would take more than half of the quads, the others keep half of what they would have
/// alone.
double setBlocks(std::vector<Component>& components, double target)
{
  double wanted = target;
  for (bool changed = true; changed;)
  {
    double blocks = 0, shares = 0;
    for (Component& component : components)
    {
      component.isBlock = wanted > 0 && wanted * component.share < component.block;
      blocks += component.isBlock ? component.block : 0;
      shares += component.isBlock ? 0 : component.share;
    }
    const double left = blocks > 0 && shares > 0
      ? std::max(kLeastBesideBlocks * target, (target - blocks) / shares)
      : target;
    changed = left < wanted;
    wanted = std::min(left, wanted); // fewer quads make more blocks
  }
  return wanted;
}

/// Where there is nothing, what it has at least.
double quadsMade(const Component& component)
{
  if (!component.status.ok() || (!component.quantizer && component.roundedUv.empty()))
  {
    return component.block;
  }
  return component.quantizer ? component.quantizer->area()
                             : mapArea(component.part.mesh, component.roundedUv);
}

/// Quads of the components that are no blocks over what they should have. Those without integers are as if they had
/// their share.
double ratioToTarget(const std::vector<Component>& components, double targetQuads)
{
  double quads = 0, shares = 0, blocks = 0, shareOfBlocks = 0;
  for (const Component& component : components)
  {
    const double made = quadsMade(component);
    blocks += component.isBlock ? made : 0;
    shareOfBlocks += component.isBlock ? component.share : 0;
    if (!component.isBlock && component.status.ok())
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
    ? std::max(kLeastBesideBlocks * targetQuads, (targetQuads - blocks) / (1 - shareOfBlocks))
    : targetQuads;
  return quads / shares / target;
}

/// What helps, and where and why a component has no map: the stages count, as numbers of the coarse mesh say nothing
/// to users.
std::string explain(const std::vector<Component>& components, std::size_t i, std::size_t failures)
{
  const Component& component = components[i];
  const Index v = component.failedAt.empty() ? 0 : component.failedAt.front();
  std::ostringstream text;
  text << kMapRemedy << ": no valid map of the coarse level ";
  if (components.size() > 1)
  {
    text << "as at least " << failures << " of " << components.size()
         << " connected components have no map, one of them ";
  }
  text << "near " << placeText(component.part.mesh.position[v]) << ": " << component.status.message;
  return text.str();
}

class MapMaker
{
public:
  MapMaker(const Mesh& mesh, const GridMapOptions& options, bool hasStraightLines)
    : mesh_(mesh), options_(options), field_(mesh, options, hasStraightLines, result_)
  {
  }

  GridMapResult run()
  {
    if (!field_.findSeams())
    {
      return std::move(result_);
    }
    field_.computeField();
    if (!result_.field.status.ok())
    {
      result_.status = result_.field.status;
      result_.failedAt = result_.field.failedAt;
      return std::move(result_);
    }
    split();
    if (options_.method == MapMethod::Seamless)
    {
      keepSeamless();
    }
    else
    {
      chooseNumber();
    }
    if (options_.method == MapMethod::ScaleAware)
    {
      embed();
    }
    collect();
    return std::move(result_);
  }

private:
  ProgressCallback progressOf(std::size_t i, double begin, double end) const
  {
    const double step = (end - begin) / static_cast<double>(components_.size());
    return subProgress(options_.progress, begin + step * static_cast<double>(i),
      begin + step * static_cast<double>(i + 1));
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

  /// The integers whose number of quads comes nearest to the target. The shares of components change together, so that
  /// quads stay alike on all of them.
  void chooseNumber()
  {
    double wanted = setBlocks(components_, options_.targetQuads);
    double bestDeviation = kInfinity;
    int kept = 0;
    // Logarithms of what was wanted, and of its ratio. The number follows by less than in proportion, as features have
    // their edges whatever is wanted.
    double lastWanted = 0, lastRatio = 0;
    for (int tried = 0; tried < kMostNumbers; ++tried)
    {
      countTry(Try::OtherNumber, tried > 0 ? 1 : 0);
      if (!makeIntegers(wanted))
      {
        break;
      }
      const double ratio =
        std::log(options_.targetQuads > 0 ? ratioToTarget(components_, options_.targetQuads) : 1);
      if (std::abs(ratio) < bestDeviation)
      {
        bestDeviation = std::abs(ratio);
        keepTried();
        kept = tried;
      }
      // With a component missing there will be no quads to count.
      // Integers that are to be small do not follow the number.
      if (bestDeviation <= kCountTolerance || failures() > 0 || options_.pull < 1)
      {
        break;
      }
      const double slope = tried > 0
        ? std::clamp((ratio - lastRatio) / (std::log(wanted) - lastWanted), kLeastSlope, 1.0)
        : 1;
      lastWanted = std::log(wanted);
      lastRatio = ratio;
      // To well within the tolerance, as every strip changes the shape of quads.
      const double tooMany = ratio - std::copysign(0.5 * kCountTolerance, ratio);
      wanted =
        std::max(std::exp(lastWanted - tooMany / slope), kLeastWanted * options_.targetQuads);
      if (std::log(wanted) == lastWanted)
      {
        break;
      }
    }
    countTryLed(Try::OtherNumber, kept > 0 ? 1 : 0);
    for (Component& component : components_)
    {
      component.quantizer.reset();
    }
  }

  /// A component without integers fails.
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
      if (component.status.ok() && component.seamlessUv.empty())
      {
        mapSeamlessly(component, quadsOf(component, wanted), progressOf(i, 0.1, 0.4));
      }
    }
    for (std::size_t i = 0; i < components_.size() && failures() < kHopeless; ++i)
    {
      Component& component = components_[i];
      if (component.status.ok())
      {
        makeIntegers(component, quadsOf(component, wanted), progressOf(i, 0.4, 0.7));
      }
    }
    return failures() < kHopeless;
  }

  /// No integers: the map as it is.
  void keepSeamless()
  {
    const double wanted = setBlocks(components_, options_.targetQuads);
    for (std::size_t i = 0; i < components_.size(); ++i)
    {
      Component& component = components_[i];
      if (mapSeamlessly(component, quadsOf(component, wanted), progressOf(i, 0.1, 1.0)))
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
      component.roundedUv = component.rounded->make(quadsOf(component, wanted),
        options_.method == MapMethod::QuadCover ? RoundingOrder::AllAtOnce
                                                : RoundingOrder::OneAtATime);
    }
  }

  void keepTried()
  {
    for (Component& component : components_)
    {
      if (!component.status.ok())
      {
        continue;
      }
      if (!component.quantizer)
      {
        component.uv = std::move(component.roundedUv);
        continue;
      }
      QuantizeResult made = component.quantizer->result();
      if (!made.status.ok())
      {
        failWithoutIntegers(component, std::move(made));
        continue;
      }
      component.uv = std::move(made.uv);
      component.refinement = made.refinement;
      component.pull = component.triedPull;
    }
  }

  /// What `make` makes. Where a bound of work is reached, the faces are told as those of the whole mesh: where it was
  /// spent, or where that is not known those where the part has failed before.
  template <typename Make>
  static auto madeOrTold(const MeshPart& part, const FailedFaces& before, const Make& make)
  {
    try
    {
      return make();
    }
    catch (const SpentInFaces& spent)
    {
      throw SpentInFaces(ofWhole(part, spent.faces));
    }
    catch (const QuantizingSpent& spent)
    {
      throw SpentInFaces(ofWhole(part, { spent.faces, {} }));
    }
    catch (const WorkSpent&)
    {
      throw SpentInFaces(ofWhole(part, before));
    }
  }

  static FailedFaces ofWhole(const MeshPart& part, FailedFaces failed)
  {
    for (Index& f : failed.faces)
    {
      f = part.face[f];
    }
    for (auto& [one, other] : failed.either)
    {
      one = part.face[one];
      other = part.face[other];
    }
    return failed;
  }

  /// The seamless map, scaled to so many quads.
  bool mapSeamlessly(Component& component, double quads, const ProgressCallback& progress)
  {
    const TimedScope timed(result_.secondsSeamless, result_.processorSeamless);
    const MeshPart& part = component.part;
    SeamlessOptions seamlessOptions;
    seamlessOptions.edgeLength = options_.edgeLength;
    seamlessOptions.targetQuads = quads;
    seamlessOptions.previous = component.earlier();
    seamlessOptions.anisotropyLimit = options_.anisotropyLimit;
    seamlessOptions.progress = progress;
    SeamlessResult seamless = madeOrTold(
      part, {}, [&] { return computeSeamlessMap(part.mesh, part.field, seamlessOptions); });
    result_.seamlessSteps += seamless.newtonSteps;
    component.seamlessReused = seamless.startedFromPrevious;
    if (!seamless.status.ok())
    {
      component.fail(seamless.status, std::move(seamless.uv),
        join(cornerVertices(part.mesh, seamless.inverted), seamless.failedAt),
        std::move(seamless.failedFaces));
      return false;
    }
    component.seamlessUv = std::move(seamless.uv);
    component.seamlessQuads = quads;
    return true;
  }

  /// Curves that bend count where sizes do.
  double edgeLengthOfCurves() const { return options_.pull < 1 ? 0 : options_.edgeLength; }

  static void failWithoutIntegers(Component& component, QuantizeResult quantized)
  {
    component.seamlessUv.clear();
    std::vector<Index> corners = cornerVertices(component.part.mesh, quantized.failedFaces);
    component.fail(quantized.status, std::move(quantized.uv), std::move(corners),
      { std::move(quantized.failedFaces), {} });
  }

  void makeIntegers(Component& component, double quads, const ProgressCallback& progress)
  {
    const TimedScope timed(result_.secondsQuantize, result_.processorQuantize);
    const MeshPart& part = component.part;
    if (!component.quantizer)
    {
      QuantizeOptions quantizeOptions;
      quantizeOptions.edgeLength = edgeLengthOfCurves();
      quantizeOptions.previousUv = component.previous.isMap ? &component.previous.uv : nullptr;
      quantizeOptions.progress = progress;
      component.quantizer = madeOrTold(part, {},
        [&]
        {
          return std::make_unique<Quantizer>(
            part.mesh, part.field, component.seamlessUv, quantizeOptions);
        });
      if (!component.quantizer->status().ok())
      {
        failWithoutIntegers(component, component.quantizer->result());
        return;
      }
      component.integersReused = component.quantizer->startedFromPrevious();
    }
    // With no number wanted, all follow the edge length.
    component.triedPull =
      quads > 0 ? options_.pull * std::sqrt(quads / component.seamlessQuads) : options_.pull;
    component.quantizer->improve(component.triedPull, progress);
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

  /// False, and nothing is changed, where there are no others with more watched. failed: where the present ones fail.
  bool changeIntegers(Component& component, const std::vector<Index>& more,
    const FailedFaces& failed, std::vector<Index>& watched, const ProgressCallback& progress)
  {
    countTry(Try::OtherIntegers);
    std::vector<Index> all = join(watched, more);
    const TimedScope timed(result_.secondsQuantize, result_.processorQuantize);
    QuantizeOptions quantizeOptions;
    quantizeOptions.pull = component.pull;
    quantizeOptions.edgeLength = edgeLengthOfCurves();
    quantizeOptions.watched = all;
    quantizeOptions.previousUv = &component.uv;
    quantizeOptions.anew = false;
    quantizeOptions.progress = progress;
    const MeshPart& part = component.part;
    QuantizeResult quantized = madeOrTold(part, failed,
      [&] { return quantizeMap(part.mesh, part.field, component.seamlessUv, quantizeOptions); });
    if (!quantized.status.ok() || quantized.uv == component.uv)
    {
      return false;
    }
    watched = std::move(all);
    component.refinement = quantized.refinement;
    component.integersReused = false;
    component.uv = std::move(quantized.uv);
    return true;
  }

  /// Integers with room round the places of the failure and for the vertices that found no star to return to; round the
  /// places of the failure alone, where there are no such integers.
  bool leaveRoom(Component& component, const EmbedResult& embedded, std::vector<Index>& watched,
    const ProgressCallback& progress)
  {
    const Mesh& mesh = component.part.mesh;
    const std::vector<Index> wide =
      join(cornerVertices(mesh, findNotPositive(mesh, component.uv)), embedded.failedAt);
    return changeIntegers(component, wide, embedded.failedFaces, watched, progress) ||
      (wide != embedded.failedAt &&
        changeIntegers(component, embedded.failedAt, embedded.failedFaces, watched, progress));
  }

  /// Where no map with these integers is positive, others are tried. Where another component has no map, all that
  /// counts is where this one would fail, too: one try tells.
  void embedOne(Component& component, const ProgressCallback& progress)
  {
    const MeshPart& part = component.part;
    std::vector<Index> watched;
    for (int tried = 1;; ++tried)
    {
      EmbedOptions embedOptions;
      embedOptions.edgeLength = options_.edgeLength;
      embedOptions.anisotropyLimit = options_.anisotropyLimit;
      embedOptions.progress = progress;
      EmbedResult embedded;
      {
        const TimedScope timed(result_.secondsEmbed, result_.processorEmbed);
        embedded = madeOrTold(
          part, {}, [&] { return embedMap(part.mesh, part.field, component.uv, embedOptions); });
        result_.embedSteps += embedded.newtonSteps;
      }
      if (embedded.status.ok())
      {
        countTryLed(Try::OtherIntegers, watched.empty() ? 0 : 1);
        component.uv = std::move(embedded.uv);
        return;
      }
      if (failures() > 0 || tried == kMostEmbeddings ||
        !leaveRoom(component, embedded, watched, progress))
      {
        component.isTriedOnce = failures() > 0;
        component.fail(embedded.status, std::move(embedded.uv),
          join(cornerVertices(part.mesh, embedded.inverted), embedded.failedAt),
          std::move(embedded.failedFaces));
        return;
      }
    }
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
      result_.refinement =
        std::max(result_.refinement, component.isBlock ? 1.0 : component.refinement);
      const auto halfEdge = [&](Index h) { return 3 * component.part.face[Mesh::face(h)] + h % 3; };
      for (Index h = 0; h < component.uv.size(); ++h)
      {
        result_.uv[halfEdge(h)] = component.uv[h];
      }
      for (Index h = 0; h < component.seamlessUv.size(); ++h)
      {
        result_.seamlessUv[halfEdge(h)] = component.seamlessUv[h];
      }
      result_.reuse.seamless += component.seamlessReused ? 1 : 0;
      result_.reuse.integers += component.integersReused ? 1 : 0;
      for (const Index v : component.failedAt)
      {
        result_.failedAt.push_back(component.part.vertex[v]);
      }
      const FailedFaces failed = ofWhole(component.part, component.failedFaces);
      append(result_.failedFaces.faces, failed.faces);
      append(result_.failedFaces.either, failed.either);
      if (component.status.ok())
      {
        continue;
      }
      if (!component.isTriedOnce)
      {
        result_.failedIn.push_back(
          component.part.vertex[component.failedAt.empty() ? 0 : component.failedAt.front()]);
      }
      if (result_.failedComponents++ == 0)
      {
        result_.status = { component.status.code, explain(components_, i, failures()) };
      }
    }
    std::sort(result_.failedAt.begin(), result_.failedAt.end());
    std::sort(result_.failedFaces.faces.begin(), result_.failedFaces.faces.end());
    result_.certificate =
      certify(mesh_, result_.uv, result_.field.turns, integerVertices(mesh_, result_.field));
    if (result_.status.ok() && !hasPromised(result_.certificate, options_.method))
    {
      result_.status = { StatusCode::NotConverged,
        std::string(kMapRemedy) + ": the map of the coarse level does not pass its certificate: " +
          result_.certificate.text() };
      result_.failedAt = cornerVertices(mesh_, result_.certificate.worstFaces);
    }
    field_.judgeLines();
    if (options_.anisotropyLimit > 0 && result_.status.ok())
    {
      result_.beyondAnisotropyLimit = shareBeyondRatio(mesh_, result_.uv, options_.anisotropyLimit);
    }
  }

  const Mesh& mesh_;
  const GridMapOptions& options_;
  GridMapResult result_;
  FieldOfMap field_;
  std::vector<Component> components_;
};

} // namespace

GridMapResult mapInOneTry(const Mesh& mesh, const GridMapOptions& options, bool hasStraightLines)
{
  return MapMaker(mesh, options, hasStraightLines).run();
}

} // namespace quadrille
