// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Restarts.h"

#include "Pipeline/FirstPlan.h"
#include "Pipeline/Strategies.h"

#include <utility>

namespace quadrille
{
WorkBound boundOf(const SizedSurface& sized)
{
  return workBound(sized.surface->mesh.faceCount(), sized.targetQuads, sized.work);
}

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

} // namespace quadrille
