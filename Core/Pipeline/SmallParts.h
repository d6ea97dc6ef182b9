// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Handles and holes that quads of the size asked for cannot resolve.
#pragma once

#include "Details/Handles.h"
#include "Hierarchy/Hierarchy.h"

#include <string>
#include <vector>

namespace quadrille
{

/// So many quads a loop needs, at least, round a handle, through it or round a hole: shorter ones are not resolved.
constexpr double kQuadsOfLoop = 3;
/// So many are made to fit round a shorter one. Loops of the intermediate level are up to a tenth too short, and of
/// four quads a map may leave two, which touch: where nothing else has led to quads, handles below are cut.
constexpr double kQuadsOfSafeLoop = 4;

/// What quads of the target edge length s cannot resolve. Measured on the intermediate level, whose edges are about s/2
/// to s long: loops about as long as 3 s come out a tenth too short, those of one or two s up to 40 %.
struct SmallParts
{
  std::size_t handles = 0; ///< genus, the sum over all components
  std::size_t unresolvedHandles =
    0; ///< those with a loop shorter than kQuadsOfLoop s, see findHandles
  /// The shortest loop round or through a handle, in units of the input; 0 without handles. Above kQuadsOfLoop s
  /// another one may be somewhat shorter.
  double shortestLoop = 0;
  Vector3 place = Vector3::Zero(); ///< the middle of that loop
  bool complete = true;            ///< false: too many to look at all
  BoundaryReport boundary;         ///< of the prepared surface
};

/// The same with the loops themselves, on the finest level.
struct ShortLoops
{
  SmallParts parts;
  std::vector<HandleLoop> loops; ///< round handles and holes, shorter than kQuadsOfLoop s
};

/// edgeLength: s, in units of the meshes. smallest: RemeshOptions::smallestDetail; loops that might be short enough to
/// be cut are measured on the finest mesh, too. threads: 0: all.
ShortLoops measureSmallParts(
  const Level& intermediate, const Mesh& finest, double edgeLength, double smallest, int threads);

/// The size of quads as messages tell it.
struct QuadSize
{
  double edgeLength = 0;          ///< s
  double unit = 1;                ///< of the user, in which lengths are told
  std::size_t quads = 0;          ///< asked for
  std::size_t maximumOfQuads = 0; ///< that may be made
};

/// What of the handles, and of the boundary loops, is not resolved, where, and what to do; empty where all is.
std::string unresolvedHandlesText(const SmallParts& parts, const QuadSize& size);
std::string tinyHolesText(const SmallParts& parts, const QuadSize& size);

} // namespace quadrille
