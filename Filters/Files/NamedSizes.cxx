// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/NamedSizes.h"

#include "Base/Lists.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Common/NewArray.h"
#include "Convert/AskedArrays.h"
#include "Convert/PolyData.h"
#include "ElementGrids/Elements.h"
#include "Files/CadNames.h"
#include "Mesh/NearestTriangle.h"

#include <vtkAbstractArray.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkVariant.h>

#include <fnmatch.h>

#include <algorithm>
#include <array>
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
/// Points this near to an edge or vertex are on it, over the diagonal.
constexpr double kOnPart = 1e-7;

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
/// The triangles, split where they are long beside what has a size. Each child has the cell of its parent.
class SplitTriangles
{
public:
  struct Triangle
  {
    std::array<Index, 3> corners{};
    vtkIdType cell = 0;
    /// Of the cell's sides the one that each side is part of; kInside.
    std::array<std::uint8_t, 3> sides{ 0, 1, 2 };
    /// Of the corners in the cell.
    std::array<Vector3, 3> weights{ Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ() };
  };
  static constexpr std::uint8_t kInside = 3;
  /// A point in the middle of two others.
  struct Middle
  {
    Index a = 0;
    Index b = 0;
  };

  SplitTriangles(vtkPolyData* surface, double shortest) : shortest_(shortest)
  {
    for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
    {
      Vector3 p;
      surface->GetPoint(i, p.data());
      points_.push_back(p);
    }
    vtkNew<vtkIdList> ids;
    for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
    {
      surface->GetCellPoints(c, ids);
      refuseIf(
        surface->GetNumberOfPolys() != surface->GetNumberOfCells() || ids->GetNumberOfIds() != 3,
        "sizes by name are for surfaces of triangles, and cell ", c,
        " is none: triangulate it first");
      Triangle& triangle = triangles_.emplace_back();
      for (std::size_t k = 0; k < 3; ++k)
      {
        triangle.corners[k] = static_cast<Index>(ids->GetId(static_cast<vtkIdType>(k)));
      }
      triangle.cell = c;
    }
  }

  const std::vector<Vector3>& points() const { return points_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const std::vector<Middle>& middles() const { return middles_; }

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
    const auto& [c, cell, sides, w] = triangle;
    const Vector3 m = (w[i] + w[j]) / 2;
    divide({ { c[i], middle, c[k] }, cell, { sides[i], kInside, sides[k] }, { w[i], m, w[k] } },
      middleOf, to);
    divide({ { middle, c[j], c[k] }, cell, { sides[i], sides[j], kInside }, { m, w[j], w[k] } },
      middleOf, to);
  }

  double shortest_;
  std::vector<Vector3> points_;
  std::vector<Triangle> triangles_;
  std::vector<Middle> middles_; ///< of the points that are new, in their order
};

//------------------------------------------------------------------------------
/// Segments, and points as segments without length.
struct Lines
{
  TriangleList list;

  void add(const Vector3& a, const Vector3& b)
  {
    const auto at = static_cast<Index>(list.points.size());
    list.points.push_back(a);
    list.points.push_back(b);
    list.corners.push_back({ at, at + 1, at + 1 });
  }
};

/// Real numbers in the middle of two points are their average, all else is that of one of them; nobody asks for a
/// valence there.
void extend(vtkAbstractArray* array, const std::vector<SplitTriangles::Middle>& middles)
{
  vtkIdType point = array->GetNumberOfTuples();
  array->Resize(point + static_cast<vtkIdType>(middles.size()));
  const bool isReal = array->GetDataType() == VTK_DOUBLE || array->GetDataType() == VTK_FLOAT;
  const bool isValence =
    array->GetName() && std::string(array->GetName()) == arrays::kTargetValence;
  for (const SplitTriangles::Middle& middle : middles)
  {
    if (isReal)
    {
      array->InterpolateTuple(point, middle.a, array, middle.b, array, 0.5);
    }
    else
    {
      array->InsertTuple(point, middle.a, array);
    }
    if (isValence)
    {
      array->SetVariantValue(point, 0);
    }
    ++point;
  }
}

/// What the array says of the triangle's cell, for the triangle.
std::uint8_t featureBits(vtkDataArray* ofCells, const SplitTriangles::Triangle& triangle)
{
  const auto bits = static_cast<unsigned>(ofCells->GetComponent(triangle.cell, 0));
  unsigned own = 0;
  for (std::size_t k = 0; k < 3; ++k)
  {
    const bool isSide = triangle.sides[k] != SplitTriangles::kInside;
    own |= isSide && (bits >> triangle.sides[k] & 1U) != 0 ? 1U << k : 0U;
  }
  return static_cast<std::uint8_t>(own);
}

std::array<float, 6> knownCurvature(vtkDataArray* ofCells, const SplitTriangles::Triangle& triangle)
{
  std::array<double, 6> known{};
  ofCells->GetTuple(triangle.cell, known.data());
  const Vector3 atCorner(known[0], known[1], known[2]);
  std::array<float, 6> own{};
  for (std::size_t k = 0; k < 3; ++k)
  {
    const std::size_t side = triangle.sides[k];
    own[k] = static_cast<float>(triangle.weights[k].dot(atCorner));
    own[3 + k] = side == SplitTriangles::kInside ? 0 : static_cast<float>(known[3 + side]);
  }
  return own;
}

vtkSmartPointer<vtkPolyData> polyDataOf(
  const SplitTriangles& split, const std::vector<float>& sizes, vtkPolyData* surface)
{
  auto result = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(split.points().size()));
  for (std::size_t i = 0; i < split.points().size(); ++i)
  {
    points->SetPoint(static_cast<vtkIdType>(i), split.points()[i].data());
  }
  result->SetPoints(points);
  vtkPointData* const pointData = result->GetPointData();
  pointData->DeepCopy(surface->GetPointData());
  for (int i = 0; i < pointData->GetNumberOfArrays(); ++i)
  {
    extend(pointData->GetAbstractArray(i), split.middles());
  }
  vtkNew<vtkCellArray> cells;
  vtkCellData* const cellData = result->GetCellData();
  const std::size_t count = split.triangles().size();
  cellData->CopyAllOn();
  cellData->CopyGlobalIdsOff(); // several triangles have one
  cellData->CopyAllocate(surface->GetCellData(), static_cast<vtkIdType>(count));
  vtkDataArray* const bitsBefore = surface->GetCellData()->GetArray(arrays::kFeatureEdges);
  vtkDataArray* const knownBefore = surface->GetCellData()->GetArray(arrays::kKnownCurvature);
  const auto bits =
    newArray<vtkUnsignedCharArray>(arrays::kFeatureEdges, 1, bitsBefore ? count : 0);
  const auto known = newArray<vtkFloatArray>(arrays::kKnownCurvature, 6, knownBefore ? count : 0);
  for (std::size_t i = 0; i < count; ++i)
  {
    const SplitTriangles::Triangle& triangle = split.triangles()[i];
    const std::array<vtkIdType, 3> ids{ triangle.corners[0], triangle.corners[1],
      triangle.corners[2] };
    cells->InsertNextCell(3, ids.data());
    cellData->CopyData(surface->GetCellData(), triangle.cell, static_cast<vtkIdType>(i));
    if (bitsBefore)
    {
      bits->SetValue(static_cast<vtkIdType>(i), featureBits(bitsBefore, triangle));
    }
    if (knownBefore)
    {
      known->SetTypedTuple(static_cast<vtkIdType>(i), knownCurvature(knownBefore, triangle).data());
    }
  }
  result->SetPolys(cells);
  if (bitsBefore)
  {
    cellData->AddArray(bits);
  }
  if (knownBefore)
  {
    cellData->AddArray(known);
  }
  const auto sizing = newArray<vtkFloatArray>(arrays::kSizing, 1, sizes.size());
  std::copy(sizes.begin(), sizes.end(), sizing->GetPointer(0));
  pointData->AddArray(sizing);
  result->GetFieldData()->ShallowCopy(surface->GetFieldData());
  return result;
}

Vector3 vectorAt(vtkDataArray* array, vtkIdType i)
{
  Vector3 p;
  array->GetTuple(i, p.data());
  return p;
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

NamedParts::NamedParts(vtkPolyData* surface, const std::string& prefix)
  : surface_(surface), prefix_(prefix)
{
  auto* ofCells =
    vtkStringArray::SafeDownCast(surface->GetCellData()->GetAbstractArray(arrays::kPatchNames));
  std::map<std::string, std::size_t> numbers;
  for (vtkIdType c = 0; ofCells && c < surface->GetNumberOfCells(); ++c)
  {
    const std::string name = ofCells->GetValue(c);
    const auto [found, isNew] = numbers.emplace(name, faces_.size());
    if (isNew)
    {
      faces_.push_back({ name, true, 0 });
    }
    faceOf_.push_back(found->second);
  }
  const auto addParts = [&](const char* array, const std::string& word, std::vector<Part>& parts)
  {
    auto* names = vtkStringArray::SafeDownCast(surface->GetFieldData()->GetAbstractArray(array));
    for (vtkIdType i = 0; names && i < names->GetNumberOfValues(); ++i)
    {
      const std::string name = names->GetValue(i);
      parts.push_back({ name.empty() ? word + std::to_string(i + 1) : name, !name.empty(), 0 });
    }
  };
  addParts(arrays::kCadEdgeNames, "EDGE_", edges_);
  addParts(arrays::kCadVertexNames, "VERTEX_", vertices_);
}

std::vector<std::string> NamedParts::names() const
{
  std::vector<std::string> all;
  std::set<std::string> known;
  for (const auto* parts : { &faces_, &edges_, &vertices_ })
  {
    for (const Part& part : *parts)
    {
      if (part.isOfFile && known.insert(part.name).second)
      {
        all.push_back(part.name);
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

vtkSmartPointer<vtkPolyData> NamedParts::sized() const
{
  const double diagonal = surface_->GetLength();
  SplitTriangles split(surface_, kShortest * diagonal);
  const auto factorOf = [this](vtkIdType cell)
  {
    const double asked =
      faceOf_.empty() ? 0 : faces_[faceOf_[static_cast<std::size_t>(cell)]].factor;
    return asked > 0 ? asked : 1;
  };
  Lines borders; // what sizes end at
  std::map<std::pair<Index, Index>, double> factorAt;
  for (const SplitTriangles::Triangle& triangle : split.triangles())
  {
    const double factor = factorOf(triangle.cell);
    for (std::size_t k = 0; k < 3; ++k)
    {
      const Index a = triangle.corners[k], b = triangle.corners[(k + 1) % 3];
      const auto [found, isNew] = factorAt.emplace(std::minmax(a, b), factor);
      if (!isNew && found->second != factor)
      {
        borders.add(split.points()[a], split.points()[b]);
      }
    }
  }
  std::map<double, Lines> linesOf; // by factor, the smallest first
  vtkDataArray* const edgePoints = surface_->GetFieldData()->GetArray(arrays::kCadEdgePoints);
  vtkDataArray* const counts = surface_->GetFieldData()->GetArray(arrays::kCadEdgeCounts);
  vtkIdType at = 0;
  for (std::size_t e = 0; edgePoints && counts && e < edges_.size(); ++e)
  {
    const auto count = static_cast<vtkIdType>(counts->GetComponent(static_cast<vtkIdType>(e), 0));
    for (vtkIdType i = at; edges_[e].factor > 0 && i + 1 < at + count; ++i)
    {
      linesOf[edges_[e].factor].add(vectorAt(edgePoints, i), vectorAt(edgePoints, i + 1));
    }
    at += count;
  }
  vtkDataArray* const vertexPoints = surface_->GetFieldData()->GetArray(arrays::kCadVertexPoints);
  for (std::size_t v = 0; vertexPoints && v < vertices_.size(); ++v)
  {
    const Vector3 p = vectorAt(vertexPoints, static_cast<vtkIdType>(v));
    if (vertices_[v].factor > 0 && p.allFinite())
    {
      linesOf[vertices_[v].factor].add(p, p);
    }
  }
  for (const auto& [factor, lines] : linesOf)
  {
    for (const std::array<Index, 3>& corners : lines.list.corners)
    {
      borders.add(lines.list.points[corners[0]], lines.list.points[corners[1]]);
    }
  }
  if (!borders.list.corners.empty())
  {
    split.split(NearestTriangle(borders.list));
  }
  // Of faces, then of lines, then of the array that is there.
  std::vector<float> sizes(split.points().size(), std::numeric_limits<float>::infinity());
  for (const SplitTriangles::Triangle& triangle : split.triangles())
  {
    for (const Index corner : triangle.corners)
    {
      sizes[corner] = std::min(sizes[corner], static_cast<float>(factorOf(triangle.cell)));
    }
  }
  for (const auto& [factor, lines] : linesOf)
  {
    const NearestTriangle tree(lines.list);
    for (std::size_t i = 0; i < sizes.size(); ++i)
    {
      pollNowAndThen(i);
      if (static_cast<float>(factor) < sizes[i] &&
        tree.at(split.points()[i], Vector3::Zero(), kOnPart * diagonal))
      {
        sizes[i] = static_cast<float>(factor);
      }
    }
  }
  std::vector<float> before = pointSizes(surface_);
  if (!before.empty())
  {
    for (const SplitTriangles::Middle& middle : split.middles())
    {
      before.push_back((before[middle.a] + before[middle.b]) / 2);
    }
    std::transform(sizes.begin(), sizes.end(), before.begin(), sizes.begin(),
      [](float a, float b) { return std::min(a, b); });
  }
  for (float& size : sizes) // points of no triangle
  {
    size = std::isfinite(size) ? size : 1;
  }
  return polyDataOf(split, sizes, surface_);
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
  constexpr std::size_t kMostTold = 5;
  std::vector<std::string> near = names;
  std::stable_sort(near.begin(), near.end(),
    [&](const std::string& a, const std::string& b)
    { return editDistance(size.pattern, a) < editDistance(size.pattern, b); });
  near.resize(std::min(near.size(), kMostTold));
  std::string list;
  for (const std::string& name : near)
  {
    list += (list.empty() ? "" : ", ") + name;
  }
  refuse(what, " is called \"", size.pattern, "\"; the nearest of ", names.size(),
    names.size() == 1 ? " name is " : " names are ", list,
    isLarge ? " (factors above 1 are for faces)" : "");
}

} // namespace quadrille
