// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Convert/Pieces.h"

#include "Convert/PolyData.h"

#include <vtkAbstractArray.h>
#include <vtkBoundingBox.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTriangleFilter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <numeric>
#include <tuple>

namespace quadrille
{

namespace
{

/// A double's bits in the order of the numbers; -0 as 0, so that all doubles, also those that are none, have a place.
std::uint64_t orderedBits(double value)
{
  if (value == 0)
  {
    value = 0;
  }
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  constexpr std::uint64_t sign = std::uint64_t{ 1 } << 63;
  return bits & sign ? ~bits : bits | sign;
}

using PointKey = std::array<std::uint64_t, 3>;

/// Of the box around all pieces: sources compute the points of a cut anew for each piece, and their last bits differ,
/// above all of those that should be 0.
double unitOfPlaces(const std::vector<vtkSmartPointer<vtkPolyData>>& pieces)
{
  vtkBoundingBox box;
  bool inDouble = false;
  for (vtkPolyData* piece : pieces)
  {
    if (piece->GetNumberOfPoints() > 0)
    {
      box.AddBounds(piece->GetBounds());
      inDouble = inDouble || needsDouble(piece);
    }
  }
  return quadrille::unitOfPlaces(box.IsValid() ? box.GetDiagonalLength() : 0, inDouble);
}

Vector3 roundedPoint(vtkPolyData* piece, vtkIdType id, double unit)
{
  Vector3 x;
  piece->GetPoint(id, x.data());
  for (double& coordinate : x)
  {
    const double multiple = unit > 0 ? std::nearbyint(coordinate / unit) : 0;
    // Beyond 2^53 units a double has no part of one.
    if (unit > 0 && std::abs(multiple) < 9007199254740992.0)
    {
      coordinate = multiple * unit;
    }
  }
  return x;
}

/// What joins the pieces. Ids of places are ids of points with the same coordinates, in the order of these.
class PieceJoin
{
public:
  explicit PieceJoin(const std::vector<vtkSmartPointer<vtkPolyData>>& pieces);

  vtkSmartPointer<vtkPolyData> run(std::vector<std::string>& notices);

private:
  struct Face
  {
    TupleOrigin origin;
    std::size_t first = 0; ///< corner, in corners_
    std::size_t size = 0;
    std::size_t start = 0; ///< the corner with the lowest place
    bool forward = true;   ///< whether the lower of its neighbours comes next
    bool ofVolume = false;
  };

  void findPlaces();
  void readFaces();
  void orient(Face& face) const;
  /// Place of the i-th corner in the order that does not depend on where the face begins and how it is turned.
  vtkIdType placeAt(const Face& face, std::size_t i) const;
  bool samePlaces(const Face& a, const Face& b) const;
  bool less(const Face& a, const Face& b) const;
  void dropFaces();
  void keepOfGroup(std::size_t begin, std::size_t end, std::vector<Face>& kept);
  vtkSmartPointer<vtkPolyData> write(std::vector<std::string>& notices) const;

  std::vector<vtkSmartPointer<vtkPolyData>> pieces_;
  std::vector<vtkIdType> firstPoint_;    ///< of each piece, in all points
  std::vector<TupleOrigin> placeOrigin_; ///< the first point at a place
  std::vector<vtkIdType> place_;         ///< of each point
  std::vector<vtkIdType> corners_;       ///< places
  std::vector<Face> faces_;
  std::size_t merged_ = 0;
  std::size_t duplicates_ = 0;
  std::size_t inside_ = 0;
};

PieceJoin::PieceJoin(const std::vector<vtkSmartPointer<vtkPolyData>>& pieces)
{
  for (const vtkSmartPointer<vtkPolyData>& piece : pieces)
  {
    pieces_.push_back(piece);
    if (piece->GetNumberOfStrips() > 0)
    {
      vtkNew<vtkTriangleFilter> triangles;
      triangles->SetInputData(piece);
      triangles->PassVertsOff();
      triangles->PassLinesOff();
      triangles->Update();
      pieces_.back() = triangles->GetOutput();
    }
  }
}

void PieceJoin::findPlaces()
{
  std::vector<PointKey> keys;
  std::vector<TupleOrigin> origins;
  const double unit = unitOfPlaces(pieces_);
  for (std::size_t p = 0; p < pieces_.size(); ++p)
  {
    firstPoint_.push_back(static_cast<vtkIdType>(keys.size()));
    for (vtkIdType i = 0; i < pieces_[p]->GetNumberOfPoints(); ++i)
    {
      keys.push_back(placeKey(pieces_[p], i, unit));
      origins.push_back({ p, i });
    }
  }
  std::vector<std::size_t> order(keys.size());
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  std::sort(order.begin(), order.end(),
    [&keys](std::size_t a, std::size_t b)
    { return std::pair(keys[a], a) < std::pair(keys[b], b); });
  place_.resize(keys.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    const bool isNew = i == 0 || keys[order[i]] != keys[order[i - 1]];
    if (isNew)
    {
      placeOrigin_.push_back(origins[order[i]]);
    }
    merged_ += !isNew;
    place_[order[i]] = static_cast<vtkIdType>(placeOrigin_.size()) - 1;
  }
}

void PieceJoin::readFaces()
{
  for (std::size_t p = 0; p < pieces_.size(); ++p)
  {
    vtkPolyData* piece = pieces_[p];
    const vtkIdType firstCell = piece->GetNumberOfVerts() + piece->GetNumberOfLines();
    vtkDataArray* ofVolume = piece->GetCellData()->GetArray(kVolumeFace);
    auto cells = vtk::TakeSmartPointer(piece->GetPolys()->NewIterator());
    for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
    {
      vtkIdType count = 0;
      const vtkIdType* ids = nullptr;
      cells->GetCurrentCell(count, ids);
      Face face;
      face.origin = { p, firstCell + cells->GetCurrentCellId() };
      face.first = corners_.size();
      face.size = static_cast<std::size_t>(count);
      face.ofVolume = ofVolume && ofVolume->GetTuple1(face.origin.tuple) != 0;
      for (vtkIdType i = 0; i < count; ++i)
      {
        if (ids[i] < 0 || ids[i] >= pieces_[p]->GetNumberOfPoints())
        {
          throw InvalidInput("cell " + std::to_string(face.origin.tuple) +
            " of a piece uses point " + std::to_string(ids[i]) + ", but the piece has only " +
            std::to_string(pieces_[p]->GetNumberOfPoints()) +
            " points: remove the cell or add the point.");
        }
        corners_.push_back(place_[firstPoint_[p] + ids[i]]);
      }
      orient(face);
      faces_.push_back(face);
    }
  }
}

void PieceJoin::orient(Face& face) const
{
  const auto begin = corners_.begin() + static_cast<std::ptrdiff_t>(face.first);
  const auto end = begin + static_cast<std::ptrdiff_t>(face.size);
  face.start = static_cast<std::size_t>(std::min_element(begin, end) - begin);
  if (face.size > 2)
  {
    const auto at = [&](std::size_t i) { return corners_[face.first + i % face.size]; };
    face.forward = at(face.start + 1) <= at(face.start + face.size - 1);
  }
}

vtkIdType PieceJoin::placeAt(const Face& face, std::size_t i) const
{
  const std::size_t step = face.forward ? i : face.size - i;
  return corners_[face.first + (face.start + step) % face.size];
}

bool PieceJoin::samePlaces(const Face& a, const Face& b) const
{
  bool same = a.size == b.size;
  for (std::size_t i = 0; same && i < a.size; ++i)
  {
    same = placeAt(a, i) == placeAt(b, i);
  }
  return same;
}

bool PieceJoin::less(const Face& a, const Face& b) const
{
  for (std::size_t i = 0; i < std::min(a.size, b.size); ++i)
  {
    if (placeAt(a, i) != placeAt(b, i))
    {
      return placeAt(a, i) < placeAt(b, i);
    }
  }
  return std::tuple(a.size, b.forward, a.origin.source, a.origin.tuple) <
    std::tuple(b.size, a.forward, b.origin.source, b.origin.tuple);
}

void PieceJoin::dropFaces()
{
  std::sort(
    faces_.begin(), faces_.end(), [this](const Face& a, const Face& b) { return less(a, b); });
  std::vector<Face> kept;
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= faces_.size(); ++i)
  {
    if (i == faces_.size() || !samePlaces(faces_[begin], faces_[i]))
    {
      keepOfGroup(begin, i, kept);
      begin = i;
    }
  }
  faces_ = std::move(kept);
}

void PieceJoin::keepOfGroup(std::size_t begin, std::size_t end, std::vector<Face>& kept)
{
  std::array<bool, 2> volumeOnSide{};
  for (std::size_t i = begin; i < end; ++i)
  {
    volumeOnSide[faces_[i].forward] |= faces_[i].ofVolume;
  }
  const bool isInside = volumeOnSide[0] && volumeOnSide[1];
  std::array<const Face*, 2> last{}; // of each side
  for (std::size_t i = begin; i < end; ++i)
  {
    const Face& face = faces_[i];
    const Face*& before = last[face.forward];
    if (isInside && face.ofVolume)
    {
      ++inside_;
    }
    else if (before && before->origin.source != face.origin.source)
    {
      ++duplicates_;
    }
    else
    {
      kept.push_back(face);
      before = &face;
    }
  }
}

vtkSmartPointer<vtkPolyData> PieceJoin::write(std::vector<std::string>& notices) const
{
  std::vector<vtkIdType> pointOfPlace(placeOrigin_.size(), -1);
  for (const Face& face : faces_)
  {
    for (std::size_t i = 0; i < face.size; ++i)
    {
      pointOfPlace[corners_[face.first + i]] = 0;
    }
  }
  std::vector<TupleOrigin> pointOrigins;
  bool inDouble = false;
  for (vtkPolyData* piece : pieces_)
  {
    inDouble = inDouble || needsDouble(piece);
  }
  for (std::size_t place = 0; place < placeOrigin_.size(); ++place)
  {
    if (pointOfPlace[place] == 0)
    {
      pointOfPlace[place] = static_cast<vtkIdType>(pointOrigins.size());
      pointOrigins.push_back(placeOrigin_[place]);
    }
  }
  auto joined = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(inDouble ? VTK_DOUBLE : VTK_FLOAT);
  points->SetNumberOfPoints(static_cast<vtkIdType>(pointOrigins.size()));
  const double unit = unitOfPlaces(pieces_);
  for (std::size_t i = 0; i < pointOrigins.size(); ++i)
  {
    const TupleOrigin& origin = pointOrigins[i];
    const Vector3 x = roundedPoint(pieces_[origin.source], origin.tuple, unit);
    points->SetPoint(static_cast<vtkIdType>(i), x.data());
  }
  vtkNew<vtkCellArray> polys;
  std::vector<TupleOrigin> cellOrigins;
  std::vector<vtkIdType> ids;
  for (const Face& face : faces_)
  {
    // The corners keep their order: arrays may tell of the first, the second and so on.
    ids.clear();
    for (std::size_t i = 0; i < face.size; ++i)
    {
      ids.push_back(pointOfPlace[corners_[face.first + i]]);
    }
    polys->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
    cellOrigins.push_back(face.origin);
  }
  joined->SetPoints(points);
  joined->SetPolys(polys);
  std::vector<vtkDataSetAttributes*> pointData, cellData;
  for (vtkPolyData* piece : pieces_)
  {
    pointData.push_back(piece->GetPointData());
    cellData.push_back(piece->GetCellData());
  }
  gatherArrays(pointData, pointOrigins, joined->GetPointData(), notices);
  gatherArrays(cellData, cellOrigins, joined->GetCellData(), notices);
  joined->GetCellData()->RemoveArray(kVolumeFace);
  for (vtkPolyData* piece : pieces_)
  {
    if (piece->GetFieldData()->GetNumberOfArrays() > 0)
    {
      joined->GetFieldData()->PassData(piece->GetFieldData());
      break;
    }
  }
  return joined;
}

vtkSmartPointer<vtkPolyData> PieceJoin::run(std::vector<std::string>& notices)
{
  findPlaces();
  readFaces();
  const std::size_t given = faces_.size();
  dropFaces();
  if (pieces_.size() > 1)
  {
    std::string text = "the surface came in " + std::to_string(pieces_.size()) + " pieces with " +
      std::to_string(given) + " faces, which were put together: " + std::to_string(merged_) +
      " points at the places of others were joined";
    if (duplicates_ > 0)
    {
      text += ", " + std::to_string(duplicates_) + " faces of several pieces were taken once";
    }
    if (inside_ > 0)
    {
      text += ", " + std::to_string(inside_) + " faces where volumes meet were left out";
    }
    notices.push_back(text);
  }
  return write(notices);
}

/// An array of several sources.
struct CommonArray
{
  vtkAbstractArray* model = nullptr;
  std::vector<vtkAbstractArray*> ofSource; ///< null where it is missing
  bool differs = false;
};

std::map<std::string, CommonArray> commonArrays(const std::vector<vtkDataSetAttributes*>& sources)
{
  std::map<std::string, CommonArray> arrays;
  for (std::size_t s = 0; s < sources.size(); ++s)
  {
    for (int i = 0; i < sources[s]->GetNumberOfArrays(); ++i)
    {
      vtkAbstractArray* array = sources[s]->GetAbstractArray(i);
      const std::string name = array->GetName() ? array->GetName() : "";
      if (name == vtkDataSetAttributes::GhostArrayName())
      {
        continue;
      }
      CommonArray& shared = arrays[name];
      shared.ofSource.resize(sources.size());
      shared.ofSource[s] = array;
      shared.model = shared.model ? shared.model : array;
      shared.differs = shared.differs || array->GetDataType() != shared.model->GetDataType() ||
        array->GetNumberOfComponents() != shared.model->GetNumberOfComponents();
    }
  }
  return arrays;
}

vtkSmartPointer<vtkAbstractArray> gatherArray(
  const CommonArray& shared, const std::vector<TupleOrigin>& origins, double missing)
{
  auto result = vtk::TakeSmartPointer(vtkAbstractArray::CreateArray(shared.model->GetDataType()));
  result->SetName(shared.model->GetName());
  result->SetNumberOfComponents(shared.model->GetNumberOfComponents());
  for (int c = 0; c < shared.model->GetNumberOfComponents(); ++c)
  {
    if (const char* name = shared.model->GetComponentName(c))
    {
      result->SetComponentName(c, name);
    }
  }
  result->SetNumberOfTuples(static_cast<vtkIdType>(origins.size()));
  if (auto* numbers = vtkDataArray::SafeDownCast(result))
  {
    numbers->Fill(missing);
  }
  for (std::size_t i = 0; i < origins.size(); ++i)
  {
    vtkAbstractArray* source = shared.ofSource[origins[i].source];
    if (source && origins[i].tuple < source->GetNumberOfTuples())
    {
      result->SetTuple(static_cast<vtkIdType>(i), origins[i].tuple, source);
    }
  }
  return result;
}

} // namespace

bool needsDouble(vtkPolyData* piece)
{
  if (!piece->GetPoints() || piece->GetPoints()->GetDataType() == VTK_FLOAT)
  {
    return false;
  }
  for (vtkIdType i = 0; i < piece->GetNumberOfPoints(); ++i)
  {
    Vector3 x;
    piece->GetPoint(i, x.data());
    if (x.cast<float>().cast<double>() != x)
    {
      return true;
    }
  }
  return false;
}

/// A power of two, 2^-25 to 2^-26 of the diagonal where all coordinates are single, else 2^-31 to 2^-32: no more than
/// their own last bit in most single ones.
double unitOfPlaces(double diagonal, bool inDouble)
{
  if (!(diagonal > 0) || !std::isfinite(diagonal))
  {
    return 0;
  }
  // The factor keeps diagonals that are powers of two, up to their last bits, off the edge between two units.
  return std::exp2(std::ceil(std::log2(0.73 * diagonal)) - (inDouble ? 32 : 26));
}

std::array<std::uint64_t, 3> placeKey(vtkPolyData* piece, vtkIdType point, double unit)
{
  const Vector3 x = roundedPoint(piece, point, unit);
  return { orderedBits(x[0]), orderedBits(x[1]), orderedBits(x[2]) };
}

vtkSmartPointer<vtkPolyData> withoutMarks(vtkPolyData* piece)
{
  if (!piece->GetCellData()->HasArray(kVolumeFace))
  {
    return piece;
  }
  auto copy = vtkSmartPointer<vtkPolyData>::New();
  copy->ShallowCopy(piece);
  copy->GetCellData()->RemoveArray(kVolumeFace);
  return copy;
}

vtkSmartPointer<vtkPolyData> joinPieces(
  const std::vector<vtkSmartPointer<vtkPolyData>>& pieces, std::vector<std::string>& notices)
{
  return PieceJoin(pieces).run(notices);
}

void gatherArrays(const std::vector<vtkDataSetAttributes*>& sources,
  const std::vector<TupleOrigin>& origins, vtkDataSetAttributes* target,
  std::vector<std::string>& notices)
{
  std::vector<std::size_t> used(sources.size(), 0);
  for (const TupleOrigin& origin : origins)
  {
    ++used[origin.source];
  }
  for (const auto& [name, shared] : commonArrays(sources))
  {
    if (shared.differs)
    {
      notices.push_back("array '" + name + "' differs between pieces and is left behind");
      continue;
    }
    const bool isFactor = name == arrays::kSizing || name == arrays::kGuidingWeight;
    bool isMissing = false;
    for (std::size_t s = 0; s < sources.size(); ++s)
    {
      isMissing = isMissing || (used[s] > 0 && !shared.ofSource[s]);
    }
    if (isMissing && name != kVolumeFace)
    {
      notices.push_back("array '" + name + "' is missing on some pieces; " +
        (isFactor ? "1" : "0 or nothing") + " stands for it there");
    }
    target->AddArray(gatherArray(shared, origins, isFactor ? 1 : 0));
  }
  for (int attribute = 0; attribute < vtkDataSetAttributes::NUM_ATTRIBUTES; ++attribute)
  {
    for (vtkDataSetAttributes* source : sources)
    {
      vtkAbstractArray* active = source->GetAbstractAttribute(attribute);
      if (active && active->GetName() && target->HasArray(active->GetName()))
      {
        target->SetActiveAttribute(active->GetName(), attribute);
        break;
      }
    }
  }
}

} // namespace quadrille
