// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The way back of a spread surface: from the quads on one rank to quads on all.
#include "Ranks/Spread.h"

#include "Common/NewArray.h"
#include "Convert/Attributes.h"
#include "Convert/Pieces.h"
#include "Convert/Quads.h"
#include "Ranks/Packing.h"
#include "Ranks/SpreadCells.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace quadrille
{

// Not in the anonymous namespace, as members of SpreadSurface consist of them.

/// Items, points or quads, that lie on pieces of one rank.
struct PlacedItems
{
  std::vector<std::int64_t> id;         ///< global
  std::vector<std::uint32_t> piece;     ///< number on the rank
  std::vector<Index> triangle;          ///< of the piece's level
  std::vector<double> weights;          ///< 3 each
  std::vector<std::uint8_t> isOff;      ///< 1: its place is that which follows, beside the triangle
  std::vector<double> offPlaces;        ///< 3 each
  std::vector<std::uint32_t> userCount; ///< ranks that use it
  std::vector<std::uint32_t> users;     ///< of one after the other, ascending

  void pack(Packer& packer) const
  {
    packer.values(id);
    packer.values(piece);
    packer.values(triangle);
    packer.values(weights);
    packer.values(isOff);
    packer.values(offPlaces);
    packer.values(userCount);
    packer.values(users);
  }
  static PlacedItems unpack(Unpacker& unpacker)
  {
    PlacedItems items;
    items.id = unpacker.values<std::int64_t>();
    items.piece = unpacker.values<std::uint32_t>();
    items.triangle = unpacker.values<Index>();
    items.weights = unpacker.values<double>();
    items.isOff = unpacker.values<std::uint8_t>();
    items.offPlaces = unpacker.values<double>();
    items.userCount = unpacker.values<std::uint32_t>();
    items.users = unpacker.values<std::uint32_t>();
    return items;
  }
};

/// Where items lie on the pieces, and what is interpolated from these.
struct CarriedItems
{
  std::vector<Vector3> places;
  vtkSmartPointer<vtkPointData> arrays = vtkSmartPointer<vtkPointData>::New();
};

namespace
{

/// A point of the quads lies on its triangle where it is not farther off than this, as a multiple of the quads' edges:
/// far more than rounding, far less than what anybody sees.
constexpr double kOnTriangle = 1e-4;

Vector3 pointAt(vtkPolyData* data, vtkIdType id)
{
  Vector3 x;
  data->GetPoint(id, x.data());
  return x;
}

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

/// The quads of the filter with all that says where they are on the joined surface.
class PlacedQuads
{
public:
  PlacedQuads(vtkPolyData* quads, vtkPolyData* joined, const std::vector<Index>& firstTriangle,
    const std::vector<std::array<std::uint32_t, 2>>& rankOf)
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

  std::size_t pointCount() const { return static_cast<std::size_t>(quads_->GetNumberOfPoints()); }
  double quadCount() const { return static_cast<double>(quads_->GetNumberOfPolys()); }
  std::size_t cellCount() const { return first_.size() - 1; }
  const vtkIdType* corners(std::size_t quad) const { return corners_.data() + first_[quad]; }
  std::size_t size(std::size_t quad) const { return first_[quad + 1] - first_[quad]; }

  std::uint32_t rankOfQuad(std::size_t quad) const
  {
    return rankOf_[pieceOf(cellCell_->GetValue(static_cast<vtkIdType>(quad)))][0];
  }

  void addPoint(std::size_t point, const std::vector<std::uint32_t>& users,
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

  void addQuad(std::size_t quad, const std::vector<std::uint32_t>& users,
    std::vector<PlacedItems>& byRank) const
  {
    Vector3 centre = Vector3::Zero();
    for (std::size_t i = 0; i < size(quad); ++i)
    {
      centre += pointAt(quads_, corners(quad)[i]) / static_cast<double>(size(quad));
    }
    const vtkIdType cell = cellCell_->GetValue(static_cast<vtkIdType>(quad));
    add(quad, cell, nearestWeights(placesOf(cornersOf(cell)), centre), nullptr, users, byRank);
  }

private:
  void readCorners()
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

  double areaOfQuads() const
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

  std::size_t pieceOf(vtkIdType triangle) const
  {
    return static_cast<std::size_t>(std::upper_bound(firstTriangle_.begin(), firstTriangle_.end(),
                                      static_cast<Index>(triangle)) -
             firstTriangle_.begin()) -
      1;
  }

  std::array<vtkIdType, 3> cornersOf(vtkIdType triangle) const
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    joined_->GetPolys()->GetCellAtId(triangle, count, ids);
    return { ids[0], ids[1], ids[2] };
  }

  std::array<Vector3, 3> placesOf(const std::array<vtkIdType, 3>& ids) const
  {
    return { pointAt(joined_, ids[0]), pointAt(joined_, ids[1]), pointAt(joined_, ids[2]) };
  }

  void add(std::size_t id, vtkIdType triangle, const std::array<double, 3>& weights,
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

  vtkPolyData* quads_;
  vtkPolyData* joined_;
  const std::vector<Index>& firstTriangle_;
  const std::vector<std::array<std::uint32_t, 2>>& rankOf_;
  vtkIdTypeArray* pointCell_;
  vtkIdTypeArray* pointIds_;
  vtkDoubleArray* pointWeights_;
  vtkIdTypeArray* cellCell_;
  std::vector<vtkIdType> corners_;
  std::vector<std::size_t> first_;
  double tolerance_ = 0;
};

/// Which quads and points each rank gets.
struct Distribution
{
  std::vector<std::uint32_t> rankOfQuad;
  std::vector<std::uint32_t> ownerOfPoint; ///< the lowest rank with a quad of its own at it
  std::vector<std::vector<std::size_t>> own, ghosts; ///< quads by rank, ascending
  std::vector<std::vector<std::size_t>> points;      ///< by rank, ascending

  Distribution(const PlacedQuads& quads, std::size_t ranks, int ghostLevels)
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

private:
  /// Quads at each point.
  struct QuadsOfPoints
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

  /// The points of a rank's own quads, and ring after ring those around them.
  void addRings(
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
};

/// By item the ranks that use it, ascending.
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

vtkSmartPointer<vtkIdTypeArray> idArray(const char* name, const std::vector<std::size_t>& ids)
{
  auto array = newArray<vtkIdTypeArray>(name, 1, ids.size());
  std::copy(ids.begin(), ids.end(), array->GetPointer(0));
  return array;
}

/// The rank that has the cell SourceCellId.
constexpr const char* kSourceRank = "SourceRank";

/// The arrays of a model as they are on quads: without those that describe the surface itself, and with those that say
/// where the quads come from.
void carriedModel(vtkDataSetAttributes* model, bool withPoints, vtkDataSetAttributes* target)
{
  carryCellArrays(model, 0, target, std::vector<vtkIdType>{}, 1);
  target->RemoveArray(arrays::kSourceCellId);
  target->RemoveArray(kSourceRank);
  target->AddArray(newArray<vtkIdTypeArray>(arrays::kSourceCellId));
  target->AddArray(newArray<vtkIntArray>(kSourceRank));
  if (withPoints)
  {
    target->AddArray(newArray<vtkIdTypeArray>(arrays::kSourcePointIds, 3));
    target->AddArray(newArray<vtkDoubleArray>(arrays::kSourceBarycentric, 3));
  }
}

/// The arrays that the filter made; those of the model come from the pieces.
void copySome(vtkDataSetAttributes* from, const std::vector<std::size_t>& ids,
  vtkDataSetAttributes* model, vtkDataSetAttributes* to)
{
  std::vector<TupleOrigin> origins;
  for (const std::size_t id : ids)
  {
    origins.push_back({ 0, static_cast<vtkIdType>(id) });
  }
  vtkNew<vtkPointData> own;
  for (int i = 0; i < from->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = from->GetAbstractArray(i);
    if (!model->HasArray(array->GetName()))
    {
      own->AddArray(array);
    }
  }
  std::vector<std::string> notices; // there is one source, so nothing can differ
  gatherArrays({ own.Get() }, origins, to, notices);
}

constexpr const char* kPointIds = "GlobalPointIds";
constexpr const char* kCellIds = "GlobalCellIds";

/// What one rank gets: its quads, then its ghosts, with the arrays that the filter made.
std::string packShare(vtkPolyData* quads, const PlacedQuads& placed, const Distribution& ranks,
  std::size_t rank, bool hasGhosts, vtkPolyData* model)
{
  const std::vector<std::size_t>& points = ranks.points[rank];
  std::vector<std::size_t> cells = ranks.own[rank];
  cells.insert(cells.end(), ranks.ghosts[rank].begin(), ranks.ghosts[rank].end());
  auto share = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  places->SetNumberOfPoints(static_cast<vtkIdType>(points.size()));
  auto ghostPoints =
    newArray<vtkUnsignedCharArray>(vtkDataSetAttributes::GhostArrayName(), 1, points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const auto id = static_cast<vtkIdType>(i);
    places->SetPoint(id, quads->GetPoint(static_cast<vtkIdType>(points[i])));
    ghostPoints->SetValue(
      id, ranks.ownerOfPoint[points[i]] == rank ? 0 : vtkDataSetAttributes::DUPLICATEPOINT);
  }
  vtkNew<vtkCellArray> polys;
  for (const std::size_t q : cells)
  {
    polys->InsertNextCell(static_cast<int>(placed.size(q)));
    for (std::size_t i = 0; i < placed.size(q); ++i)
    {
      const auto p = static_cast<std::size_t>(placed.corners(q)[i]);
      polys->InsertCellPoint(std::lower_bound(points.begin(), points.end(), p) - points.begin());
    }
  }
  share->SetPoints(places);
  share->SetPolys(polys);
  vtkNew<vtkPointData> pointModel, cellModel;
  carriedModel(model->GetPointData(), true, pointModel);
  carriedModel(model->GetCellData(), false, cellModel);
  copySome(quads->GetPointData(), points, pointModel, share->GetPointData());
  copySome(quads->GetCellData(), cells, cellModel, share->GetCellData());
  share->GetPointData()->AddArray(idArray(kPointIds, points));
  share->GetCellData()->AddArray(idArray(kCellIds, cells));
  share->GetPointData()->AddArray(ghostPoints);
  if (hasGhosts)
  {
    auto ghostCells =
      newArray<vtkUnsignedCharArray>(vtkDataSetAttributes::GhostArrayName(), 1, cells.size());
    std::fill_n(ghostCells->GetPointer(0), ranks.own[rank].size(), static_cast<unsigned char>(0));
    std::fill_n(ghostCells->GetPointer(0) + ranks.own[rank].size(), ranks.ghosts[rank].size(),
      static_cast<unsigned char>(vtkDataSetAttributes::DUPLICATECELL));
    share->GetCellData()->AddArray(ghostCells);
  }
  share->GetFieldData()->PassData(quads->GetFieldData());
  Packer packer;
  packSurface(share, packer);
  return packer.take();
}

/// The places of items on one piece, and which items these are.
struct ItemsOfPiece
{
  std::vector<std::size_t> items;
  std::vector<PiecePlace> places;

  ItemsOfPiece(const PlacedItems& all, std::size_t piece)
  {
    for (std::size_t i = 0; i < all.id.size(); ++i)
    {
      if (all.piece[i] == piece)
      {
        items.push_back(i);
        places.push_back({ all.triangle[i],
          { all.weights[3 * i], all.weights[3 * i + 1], all.weights[3 * i + 2] } });
      }
    }
  }
};

vtkIdType sourceCellOf(const SpreadPiece& piece, vtkIdType cell)
{
  return piece.sourceCell.empty() ? cell : piece.sourceCell[static_cast<std::size_t>(cell)];
}

int sourceRankOf(const SpreadPiece& piece, vtkIdType cell, int rank)
{
  return piece.sourceRank.empty() ? rank : piece.sourceRank[static_cast<std::size_t>(cell)];
}

/// SourceCellId and SourceRank for all items, set piece by piece.
struct SourceArrays
{
  vtkSmartPointer<vtkIdTypeArray> cell;
  vtkSmartPointer<vtkIntArray> rank;

  SourceArrays(vtkPointData* target, std::size_t items)
    : cell(newArray<vtkIdTypeArray>(arrays::kSourceCellId, 1, items)),
      rank(newArray<vtkIntArray>(kSourceRank, 1, items))
  {
    target->RemoveArray(arrays::kSourceCellId);
    target->RemoveArray(kSourceRank);
    target->AddArray(cell);
    target->AddArray(rank);
  }
  void set(std::size_t item, const SpreadPiece& piece, vtkIdType id, int ofRank) const
  {
    cell->SetValue(static_cast<vtkIdType>(item), sourceCellOf(piece, id));
    rank->SetValue(static_cast<vtkIdType>(item), sourceRankOf(piece, id, ofRank));
  }
};

} // namespace

/// What the owner asks of a rank.
struct SpreadSurface::Orders
{
  PlacedItems points, quads;
};

struct SpreadSurface::Carried
{
  CarriedItems points, quads;
};

std::vector<std::string> SpreadSurface::placeQuads(vtkPolyData* quads, int ghostLevels)
{
  const auto ranks = static_cast<std::size_t>(ranks_.size());
  const PlacedQuads placed(quads, joined_, firstTriangle_, rankOf_);
  const Distribution distribution(placed, ranks, ghostLevels);
  std::vector<PlacedItems> points(ranks), cells(ranks);
  const auto usersOfPoints = usersOf(distribution.points, placed.pointCount());
  for (std::size_t p = 0; p < placed.pointCount(); ++p)
  {
    placed.addPoint(p, usersOfPoints[p], points);
  }
  auto usersOfQuads = usersOf(distribution.ghosts, placed.cellCount());
  for (std::size_t q = 0; q < placed.cellCount(); ++q)
  {
    usersOfQuads[q].push_back(distribution.rankOfQuad[q]);
    placed.addQuad(q, usersOfQuads[q], cells);
  }
  std::vector<std::string> messages(ranks);
  for (std::size_t r = 0; r < ranks; ++r)
  {
    Packer packer;
    points[r].pack(packer);
    cells[r].pack(packer);
    packer.count(distribution.own[r].size());
    packer.text(packShare(quads, placed, distribution, r, ghostLevels > 0, model_));
    messages[r] = packer.take();
  }
  return messages;
}

SpreadSurface::Carried SpreadSurface::carry(const Orders& orders)
{
  Carried carried;
  carried.points.places.resize(orders.points.id.size());
  std::vector<PointOrigin> origins(orders.points.id.size());
  std::vector<vtkIdType> pointCells(orders.points.id.size()), quadCells(orders.quads.id.size());
  std::vector<CarriedItems> pointsOf(pieces_.size()), quadsOf(pieces_.size());
  std::vector<TupleOrigin> pointTuple(orders.points.id.size()), quadTuple(orders.quads.id.size());
  const int threads = plan_.piece.threads;
  for (std::size_t k = 0; k < pieces_.size(); ++k)
  {
    SpreadPiece& piece = pieces_[k];
    const ItemsOfPiece points(orders.points, k), quads(orders.quads, k);
    std::vector<PiecePlace> places = points.places;
    places.insert(places.end(), quads.places.begin(), quads.places.end());
    const std::vector<CarriedPlace> found = piece.piece->carry(places);
    std::vector<PointOrigin> originsHere;
    std::vector<vtkIdType> cellsHere;
    for (std::size_t i = 0; i < points.items.size(); ++i)
    {
      const std::size_t item = points.items[i];
      origins[item] = pointOrigin(found[i].source, piece.converted, piece.data);
      originsHere.push_back(origins[item]);
      pointCells[item] = piece.converted.cell(found[i].source.polygon);
      pointTuple[item] = { k, static_cast<vtkIdType>(i) };
      Vector3 x = Vector3::Zero();
      for (std::size_t c = 0; c < 3; ++c)
      {
        x += origins[item].weights[c] * pointAt(piece.data, origins[item].ids[c]);
      }
      carried.points.places[item] = found[i].offInput.value_or(x);
    }
    for (std::size_t i = 0; i < quads.items.size(); ++i)
    {
      const Index polygon = found[points.items.size() + i].source.polygon;
      quadCells[quads.items[i]] = piece.converted.cell(polygon);
      cellsHere.push_back(quadCells[quads.items[i]]);
      quadTuple[quads.items[i]] = { k, static_cast<vtkIdType>(i) };
    }
    carryPointArrays(piece.data->GetPointData(), piece.data->GetNumberOfPoints(),
      pointsOf[k].arrays, originsHere, threads);
    carryCellArrays(piece.data->GetCellData(), piece.data->GetNumberOfCells(), quadsOf[k].arrays,
      cellsHere, threads);
  }
  for (std::size_t i = 0, off = 0; i < orders.points.id.size(); ++i)
  {
    if (orders.points.isOff[i] != 0)
    {
      const double* x = orders.points.offPlaces.data() + 3 * off++;
      carried.points.places[i] = Vector3(x[0], x[1], x[2]);
    }
  }
  const auto join = [](const std::vector<CarriedItems>& parts,
                      const std::vector<TupleOrigin>& tuples, vtkPointData* target)
  {
    std::vector<vtkDataSetAttributes*> sources;
    for (const CarriedItems& part : parts)
    {
      sources.push_back(part.arrays);
    }
    std::vector<std::string> notices; // all pieces have the same arrays
    gatherArrays(sources, tuples, target, notices);
  };
  join(pointsOf, pointTuple, carried.points.arrays);
  join(quadsOf, quadTuple, carried.quads.arrays);
  const SourceArrays ofPoints(carried.points.arrays, pointCells.size());
  for (std::size_t i = 0; i < pointCells.size(); ++i)
  {
    ofPoints.set(i, pieces_[orders.points.piece[i]], pointCells[i], ranks_.rank());
  }
  const SourceArrays ofQuads(carried.quads.arrays, quadCells.size());
  for (std::size_t i = 0; i < quadCells.size(); ++i)
  {
    ofQuads.set(i, pieces_[orders.quads.piece[i]], quadCells[i], ranks_.rank());
  }
  if (!isRedistributed_)
  {
    auto ids = newArray<vtkIdTypeArray>(arrays::kSourcePointIds, 3, origins.size());
    auto weights = newArray<vtkDoubleArray>(arrays::kSourceBarycentric, 3, origins.size());
    for (std::size_t i = 0; i < origins.size(); ++i)
    {
      ids->SetTypedTuple(static_cast<vtkIdType>(i), origins[i].ids.data());
      weights->SetTypedTuple(static_cast<vtkIdType>(i), origins[i].weights.data());
    }
    carried.points.arrays->AddArray(ids);
    carried.points.arrays->AddArray(weights);
  }
  return carried;
}

std::vector<std::string> SpreadSurface::packParcels(
  const Orders& orders, const Carried& carried) const
{
  const auto ranks = static_cast<std::size_t>(ranks_.size());
  std::vector<Packer> packers(ranks);
  const auto pack = [&](const PlacedItems& items, const CarriedItems& from)
  {
    std::vector<std::vector<std::size_t>> ofRank(ranks);
    std::size_t at = 0;
    for (std::size_t i = 0; i < items.id.size(); ++i)
    {
      for (std::uint32_t u = 0; u < items.userCount[i]; ++u)
      {
        ofRank[items.users[at++]].push_back(i);
      }
    }
    for (std::size_t r = 0; r < ranks; ++r)
    {
      std::vector<std::int64_t> ids;
      std::vector<double> places;
      std::vector<TupleOrigin> origins;
      for (const std::size_t i : ofRank[r])
      {
        ids.push_back(items.id[i]);
        origins.push_back({ 0, static_cast<vtkIdType>(i) });
        if (!from.places.empty())
        {
          places.insert(places.end(), { from.places[i][0], from.places[i][1], from.places[i][2] });
        }
      }
      packers[r].values(ids);
      packers[r].values(places);
      vtkNew<vtkPointData> tuples;
      std::vector<std::string> notices; // there is one source, so nothing can differ
      gatherArrays({ from.arrays.Get() }, origins, tuples, notices);
      packArrays(tuples, packers[r]);
    }
  };
  pack(orders.points, carried.points);
  pack(orders.quads, carried.quads);
  std::vector<std::string> parcels;
  for (Packer& packer : packers)
  {
    parcels.push_back(packer.take());
  }
  return parcels;
}

namespace
{

/// Items from all ranks, put to their places in a share.
class ReceivedItems
{
public:
  /// ids: global ones of the share's items.
  explicit ReceivedItems(vtkDataArray* ids)
  {
    for (vtkIdType i = 0; i < ids->GetNumberOfTuples(); ++i)
    {
      local_.emplace_back(static_cast<std::int64_t>(ids->GetComponent(i, 0)), i);
    }
    std::sort(local_.begin(), local_.end());
    origins_.resize(local_.size());
  }

  /// Calls place(local id, number in the message, places).
  template <class Place>
  void take(Unpacker& unpacker, const Place& place)
  {
    const auto ids = unpacker.values<std::int64_t>();
    const auto places = unpacker.values<double>();
    for (std::size_t i = 0; i < ids.size(); ++i)
    {
      const auto found = std::lower_bound(
        local_.begin(), local_.end(), std::pair<std::int64_t, vtkIdType>(ids[i], 0));
      origins_[static_cast<std::size_t>(found->second)] = { sources_.size(),
        static_cast<vtkIdType>(i) };
      if (!places.empty())
      {
        place(found->second, places.data() + 3 * i);
      }
    }
    sources_.push_back(vtkSmartPointer<vtkPointData>::New());
    unpackArrays(unpacker, sources_.back());
  }

  /// The arrays in an order that all ranks have: those of the model first.
  void write(vtkDataSetAttributes* model, vtkDataSetAttributes* target) const
  {
    std::vector<vtkDataSetAttributes*> sources;
    for (const vtkSmartPointer<vtkPointData>& source : sources_)
    {
      sources.push_back(source);
    }
    gatherInModelsOrder(sources, origins_, model, target);
  }

private:
  std::vector<std::pair<std::int64_t, vtkIdType>> local_;
  std::vector<TupleOrigin> origins_;
  std::vector<vtkSmartPointer<vtkPointData>> sources_;
};

void addArrays(vtkDataSetAttributes* from, vtkDataSetAttributes* to)
{
  for (int i = 0; i < from->GetNumberOfArrays(); ++i)
  {
    to->AddArray(from->GetAbstractArray(i));
  }
}

/// As the filter does for a surface in one place: where there are features, points on them have no one normal; else the
/// normals that the surface has go before those of the quads.
void chooseNormals(vtkPointData* data)
{
  vtkAbstractArray* ofQuads = data->GetAbstractArray(arrays::kQuadNormals);
  if (!ofQuads)
  {
    data->SetActiveAttribute(-1, vtkDataSetAttributes::NORMALS);
  }
  else if (data->GetNormals())
  {
    data->RemoveArray(arrays::kQuadNormals);
  }
  else
  {
    data->SetActiveAttribute(arrays::kQuadNormals, vtkDataSetAttributes::NORMALS);
  }
}

} // namespace

vtkSmartPointer<vtkPolyData> SpreadSurface::assemble(
  const std::string& share, const std::vector<std::string>& parcels) const
{
  Unpacker unpacker(share);
  vtkSmartPointer<vtkPolyData> mine = unpackSurface(unpacker);
  ReceivedItems points(mine->GetPointData()->GetArray(kPointIds));
  ReceivedItems quads(mine->GetCellData()->GetArray(kCellIds));
  for (const std::string& bytes : parcels)
  {
    Unpacker parcel(bytes);
    points.take(parcel, [&](vtkIdType id, const double* x) { mine->GetPoints()->SetPoint(id, x); });
    quads.take(parcel, [](vtkIdType, const double*) {});
  }
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->SetPoints(mine->GetPoints());
  result->SetPolys(mine->GetPolys());
  vtkNew<vtkPointData> pointModel, cellModel;
  carriedModel(model_->GetPointData(), !isRedistributed_, pointModel);
  carriedModel(model_->GetCellData(), false, cellModel);
  points.write(pointModel, result->GetPointData());
  quads.write(cellModel, result->GetCellData());
  addArrays(mine->GetPointData(), result->GetPointData());
  addArrays(mine->GetCellData(), result->GetCellData());
  result->GetPointData()->SetActiveAttribute(kPointIds, vtkDataSetAttributes::GLOBALIDS);
  result->GetCellData()->SetActiveAttribute(kCellIds, vtkDataSetAttributes::GLOBALIDS);
  chooseNormals(result->GetPointData());
  result->GetFieldData()->PassData(mine->GetFieldData());
  return result;
}

vtkSmartPointer<vtkPolyData> SpreadSurface::spread(
  vtkPolyData* quads, const std::vector<vtkPolyData*>& others, int ghostLevels)
{
  const bool isOwner = ranks_.rank() == owner_;
  std::vector<std::string> messages;
  std::string order;
  {
    const SpreadTimer timer(figures_, "place");
    ranks_.together("",
      [&]
      {
        if (isOwner)
        {
          messages = placeQuads(quads, ghostLevels);
        }
      });
    order = ranks_.scatter(owner_, std::move(messages));
  }
  Orders orders;
  std::string share;
  std::vector<std::string> parcels;
  std::string places;
  {
    const SpreadTimer timer(figures_, "carry");
    ranks_.together("",
      [&]
      {
        Unpacker unpacker(order);
        orders.points = PlacedItems::unpack(unpacker);
        orders.quads = PlacedItems::unpack(unpacker);
        figures_.quads = unpacker.count();
        share = unpacker.text();
        std::string().swap(order);
        const Carried carried = carry(orders);
        parcels = packParcels(orders, carried);
        Packer packer;
        packer.values(orders.points.id);
        std::vector<double> numbers;
        for (const Vector3& x : carried.points.places)
        {
          numbers.insert(numbers.end(), { x[0], x[1], x[2] });
        }
        packer.values(numbers);
        places = packer.take();
      });
  }
  const SpreadTimer timer(figures_, "scatter");
  parcels = ranks_.exchange(std::move(parcels));
  const std::vector<std::string> allPlaces = ranks_.gatherTo(owner_, std::move(places));
  vtkSmartPointer<vtkPolyData> result;
  ranks_.together("",
    [&]
    {
      result = assemble(share, parcels);
      std::vector<Vector3> byId(isOwner ? static_cast<std::size_t>(quads->GetNumberOfPoints()) : 0);
      for (const std::string& bytes : allPlaces)
      {
        Unpacker unpacker(bytes);
        const auto ids = unpacker.values<std::int64_t>();
        const auto numbers = unpacker.values<double>();
        for (std::size_t i = 0; i < ids.size(); ++i)
        {
          byId[static_cast<std::size_t>(ids[i])] =
            Vector3(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
        }
      }
      for (vtkPolyData* other : others)
      {
        vtkDataArray* ids = other->GetPointData()->GetArray("QuadPointId");
        for (vtkIdType i = 0; ids && i < ids->GetNumberOfTuples(); ++i)
        {
          const auto id = static_cast<std::size_t>(ids->GetComponent(i, 0));
          other->GetPoints()->SetPoint(i, byId[id].data());
        }
        other->GetPoints() ? other->GetPoints()->Modified() : void();
      }
    });
  return result;
}

std::vector<SpreadFigures> SpreadSurface::figures() const
{
  SpreadFigures mine = figures_;
  mine.traffic = ranks_.traffic();
  mine.peakMemory = peakMemory();
  Packer packer;
  mine.pack(packer);
  std::vector<SpreadFigures> all;
  for (const std::string& bytes : ranks_.gather(packer.bytes()))
  {
    Unpacker unpacker(bytes);
    all.push_back(SpreadFigures::unpack(unpacker));
  }
  return all;
}

} // namespace quadrille
