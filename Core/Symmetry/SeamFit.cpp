// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
// The points of a seam half way between their two places, and those round it: fitSeams.
#include "Base/Lists.h"
#include "Evaluation/QuadQuality.h"
#include "Quads/QuadProjection.h"
#include "Symmetry/Seams.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille
{

namespace
{

/// How often moves of the seam are passed on to the points round it.
constexpr int kSpreads = 16;
/// Rounds of smoothing, of points so many edges from the seam.
constexpr int kSeamRounds = 4;
constexpr int kSeamRings = 2;

/// Positions round the seams of a wedge.
class SeamFit
{
public:
  SeamFit(QuadMesh& quads, const CutQuads& cut, const Isometry& rotation,
    const SearchedSurface& whole, double tolerance)
    : quads_(quads), cut_(cut), pairs_(cut.pairs), rotation_(rotation), whole_(whole),
      tolerance_(tolerance)
  {
  }

  std::vector<std::uint8_t> run()
  {
    findRoles();
    findNeighbours();
    normals_ = pointNormals(quads_.points, quads_.quads);
    const std::vector<Vector3> before = quads_.points;
    followPairs();
    const std::size_t given = countUnsound();
    quads_.points = before;
    meetHalfWay();
    const std::vector<Vector3> met = quads_.points;
    smooth();
    if (countUnsound() > given)
    {
      quads_.points = met;
    }
    if (countUnsound() > given)
    {
      quads_.points = before;
      followPairs();
    }
    std::vector<std::uint8_t> moved(before.size(), 0);
    for (std::size_t p = 0; p < before.size(); ++p)
    {
      moved[p] = quads_.points[p] != before[p] ? 1 : 0;
    }
    return moved;
  }

private:
  enum class Role : std::uint8_t
  {
    Free,
    OnFeature,
    OnBoundary,
    Stays
  };

  void findRoles()
  {
    const std::size_t count = quads_.points.size();
    isPaired_.assign(count, 0);
    for (const SamePoints& pair : pairs_)
    {
      isPaired_[pair.first] = isPaired_[pair.second] = 1;
    }
    role_.assign(count, Role::Free);
    const auto add = [&](Index p, Role role)
    { role_[p] = role_[p] == Role::Free || role_[p] == role ? role : Role::Stays; };
    for (std::size_t l = 0; l < quads_.lines.size(); ++l)
    {
      const QuadLine& line = quads_.lines[l];
      if (cut_.lines[l] == CutQuads::Own)
      {
        const Role role = line.boundary ? Role::OnBoundary : Role::OnFeature;
        add(line.a, role);
        add(line.b, role);
      }
    }
    for (std::size_t p = 0; p < count; ++p)
    {
      // Where the map has it, and where it may have been asked for.
      const bool isIrregular = quads_.onBoundary[p] == 0 && quads_.valence[p] != kRegularValence;
      role_[p] = isIrregular ? Role::Stays : role_[p];
    }
    for (const SamePoints& pair : pairs_)
    {
      if (pair.first == pair.second)
      {
        role_[pair.first] = Role::Stays; // the pole
      }
      const Role both = role_[pair.first] == Role::Free ? role_[pair.second] : role_[pair.first];
      role_[pair.first] = role_[pair.second] = both;
    }
  }

  void findNeighbours()
  {
    neighbours_.assign(quads_.points.size(), {});
    for (const std::array<Index, 4>& quad : quads_.quads)
    {
      for (std::size_t i = 0; i < 4; ++i)
      {
        neighbours_[quad[i]].push_back(quad[(i + 1) % 4]);
        neighbours_[quad[(i + 1) % 4]].push_back(quad[i]);
      }
    }
    for (std::vector<Index>& all : neighbours_)
    {
      sortUnique(all);
    }
  }

  Vector3 forth(const Vector3& p) const { return rotation_.image(p); }
  Vector3 back(const Vector3& p) const { return rotation_.image(p, -1); }

  void followPairs()
  {
    for (const SamePoints& pair : pairs_)
    {
      if (pair.first != pair.second)
      {
        quads_.points[pair.second] = forth(quads_.points[pair.first]);
      }
    }
  }

  std::size_t countUnsound() const
  {
    return evaluateQuads(quads_.points, quads_.quads).nonPositiveJacobians;
  }

  Vector3 onSurface(Index p, const Vector3& place) const
  {
    if (role_[p] == Role::OnFeature || role_[p] == Role::OnBoundary)
    {
      const NearestTriangle& lines =
        role_[p] == Role::OnFeature ? whole_.features : whole_.boundary;
      if (const auto at = lines.at(place))
      {
        return at->point;
      }
    }
    return whole_.nearestFace(place, normals_[p]).point;
  }

  void meetHalfWay()
  {
    std::vector<Vector3> moves(quads_.points.size(), Vector3::Zero());
    for (const SamePoints& pair : pairs_)
    {
      const Vector3& here = quads_.points[pair.first];
      const Vector3 there = back(quads_.points[pair.second]);
      const bool isSame = role_[pair.first] == Role::Stays || (here - there).norm() <= tolerance_;
      const Vector3 target = isSame ? here : onSurface(pair.first, (here + there) / 2);
      moves[pair.first] = target - here;
      if (pair.first != pair.second)
      {
        moves[pair.second] = forth(target) - quads_.points[pair.second];
      }
    }
    for (int k = 0; k < kSpreads; ++k)
    {
      spread(moves);
    }
    for (Index p = 0; p < moves.size(); ++p)
    {
      const Vector3 place = quads_.points[p] + moves[p];
      if (isPaired_[p] != 0)
      {
        quads_.points[p] = place;
      }
      else if (moves[p].norm() > tolerance_)
      {
        quads_.points[p] = onSurface(p, place);
      }
    }
    followPairs();
  }

  /// Moves of free points become the mean of their neighbours'.
  void spread(std::vector<Vector3>& moves) const
  {
    const std::vector<Vector3> before = moves;
    for (Index p = 0; p < moves.size(); ++p)
    {
      if (isPaired_[p] == 0 && role_[p] == Role::Free && !neighbours_[p].empty())
      {
        Vector3 sum = Vector3::Zero();
        for (const Index other : neighbours_[p])
        {
          sum += before[other];
        }
        moves[p] = sum / static_cast<double>(neighbours_[p].size());
      }
    }
  }

  /// Free points near the seam, and on it, go half of the way to the mean of their neighbours, those of the next wedge
  /// among them.
  void smooth()
  {
    std::vector<int> ring(quads_.points.size(), kSeamRings + 1);
    std::vector<Index> imageOf(quads_.points.size(), kInvalidIndex);
    std::vector<std::uint8_t> isSecond(quads_.points.size(), 0);
    for (const SamePoints& pair : pairs_)
    {
      ring[pair.first] = ring[pair.second] = 0;
      imageOf[pair.first] = pair.second;
      isSecond[pair.second] = pair.first != pair.second ? 1 : 0;
    }
    for (int r = 1; r <= kSeamRings; ++r)
    {
      for (Index p = 0; p < ring.size(); ++p)
      {
        for (const Index other : neighbours_[p])
        {
          ring[p] = ring[other] == r - 1 ? std::min(ring[p], r) : ring[p];
        }
      }
    }
    for (int round = 0; round < kSeamRounds; ++round)
    {
      const std::vector<Vector3> before = quads_.points;
      for (Index p = 0; p < ring.size(); ++p)
      {
        if (ring[p] > kSeamRings || role_[p] != Role::Free || isSecond[p] != 0)
        {
          continue;
        }
        Vector3 sum = Vector3::Zero();
        double count = 0;
        for (const Index other : neighbours_[p])
        {
          sum += before[other];
          count += 1;
        }
        if (imageOf[p] != kInvalidIndex)
        {
          for (const Index other : neighbours_[imageOf[p]])
          {
            // Along the seam they are here, too.
            if (ring[other] != 0)
            {
              sum += back(before[other]);
              count += 1;
            }
          }
        }
        quads_.points[p] = onSurface(p, before[p] / 2 + sum / (2 * count));
      }
      followPairs();
    }
  }

  QuadMesh& quads_;
  const CutQuads& cut_;
  const std::vector<SamePoints>& pairs_;
  const Isometry& rotation_;
  const SearchedSurface& whole_;
  double tolerance_;
  std::vector<std::uint8_t> isPaired_;
  std::vector<Role> role_;
  std::vector<std::vector<Index>> neighbours_;
  std::vector<Vector3> normals_;
};

} // namespace

std::vector<std::uint8_t> fitSeams(QuadMesh& quads, const CutQuads& cut, const Isometry& rotation,
  const SearchedSurface& whole, double tolerance)
{
  return SeamFit(quads, cut, rotation, whole, tolerance).run();
}

} // namespace quadrille
