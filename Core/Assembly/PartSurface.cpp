// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Assembly/PartSurface.h"

#include "Base/Angles.h"
#include "Base/Progress.h"
#include "Mesh/Topology.h"

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <vector>

namespace quadrille
{
namespace
{

/// Quarter turns of the map within a fan of faces, from corner to corner; its border lies on isolines.
int turnsWithin(const std::vector<FixedVec2>& uv, const std::vector<Index>& corners)
{
  double angle = 0;
  for (const Index h : corners)
  {
    const FixedVec2 origin = uv[h], next = uv[Mesh::next(h)], previous = uv[Mesh::previous(h)];
    const Vector2 a(toDouble(next.u - origin.u), toDouble(next.v - origin.v));
    const Vector2 b(toDouble(previous.u - origin.u), toDouble(previous.v - origin.v));
    angle += std::atan2(parallelogram(a, b), a.dot(b));
  }
  return static_cast<int>(std::lround(angle / (0.5 * kPi)));
}

/// The faces of a part as a surface of its own.
class PartSurface
{
public:
  PartSurface(const CutSource& source, const FaceParts& faceParts, std::size_t part)
    : source_(source), result_(source.result), whole_(source.result.surface.mesh),
      faceParts_(faceParts), faces_(faceParts.faces(part)), part_(static_cast<Index>(part))
  {
  }

  void write(RemeshResult& to)
  {
    Mesh& mesh = to.surface.mesh;
    mesh.origin.assign(3 * faces_.size(), kInvalidIndex);
    for (const Index f : faces_)
    {
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        const Index g = whole_.twin[h];
        const bool isInside = g != kInvalidIndex && faceParts_.has(part_, Mesh::face(g));
        mesh.twin.push_back(isInside ? faceParts_.ownHalfEdge(part_, g) : kInvalidIndex);
        mesh.flags.push_back(whole_.flags[h]);
        if (!result_.uv.empty())
        {
          to.uv.push_back(result_.uv[h]);
        }
      }
    }
    writeVertices(to);
    const JoinedParts& joined = source_.joined;
    writeSources(joined.parts[part_], joined.firstPolygon[part_], to.surface);
    faceComponents(mesh, to.surface.components);
    to.surface.boundingBoxDiagonal = result_.surface.boundingBoxDiagonal;
  }

private:
  /// A vertex for each fan: a part may touch itself where other parts lie between.
  void writeVertices(RemeshResult& to) const
  {
    Mesh& mesh = to.surface.mesh;
    std::vector<Index> corners;
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      pollNowAndThen(h);
      if (mesh.origin[h] != kInvalidIndex)
      {
        continue;
      }
      const Index v = whole_.origin[wholeHalfEdge(h)];
      const Index own = mesh.vertexCount();
      Index first = h;
      for (Index g = mesh.twin[h]; g != kInvalidIndex && Mesh::next(g) != h; g = mesh.twin[first])
      {
        first = Mesh::next(g);
      }
      corners.clear();
      for (Index g = first; g != kInvalidIndex && mesh.origin[g] == kInvalidIndex;
           g = mesh.twin[Mesh::previous(g)])
      {
        mesh.origin.edit()[g] = own;
        corners.push_back(g);
      }
      mesh.position.push_back(whole_.position[v]);
      if (!whole_.sizing.empty())
      {
        mesh.sizing.push_back(whole_.sizing[v]);
      }
      if (!result_.framePositions.empty())
      {
        to.framePositions.push_back(result_.framePositions[v]);
      }
      if (!result_.turns.empty())
      {
        to.turns.push_back(mesh.isBoundary(first) ? turnsWithin(to.uv, corners) : result_.turns[v]);
      }
    }
  }

  Index wholeHalfEdge(Index own) const { return 3 * faces_[own / 3] + own % 3; }

  void writeSources(
    const JoinedParts::Part& own, Index firstPolygon, PreparedSurface& surface) const
  {
    const PreparedSurface& from = result_.surface;
    for (const Index f : faces_)
    {
      const Index polygon = faceParts_.ownerIn(part_, f)->polygon - firstPolygon;
      surface.sourcePolygon.push_back(polygon);
      std::array<Index, 3> points{};
      for (std::size_t i = 0; i < 3; ++i)
      {
        points[i] = own.ownPoint(source_.jointPoint(from.sourcePoints[f][i]));
        if (points[i] == kInvalidIndex)
        {
          // Repair has moved the corner to a point that only another part has.
          points[i] = own.polygonPoints[own.polygonOffsets[polygon]];
        }
      }
      surface.sourcePoints.push_back(points);
      if (!from.refinedEntry.empty())
      {
        const Index entry = from.refinedEntry[f];
        surface.refinedEntry.push_back(
          entry == kInvalidIndex ? entry : static_cast<Index>(surface.cornerWeights.size()));
        if (entry != kInvalidIndex)
        {
          surface.cornerWeights.push_back(from.cornerWeights[entry]);
        }
      }
      const Mesh& mesh = whole_;
      surface.area += mesh.faceArea(f);
    }
  }

  const CutSource& source_;
  const RemeshResult& result_;
  const Mesh& whole_;
  const FaceParts& faceParts_;
  const std::vector<Index>& faces_;
  Index part_;
};

} // namespace

void writePartSurface(
  const CutSource& source, const FaceParts& faceParts, std::size_t part, RemeshResult& to)
{
  PartSurface(source, faceParts, part).write(to);
}

} // namespace quadrille
