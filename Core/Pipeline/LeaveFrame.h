// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a run made in its frame (see Prepare/Frame.h), back on the user's surface. Where the frame's faces run the
/// other way round, corners 0 1 2 become 0 2 1 everywhere and u and v change places, so that maps stay positive.
#pragma once

#include "Pipeline/Pipeline.h"
#include "Prepare/Frame.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// positions: userPositions of the finest level.
void leaveFrame(Level& level, const Frame& frame, const std::vector<Vector3>& positions);
/// The surface with its guides and measures.
void leaveFrame(PreparedSurface& surface, const Frame& frame, std::vector<Vector3> positions);
/// Points on vertices of the mapped mesh get their positions, others the place between them. mapped: still in the
/// frame.
void leaveFrame(
  QuadMesh& quads, const Mesh& mapped, const Frame& frame, const std::vector<Vector3>& positions);

/// The map of a mesh whose faces were reversed, or are to be. uv: #H.
void reverseMap(std::vector<FixedVec2>& uv);
/// The same of its matching, #H.
void reverseMatching(std::vector<std::int8_t>& matching);

/// Of a preview, which has no surface: quads and measures. What tells of the mapped mesh goes.
void leaveFrameAlone(RemeshResult& result, const Frame& frame);

/// Of a result without its surface: quads and measures. made: the surface in the frame. points: FramedInput::points.
void leaveFrame(RemeshResult& result, const PreparedSurface& made, const Frame& frame,
  const std::vector<Vector3>& points);

/// All of a result, or all but the positions of its surface, which go; the coarse level has those of the frame then.
/// points: FramedInput::points.
void leaveFrame(RemeshResult& result, const Frame& frame, const std::vector<Vector3>& points,
  bool keepsPositions, int threads);

} // namespace quadrille
