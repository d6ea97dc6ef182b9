// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Features of a map that quads cannot follow to their end.
#pragma once

#include "Extraction/ExactMap.h"

#include <string>
#include <vector>

namespace quadrille
{

struct FeatureEnds
{
  /// Vertices, ascending, where a feature curve ends, meets others or the boundary, or turns in the
  /// map, and which are no integer points.
  std::vector<Index> nonInteger;
  /// Feature edges, by their lower half-edge, that lie on no integer isoline.
  std::vector<Index> offIsolines;

  /// "2 ends of features that are no integer points (near 1, 0, 3), 4 feature edges ..."; empty
  /// where there are none.
  std::string text(const Mesh& mesh) const;
};

/// Linear. The boundary counts as a feature only where one ends at it.
FeatureEnds findFeatureEnds(const ExactMap& map);

} // namespace quadrille
