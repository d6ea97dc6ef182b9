// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A surface that is made of the faces of cells has sharp edges all over. Quads that are larger than the cells follow
/// the shape that these sample, and none of their steps.
#pragma once

#include "Pipeline/SizedSurface.h"

namespace quadrille
{

/// Where the surface is made of cells: steps lower than the smallest detail are no features any more, nor are curves
/// that go by steps shorter than that, and the rest of the features is judged again, as on a scan. sized: tells them,
/// for its edge length. Whether there were any.
bool dropSteps(PreparedSurface& surface, const RemeshOptions& options, SizeReport& sized);

/// The same for the surface that attempts begin with, which gets another key then.
void dropSteps(SizedSurface& sized, const RemeshOptions& options);

} // namespace quadrille
