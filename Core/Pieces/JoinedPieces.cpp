// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Pieces/SurfacePiece.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

namespace quadrille
{
namespace
{

/// A shared point of a piece, by what tells it from others.
struct SharedPoint
{
  std::int64_t id = 0;           ///< 0 where points have none
  std::array<double, 3> place{}; ///< the origin where points have ids
  Index piece = 0, point = 0;

  auto key() const { return std::tie(id, place); }
  bool operator<(const SharedPoint& other) const
  {
    return std::tie(id, place, piece, point) <
      std::tie(other.id, other.place, other.piece, other.point);
  }
};

/// An edge between two pieces as one of them has it.
struct BorderUse
{
  std::array<Index, 2> ends{}; ///< points of the joined surface, ascending
  bool isReversed = false;     ///< it runs from ends[1] to ends[0]
  Index piece = 0;
  Index triangle = 0, corner = 0; ///< of the joined surface
  Vector3 normal;

  bool operator<(const BorderUse& other) const
  {
    return std::tie(ends, triangle, corner) < std::tie(other.ends, other.triangle, other.corner);
  }
};

class PieceJoiner
{
public:
  PieceJoiner(
    const std::vector<PieceLevel>& pieces, const std::vector<std::vector<std::int64_t>>& ids)
    : pieces_(pieces), ids_(ids), joined_(pieces.size())
  {
    for (std::size_t p = 0; p < pieces.size(); ++p)
    {
      joined_[p].assign(pieces[p].points.size(), kInvalidIndex);
      if (p < ids.size() && !ids[p].empty() && ids[p].size() != pieces[p].points.size())
      {
        throw InvalidInput("Piece " + std::to_string(p) + " of a surface has " +
          std::to_string(ids[p].size()) + " ids for " + std::to_string(pieces[p].points.size()) +
          " points.");
      }
    }
  }

  JoinedPieces run(std::optional<double> featureAngle)
  {
    addPoints();
    addTriangles();
    if (featureAngle)
    {
      markBorder(*featureAngle);
    }
    return std::move(result_);
  }

private:
  bool hasId(std::size_t piece) const { return piece < ids_.size() && !ids_[piece].empty(); }

  std::vector<SharedPoint> sharedPoints() const
  {
    std::vector<SharedPoint> shared;
    for (std::size_t p = 0; p < pieces_.size(); ++p)
    {
      const PieceLevel& piece = pieces_[p];
      for (std::size_t v = 0; v < piece.points.size(); ++v)
      {
        if (piece.shared[v] == 0)
        {
          continue;
        }
        SharedPoint point{ 0, {}, static_cast<Index>(p), static_cast<Index>(v) };
        if (hasId(p))
        {
          point.id = ids_[p][v];
        }
        else
        {
          for (int i = 0; i < 3; ++i)
          {
            point.place[static_cast<std::size_t>(i)] = piece.points[v][i] + 0.0; // no -0
          }
        }
        shared.push_back(point);
      }
    }
    std::sort(shared.begin(), shared.end());
    return shared;
  }

  /// Points piece by piece; a shared one with the first piece that has it.
  void addPoints()
  {
    const std::vector<SharedPoint> shared = sharedPoints();
    std::vector<std::vector<Index>> first(pieces_.size()); // into `shared`
    for (std::size_t p = 0; p < pieces_.size(); ++p)
    {
      first[p].assign(pieces_[p].points.size(), kInvalidIndex);
    }
    for (std::size_t i = 0, begin = 0; i < shared.size(); ++i)
    {
      begin = i > 0 && shared[i].key() == shared[begin].key() ? begin : i;
      first[shared[i].piece][shared[i].point] = static_cast<Index>(begin);
      result_.sharedPoints += i == begin + 1 ? 1 : 0;
    }
    for (std::size_t p = 0; p < pieces_.size(); ++p)
    {
      for (std::size_t v = 0; v < pieces_[p].points.size(); ++v)
      {
        const Index of = first[p][v];
        Index& mine =
          of == kInvalidIndex ? joined_[p][v] : joined_[shared[of].piece][shared[of].point];
        if (mine == kInvalidIndex)
        {
          mine = static_cast<Index>(result_.surface.points.size());
          result_.surface.points.push_back(pieces_[p].points[v]);
          result_.origin.push_back({ static_cast<Index>(p), static_cast<Index>(v) });
        }
        joined_[p][v] = mine;
      }
    }
  }

  void addTriangles()
  {
    SurfaceInput& surface = result_.surface;
    surface.polygonOffsets = { 0 };
    result_.firstTriangle = { 0 };
    bool hasRequested = false;
    for (std::size_t p = 0; p < pieces_.size(); ++p)
    {
      const PieceLevel& piece = pieces_[p];
      for (const std::array<Index, 3>& triangle : piece.triangles)
      {
        for (const Index v : triangle)
        {
          surface.polygonPoints.push_back(joined_[p][v]);
        }
        surface.polygonOffsets.push_back(static_cast<Index>(surface.polygonPoints.size()));
      }
      surface.detectedFeatures.insert(surface.detectedFeatures.end(),
        piece.detectedFeatures.begin(), piece.detectedFeatures.end());
      surface.featureEdges.insert(
        surface.featureEdges.end(), piece.requestedFeatures.begin(), piece.requestedFeatures.end());
      hasRequested = hasRequested ||
        std::any_of(piece.requestedFeatures.begin(), piece.requestedFeatures.end(),
          [](std::uint8_t bits) { return bits != 0; });
      result_.firstTriangle.push_back(static_cast<Index>(surface.polygonOffsets.size() - 1));
    }
    if (!hasRequested)
    {
      surface.featureEdges.clear();
    }
  }

  std::vector<BorderUse> borderUses() const
  {
    std::vector<BorderUse> uses;
    for (std::size_t p = 0; p < pieces_.size(); ++p)
    {
      for (const BorderEdge& edge : pieces_[p].border)
      {
        const std::array<Index, 3>& corners = pieces_[p].triangles[edge.triangle];
        const Index a = joined_[p][corners[edge.corner]];
        const Index b = joined_[p][corners[(edge.corner + 1) % 3]];
        uses.push_back({ { std::min(a, b), std::max(a, b) }, b < a, static_cast<Index>(p),
          result_.firstTriangle[p] + edge.triangle, edge.corner, edge.normal });
      }
    }
    std::sort(uses.begin(), uses.end());
    return uses;
  }

  void markBorder(double featureAngle)
  {
    const double limit = std::cos(featureAngle);
    const std::vector<BorderUse> uses = borderUses();
    for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end)
    {
      while (end < uses.size() && uses[end].ends == uses[begin].ends)
      {
        ++end;
      }
      if (end - begin != 2)
      {
        continue; // the end of the surface, or more than two faces: no edge of a manifold
      }
      const BorderUse& one = uses[begin];
      const BorderUse& other = uses[begin + 1];
      const double cosine = one.normal.dot(other.normal);
      if ((one.isReversed != other.isReversed ? cosine : -cosine) < limit)
      {
        for (const BorderUse* use : { &one, &other })
        {
          std::uint8_t& bits = result_.surface.detectedFeatures[use->triangle];
          bits = static_cast<std::uint8_t>(bits | 1U << use->corner);
        }
      }
    }
  }

  const std::vector<PieceLevel>& pieces_;
  const std::vector<std::vector<std::int64_t>>& ids_;
  std::vector<std::vector<Index>> joined_; ///< of each point of each piece, that of the surface
  JoinedPieces result_;
};

} // namespace

JoinedPieces joinPieces(const std::vector<PieceLevel>& pieces,
  const std::vector<std::vector<std::int64_t>>& ids, std::optional<double> featureAngle)
{
  return PieceJoiner(pieces, ids).run(featureAngle);
}

} // namespace quadrille
