// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A few faces round defects of a map, with what of their vertices may move.
#pragma once

#include "Base/FixedPoint.h"
#include "Mesh/Mesh.h"
#include "Transfer/DefectSearch.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille
{

/// How a vertex of a patch may move.
enum class PatchFreedom : std::uint8_t
{
  Fixed,
  AlongU, ///< in the chart of its first corner
  AlongV,
  Plane
};

/// A corner of a vertex and the rotation from the chart of the first corner of its fan to its own.
struct PatchCorner
{
  Index corner = 0; ///< of the mesh
  int rotation = 0;
};

struct PatchVertex
{
  PatchFreedom freedom = PatchFreedom::Fixed;
  bool interior = false;
  std::size_t firstFan = 0; ///< range of the patch's fans
  std::size_t fanCount = 0;
  int firstUnknown = 0;
};

/// One patch after the other of the same map; all before release() is of the one that began last.
class MendedPatch
{
public:
  MendedPatch(const Mesh& mesh, std::vector<FixedVec2>& uv, const std::vector<int>& expectedTurns)
    : mesh_(mesh), uv_(uv), expectedTurns_(expectedTurns), defects_(mesh, uv, expectedTurns),
      inPatch_(mesh.faceCount(), 0), seenVertex_(mesh.vertexCount(), 0)
  {
  }

  /// Of a face and those that are not positive next to it, and so on.
  void beginAt(Index seed, std::size_t maximumFaces);
  /// By all faces that touch one of the patch, where it does not have more already.
  void grow(std::size_t maximumFaces);
  void release();

  /// Sorted once it has grown.
  const std::vector<Index>& faces() const { return faces_; }
  const std::vector<std::uint8_t>& inPatch() const { return inPatch_; } ///< #F flags

  /// The vertices of the patch with all their corners, and how they may move.
  void collectFans();
  const std::vector<PatchVertex>& vertices() const { return vertices_; }
  const std::vector<PatchCorner>& fans() const { return fans_; }
  int unknowns() const { return unknowns_; }

  /// Triangles that are not positive, and vertices of wrong turns, of the patch as collectFans left it; those with
  /// positive triangles only count more: nothing shows the untangler, or the extraction, where the turn was lost.
  std::size_t countDefects() const;

  /// uv of the corners of the patch, face after face.
  std::vector<FixedVec2> corners() const;
  void restore(const std::vector<FixedVec2>& corners);
  /// y: the unknowns.
  void applyDisplacements(const Eigen::VectorXd& y);

private:
  void addFacesAround(Index corner);
  void addFan(Index corner);
  bool walkFan(Index corner, std::vector<PatchCorner>& fan, bool& interior) const;
  PatchFreedom freedomOf(const std::vector<PatchCorner>& fan, bool interior, bool closes) const;

  const Mesh& mesh_;
  std::vector<FixedVec2>& uv_;
  const std::vector<int>& expectedTurns_;
  DefectSearch defects_;
  std::vector<std::uint8_t> inPatch_;
  std::vector<std::uint8_t> seenVertex_;
  std::vector<Index> faces_;
  std::vector<PatchVertex> vertices_;
  std::vector<PatchCorner> fans_;
  int unknowns_ = 0;
};

} // namespace quadrille
