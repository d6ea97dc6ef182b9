// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A mirror plane's curve as the mid-line of quads: each of them is its own image, with two corners in front and two
/// behind. The half in front gets a map with the curve on an isoline and straight, and that boundary then moves by half
/// a quad. So the map of the half and its image is an integer-grid map, with the curve at half numbers, and the quads
/// are those of this map.
#pragma once

#include "Features/GivenUpFeatures.h"
#include "Pipeline/Pipeline.h"
#include "Symmetry/Copies.h"
#include "Symmetry/PlaneCut.h"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille
{

/// Asks of the half that the plane's curve is straight in its map. tolerance: within which places are in the plane.
/// Throws InvalidInput, with the place, where features meet in the plane: there is no point of the quads.
void askMidLine(SurfacePart& half, double tolerance);

/// Takes the features that lie in the plane between both sides of a surface off its mesh, as quads will have nothing
/// there. Returns them; notices get one of their lengths and a place.
std::vector<GivenUpCurve> giveUpInPlane(Mesh& mesh, const MirrorPlane& plane, double tolerance,
  double edgeLength, std::vector<std::string>& notices);

/// The length of the half's boundary in the plane, each edge over the size asked for there.
double midLineLength(const SurfacePart& half, double tolerance);

/// Flags of vertices that have other turns than regular ones.
std::vector<std::uint8_t> irregularOf(const Mesh& mesh, const std::vector<int>& turns);

/// The map of the whole, which becomes that of `whole`, is the half's with its boundary in the plane half a quad
/// inside, and its quads are returned. Rows of quads beside the plane are evened out; irregular vertices and what lies
/// beyond those rows stay. Not ok where there is no room, with a place.
CopiedQuads quadsAcross(const RemeshResult& half, const RemeshOptions& options,
  const Isometry& mirror, CopiedMesh& whole);

/// The quads of the copied map as copyQuads() has them: those of the half, their images, and then those that are
/// their own images. extracted: of the copied mesh; its points in front count, those behind become their images. Not
/// ok where there is a pair of points in front and behind that belongs to two quads across the plane.
CopiedQuads foldQuads(const QuadMesh& extracted, const CopiedMesh& copied, const Isometry& mirror);

} // namespace quadrille
