// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/PlacedQuads.h"

#include "Convert/PolyData.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkPointData.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace quadrille
{

namespace
{

/// A point of the quads lies on its triangle where it is not farther off than this, as a multiple of the quads' edges:
/// far more than rounding, far less than what anybody sees.
constexpr double kOnTriangle = 1e-4;

/// Weights of the point of a triangle that is nearest to x.
std::array<double, 3> nearestWeights(const std::array<Vector3, 3>& corners, const Vector3& x)
{
  const Vector3 u = corners[1] - corners[0];
  const Vector3 v = corners[2] - corners[0];
  const Vector3 normal = u.cross(v);
  const double area = normal.squaredNorm();
  std::array<double, 3> inside{};
  bool isInside = area > 0;
  for (std::size_t i = 0; i < 3 && isInside; ++i)
  {
    const Vector3& a = corners[(i + 1) % 3];
    const Vector3& b = corners[(i + 2) % 3];
    inside[i] = (b - a).cross(x - a).dot(normal) / area;
    isInside = inside[i] >= 0;
  }
  if (isInside)
  {
    const double sum = inside[0] + inside[1] + inside[2];
    return { inside[0] / sum, inside[1] / sum, inside[2] / sum };
  }
  std::array<double, 3> best{ 1, 0, 0 };
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i)
  {
    const Vector3& a = corners[i];
    const Vector3 edge = corners[(i + 1) % 3] - a;
    const double square = edge.squaredNorm();
    const double t = square > 0 ? std::clamp((x - a).dot(edge) / square, 0.0, 1.0) : 0;
    const double distance = (a + t * edge - x).squaredNorm();
    if (distance < least)
    {
      least = distance;
      best = {};
      best[i] = 1 - t;
      best[(i + 1) % 3] = t;
    }
  }
  return best;
}

} // namespace

PlacedQuads::PlacedQuads(vtkPolyData* quads, vtkPolyData* joined,
  const std::vector<Index>& firstTriangle, const std::vector<std::array<std::uint32_t, 2>>& rankOf)
  : quads_(quads), joined_(joined), firstTriangle_(firstTriangle), rankOf_(rankOf),
    pointCell_(
      vtkIdTypeArray::SafeDownCast(quads->GetPointData()->GetArray(arrays::kSourceCellId))),
    pointIds_(
      vtkIdTypeArray::SafeDownCast(quads->GetPointData()->GetArray(arrays::kSourcePointIds))),
    pointWeights_(
      vtkDoubleArray::SafeDownCast(quads->GetPointData()->GetArray(arrays::kSourceBarycentric))),
    cellCell_(vtkIdTypeArray::SafeDownCast(quads->GetCellData()->GetArray(arrays::kSourceCellId)))
{
  readCorners();
  const double area = areaOfQuads();
  tolerance_ = kOnTriangle * std::sqrt(area / std::max<double>(1, quadCount()));
}

std::uint32_t PlacedQuads::rankOfQuad(std::size_t quad) const
{
  return rankOf_[pieceOf(cellCell_->GetValue(static_cast<vtkIdType>(quad)))][0];
}

void PlacedQuads::addPoint(std::size_t point, const std::vector<std::uint32_t>& users,
  std::vector<PlacedItems>& byRank) const
{
  const auto id = static_cast<vtkIdType>(point);
  const vtkIdType cell = pointCell_->GetValue(id);
  const std::array<vtkIdType, 3> ids = cornersOf(cell);
  std::array<double, 3> weights{};
  bool isKnown = true;
  for (int i = 0; i < 3; ++i)
  {
    const auto found = std::find(ids.begin(), ids.end(), pointIds_->GetComponent(id, i));
    isKnown = isKnown && found != ids.end();
    if (isKnown)
    {
      weights[static_cast<std::size_t>(found - ids.begin())] +=
        std::max(0.0, pointWeights_->GetComponent(id, i));
    }
  }
  const Vector3 x = pointAt(quads_, id);
  const std::array<Vector3, 3> places = placesOf(ids);
  const double sum = weights[0] + weights[1] + weights[2];
  if (!isKnown || !(sum > 0))
  {
    weights = nearestWeights(places, x);
  }
  else
  {
    weights = { weights[0] / sum, weights[1] / sum, weights[2] / sum };
  }
  const Vector3 onTriangle =
    weights[0] * places[0] + weights[1] * places[1] + weights[2] * places[2];
  add(point, cell, weights, (onTriangle - x).norm() > tolerance_ ? &x : nullptr, users, byRank);
}

void PlacedQuads::addQuad(
  std::size_t quad, const std::vector<std::uint32_t>& users, std::vector<PlacedItems>& byRank) const
{
  Vector3 centre = Vector3::Zero();
  for (std::size_t i = 0; i < size(quad); ++i)
  {
    centre += pointAt(quads_, corners(quad)[i]) / static_cast<double>(size(quad));
  }
  const vtkIdType cell = cellCell_->GetValue(static_cast<vtkIdType>(quad));
  add(quad, cell, nearestWeights(placesOf(cornersOf(cell)), centre), nullptr, users, byRank);
}

void PlacedQuads::readCorners()
{
  auto cells = vtk::TakeSmartPointer(quads_->GetPolys()->NewIterator());
  first_ = { 0 };
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCurrentCell(count, ids);
    corners_.insert(corners_.end(), ids, ids + count);
    first_.push_back(corners_.size());
  }
}

double PlacedQuads::areaOfQuads() const
{
  double area = 0;
  for (std::size_t q = 0; q < cellCount(); ++q)
  {
    for (std::size_t i = 2; i < size(q); ++i)
    {
      const Vector3 a = pointAt(quads_, corners(q)[0]);
      area += 0.5 *
        (pointAt(quads_, corners(q)[i - 1]) - a).cross(pointAt(quads_, corners(q)[i]) - a).norm();
    }
  }
  return area;
}

std::size_t PlacedQuads::pieceOf(vtkIdType triangle) const
{
  return static_cast<std::size_t>(std::upper_bound(firstTriangle_.begin(), firstTriangle_.end(),
                                    static_cast<Index>(triangle)) -
           firstTriangle_.begin()) -
    1;
}

std::array<vtkIdType, 3> PlacedQuads::cornersOf(vtkIdType triangle) const
{
  vtkIdType count = 0;
  const vtkIdType* ids = nullptr;
  joined_->GetPolys()->GetCellAtId(triangle, count, ids);
  return { ids[0], ids[1], ids[2] };
}

std::array<Vector3, 3> PlacedQuads::placesOf(const std::array<vtkIdType, 3>& ids) const
{
  return { pointAt(joined_, ids[0]), pointAt(joined_, ids[1]), pointAt(joined_, ids[2]) };
}

void PlacedQuads::add(std::size_t id, vtkIdType triangle, const std::array<double, 3>& weights,
  const Vector3* offPlace, const std::vector<std::uint32_t>& users,
  std::vector<PlacedItems>& byRank) const
{
  const std::size_t piece = pieceOf(triangle);
  PlacedItems& items = byRank[rankOf_[piece][0]];
  items.id.push_back(static_cast<std::int64_t>(id));
  items.piece.push_back(rankOf_[piece][1]);
  items.triangle.push_back(static_cast<Index>(triangle) - firstTriangle_[piece]);
  items.weights.insert(items.weights.end(), weights.begin(), weights.end());
  items.isOff.push_back(offPlace ? 1 : 0);
  if (offPlace)
  {
    items.offPlaces.insert(
      items.offPlaces.end(), { (*offPlace)[0], (*offPlace)[1], (*offPlace)[2] });
  }
  items.userCount.push_back(static_cast<std::uint32_t>(users.size()));
  items.users.insert(items.users.end(), users.begin(), users.end());
}

/// Quads at each point.
struct Distribution::QuadsOfPoints
{
  explicit QuadsOfPoints(const PlacedQuads& quads) : first(quads.pointCount() + 1, 0)
  {
    const auto visit = [&quads](const auto& body)
    {
      for (std::size_t q = 0; q < quads.cellCount(); ++q)
      {
        for (std::size_t i = 0; i < quads.size(q); ++i)
        {
          body(q, static_cast<std::size_t>(quads.corners(q)[i]));
        }
      }
    };
    visit([this](std::size_t, std::size_t p) { ++first[p + 1]; });
    std::partial_sum(first.begin(), first.end(), first.begin());
    quad.resize(first.back());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    visit([&](std::size_t q, std::size_t p) { quad[next[p]++] = q; });
  }
  std::vector<std::size_t> first, quad;
};

Distribution::Distribution(const PlacedQuads& quads, std::size_t ranks, int ghostLevels)
  : rankOfQuad(quads.cellCount()),
    ownerOfPoint(quads.pointCount(), std::numeric_limits<std::uint32_t>::max()), own(ranks),
    ghosts(ranks), points(ranks)
{
  for (std::size_t q = 0; q < quads.cellCount(); ++q)
  {
    rankOfQuad[q] = quads.rankOfQuad(q);
    own[rankOfQuad[q]].push_back(q);
    for (std::size_t i = 0; i < quads.size(q); ++i)
    {
      std::uint32_t& owner = ownerOfPoint[static_cast<std::size_t>(quads.corners(q)[i])];
      owner = std::min(owner, rankOfQuad[q]);
    }
  }
  const QuadsOfPoints around(quads);
  for (std::size_t r = 0; r < ranks; ++r)
  {
    addRings(quads, around, r, ghostLevels);
  }
}

void Distribution::addRings(
  const PlacedQuads& quads, const QuadsOfPoints& around, std::size_t rank, int ghostLevels)
{
  std::vector<bool> hasPoint(quads.pointCount(), false), hasQuad(quads.cellCount(), false);
  std::vector<std::size_t> ring = own[rank];
  for (const std::size_t q : ring)
  {
    hasQuad[q] = true;
  }
  for (int level = 0; level <= ghostLevels; ++level)
  {
    std::vector<std::size_t> added;
    for (const std::size_t q : ring)
    {
      for (std::size_t i = 0; i < quads.size(q); ++i)
      {
        const auto p = static_cast<std::size_t>(quads.corners(q)[i]);
        if (!hasPoint[p])
        {
          hasPoint[p] = true;
          points[rank].push_back(p);
          added.push_back(p);
        }
      }
    }
    ring.clear();
    for (const std::size_t p : added)
    {
      for (std::size_t i = around.first[p]; level < ghostLevels && i < around.first[p + 1]; ++i)
      {
        const std::size_t q = around.quad[i];
        if (!hasQuad[q])
        {
          hasQuad[q] = true;
          ring.push_back(q);
          ghosts[rank].push_back(q);
        }
      }
    }
  }
  std::sort(points[rank].begin(), points[rank].end());
  std::sort(ghosts[rank].begin(), ghosts[rank].end());
}

std::vector<std::vector<std::uint32_t>> usersOf(
  const std::vector<std::vector<std::size_t>>& byRank, std::size_t items)
{
  std::vector<std::vector<std::uint32_t>> users(items);
  for (std::size_t r = 0; r < byRank.size(); ++r)
  {
    for (const std::size_t item : byRank[r])
    {
      users[item].push_back(static_cast<std::uint32_t>(r));
    }
  }
  return users;
}

Vector3 pointAt(vtkPolyData* data, vtkIdType id)
{
  Vector3 x;
  data->GetPoint(id, x.data());
  return x;
}

} // namespace quadrille
