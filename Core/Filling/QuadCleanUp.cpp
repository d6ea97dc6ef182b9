// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/QuadCleanUp.h"

#include "Filling/QuadChanges.h"
#include "Filling/QuadRelaxation.h"
#include "Quads/QuadShape.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace quadrille
{

namespace
{

/// Passes over all quads; faces that are not done after so many hardly change any more.
constexpr int kCleanUpPasses = 20;
/// Sweeps of smoothing after each pass, and at the end.
constexpr int kSweeps = 2, kLastSweeps = 10;

using Quad = QuadChanges::Quad;

double worstShape(const FaceQuads& mesh, const std::vector<Quad>& quads)
{
  double worst = 1;
  for (const Quad& quad : quads)
  {
    worst = std::min(worst, shapeOfQuad(mesh, quad));
  }
  return worst;
}

/// How far off angles are by the number of quads, as if each had the same share.
double misfit(const FaceQuads& mesh, Index v, Index count)
{
  const double off = count == 0 ? 0 : std::log(count / mesh.fitting[v]);
  return off * off;
}

/// One pass over all quads, which replaces them where angles come to fit better; whether something was changed.
bool changeQuads(FaceQuads& mesh)
{
  QuadChanges changes(mesh,
    [&mesh](const QuadChanges::Change& change)
    {
      double gain = 0;
      for (const QuadChanges::Count& count : change.counts)
      {
        gain += misfit(mesh, count.point, count.before) - misfit(mesh, count.point, count.after);
      }
      std::vector<Quad> gone;
      std::transform(change.old.begin(), change.old.end(), std::back_inserter(gone),
        [&](Index q) { return mesh.quads[q]; });
      // Smoothing makes those that are not bad better again.
      return gain > 1e-6 &&
        worstShape(mesh, change.made) >= std::min(kLeastShape, worstShape(mesh, gone));
    });
  bool any = false;
  for (Index v = mesh.pinCount; v < changes.pointCount(); ++v)
  {
    any |= changes.tryDoublet(v);
  }
  for (Index h = 0; h < 4 * changes.quadCount(); ++h)
  {
    any |= changes.tryAt(h);
  }
  changes.finish();
  return any;
}

} // namespace

void cleanUpQuads(FaceQuads& mesh, const FaceGround& ground)
{
  bool any = true;
  for (int pass = 0; any && pass < kCleanUpPasses; ++pass)
  {
    relaxQuads(mesh, ground, kSweeps);
    any = changeQuads(mesh);
  }
  relaxQuads(mesh, ground, kLastSweeps);
}

} // namespace quadrille
