// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Whether options of a hierarchy make sense for its finest mesh.
#pragma once

#include "Hierarchy/Hierarchy.h"
#include "Mesh/Mesh.h"

namespace quadrille
{

/// Both throw InvalidInput.
/// What may change from one update to the next.
void checkPhase2(const Mesh& fine, const HierarchyOptions& options);

void checkOptions(const Mesh& fine, const HierarchyOptions& options);

} // namespace quadrille
