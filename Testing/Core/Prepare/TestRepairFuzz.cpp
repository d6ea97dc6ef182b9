// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Random damage: whatever comes in, a valid surface or a clear error comes out.
#include "Prepare/Refine.h"
#include "RandomSurface.h"
#include "SurfaceInputs.h"

namespace quadrille
{

using namespace test;

TEST(RepairFuzz, AValidSurfaceOrAnError)
{
  int prepared = 0;
  for (unsigned seed = 0; seed < 1000; ++seed)
  {
    SCOPED_TRACE(seed);
    const SurfaceInput input = RandomSurface(seed).make();
    PreparedSurface surface;
    try
    {
      surface = prepare(input, 0.7);
    }
    catch (const InvalidInput& error)
    {
      EXPECT_STRNE(error.what(), "");
      continue;
    }
    ++prepared;
    expectSound(surface, input);
    // No two edges join the same vertices: the twins follow from the corners alone.
    EXPECT_EQ(pairHalfEdges(surface.mesh.origin, surface.mesh.vertexCount()), surface.mesh.twin);
    refineSurface(surface, 0.3 * surface.boundingBoxDiagonal, {});
    expectSound(surface, input);
    for (Index f = 0; f < surface.mesh.faceCount(); ++f)
    {
      EXPECT_LE(surface.mesh.isConstrained(3 * f) + surface.mesh.isConstrained(3 * f + 1) +
          surface.mesh.isConstrained(3 * f + 2),
        1);
    }
  }
  EXPECT_GT(prepared, 900); // errors are for Moebius strips and for what has no area at all
}

} // namespace quadrille
