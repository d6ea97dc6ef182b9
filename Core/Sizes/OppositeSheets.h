// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// How thick the solid is, and how wide the gaps outside of it.
#pragma once

#include "Sizes/Curvature.h"

#include <vector>

namespace quadrille
{

/// #patches: the distance from each patch to the first sheet opposite, along its normal either way; infinite where
/// there is none within `reach`. Of a patch and its neighbours the median counts, so that a ray that slips through a
/// hole, or meets a spike, does not. Sheets whose normals are more than 45 degrees from opposite do not count.
std::vector<float> distancesToOpposite(
  const Mesh& mesh, const SurfacePatches& patches, double reach, int threads);

} // namespace quadrille
