// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/FoldedCells.h"

#include "Base/DisjointSets.h"
#include "Base/Progress.h"
#include "Extraction/GridVertices.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace quadrille
{
namespace
{

/// A side of length one of an outline.
struct OutlineSide
{
  Index vertex; ///< the grid vertex where it begins
  Index port;
  int way; ///< +1: counterclockwise round the square, in an upright triangle; -1: the other way
};

using Outline = std::vector<OutlineSide>;

/// One quad of a sheet.
struct Sheet
{
  std::array<Index, 4> key; ///< the vertices counterclockwise in the map, the lowest first
  std::array<Index, 4> corners;
  Index port;
  int orientation;
};

/// Is the vertex on a feature or on the boundary?
bool isConstrainedSite(const Mesh& mesh, const GridVertex& vertex)
{
  if (vertex.kind != Site::Vertex)
  {
    return vertex.kind == Site::Edge && mesh.isConstrained(vertex.site);
  }
  return !constrainedEdgesAt(mesh, vertex.site).empty();
}

/// Copies of grid vertices as sets, each named by the member whose place the vertex takes.
class Copies
{
public:
  Copies(const ExactMap& map, const GridVertices& grid)
    : map_(map), grid_(grid), sets_(grid.vertices().size(), 1), name_(grid.vertices().size())
  {
    std::iota(name_.begin(), name_.end(), Index{ 0 });
  }

  Index find(Index q) { return name_[sets_.find(q)]; }

  void join(Index a, Index b)
  {
    const Index nameA = find(a);
    const Index nameB = find(b);
    sets_.join(a, b);
    name_[sets_.find(a)] = isBetter(nameA, nameB) ? nameA : nameB;
  }

  /// How far joining moves the surface; curves are kept apart as long as there is a choice.
  std::pair<bool, double> distance(Index a, Index b)
  {
    const GridVertex& first = grid_.vertices()[find(a)];
    const GridVertex& second = grid_.vertices()[find(b)];
    if (find(a) == find(b))
    {
      return { false, 0 };
    }
    const Vector3 way =
      positionOf(map_.mesh, placeOf(map_, first)) - positionOf(map_.mesh, placeOf(map_, second));
    return { isConstrainedSite(map_.mesh, first) && isConstrainedSite(map_.mesh, second),
      way.norm() };
  }

private:
  /// Features first, then mesh vertices.
  int rank(Index q) const
  {
    const GridVertex& vertex = grid_.vertices()[q];
    return (isConstrainedSite(map_.mesh, vertex) ? 4 : 0) + static_cast<int>(vertex.kind);
  }
  bool isBetter(Index a, Index b) const { return rank(a) != rank(b) ? rank(a) > rank(b) : a < b; }

  const ExactMap& map_;
  const GridVertices& grid_;
  DisjointSets sets_;
  std::vector<Index> name_; ///< per root of sets_
};

class Folding
{
public:
  Folding(const ExactMap& map, const GridVertices& grid, const CellCorners& cells,
    const std::vector<CurveLine>& curves)
    : cells_(cells), curves_(curves), copies_(map, grid), vertexCount_(grid.vertices().size())
  {
  }

  FoldedCells run()
  {
    for (const auto& [a, b] : cells_.merged)
    {
      copies_.join(a, b);
    }
    for (const CurveLine& line : curves_)
    {
      if (line.zero)
      {
        copies_.join(line.a, line.b);
      }
    }
    collectOutlines();
    for (Outline& outline : outlines_)
    {
      poll();
      zip(outline);
    }
    result_.root.resize(vertexCount_);
    for (Index q = 0; q < vertexCount_; ++q)
    {
      result_.root[q] = copies_.find(q);
      result_.mergedVertices += result_.root[q] != q ? 1 : 0;
    }
    for (const Outline& outline : outlines_)
    {
      addSheet(outline);
    }
    cancel();
    return std::move(result_);
  }

private:
  void collectOutlines()
  {
    std::vector<std::uint8_t> seen(cells_.next.size(), 0);
    for (Index start = 0; start < seen.size(); ++start)
    {
      pollNowAndThen(start);
      Outline outline;
      Index port = start;
      while (port != kInvalidIndex && !seen[port])
      {
        seen[port] = 1;
        const Index next = cells_.next[port];
        if (next != kInvalidIndex && !cells_.isZero(port))
        {
          outline.push_back({ cells_.vertex[port], port, cells_.orientation[port] });
        }
        port = next;
      }
      if (port == start && !outline.empty()) // otherwise a line has no end
      {
        outlines_.push_back(std::move(outline));
      }
    }
  }

  /// Closes opposite sides that follow each other until all go the same way.
  void zip(Outline& outline)
  {
    while (true)
    {
      const std::size_t size = outline.size();
      std::size_t best = size;
      std::pair<bool, double> least;
      for (std::size_t i = 0; i < size; ++i)
      {
        if (outline[i].way == -outline[(i + 1) % size].way)
        {
          const auto distance = copies_.distance(outline[i].vertex, outline[(i + 2) % size].vertex);
          if (best == size || distance < least)
          {
            best = i;
            least = distance;
          }
        }
      }
      if (best == size)
      {
        return;
      }
      copies_.join(outline[best].vertex, outline[(best + 2) % size].vertex);
      ++result_.zippedSides;
      std::rotate(
        outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(best), outline.end());
      std::rotate(outline.begin(), outline.begin() + 2, outline.end());
      outline.resize(size - 2);
    }
  }

  void addSheet(const Outline& outline)
  {
    if (outline.size() != 4)
    {
      result_.dropped += outline.empty() ? 0 : 1;
      return;
    }
    Sheet sheet;
    sheet.port = outline.front().port;
    sheet.orientation = outline.front().way;
    for (std::size_t i = 0; i < 4; ++i)
    {
      sheet.corners[i] = result_.root[outline[i].vertex];
      sheet.port = std::min(sheet.port, outline[i].port);
    }
    sheet.key = sheet.corners;
    if (sheet.orientation < 0)
    {
      std::reverse(sheet.key.begin(), sheet.key.end());
    }
    std::rotate(
      sheet.key.begin(), std::min_element(sheet.key.begin(), sheet.key.end()), sheet.key.end());
    std::array<Index, 4> sorted = sheet.key;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    {
      ++result_.dropped;
      return;
    }
    sheets_.push_back(sheet);
  }

  /// Upright and inverted sheets of the same quad cancel out.
  void cancel()
  {
    std::sort(sheets_.begin(), sheets_.end(),
      [](const Sheet& a, const Sheet& b)
      { return std::tie(a.key, a.port) < std::tie(b.key, b.port); });
    for (std::size_t i = 0, end = 0; i < sheets_.size(); i = end)
    {
      int sum = 0;
      for (end = i; end < sheets_.size() && sheets_[end].key == sheets_[i].key; ++end)
      {
        sum += sheets_[end].orientation;
      }
      const auto kept = std::find_if(sheets_.begin() + static_cast<std::ptrdiff_t>(i),
        sheets_.begin() + static_cast<std::ptrdiff_t>(end),
        [sum](const Sheet& s) { return s.orientation * sum > 0; });
      result_.cancelled += end - i - (sum != 0 ? 1 : 0);
      if (sum != 0)
      {
        result_.corners.push_back(kept->corners);
        result_.port.push_back(kept->port);
      }
    }
  }

  const CellCorners& cells_;
  const std::vector<CurveLine>& curves_;
  Copies copies_;
  std::size_t vertexCount_;
  std::vector<Outline> outlines_;
  std::vector<Sheet> sheets_;
  FoldedCells result_;
};

} // namespace

FoldedCells findFoldedCells(const ExactMap& map, const GridVertices& grid, const CellCorners& cells,
  const std::vector<CurveLine>& curves)
{
  return Folding(map, grid, cells, curves).run();
}

} // namespace quadrille
