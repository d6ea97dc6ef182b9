// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Sharp edges that are creases, and those that are the facets of a smooth surface: on a coarse or noisy sampling of
/// one the angles between faces are of all sizes, and those above any limit are no lines that quads could follow.
#pragma once

#include "Mesh/Mesh.h"

#include <functional>
#include <vector>

namespace quadrille
{

/// Detected features (without kRequestedFeature) that do not stand out from their surroundings, one half-edge each.
/// `angleOf` gives the angle between the normals of the two faces of an inner half-edge (radians) and must be callable
/// from several threads; `featureAngle` is the angle from which on edges were marked.
///
/// Within three rings of an edge e, other edges e' count by their length times the squared cosine between the two:
/// those that bend the surface as e does. A crease has creases or nothing much beside it; round the edge of a facet
/// some of the weight belongs to edges that are a little blunter than a feature (above 0.6 of the feature angle, and
/// above 0.4 of the angle of e). An edge goes where the mean of that part over the sharp edges nearby exceeds a tenth;
/// edges that have gone count as blunt ones in the next round. An edge on a chain of at least 12 that bends by less
/// than 20 degrees at each vertex stays: noise makes no such lines. At last connected edges without such a chain go
/// where more length went near them than they have.
std::vector<Index> edgesOfFacets(
  const Mesh& mesh, double featureAngle, const std::function<double(Index)>& angleOf, int threads);

} // namespace quadrille
