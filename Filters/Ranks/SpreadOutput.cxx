// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The way back of a spread surface: from the quads on one rank to quads on all.
#include "Ranks/Spread.h"

#include "Common/NewArray.h"
#include "Convert/Attributes.h"
#include "Convert/Pieces.h"
#include "Convert/Quads.h"
#include "Ranks/Packing.h"
#include "Ranks/PlacedQuads.h"
#include "Ranks/SpreadShare.h"

#include <vtkCellArray.h>
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

namespace quadrille
{

// Not in the anonymous namespace, as members of SpreadSurface consist of it.

/// Where items lie on the pieces, and what is interpolated from these.
struct CarriedItems
{
  std::vector<Vector3> places;
  vtkSmartPointer<vtkPointData> arrays = vtkSmartPointer<vtkPointData>::New();
};

namespace
{

/// The places of items on one piece, and which items these are.
struct ItemsOfPiece
{
  std::vector<std::size_t> items;
  std::vector<SurfacePoint> places;

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
    std::vector<SurfacePoint> places = points.places;
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

void addArrays(vtkDataSetAttributes* from, vtkDataSetAttributes* to)
{
  for (int i = 0; i < from->GetNumberOfArrays(); ++i)
  {
    to->AddArray(from->GetAbstractArray(i));
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
