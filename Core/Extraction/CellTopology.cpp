// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/CellTopology.h"

#include "Base/DisjointSets.h"
#include "Base/Refuse.h"

#include <algorithm>
#include <numeric>

namespace quadrille
{
namespace
{

/// The corners of all cells in one list, quads first.
struct Corners
{
  std::vector<Index> point, next, previous;

  explicit Corners(const QuadMesh& mesh)
  {
    for (const std::array<Index, 4>& quad : mesh.quads)
    {
      addCell(quad.begin(), quad.end());
    }
    for (std::size_t i = 0; i + 1 < mesh.polygonOffsets.size(); ++i)
    {
      addCell(mesh.polygonPoints.begin() + mesh.polygonOffsets[i],
        mesh.polygonPoints.begin() + mesh.polygonOffsets[i + 1]);
    }
    for (const Index p : point)
    {
      refuseIf(p >= mesh.points.size(), "a cell refers to point ", p, " of ", mesh.points.size());
    }
  }

  Index size() const { return static_cast<Index>(point.size()); }
  Index target(Index h) const { return point[next[h]]; }

private:
  template <typename Iterator>
  void addCell(Iterator begin, Iterator end)
  {
    const Index first = size();
    const Index count = static_cast<Index>(end - begin);
    for (Index i = 0; i < count; ++i)
    {
      point.push_back(begin[i]);
      next.push_back(first + (i + 1) % count);
      previous.push_back(first + (i + count - 1) % count);
    }
  }
};

/// Half-edges grouped by the point that they leave.
struct Leaving
{
  std::vector<Index> first, halfEdges;

  Leaving(const Corners& corners, std::size_t points)
    : first(points + 1, 0), halfEdges(corners.size())
  {
    for (const Index p : corners.point)
    {
      ++first[p + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<Index> fill(first.begin(), first.end() - 1);
    for (Index h = 0; h < corners.size(); ++h)
    {
      halfEdges[fill[corners.point[h]]++] = h;
    }
  }

  /// Number of half-edges from a to b; the last of them in h.
  int count(const Corners& corners, Index a, Index b, Index& h) const
  {
    int number = 0;
    for (Index i = first[a]; i < first[a + 1]; ++i)
    {
      if (corners.target(halfEdges[i]) == b)
      {
        h = halfEdges[i];
        ++number;
      }
    }
    return number;
  }
};

class Analysis
{
public:
  explicit Analysis(const QuadMesh& mesh)
    : corners_(mesh), leaving_(corners_, mesh.points.size()), points_(mesh.points.size()),
      twin_(corners_.size(), kInvalidIndex)
  {
    result_.valence.assign(points_, 0);
    result_.onBoundary.assign(points_, 0);
    pairTwins();
    checkFans();
    countComponents();
    const std::size_t polygons = mesh.polygonOffsets.empty() ? 0 : mesh.polygonOffsets.size() - 1;
    result_.eulerCharacteristic = static_cast<long long>(points_ - result_.isolatedPoints) -
      static_cast<long long>(result_.edges) + static_cast<long long>(mesh.quads.size() + polygons);
    if (result_.manifold())
    {
      countLoops();
    }
  }

  QuadTopology take() { return std::move(result_); }

private:
  void note(Index p) { result_.offendingPoints.push_back(p); }

  void pairTwins()
  {
    for (Index h = 0; h < corners_.size(); ++h)
    {
      const Index a = corners_.point[h];
      const Index b = corners_.target(h);
      if (a == b)
      {
        ++result_.degenerateQuads;
        note(a);
        continue;
      }
      Index mine = h, other = h;
      const int same = leaving_.count(corners_, a, b, mine);
      const int opposite = leaving_.count(corners_, b, a, other);
      if (same > 1)
      {
        ++result_.nonManifoldEdges;
        note(a);
      }
      else if (opposite == 1)
      {
        twin_[h] = other;
      }
      if (mine == h)
      {
        countEdge(a, b, opposite, same);
      }
    }
  }

  void countEdge(Index a, Index b, int opposite, int same)
  {
    ++result_.valence[a];
    if (opposite > 0)
    {
      result_.edges += a < b ? 1 : 0;
      return;
    }
    ++result_.edges;
    ++result_.valence[b];
    result_.boundaryEdges += same == 1 ? 1 : 0;
    result_.onBoundary[a] = result_.onBoundary[b] = 1;
  }

  Index fanSize(Index h) const
  {
    Index size = 1;
    Index g = twin_[corners_.previous[h]];
    for (; g != kInvalidIndex && g != h; g = twin_[corners_.previous[g]])
    {
      ++size;
    }
    if (g == h)
    {
      return size;
    }
    for (g = twin_[h]; g != kInvalidIndex; g = twin_[corners_.next[g]])
    {
      ++size;
    }
    return size;
  }

  void checkFans()
  {
    for (Index p = 0; p < points_; ++p)
    {
      const Index count = leaving_.first[p + 1] - leaving_.first[p];
      if (count == 0)
      {
        ++result_.isolatedPoints;
        note(p);
      }
      else if (fanSize(leaving_.halfEdges[leaving_.first[p]]) != count)
      {
        ++result_.nonManifoldVertices;
        note(p);
      }
    }
  }

  void countComponents()
  {
    DisjointSets sets(points_, 1);
    for (Index h = 0; h < corners_.size(); ++h)
    {
      sets.join(corners_.point[h], corners_.target(h));
    }
    result_.components = sets.countSets();
    result_.components -= result_.isolatedPoints;
  }

  void countLoops()
  {
    std::vector<std::uint8_t> seen(corners_.size(), 0);
    for (Index h = 0; h < corners_.size(); ++h)
    {
      if (twin_[h] != kInvalidIndex || seen[h])
      {
        continue;
      }
      ++result_.boundaryLoops;
      for (Index g = h; !seen[g];)
      {
        seen[g] = 1;
        g = corners_.next[g];
        while (twin_[g] != kInvalidIndex)
        {
          g = corners_.next[twin_[g]];
        }
      }
    }
  }

  Corners corners_;
  Leaving leaving_;
  std::size_t points_;
  std::vector<Index> twin_;
  QuadTopology result_;
};

} // namespace

QuadTopology analyzeCells(const QuadMesh& mesh)
{
  return Analysis(mesh).take();
}

std::vector<std::uint8_t> linesOnEdges(const QuadMesh& mesh)
{
  const Corners corners(mesh);
  const Leaving leaving(corners, mesh.points.size());
  std::vector<std::uint8_t> found;
  for (const QuadLine& line : mesh.lines)
  {
    Index unused = 0;
    found.push_back(leaving.count(corners, line.a, line.b, unused) > 0 ||
          leaving.count(corners, line.b, line.a, unused) > 0
        ? 1
        : 0);
  }
  return found;
}

} // namespace quadrille
