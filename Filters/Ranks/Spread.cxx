// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/Spread.h"

#include "Base/Lists.h"
#include "Base/Refuse.h"
#include "Common/NewArray.h"
#include "Common/Report.h"
#include "Convert/ArrayNames.h"
#include "Convert/Pieces.h"
#include "Convert/Surfaces.h"
#include "Ranks/InnerFaces.h"
#include "Ranks/Packing.h"
#include "Ranks/SpreadArrays.h"
#include "Ranks/SpreadCells.h"
#include "Ranks/SpreadFigures.h"

#include <vtkBoundingBox.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace quadrille
{

namespace
{

/// Points with a valence or a connection of their own that a rank may have: each stays when its piece is thinned out.
constexpr std::size_t kMostKept = 20000;

/// Of the joined surface, about: triangles with edges of this length and more.
double expectedVertices(double area, double edgeLength)
{
  return area / (0.5 * std::sqrt(3.0) * edgeLength * edgeLength);
}

std::vector<double> flat(const std::vector<Vector3>& points)
{
  std::vector<double> numbers;
  numbers.reserve(3 * points.size());
  for (const Vector3& x : points)
  {
    numbers.insert(numbers.end(), { x[0], x[1], x[2] });
  }
  return numbers;
}

Vector3 tripleAt(const std::vector<double>& numbers, std::size_t i)
{
  return Vector3(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
}

void packLevel(const PieceLevel& level, Packer& packer)
{
  packer.values(flat(level.points));
  packer.values(level.shared);
  std::vector<Index> corners;
  corners.reserve(3 * level.triangles.size());
  for (const std::array<Index, 3>& triangle : level.triangles)
  {
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  }
  packer.values(corners);
  packer.values(level.detectedFeatures);
  packer.values(level.requestedFeatures);
  std::vector<Index> places;
  std::vector<Vector3> normals;
  for (const BorderEdge& edge : level.border)
  {
    places.insert(places.end(), { edge.triangle, edge.corner });
    normals.push_back(edge.normal);
  }
  packer.values(places);
  packer.values(flat(normals));
}

PieceLevel unpackLevel(Unpacker& unpacker)
{
  PieceLevel level;
  const auto points = unpacker.values<double>();
  for (std::size_t i = 0; i < points.size() / 3; ++i)
  {
    level.points.push_back(tripleAt(points, i));
  }
  level.shared = unpacker.values<std::uint8_t>();
  const auto corners = unpacker.values<Index>();
  for (std::size_t i = 0; i < corners.size(); i += 3)
  {
    level.triangles.push_back({ corners[i], corners[i + 1], corners[i + 2] });
  }
  level.detectedFeatures = unpacker.values<std::uint8_t>();
  level.requestedFeatures = unpacker.values<std::uint8_t>();
  const auto places = unpacker.values<Index>();
  const auto normals = unpacker.values<double>();
  for (std::size_t i = 0; i < places.size() / 2; ++i)
  {
    level.border.push_back({ places[2 * i], places[2 * i + 1], tripleAt(normals, i) });
  }
  return level;
}

void packPatches(const std::vector<BorderPatch>& patches, Packer& packer)
{
  std::vector<std::int64_t> numbers;
  for (const BorderPatch& edge : patches)
  {
    numbers.insert(numbers.end(),
      { static_cast<std::int64_t>(edge.triangle), static_cast<std::int64_t>(edge.corner),
        edge.patch });
  }
  packer.values(numbers);
}

std::vector<BorderPatch> unpackPatches(Unpacker& unpacker)
{
  const auto numbers = unpacker.values<std::int64_t>();
  std::vector<BorderPatch> patches;
  for (std::size_t i = 0; i < numbers.size(); i += 3)
  {
    patches.push_back(
      { static_cast<Index>(numbers[i]), static_cast<Index>(numbers[i + 1]), numbers[i + 2] });
  }
  return patches;
}

/// The arrays of one point of a piece each.
void copyArrays(vtkDataSetAttributes* from, const std::vector<std::string>& names,
  const std::vector<Index>& ids, vtkFieldData* to)
{
  for (const std::string& name : names)
  {
    vtkAbstractArray* array = from->GetAbstractArray(name.c_str());
    if (!array)
    {
      continue;
    }
    auto copy = vtk::TakeSmartPointer(vtkAbstractArray::CreateArray(array->GetDataType()));
    copy->SetName(name.c_str());
    copy->SetNumberOfComponents(array->GetNumberOfComponents());
    copy->SetNumberOfTuples(static_cast<vtkIdType>(ids.size()));
    for (std::size_t i = 0; i < ids.size(); ++i)
    {
      copy->SetTuple(static_cast<vtkIdType>(i), ids[i], array);
    }
    to->AddArray(copy);
  }
}

vtkSmartPointer<vtkUnsignedCharArray> featureArray(
  const char* name, const std::vector<std::uint8_t>& bits)
{
  auto array = newArray<vtkUnsignedCharArray>(name, 1, bits.size());
  std::copy(bits.begin(), bits.end(), array->GetPointer(0));
  return array;
}

vtkSmartPointer<vtkPolyData> writeJoined(const SurfaceInput& surface)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(surface.points.size()));
  for (std::size_t i = 0; i < surface.points.size(); ++i)
  {
    points->SetPoint(static_cast<vtkIdType>(i), surface.points[i].data());
  }
  auto corners = newArray<vtkIdTypeArray>("", 1, surface.polygonPoints.size());
  std::copy(surface.polygonPoints.begin(), surface.polygonPoints.end(), corners->GetPointer(0));
  auto offsets = newArray<vtkIdTypeArray>("", 1, surface.polygonOffsets.size());
  std::copy(surface.polygonOffsets.begin(), surface.polygonOffsets.end(), offsets->GetPointer(0));
  vtkNew<vtkCellArray> polys;
  polys->SetData(offsets.Get(), corners.Get());
  data->SetPoints(points);
  data->SetPolys(polys);
  if (!surface.featureEdges.empty())
  {
    data->GetCellData()->AddArray(featureArray(arrays::kFeatureEdges, surface.featureEdges));
  }
  data->GetCellData()->AddArray(featureArray(arrays::kDetectedFeatures, surface.detectedFeatures));
  return data;
}

/// Point arrays that ask for something.
std::vector<std::string> askingArrays(const std::string& guideArray)
{
  std::vector<std::string> names = { arrays::kTargetValence, arrays::kSizing, arrays::kConnectId };
  if (!guideArray.empty())
  {
    names.push_back(guideArray);
  }
  return names;
}

} // namespace

SpreadSurface::SpreadSurface(
  const Ranks& ranks, int owner, const std::vector<vtkSmartPointer<vtkPolyData>>& pieces)
  : ranks_(ranks), owner_(owner)
{
  for (const vtkSmartPointer<vtkPolyData>& piece : pieces)
  {
    if (piece->GetNumberOfPolys() + piece->GetNumberOfStrips() > 0)
    {
      pieces_.emplace_back();
      pieces_.back().data = piece;
      pieces_.back().ofVolume = piece->GetCellData()->GetArray(kVolumeFace);
    }
  }
  measure();
}

SpreadSurface::~SpreadSurface() = default;

void SpreadSurface::measure()
{
  Packer packer;
  std::size_t cells = 0;
  double area = 0;
  bool inDouble = false;
  vtkBoundingBox box;
  for (const SpreadPiece& piece : pieces_)
  {
    cells +=
      static_cast<std::size_t>(piece.data->GetNumberOfPolys() + piece.data->GetNumberOfStrips());
    area += areaOf(piece.data);
    box.AddBounds(piece.data->GetBounds());
    inDouble = inDouble || needsDouble(piece.data);
  }
  double bounds[6];
  box.IsValid() ? box.GetBounds(bounds) : vtkMath::UninitializeBounds(bounds);
  packer.count(cells);
  packer.number(area);
  packer.values(bounds, 6);
  packer.count(inDouble ? 1 : 0);
  vtkBoundingBox whole;
  for (const std::string& bytes : ranks_.gather(packer.bytes()))
  {
    Unpacker unpacker(bytes);
    size_.cells += unpacker.count();
    size_.area += unpacker.number();
    const auto part = unpacker.values<double>();
    whole.AddBounds(part.data()); // ignores what is uninitialized
    inDouble = unpacker.count() != 0 || inDouble;
  }
  if (whole.IsValid())
  {
    whole.GetBounds(size_.bounds);
  }
  size_.diagonal = whole.IsValid() ? whole.GetDiagonalLength() : 0;
  unit_ = unitOfPlaces(size_.diagonal, inDouble);
  figures_.faces = cells;
}

vtkSmartPointer<vtkPolyData> SpreadSurface::join(
  const SpreadPlan& plan, std::vector<std::string>& notices)
{
  plan_ = plan;
  {
    const SpreadTimer timer(figures_, "prepare");
    model_ = agreeOnArrays(ranks_, pieces_, notices);
    hasGlobalIds_ = model_->GetPointData()->GetGlobalIds() != nullptr;
    dropInnerFaces(ranks_, pieces_, hasGlobalIds_, unit_, notices);
  }
  std::size_t border = 0;
  ranks_.together("the boundaries of the pieces",
    [&]
    {
      for (const SpreadPiece& piece : pieces_)
      {
        border += estimatedBorder(piece, hasGlobalIds_, unit_);
      }
    });
  if (isScattered(border))
  {
    redistribute(notices);
  }
  {
    const SpreadTimer timer(figures_, "prepare");
    makePieces();
  }
  {
    const SpreadTimer timer(figures_, "exchange");
    findSharedPoints();
  }
  {
    const SpreadTimer timer(figures_, "thin");
    ranks_.together("",
      [&]
      {
        keepWhatAsks();
        for (SpreadPiece& piece : pieces_)
        {
          piece.piece->thinOut(piece.kept);
          figures_.levelFaces += piece.piece->level().triangles.size();
        }
      });
  }
  return gatherLevels(notices);
}

void SpreadSurface::redistribute(std::vector<std::string>& notices)
{
  const SpreadTimer timer(figures_, "redistribute");
  notices.emplace_back("the pieces of the surface have so long boundaries that they were "
                       "redistributed among the ranks first; SourcePointIds are left out");
  pieces_ = redistributeCells(ranks_, std::move(pieces_), model_, unit_, figures_);
  isRedistributed_ = true;
}

void SpreadSurface::makePieces()
{
  figures_.faces = 0;
  ranks_.together("",
    [&]
    {
      std::size_t bytes = 0;
      for (SpreadPiece& piece : pieces_)
      {
        piece.converted = convertSurface(piece.data, plan_.patchArray, plan_.piece.threads);
        SurfaceInput input = std::move(piece.converted.input);
        piece.converted.input = {};
        input.guideDirections.clear(); // what asks for something does so on the joined surface
        input.guideWeights.clear();
        input.targetValences.clear();
        figures_.faces += input.polygonOffsets.size() - 1;
        PieceOptions options = plan_.piece;
        options.edgeLength = options.edgeLength > 0 ? options.edgeLength : 1; // is refused below
        piece.piece = std::make_unique<SurfacePiece>(std::move(input), options);
        bytes += piece.piece->bytes() +
          (static_cast<std::size_t>(piece.data->GetActualMemorySize()) << 10U);
        if (plan_.memoryLimit > 0 && static_cast<double>(bytes) > plan_.memoryLimit)
        {
          throw OutOfMemory("the pieces of the surface take " + std::to_string(bytes / 1000000) +
            " MB, more than the memory limit of " +
            std::to_string(static_cast<std::size_t>(1e-6 * plan_.memoryLimit)) +
            " MB: use more ranks, or raise Memory Limit");
        }
      }
    });
  if (!(plan_.piece.edgeLength > 0))
  {
    throw InvalidInput("the surface has no area, so that no size of quads follows from it");
  }
}

void SpreadSurface::findSharedPoints()
{
  std::vector<std::vector<std::uint64_t>> numbers(pieces_.size());
  ranks_.together("the boundaries of the pieces",
    [&]
    {
      figures_.borderPoints = 0;
      for (std::size_t p = 0; p < pieces_.size(); ++p)
      {
        for (const Index point : pieces_[p].piece->boundary())
        {
          numbers[p].push_back(
            static_cast<std::uint64_t>(pointNumber(pieces_[p], point, hasGlobalIds_, unit_)));
        }
        figures_.borderPoints += numbers[p].size();
      }
    });
  const std::vector<std::vector<std::uint8_t>> isShared = findShared(ranks_, numbers);
  figures_.sharedPoints = 0;
  for (std::size_t p = 0; p < pieces_.size(); ++p)
  {
    pieces_[p].kept.clear();
    for (std::size_t i = 0; i < isShared[p].size(); ++i)
    {
      if (isShared[p][i] != 0)
      {
        pieces_[p].kept.push_back(pieces_[p].piece->boundary()[i]);
      }
    }
    figures_.sharedPoints += pieces_[p].kept.size();
  }
}

void SpreadSurface::keepWhatAsks()
{
  for (SpreadPiece& piece : pieces_)
  {
    vtkPointData* arrays = piece.data->GetPointData();
    const std::size_t shared = piece.kept.size();
    for (const char* name : { arrays::kTargetValence, arrays::kConnectId })
    {
      vtkDataArray* array = arrays->GetArray(name);
      for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
      {
        if (array->GetComponent(i, 0) != 0)
        {
          piece.kept.push_back(static_cast<Index>(i));
        }
      }
    }
    if (piece.kept.size() > shared + kMostKept)
    {
      refuse(piece.kept.size() - shared, " points of a piece have a ", arrays::kTargetValence,
        " or a ", arrays::kConnectId, ", and of a spread surface each of them is kept, at most ",
        kMostKept, ": ask for fewer, or set Spread Surfaces to Never");
    }
    sortUnique(piece.kept);
  }
}

bool SpreadSurface::isScattered(std::size_t borderPoints) const
{
  Packer packer;
  double perimeter = 0; // of compact pieces, in points
  for (const SpreadPiece& piece : pieces_)
  {
    perimeter += 8 * std::sqrt(static_cast<double>(piece.data->GetNumberOfPolys()));
  }
  packer.number(perimeter);
  packer.count(borderPoints);
  packer.count(pieces_.size());
  perimeter = 0;
  double border = 0;
  std::size_t pieces = 0;
  for (const std::string& bytes : ranks_.gather(packer.bytes()))
  {
    Unpacker unpacker(bytes);
    perimeter += unpacker.number();
    border += static_cast<double>(unpacker.count());
    pieces += unpacker.count();
  }
  return pieces > 1 && border > perimeter &&
    border > 0.5 * expectedVertices(size_.area, plan_.piece.edgeLength);
}

std::string SpreadSurface::packLevels()
{
  Packer packer;
  packer.count(pieces_.size());
  const std::vector<std::string> asking = askingArrays(plan_.guideArray);
  std::string repaired;
  for (SpreadPiece& piece : pieces_)
  {
    const PieceLevel& level = piece.piece->level();
    packLevel(level, packer);
    vtkPointData* arrays = piece.data->GetPointData();
    std::vector<std::int64_t> ids;
    for (const Index point : level.inputPoint)
    {
      ids.push_back(pointNumber(piece, point, hasGlobalIds_, unit_));
    }
    packer.values(ids);
    packPatches(borderPatches(piece), packer);
    vtkNew<vtkFieldData> tuples;
    copyArrays(arrays, asking, level.inputPoint, tuples);
    packArrays(tuples, packer);
    piece.piece->forgetLevel();
    for (const std::string& text :
      { piece.piece->repairText(), detailsNotice(piece.piece->closedHandles()) })
    {
      repaired += (repaired.empty() || text.empty() ? "" : "; ") + text;
    }
  }
  packer.text(repaired);
  vtkNew<vtkFieldData> none;
  packArrays(pieces_.empty() ? none.Get() : pieces_[0].data->GetFieldData(), packer);
  figures_.gathered = packer.bytes().size();
  return packer.take();
}

vtkSmartPointer<vtkPolyData> SpreadSurface::gatherLevels(std::vector<std::string>& notices)
{
  const SpreadTimer timer(figures_, "gather");
  std::string mine;
  ranks_.together("", [&] { mine = packLevels(); });
  const std::vector<std::string> all = ranks_.gatherTo(owner_, std::move(mine));
  ranks_.together("the thinned pieces",
    [&]
    {
      if (ranks_.rank() == owner_)
      {
        joined_ = joinLevels(all, notices);
      }
    });
  return joined_;
}

vtkSmartPointer<vtkPolyData> SpreadSurface::joinLevels(
  const std::vector<std::string>& all, std::vector<std::string>& notices)
{
  std::vector<PieceLevel> levels;
  std::vector<std::vector<std::int64_t>> ids;
  std::vector<std::vector<BorderPatch>> patches;
  std::vector<vtkSmartPointer<vtkPolyData>> asking; // its point arrays
  vtkNew<vtkFieldData> field;
  rankOf_.clear();
  std::size_t repairedRanks = 0;
  for (std::size_t r = 0; r < all.size(); ++r)
  {
    Unpacker unpacker(all[r]);
    const std::uint64_t count = unpacker.count();
    for (std::uint64_t p = 0; p < count; ++p)
    {
      levels.push_back(unpackLevel(unpacker));
      ids.push_back(unpacker.values<std::int64_t>());
      patches.push_back(unpackPatches(unpacker));
      asking.push_back(vtkSmartPointer<vtkPolyData>::New());
      unpackArrays(unpacker, asking.back()->GetPointData());
      rankOf_.push_back({ static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(p) });
    }
    const std::string repaired = unpacker.text();
    if (!repaired.empty() && ++repairedRanks <= kMostTold)
    {
      notices.push_back(
        (all.size() > 1 ? "piece of rank " + std::to_string(r) + ": " : "") + repaired);
    }
    vtkNew<vtkFieldData> more;
    unpackArrays(unpacker, more);
    if (field->GetNumberOfArrays() == 0)
    {
      field->PassData(more);
    }
  }
  if (repairedRanks > kMostTold)
  {
    notices.push_back(std::to_string(repairedRanks) + " ranks repaired their pieces, of which " +
      std::to_string(kMostTold) + " are told here");
  }
  JoinedPieces joined = quadrille::joinPieces(levels, ids, plan_.piece.featureAngle);
  markPatchBorders(patches, joined);
  firstTriangle_ = joined.firstTriangle;
  vtkSmartPointer<vtkPolyData> data = writeJoined(joined.surface);
  std::vector<vtkDataSetAttributes*> sources;
  for (const vtkSmartPointer<vtkPolyData>& arrays : asking)
  {
    sources.push_back(arrays->GetPointData());
  }
  std::vector<TupleOrigin> origins;
  for (const std::array<Index, 2>& origin : joined.origin)
  {
    origins.push_back({ origin[0], static_cast<vtkIdType>(origin[1]) });
  }
  gatherArrays(sources, origins, data->GetPointData(), notices);
  data->GetFieldData()->PassData(field);
  notices.push_back("the surface of " + std::to_string(size_.cells) + " faces stays spread in " +
    std::to_string(levels.size()) + " pieces: the quads were made on its pieces thinned out to " +
    std::to_string(data->GetNumberOfPolys()) + " triangles, joined at " +
    std::to_string(joined.sharedPoints) + " points, and brought back onto them");
  return data;
}

bool isJoined(vtkPolyData* surface)
{
  return surface->GetCellData()->HasArray(arrays::kDetectedFeatures) != 0;
}

std::string reasonNotToSpread(
  const std::vector<vtkSmartPointer<vtkPolyData>>& pieces, const std::string& guideArray)
{
  for (vtkPolyData* piece : pieces)
  {
    vtkCellData* cells = piece->GetCellData();
    for (const std::string& name : { std::string(arrays::kGuidingDirection), guideArray })
    {
      if (!name.empty() && cells->HasArray(name.c_str()))
      {
        return "the directions of the cell array '" + name +
          "' cannot be carried over to thinned "
          "pieces";
      }
    }
  }
  return {};
}

} // namespace quadrille
