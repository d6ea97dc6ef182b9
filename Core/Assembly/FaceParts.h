// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A result that is cut up by parts (see Assembly/PartSplit.h), and whose its faces are.
#pragma once

#include "Assembly/JoinParts.h"
#include "Assembly/JointSheets.h"
#include "Assembly/SheetJoints.h"
#include "Base/Progress.h"
#include "Pipeline/Pipeline.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace quadrille
{

/// What is cut up: a result, with what says whose its polygons and points are.
struct CutSource
{
  const RemeshResult& result;
  const JoinedParts& joined;
  const JointSheets* sheets = nullptr; ///< where the surface is of sheets
  const MetSheets* met = nullptr;
  QuadMesh quads; ///< of the result, each on a face of the parts that it goes to

  /// Polygons of the joint surface at a face.
  std::vector<Index> polygonsAt(Index face) const
  {
    const Index polygon = result.surface.sourcePolygon[face];
    return sheets != nullptr ? sheets->polygons[polygon] : std::vector<Index>{ polygon };
  }
  Index jointPoint(Index point) const
  {
    return sheets != nullptr ? sheets->jointPoint[point] : point;
  }
  /// The lowest point of the quads that is the same.
  Index same(Index point) const { return met != nullptr ? met->same[point] : point; }
};

/// Whose the faces are: of one part, or, where parts share a face, of several.
class FaceParts
{
public:
  explicit FaceParts(const CutSource& source)
    : first_(source.result.surface.mesh.faceCount() + 1, 0), faces_(source.joined.parts.size())
  {
    for (Index f = 0; f + 1 < first_.size(); ++f)
    {
      pollNowAndThen(f);
      for (const Index polygon : source.polygonsAt(f))
      {
        const Index part = source.joined.partOf(polygon);
        owners_.push_back({ part, static_cast<Index>(faces_[part].size()), polygon });
        faces_[part].push_back(f);
      }
      first_[f + 1] = static_cast<Index>(owners_.size());
    }
  }

  struct Owner
  {
    Index part, face; ///< the face's id in the part
    Index polygon;    ///< of the joint surface
  };

  /// Null where the part does not have the face.
  const Owner* ownerIn(Index part, Index face) const
  {
    for (Index i = first_[face]; i < first_[face + 1]; ++i)
    {
      if (owners_[i].part == part)
      {
        return &owners_[i];
      }
    }
    return nullptr;
  }
  bool has(Index part, Index face) const { return ownerIn(part, face) != nullptr; }
  Index ownFace(Index part, Index face) const { return ownerIn(part, face)->face; }
  Index ownHalfEdge(Index part, Index h) const { return 3 * ownFace(part, h / 3) + h % 3; }
  const std::vector<Index>& faces(std::size_t part) const { return faces_[part]; }
  template <class Visit>
  void forEachOwner(Index face, const Visit& visit) const
  {
    std::for_each(owners_.begin() + first_[face], owners_.begin() + first_[face + 1], visit);
  }

private:
  std::vector<Index> first_; ///< per face, in owners_
  std::vector<Owner> owners_;
  std::vector<std::vector<Index>> faces_;
};

} // namespace quadrille
