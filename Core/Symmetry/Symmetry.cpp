// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/Symmetry.h"

#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Base/TryCount.h"
#include "Symmetry/SymmetryRun.h"

#include <optional>

namespace quadrille
{

SymmetricResult remeshSymmetric(SurfaceInput input, const RemeshOptions& options,
  const SymmetryOptions& symmetry, ResultStore* store)
{
  refuseIf(!input.detectedFeatures.empty(),
    "features that were detected on a finer surface cannot be cut by a symmetry: "
    "give them as feature edges.");
  const TryScope tries; // but for those of the part's runs
  std::optional<SymmetryRun> run;
  // What is left to do after a stop that has kept the quads of the part is short, and does not ask again.
  PollScope poll(!options.progress ? ProgressCallback()
                                   : [&](double fraction, const std::string& text)
      { return (run && run->isStopped()) || options.progress(fraction, text); });
  RemeshOptions ownOptions = options;
  ownOptions.progress = poll.callback();
  try
  {
    refuseIf(symmetry.planeCurve == PlaneCurve::MidLine && symmetry.rotation,
      "a mid-line of quads belongs to a mirror plane, and a rotation has none: "
      "choose an isoline, or a mirror plane");
    refuseIf(symmetry.planeCurve == PlaneCurve::MidLine && options.method == MapMethod::Seamless,
      "the method 'seamless' makes no quads, and a mid-line is made of them: "
      "choose scale aware, or an isoline for the plane's curve");
    run.emplace(ownOptions, symmetry, store);
    SymmetricResult made = run->run(input);
    made.remeshed.tries.add(tries.counts());
    return made;
  }
  catch (const Cancelled&)
  {
    SymmetricResult stopped;
    stopped.remeshed.becomeStopped();
    return stopped;
  }
}

std::optional<Isometry> isometryOf(const MadeSymmetry* made)
{
  if (made == nullptr || (made->mirrorPoint.empty() && made->rotatedPoint.empty()))
  {
    return std::nullopt;
  }
  return made->rotation ? Isometry::of(made->rotation->axis, made->rotation->order)
                        : Isometry::of(made->plane);
}

ConstraintWord judgeSymmetry(const MadeSymmetry& made)
{
  ConstraintWord word;
  word.kind = made.rotation ? "rotation" : "symmetry";
  word.place = made.deviation.place;
  word.isMet = made.isAlike;
  word.deviation = made.deviation.rms / made.diagonal;
  word.deviation95 = made.deviation.maximum / made.diagonal;
  word.unit = "relative to the diagonal";
  if (!word.isMet)
  {
    word.reason = made.rotation ? "the wedges of the surface are not alike, see the notices"
                                : "the two sides of the surface are not alike, see the notices";
  }
  return word;
}

} // namespace quadrille
