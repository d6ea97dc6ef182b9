// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What vertices, faces, records and curves of one level are called on another one.
#pragma once

#include "Hierarchy/FeatureCurves.h"
#include "Hierarchy/Hierarchy.h"

#include <optional>

namespace quadrille
{

/// The vertex of the level that is vertex v of the finest one, if it is there.
std::optional<Index> positionIn(const Level& level, Index v);

/// A level of a level, in terms of the finest mesh.
Level inFineTerms(Level level, const Level& above);

/// The same for records.
BlockRecords inFineTerms(BlockRecords records, const Level& above);

/// The curves among the vertices of a level; the ends of curves are on every level.
FeatureCurves curvesOf(const Level& level, const FeatureCurves& fine);

} // namespace quadrille
