// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A failure stays in its face: where a surface of one connected component has no map, the faces between features in
/// which that was are cut out, and filled with quads once the rest has some.
#pragma once

#include "Filling/FaceFilling.h"
#include "Pipeline/Division.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

struct CutFaces
{
  PreparedSurface faces;              ///< that go without a map, with the features between them
  std::vector<std::uint8_t> isShared; ///< #H of its mesh: of its boundary, where the rest was
  std::vector<Vector3>
    beyond; ///< of these half-edges, ascending: the middle of the rest's face there
  std::vector<Index> curves;   ///< which of the whole's pass through them
  std::vector<Vector3> inside; ///< a point of each face
  double share = 0;            ///< of the area over the sizes
  std::size_t count = 0;
  std::optional<SizedPart> rest; ///< none where these are all
};

/// Whether features cut a surface into several faces, and parts of its boundary have not to fit others, which quads
/// without a map do not care for.
bool mayCutFaces(const PreparedSurface& surface, const RemeshOptions& options);
/// Whether the features are those of a designed body, or someone has asked for all of them: then none is given up for a
/// map. On others they are found by their angle, and those near a failure go before faces are cut out; a line that is
/// drawn there says nothing of them.
bool keepsFeatures(const PreparedSurface& surface);
/// Whether attempts on such a surface have no quads yet, and not as what was asked for contradicts itself.
bool isCutAtFaces(
  const PreparedSurface& surface, const RemeshOptions& options, const History& history);
/// Whether it is filled: cut at faces, or as a whole where the features of a designed body leave it in one piece.
bool isFilled(const PreparedSurface& surface, const RemeshOptions& options, const History& history);
/// The faces that the places lie in, as SurfaceRequests::withoutMap.
FailedFaces facesAt(const std::vector<Vector3>& places, const Mesh& mesh);
/// #F: whether a triangle belongs to one of the faces.
std::vector<std::uint8_t> isInFaces(const Mesh& mesh, const FailedFaces& faces);
/// Adds those at places, as where quads do not fit; whether there are any that had not failed.
bool addFacesAt(const std::vector<Vector3>& places, const SizedSurface& whole, FailedFaces& failed);
/// What is asked for on the faces, their boundary included, is not asked of the rest, but for vertices on features that
/// are held: these are in the rest what they were there.
CutFaces cutFaces(const SizedSurface& whole, const FailedFaces& failed, int threads);

/// The faces with quads that meet those of the rest.
struct FilledPart
{
  QuadMesh quads;            ///< on the mesh of the faces; the first points are those of the rest
  std::vector<Index> points; ///< which of the rest's these are
  std::vector<std::array<Index, 2>>
    same;                        ///< of the rest's points the first one is to be the second one
  std::vector<Vector3> failedAt; ///< why there are none
};
/// Where quads of faces and of the rest do not meet; empty where all is well.
std::vector<Vector3> gapsIn(const QuadMesh& quads);

/// What to tell of them. quads, all: targetQuads and quadsOfAll of the surface that they are cut from.
std::string filledText(const CutFaces& cut, std::size_t quads, std::size_t all);

/// A face, with sizes, as a surface of its own, without what is asked of it. One attempt is made at it.
SizedSurface faceAlone(const Mesh& face, const SizedSurface& whole, int threads);

/// rest: the surface and the quads of the rest, which get strips of quads where an odd number of edges goes round a
/// face. quadsOf: see fillFace.
FilledPart fillCutFaces(const CutFaces& cut, const Mesh* restMesh, QuadMesh* restQuads,
  double edgeLength, const QuadsOfFace& quadsOf);

} // namespace quadrille
