// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What is asked of places of a surface, as part of keys in the store.
#pragma once

#include "Mesh/Surface.h"
#include "Pipeline/ResultStore.h"

namespace quadrille
{

/// Guides, valences, curves and what runs ask of each other, as users give them.
ResultKey requestsKey(const SurfaceInput& input);
/// The same, as a prepared surface has them.
ResultKey requestsKey(const SurfaceRequests& requests);

} // namespace quadrille
