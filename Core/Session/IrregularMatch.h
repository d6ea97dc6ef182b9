// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Which irregular vertices of a result are those that operations lead to.
#pragma once

#include "Evaluation/QuadPlaces.h"
#include "Quads/QuadMesh.h"
#include "Session/Constraints.h"
#include "Symmetry/Isometry.h"

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <vector>

namespace quadrille
{

struct IrregularMatch
{
  std::vector<std::optional<std::size_t>> actual; ///< of each expected one
  std::vector<std::size_t> unexpected;            ///< of the actual ones, ascending
};

/// Pairs of the same valence at most reach apart, as many as can be, each vertex in one at most; the nearest ones where
/// that leaves no other without a partner. reach: of each expected one. mayPair(expected, actual): of those in reach;
/// empty: all.
IrregularMatch matchIrregular(const std::vector<IrregularVertex>& expected,
  const std::vector<IrregularVertex>& actual, const std::vector<double>& reach,
  const std::function<bool(std::size_t, std::size_t)>& mayPair = {});

/// Points of the quads whose valence is not that of a regular one, on features and boundaries too; on boundaries it is
/// one more than the edges. In the order of places.
std::vector<IrregularVertex> irregularPoints(const QuadMesh& quads);

/// What the quads are to have: those of the list, and their images in a symmetry of the quads.
std::vector<ValencePlace> expectedIrregular(
  const std::vector<IrregularVertex>& shown, const std::optional<Isometry>& symmetry);

/// Where the quads show an irregular vertex, from which smoothing has moved it.
struct ShownPlace
{
  Vector3 point = Vector3::Zero();
  double edgeLength = 0;            ///< of the quads there, the mean
  Vector3 normal = Vector3::Zero(); ///< of the quads there, unit; zero: not known
};
/// By the places of the vertices.
using ShownPlaces = std::map<Vector3, ShownPlace, PlaceOrder>;
/// Of irregular vertices inside those that have a partner of the same valence among the points of the quads inside, two
/// edge lengths away at most and on the same side of a thin wall. nearest: of the quads.
ShownPlaces shownPlaces(const std::vector<IrregularVertex>& irregular, const QuadMesh& quads,
  const NearestQuads& nearest);

/// The list as it is after a change: of those of the valence before the one nearest to the place goes, and one of the
/// valence after comes to it.
void change(std::vector<IrregularVertex>& shown, const IrregularEdit::Change& made);

} // namespace quadrille
