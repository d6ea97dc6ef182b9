// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Sizes/NamedSizes.h"

#include "Base/Lists.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Mesh/NearestTriangle.h"

#include <Eigen/Geometry>

#include <fnmatch.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <utility>

namespace quadrille
{

namespace
{

/// Edges beside what has a size are split down to this part of the diagonal: about an edge of 30,000 quads on a part
/// like a cube, so that sizes end within a quad.
constexpr double kShortest = 1.0 / 300;

std::string trimmed(const std::string& text)
{
  const auto isBlank = [](unsigned char c) { return std::isspace(c) != 0; };
  const auto begin = std::find_if_not(text.begin(), text.end(), isBlank);
  const auto end = std::find_if_not(text.rbegin(), std::make_reverse_iterator(begin), isBlank);
  return std::string(begin, end.base());
}

std::string lower(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool matches(const std::string& pattern, const std::string& name)
{
  return pattern == name || ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

/// By how many letters two names differ, in any case [Levenshtein 1966].
std::size_t editDistance(const std::string& from, const std::string& to)
{
  const std::string a = lower(from), b = lower(to);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
  {
    row[j] = j;
  }
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j)
    {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({ replaced, row[j] + 1, row[j + 1] + 1 });
    }
  }
  return row.back();
}

//------------------------------------------------------------------------------
/// The triangles, split where they are long beside what has a size.
class SplitTriangles
{
public:
  struct Triangle
  {
    std::array<Index, 3> corners{};
    Index parent = 0; ///< of the surface
    /// Of the parent's sides the one that each side is part of; kInside.
    std::array<std::uint8_t, 3> sides{ 0, 1, 2 };
    /// Of the corners in the parent.
    std::array<Vector3, 3> weights{ Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ() };
  };
  static constexpr std::uint8_t kInside = 3;

  SplitTriangles(const NamedSurface& surface, double shortest)
    : shortest_(shortest), points_(surface.points)
  {
    for (const std::array<Index, 3>& corners : surface.triangles)
    {
      Triangle& triangle = triangles_.emplace_back();
      triangle.corners = corners;
      triangle.parent = static_cast<Index>(triangles_.size() - 1);
    }
  }

  const std::vector<Vector3>& points() const { return points_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const std::vector<std::array<Index, 2>>& middles() const { return middles_; }

  /// Until no edge is longer than its distance from the lines and than the shortest length.
  void split(const NearestTriangle& lines)
  {
    while (splitOnce(lines))
    {
    }
  }

private:
  using Edge = std::pair<Index, Index>;

  static Edge edgeOf(Index a, Index b) { return std::minmax(a, b); }

  bool isTooLong(const Edge& edge, const NearestTriangle& lines) const
  {
    const Vector3& a = points_[edge.first];
    const Vector3& b = points_[edge.second];
    const double length = (b - a).norm();
    return length > shortest_ && lines.at((a + b) / 2, Vector3::Zero(), length).has_value();
  }

  bool splitOnce(const NearestTriangle& lines)
  {
    std::map<Edge, Index> middleOf; // kInvalidIndex: the edge stays
    for (const Triangle& triangle : triangles_)
    {
      pollNowAndThen(middleOf.size());
      for (std::size_t k = 0; k < 3; ++k)
      {
        const Edge edge = edgeOf(triangle.corners[k], triangle.corners[(k + 1) % 3]);
        const auto [found, isNew] = middleOf.emplace(edge, kInvalidIndex);
        if (isNew && isTooLong(edge, lines))
        {
          found->second = static_cast<Index>(points_.size());
          points_.push_back((points_[edge.first] + points_[edge.second]) / 2);
          middles_.push_back({ edge.first, edge.second });
        }
      }
    }
    std::vector<Triangle> next;
    for (const Triangle& triangle : triangles_)
    {
      divide(triangle, middleOf, next);
    }
    const bool isChanged = next.size() > triangles_.size();
    triangles_ = std::move(next);
    return isChanged;
  }

  /// At the middle of its longest edge that has one, and its halves likewise.
  void divide(const Triangle& triangle, const std::map<Edge, Index>& middleOf,
    std::vector<Triangle>& to) const
  {
    std::size_t longest = 3;
    Index middle = kInvalidIndex;
    double most = 0;
    for (std::size_t k = 0; k < 3; ++k)
    {
      const Index a = triangle.corners[k], b = triangle.corners[(k + 1) % 3];
      const auto found = middleOf.find(edgeOf(a, b));
      const double length = (points_[b] - points_[a]).norm();
      if (found != middleOf.end() && found->second != kInvalidIndex && length > most)
      {
        longest = k;
        middle = found->second;
        most = length;
      }
    }
    if (longest == 3)
    {
      to.push_back(triangle);
      return;
    }
    const std::size_t i = longest, j = (i + 1) % 3, k = (i + 2) % 3;
    const auto& [c, parent, sides, w] = triangle;
    const Vector3 m = (w[i] + w[j]) / 2;
    divide({ { c[i], middle, c[k] }, parent, { sides[i], kInside, sides[k] }, { w[i], m, w[k] } },
      middleOf, to);
    divide({ { middle, c[j], c[k] }, parent, { sides[i], sides[j], kInside }, { m, w[j], w[k] } },
      middleOf, to);
  }

  double shortest_;
  std::vector<Vector3> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<Index, 2>> middles_; ///< of the points that are new, in their order
};

//------------------------------------------------------------------------------
/// What the bits say of the triangle's parent, for the triangle.
std::uint8_t featureBits(unsigned ofParent, const SplitTriangles::Triangle& triangle)
{
  unsigned own = 0;
  for (std::size_t k = 0; k < 3; ++k)
  {
    const bool isSide = triangle.sides[k] != SplitTriangles::kInside;
    own |= isSide && (ofParent >> triangle.sides[k] & 1U) != 0 ? 1U << k : 0U;
  }
  return static_cast<std::uint8_t>(own);
}

std::array<float, 6> curvatureOf(
  const std::array<float, 6>& ofParent, const SplitTriangles::Triangle& triangle)
{
  const Vector3 atCorner(ofParent[0], ofParent[1], ofParent[2]);
  std::array<float, 6> own{};
  for (std::size_t k = 0; k < 3; ++k)
  {
    const std::size_t side = triangle.sides[k];
    own[k] = static_cast<float>(triangle.weights[k].dot(atCorner));
    own[3 + k] = side == SplitTriangles::kInside ? 0 : ofParent[3 + side];
  }
  return own;
}

double diagonalOf(const NamedSurface& surface)
{
  Eigen::AlignedBox3d box;
  for (const std::array<Index, 3>& triangle : surface.triangles)
  {
    for (const Index corner : triangle)
    {
      box.extend(surface.points[corner]);
    }
  }
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

/// Where triangles meet of which other sizes are asked.
template <class FactorOf>
TriangleList bordersOf(const NamedSurface& surface, const FactorOf& factorOf)
{
  TriangleList borders;
  std::map<std::pair<Index, Index>, double> factorAt;
  for (Index t = 0; t < surface.triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const Index a = surface.triangles[t][k], b = surface.triangles[t][(k + 1) % 3];
      const auto [found, isNew] = factorAt.emplace(std::minmax(a, b), factorOf(t));
      if (!isNew && found->second != factorOf(t))
      {
        borders.addSegment(surface.points[a], surface.points[b]);
      }
    }
  }
  return borders;
}

SizedTriangles trianglesOf(const SplitTriangles& split, const NamedSurface& surface)
{
  SizedTriangles result;
  result.points = split.points();
  result.middles = split.middles();
  for (const SplitTriangles::Triangle& triangle : split.triangles())
  {
    result.triangles.push_back(triangle.corners);
    result.parents.push_back(triangle.parent);
    if (!surface.featureEdges.empty())
    {
      result.featureEdges.push_back(featureBits(surface.featureEdges[triangle.parent], triangle));
    }
    if (!surface.knownCurvature.empty())
    {
      result.knownCurvature.push_back(
        curvatureOf(surface.knownCurvature[triangle.parent], triangle));
    }
  }
  return result;
}

} // namespace

std::vector<NamedSize> namedSizesOf(const std::string& text)
{
  std::string lines = text;
  std::replace(lines.begin(), lines.end(), ';', '\n');
  std::istringstream stream(lines);
  std::vector<NamedSize> sizes;
  for (std::string line; std::getline(stream, line);)
  {
    line = trimmed(line);
    if (line.empty())
    {
      continue;
    }
    const std::size_t equals = line.rfind('=');
    const std::string number = equals == std::string::npos ? "" : trimmed(line.substr(equals + 1));
    NamedSize size{ trimmed(line.substr(0, equals)), 0 };
    std::istringstream value(number);
    const bool isRead = static_cast<bool>(value >> size.factor) &&
      value.peek() == std::istringstream::traits_type::eof();
    refuseIf(size.pattern.empty() || !isRead || !(size.factor > 0 && std::isfinite(size.factor)),
      "the size \"", line,
      "\" is none: give a name, = and a factor above 0 of the target edge "
      "length, as fillet*=0.5");
    sizes.push_back(size);
  }
  return sizes;
}

NamedParts::NamedParts(NamedSurface surface, std::string prefix)
  : surface_(std::move(surface)), prefix_(std::move(prefix))
{
  std::map<std::string, std::size_t> numbers;
  for (const std::string& name : surface_.faceNames)
  {
    const auto [found, isNew] = numbers.emplace(name, faces_.size());
    if (isNew)
    {
      faces_.push_back({ name, true, 0 });
    }
    faceOf_.push_back(found->second);
  }
  addParts(surface_.edgeNames, "EDGE_", edges_);
  addParts(surface_.vertexNames, "VERTEX_", vertices_);
}

void NamedParts::addParts(
  const std::vector<std::string>& names, const std::string& word, std::vector<Part>& parts)
{
  for (const std::string& name : names)
  {
    const std::string number = std::to_string(parts.size() + 1);
    parts.push_back({ name.empty() ? word + number : name, !name.empty(), 0 });
  }
}

std::vector<std::string> NamedParts::names() const
{
  std::vector<std::string> all;
  std::set<std::string> known;
  for (const auto* parts : { &faces_, &edges_, &vertices_ })
  {
    for (const Part& part : *parts)
    {
      if (part.isOfDesign && known.insert(part.name).second)
      {
        all.push_back(prefix_ + part.name);
      }
    }
  }
  return all;
}

void NamedParts::ask(const std::vector<NamedSize>& sizes, std::vector<bool>& isUsed)
{
  isUsed.resize(sizes.size(), false);
  for (std::size_t s = 0; s < sizes.size(); ++s)
  {
    for (auto* parts : { &faces_, &edges_, &vertices_ })
    {
      for (Part& part : *parts)
      {
        const bool isMeant = (parts == &faces_ || sizes[s].factor <= 1) &&
          (matches(sizes[s].pattern, part.name) ||
            (!prefix_.empty() && matches(sizes[s].pattern, prefix_ + part.name)));
        part.factor = isMeant ? sizes[s].factor : part.factor;
        isUsed[s] = isUsed[s] || isMeant;
      }
    }
  }
}

double NamedParts::factorOf(Index triangle) const
{
  const double asked = faceOf_.empty() ? 0 : faces_[faceOf_[triangle]].factor;
  return asked > 0 ? asked : 1;
}

SizedTriangles NamedParts::sized() const
{
  const double diagonal = diagonalOf(surface_);
  SplitTriangles split(surface_, kShortest * diagonal);
  TriangleList borders = bordersOf(surface_, [this](Index t) { return factorOf(t); });
  std::map<double, TriangleList> linesOf; // by factor, the smallest first
  for (std::size_t e = 0; e < edges_.size(); ++e)
  {
    const std::vector<Vector3>& line = surface_.edgeLines[e];
    for (std::size_t i = 0; edges_[e].factor > 0 && i + 1 < line.size(); ++i)
    {
      linesOf[edges_[e].factor].addSegment(line[i], line[i + 1]);
    }
  }
  for (std::size_t v = 0; v < vertices_.size(); ++v)
  {
    const Vector3& p = surface_.vertexPoints[v];
    if (vertices_[v].factor > 0 && p.allFinite())
    {
      linesOf[vertices_[v].factor].addSegment(p, p);
    }
  }
  for (const auto& [factor, lines] : linesOf)
  {
    for (const std::array<Index, 3>& corners : lines.corners)
    {
      borders.addSegment(lines.points[corners[0]], lines.points[corners[1]]);
    }
  }
  if (!borders.corners.empty())
  {
    split.split(NearestTriangle(borders));
  }
  SizedTriangles result = trianglesOf(split, surface_);
  // Of faces, then of lines, then those that are there.
  result.sizes.assign(result.points.size(), std::numeric_limits<float>::infinity());
  for (std::size_t t = 0; t < result.triangles.size(); ++t)
  {
    for (const Index corner : result.triangles[t])
    {
      result.sizes[corner] =
        std::min(result.sizes[corner], static_cast<float>(factorOf(result.parents[t])));
    }
  }
  for (const auto& [factor, lines] : linesOf)
  {
    const NearestTriangle tree(lines);
    for (std::size_t i = 0; i < result.sizes.size(); ++i)
    {
      pollNowAndThen(i);
      if (static_cast<float>(factor) < result.sizes[i] &&
        tree.at(result.points[i], Vector3::Zero(), kRoundingOfSingle * diagonal))
      {
        result.sizes[i] = static_cast<float>(factor);
      }
    }
  }
  std::vector<float> before = surface_.sizes;
  if (!before.empty())
  {
    for (const auto& [a, b] : result.middles)
    {
      before.push_back((before[a] + before[b]) / 2);
    }
    std::transform(result.sizes.begin(), result.sizes.end(), before.begin(), result.sizes.begin(),
      [](float a, float b) { return std::min(a, b); });
  }
  for (float& size : result.sizes) // points of no triangle
  {
    size = std::isfinite(size) ? size : 1;
  }
  return result;
}

void refuseUnknownNames(const std::vector<NamedSize>& sizes, const std::vector<bool>& isUsed,
  const std::vector<std::string>& names)
{
  const auto unknown = std::find(isUsed.begin(), isUsed.end(), false);
  if (unknown == isUsed.end())
  {
    return;
  }
  const NamedSize& size = sizes[static_cast<std::size_t>(unknown - isUsed.begin())];
  const bool isLarge = size.factor > 1;
  const std::string what = isLarge ? "no face" : "no face, edge or vertex";
  refuseIf(names.empty(), what, " is called \"", size.pattern,
    "\", as the surface has no names: take one from the CAD reader, or with the cell array "
    "PatchNames");
  std::vector<std::string> near = names;
  std::stable_sort(near.begin(), near.end(),
    [&](const std::string& a, const std::string& b)
    { return editDistance(size.pattern, a) < editDistance(size.pattern, b); });
  near.resize(std::min(near.size(), kMostTold));
  refuse(what, " is called \"", size.pattern, "\"; the nearest of ", names.size(),
    names.size() == 1 ? " name is " : " names are ",
    joined(near, near.size(), [](const std::string& name) { return name; }),
    isLarge ? " (factors above 1 are for faces)" : "");
}

} // namespace quadrille
