// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Restarts.h"

#include "Base/Lists.h"
#include "Details/SmallComponents.h"
#include "Mesh/ComponentSizes.h"
#include "Pipeline/FirstPlan.h"
#include "Pipeline/Strategies.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <memory>
#include <sstream>
#include <utility>

namespace quadrille
{
namespace
{

WorkBound boundOf(const SizedSurface& sized)
{
  return workBound(sized.surface->mesh.faceCount(), sized.targetQuads);
}

/// By component: in how many attempts it has failed.
std::vector<std::size_t> failuresOf(
  const std::vector<Index>& componentOfVertex, std::size_t components, const History& before)
{
  std::vector<std::size_t> failures(components, 0);
  for (const std::vector<Index>& vertices : before.failures())
  {
    std::vector<std::uint8_t> isHit(components, 0);
    for (const Index v : vertices)
    {
      isHit[componentOfVertex[v]] = 1;
    }
    for (std::size_t c = 0; c < components; ++c)
    {
      failures[c] += isHit[c];
    }
  }
  return failures;
}

/// What goes: the components that have failed at least half as often as the one that has failed most.
struct LeftOut
{
  std::size_t count = 0;
  double share = 0;                    ///< of the surface's area over its sizes
  std::vector<std::uint8_t> isRemoved; ///< #F
};

LeftOut chooseLeftOut(const Mesh& mesh, const History& before, int threads, FailedParts& failed)
{
  const ComponentSizes sizes = measureComponents(mesh, threads);
  const std::size_t components = sizes.area.size();
  std::vector<Index> componentOfVertex(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    componentOfVertex[mesh.origin[h]] = sizes.componentOfFace[Mesh::face(h)];
  }
  const std::vector<std::size_t> failures = failuresOf(componentOfVertex, components, before);
  const std::size_t most = *std::max_element(failures.begin(), failures.end());
  const auto isHopeless = [&](Index c) { return 2 * failures[c] >= most; };
  LeftOut out;
  double all = 0;
  for (Index c = 0; c < components; ++c)
  {
    const bool goes = isHopeless(c);
    out.count += goes ? 1 : 0;
    out.share += goes ? sizes.area[c] : 0;
    all += sizes.area[c];
  }
  if (most == 0 || out.count == components)
  {
    return {};
  }
  out.share /= all;
  failed.ofComponents = std::max(failed.ofComponents, components);
  for (const Index v : before.failures().back())
  {
    if (isHopeless(componentOfVertex[v]))
    {
      failed.places.push_back(mesh.position[v]);
    }
  }
  for (const Index c : sizes.componentOfFace)
  {
    out.isRemoved.push_back(isHopeless(c) ? 1 : 0);
  }
  return out;
}

} // namespace

History firstHistory(
  const Settled& settled, const SizedSurface& sized, const RemeshOptions& options)
{
  WorkBound bound = boundOf(sized);
  if (hasRest(settled, options))
  {
    bound.work = bound.work / 3 * 2;
    bound.attempts = bound.attempts / 3 * 2;
    bound.attemptsOfLastResort = 0;
  }
  return History(bound);
}

std::optional<Restart> withoutRest(Settled& settled, SizedSurface& sized,
  const RemeshOptions& options, ResultStore* store, Plan& first, const History& before)
{
  if (!hasRest(settled, options))
  {
    return std::nullopt;
  }
  const bool isMatterOfFeatures = leavesNoArea(*before.last().map);
  const bool isOther = simplifyRest(settled, sized, options, store);
  if (!settled.status.ok())
  {
    return std::nullopt;
  }
  const WorkBound bound = boundOf(sized);
  first = firstPlan(*settled.run);
  std::optional<Plan> plan;
  if (!isOther || isMatterOfFeatures)
  {
    plan = withCoarserFeatures(*settled.run, first);
  }
  if (plan)
  {
    setStep(*plan, Try::CoarserFeatures);
  }
  else if (isOther)
  {
    plan = first;
    plan->step = tryRow(Try::FewerDetails).name;
  }
  else
  {
    return std::nullopt;
  }
  return Restart{ std::move(*plan), History(bound, before.work(), before.attempts()),
    Try::FewerDetails, isOther };
}

std::optional<Restart> withoutFailed(Settled& settled, SizedSurface& sized,
  const RemeshOptions& options, ResultStore* store, Plan& first, const History& before,
  FailedParts& failed)
{
  const PreparedSurface& whole = *sized.surface;
  if (!options.leavesOutFailed || !settled.status.ok() || whole.components < 2 ||
    before.failures().empty() || isTooLarge(before.last()))
  {
    return std::nullopt;
  }
  const LeftOut out = chooseLeftOut(whole.mesh, before, options.threads, failed);
  if (out.count == 0)
  {
    return std::nullopt;
  }
  const Attempt& last = before.last();
  failed.components += out.count;
  failed.share += (1 - failed.share) * out.share;
  failed.why = last.quads ? last.quads->status.message : last.map->status.message;
  for (Index f = 0; f < whole.mesh.faceCount(); ++f)
  {
    if (out.isRemoved[f] != 0)
    {
      failed.polygons.push_back(whole.sourcePolygon[f]);
    }
  }
  sortUnique(failed.polygons);
  auto left = std::make_shared<PreparedSurface>(whole);
  removeComponents(*left, out.isRemoved, out.count);
  sized.key = KeyMaker(sized.key).add(left->hash).key();
  sized.starsKey = 0;
  sized.sharedVertices = 0;
  sized.surface = std::move(left);
  if (options.quads)
  {
    sized.targetQuads = static_cast<std::size_t>(
      std::max(1.0, std::round((1 - out.share) * static_cast<double>(sized.targetQuads))));
  }
  countBlocks(sized, options, store);
  settleOther(settled, sized, options, store);
  first = firstPlan(*settled.run);
  Plan plan = first;
  plan.step = tryRow(Try::FewerComponents).name;
  return Restart{ std::move(plan), History(boundOf(sized)), Try::FewerComponents };
}

std::optional<Restart> withYieldingBorders(
  const Settled& settled, const SizedSurface& sized, const Plan& first, const History& before)
{
  if (!settled.status.ok() || isTooLarge(before.last()))
  {
    return std::nullopt;
  }
  std::optional<Plan> plan = withFewerBorders(*settled.run, first, {});
  if (!plan)
  {
    return std::nullopt;
  }
  setStep(*plan, Try::FewerBorders);
  return Restart{ std::move(*plan), History(boundOf(sized)), Try::BordersYield };
}

std::string FailedParts::text() const
{
  if (components == 0)
  {
    return {};
  }
  return why + "; " + countText() +
    (components == 1 ? ", has no quads and was left out" : ", have no quads and were left out");
}

std::string FailedParts::countText() const
{
  std::ostringstream text;
  text << components << " of " << ofComponents << " connected components, with "
       << std::setprecision(2) << 100 * share << " % of the area";
  return text.str();
}

} // namespace quadrille
