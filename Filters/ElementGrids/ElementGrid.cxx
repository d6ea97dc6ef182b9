// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "ElementGrids/ElementGrid.h"

#include "Base/Parallel.h"
#include "Base/Refuse.h"
#include "Common/NewArray.h"
#include "Convert/Attributes.h"
#include "Convert/Quads.h"
#include "Mesh/NearestTriangle.h"
#include "Prepare/Prepare.h"
#include "Quads/QuadShape.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

namespace quadrille
{

namespace
{

constexpr std::size_t kElementChunk = 512;
constexpr double kOnSurface = 1e-9; ///< of the diagonal

//------------------------------------------------------------------------------
/// Where SourceCellId and its companions say that points of the quads lie.
class NamedPlaces
{
public:
  NamedPlaces(vtkPolyData* quads, const ElementSurface& surface)
    : surface_(surface), cells_(quads->GetPointData()->GetArray(arrays::kSourceCellId)),
      ids_(quads->GetPointData()->GetArray(arrays::kSourcePointIds)),
      weights_(quads->GetPointData()->GetArray(arrays::kSourceBarycentric))
  {
    const vtkIdType count = quads->GetNumberOfPoints();
    const auto fits = [count](vtkDataArray* array, int components)
    {
      return array && array->GetNumberOfTuples() == count &&
        array->GetNumberOfComponents() == components;
    };
    isThere_ = fits(cells_, 1) && fits(ids_, 3) && fits(weights_, 3) &&
      surface.converted.cellOfPolygon.empty();
    if (isThere_)
    {
      sortFaces();
    }
  }

  /// None where nothing is named, or what is not there.
  std::optional<SurfacePoint> at(vtkIdType point) const
  {
    if (!isThere_)
    {
      return std::nullopt;
    }
    const auto polygon =
      static_cast<vtkIdType>(cells_->GetComponent(point, 0)) - surface_.converted.firstCell;
    const std::vector<Index>& ofFace = surface_.prepared.sourcePolygon;
    const auto first = std::lower_bound(faces_.begin(), faces_.end(), polygon,
      [&ofFace](Index f, vtkIdType p) { return static_cast<vtkIdType>(ofFace[f]) < p; });
    for (auto f = first; f != faces_.end() && static_cast<vtkIdType>(ofFace[*f]) == polygon; ++f)
    {
      if (const auto place = inFaceOf(*f, point))
      {
        return place;
      }
    }
    return std::nullopt;
  }

private:
  void sortFaces()
  {
    const std::vector<Index>& polygon = surface_.prepared.sourcePolygon;
    faces_.resize(polygon.size());
    for (Index f = 0; f < faces_.size(); ++f)
    {
      faces_[f] = f;
    }
    std::sort(faces_.begin(), faces_.end(),
      [&polygon](Index a, Index b)
      { return std::make_pair(polygon[a], a) < std::make_pair(polygon[b], b); });
  }

  std::optional<SurfacePoint> inFaceOf(Index f, vtkIdType point) const
  {
    SurfacePoint place{ f, {} };
    const std::array<Index, 3>& corners = surface_.prepared.sourcePoints[f];
    for (int k = 0; k < 3; ++k)
    {
      const double weight = weights_->GetComponent(point, k);
      const auto id = static_cast<vtkIdType>(ids_->GetComponent(point, k));
      const auto found = std::find_if(corners.begin(), corners.end(),
        [id](Index corner) { return static_cast<vtkIdType>(corner) == id; });
      if (found == corners.end())
      {
        return std::nullopt;
      }
      place.weights[static_cast<std::size_t>(found - corners.begin())] = weight;
    }
    return place;
  }

  const ElementSurface& surface_;
  vtkDataArray* cells_;
  vtkDataArray* ids_;
  vtkDataArray* weights_;
  bool isThere_ = false;
  std::vector<Index> faces_; ///< by polygon
};

std::vector<Vector3> normalsAtPoints(
  const std::vector<Vector3>& points, const std::vector<std::array<Index, 4>>& quads)
{
  std::vector<Vector3> normals(points.size(), Vector3::Zero());
  for (const std::array<Index, 4>& quad : quads)
  {
    const Vector3 normal = centreNormal(cornersOf(points, quad)).stableNormalized();
    for (const Index corner : quad)
    {
      normals[corner] += normal;
    }
  }
  return normals;
}

std::unique_ptr<NearestTriangle> treeOf(const Mesh& mesh)
{
  TriangleList list;
  list.points = mesh.position;
  list.corners.resize(mesh.faceCount());
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    list.corners[f] = { mesh.origin[3 * f], mesh.origin[3 * f + 1], mesh.origin[3 * f + 2] };
  }
  return std::make_unique<NearestTriangle>(std::move(list));
}

/// The nearest place that faces the same way; of all where there is none, or where p lies on the surface elsewhere, as
/// beside a fold; `known` where that is as near.
SurfacePoint nearestPlace(const NearestTriangle& tree, const Mesh& mesh, const Vector3& p,
  const Vector3& normal, const SurfacePoint& known, double near)
{
  auto place = tree.at(p, normal);
  if (!place || place->distance > near)
  {
    const auto any = tree.at(p); // there is a triangle, and no bound
    place = !place || any->distance <= near ? any : place;
  }
  if (known.face != kInvalidIndex && (positionOf(mesh, known) - p).norm() <= place->distance)
  {
    return known;
  }
  return { place->triangle, place->weights };
}

//------------------------------------------------------------------------------
/// Places of nodes in the points of a surface, and, where that is a mapped surface, of the user's.
class NodeOrigins
{
public:
  explicit NodeOrigins(const ElementSurface& surface)
    : surface_(surface), cells_(array(arrays::kSourceCellId, 1)),
      ids_(array(arrays::kSourcePointIds, 3)), weights_(array(arrays::kSourceWeights, 9))
  {
  }

  PointOrigin onSurface(const SurfacePoint& place) const
  {
    return pointOrigin(
      surface_.prepared, surface_.converted, surface_.data, place.face, place.weights);
  }

  vtkIdType cellOf(const SurfacePoint& place) const
  {
    return surface_.converted.cell(surface_.prepared.sourcePolygon[place.face]);
  }

  vtkIdType sourceCell(const SurfacePoint& place) const
  {
    const vtkIdType cell = cellOf(place);
    return cells_ ? static_cast<vtkIdType>(cells_->GetComponent(cell, 0)) : cell;
  }

  PointOrigin source(const SurfacePoint& place) const
  {
    const PointOrigin here = onSurface(place);
    if (!ids_)
    {
      return here;
    }
    const vtkIdType cell = cellOf(place);
    PointOrigin origin;
    for (int k = 0; k < 3; ++k)
    {
      const auto i = static_cast<std::size_t>(k);
      origin.ids[i] = static_cast<vtkIdType>(ids_->GetComponent(cell, k));
      origin.weights[i] = here.weights[i];
      if (weights_)
      {
        origin.weights[i] = 0;
        for (int c = 0; c < 3; ++c)
        {
          origin.weights[i] +=
            here.weights[static_cast<std::size_t>(c)] * weights_->GetComponent(cell, 3 * c + k);
        }
      }
    }
    return origin;
  }

private:
  vtkDataArray* array(const char* name, int components) const
  {
    vtkDataArray* found = surface_.data->GetCellData()->GetArray(name);
    return found && found->GetNumberOfComponents() == components ? found : nullptr;
  }

  const ElementSurface& surface_;
  vtkDataArray* cells_;
  vtkDataArray* ids_;
  vtkDataArray* weights_;
};

//------------------------------------------------------------------------------
/// Point arrays of elements of second order.
class NodeArrays
{
public:
  NodeArrays(vtkPolyData* quads, const std::vector<std::array<Index, 4>>& corners,
    const SecondOrderNodes& nodes, const ElementSurface& surface, int threads)
    : quads_(quads), nodes_(nodes), origins_(surface), corners_(corners),
      points_(quads->GetNumberOfPoints()), count_(nodes.points.size())
  {
    std::vector<PointOrigin> places(count_);
    std::vector<PointOrigin> means(count_), others(count_);
    for (std::size_t n = 0; n < count_; ++n)
    {
      means[n] = meanOfCorners(n, 0);
      others[n] = meanOfCorners(n, 1);
      places[n] = isPlaced(n) ? origins_.onSurface(nodes.places[n]) : PointOrigin{};
    }
    carryPointArrays(
      surface.data->GetPointData(), surface.data->GetNumberOfPoints(), ofSurface_, places, threads);
    carryPointArrays(quads->GetPointData(), points_, ofCorners_, means, threads);
    vtkNew<vtkPointData> ofOthers;
    carryPointArrays(quads->GetPointData(), points_, ofOthers, others, threads);
    for (int i = 0; i < ofCorners_->GetNumberOfArrays(); ++i)
    {
      averageCentres(ofCorners_->GetArray(i), ofOthers->GetArray(i));
    }
  }

  void write(vtkPointData* target)
  {
    vtkPointData* source = quads_->GetPointData();
    int unnamed = 0;
    for (int i = 0; i < source->GetNumberOfArrays(); ++i)
    {
      vtkAbstractArray* array = source->GetAbstractArray(i);
      const vtkSmartPointer<vtkAbstractArray> added =
        array->GetName() ? addedTo(array) : addedToUnnamed(unnamed++);
      if (!added)
      {
        continue;
      }
      const int index = target->AddArray(joined(array, added));
      for (int type = 0; type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
      {
        if (source->GetAbstractAttribute(type) == array &&
          type != vtkDataSetAttributes::GLOBALIDS && type != vtkDataSetAttributes::PEDIGREEIDS)
        {
          target->SetActiveAttribute(index, type);
        }
      }
    }
    target->AddArray(movedBack());
  }

private:
  bool isPlaced(std::size_t n) const { return nodes_.places[n].face != kInvalidIndex; }
  bool isCentre(std::size_t n) const { return n >= nodes_.edges.size(); }
  const std::array<Index, 4>& quadOfCentre(std::size_t n) const
  {
    return corners_[n - nodes_.edges.size()];
  }

  /// Of centres that of two opposite corners, as a PointOrigin has three points; see averageCentres.
  PointOrigin meanOfCorners(std::size_t n, std::size_t diagonal) const
  {
    const Index a = isCentre(n) ? quadOfCentre(n)[diagonal] : nodes_.edges[n][0];
    const Index b = isCentre(n) ? quadOfCentre(n)[diagonal + 2] : nodes_.edges[n][1];
    return { { a, b, a }, { 0.5, 0.5, 0 } };
  }

  /// The mean of all four corners, of real numbers.
  void averageCentres(vtkDataArray* means, vtkDataArray* others) const
  {
    if (!means || (means->GetDataType() != VTK_FLOAT && means->GetDataType() != VTK_DOUBLE))
    {
      return;
    }
    for (std::size_t n = nodes_.edges.size(); n < count_; ++n)
    {
      const auto i = static_cast<vtkIdType>(n);
      for (int c = 0; c < means->GetNumberOfComponents(); ++c)
      {
        means->SetComponent(i, c, (means->GetComponent(i, c) + others->GetComponent(i, c)) / 2);
      }
    }
  }

  /// The array at the new nodes; null where it is left out.
  vtkSmartPointer<vtkAbstractArray> addedTo(vtkAbstractArray* array) const
  {
    const std::string name = array->GetName();
    if (vtkSmartPointer<vtkAbstractArray> own = ownArray(name))
    {
      return own;
    }
    vtkAbstractArray* const surface = ofSurface_->GetAbstractArray(name.c_str());
    vtkAbstractArray* const mean = ofCorners_->GetAbstractArray(name.c_str());
    if (!mean || !surface || surface->GetDataType() != array->GetDataType() ||
      surface->GetNumberOfComponents() != array->GetNumberOfComponents())
    {
      return mean;
    }
    for (std::size_t n = 0; n < count_; ++n)
    {
      if (!isPlaced(n))
      {
        surface->SetTuple(static_cast<vtkIdType>(n), static_cast<vtkIdType>(n), mean);
      }
    }
    return surface;
  }

  vtkSmartPointer<vtkAbstractArray> addedToUnnamed(int which) const
  {
    for (int i = 0; i < ofCorners_->GetNumberOfArrays(); ++i)
    {
      if (!ofCorners_->GetAbstractArray(i)->GetName() && which-- == 0)
      {
        return ofCorners_->GetAbstractArray(i);
      }
    }
    return nullptr;
  }

  template <class Array, class Set>
  vtkSmartPointer<vtkAbstractArray> made(int components, const Set& set) const
  {
    auto array = newArray<Array>("", components, count_);
    for (std::size_t n = 0; n < count_; ++n)
    {
      set(array, static_cast<vtkIdType>(n), n);
    }
    return array;
  }

  /// What filters of Quadrille have written, which is no array of the surface.
  vtkSmartPointer<vtkAbstractArray> ownArray(const std::string& name) const
  {
    if (name == arrays::kValence)
    {
      return made<vtkIntArray>(1, [](auto& a, vtkIdType i, std::size_t) { a->SetValue(i, 0); });
    }
    if (name == arrays::kOnBoundary)
    {
      return made<vtkUnsignedCharArray>(1,
        [this](auto& a, vtkIdType i, std::size_t n)
        { a->SetValue(i, isCentre(n) ? 0 : nodes_.onBoundary[n]); });
    }
    if (name == arrays::kSourceCellId)
    {
      return made<vtkIdTypeArray>(1,
        [this](auto& a, vtkIdType i, std::size_t n)
        { a->SetValue(i, isPlaced(n) ? origins_.sourceCell(nodes_.places[n]) : -1); });
    }
    if (name == arrays::kSourcePointIds)
    {
      return made<vtkIdTypeArray>(3,
        [this](auto& a, vtkIdType i, std::size_t n)
        { a->SetTypedTuple(i, sourceOf(n).ids.data()); });
    }
    if (name == arrays::kSourceBarycentric)
    {
      return made<vtkDoubleArray>(3,
        [this](auto& a, vtkIdType i, std::size_t n)
        { a->SetTypedTuple(i, sourceOf(n).weights.data()); });
    }
    if (name == arrays::kQuadNormals)
    {
      return made<vtkFloatArray>(
        3, [this](auto& a, vtkIdType i, std::size_t n) { a->SetTuple(i, normalOf(n).data()); });
    }
    return nullptr;
  }

  PointOrigin sourceOf(std::size_t n) const
  {
    return isPlaced(n) ? origins_.source(nodes_.places[n]) : PointOrigin{ { -1, -1, -1 }, {} };
  }

  Vector3 normalOf(std::size_t n) const
  {
    vtkDataArray* normals = quads_->GetPointData()->GetArray(arrays::kQuadNormals);
    Vector3 sum = Vector3::Zero();
    const auto add = [&](Index corner)
    {
      Vector3 normal;
      normals->GetTuple(corner, normal.data());
      sum += normal;
    };
    if (isCentre(n))
    {
      std::for_each(quadOfCentre(n).begin(), quadOfCentre(n).end(), add);
    }
    else
    {
      std::for_each(nodes_.edges[n].begin(), nodes_.edges[n].end(), add);
    }
    return sum.stableNormalized();
  }

  vtkSmartPointer<vtkAbstractArray> joined(vtkAbstractArray* corners, vtkAbstractArray* added) const
  {
    auto array = vtk::TakeSmartPointer(corners->NewInstance());
    array->SetName(corners->GetName());
    array->SetNumberOfComponents(corners->GetNumberOfComponents());
    for (int c = 0; corners->HasAComponentName() && c < corners->GetNumberOfComponents(); ++c)
    {
      array->SetComponentName(c, corners->GetComponentName(c));
    }
    array->SetNumberOfTuples(points_ + static_cast<vtkIdType>(count_));
    array->InsertTuples(0, points_, 0, corners);
    array->InsertTuples(points_, static_cast<vtkIdType>(count_), 0, added);
    return array;
  }

  vtkSmartPointer<vtkAbstractArray> movedBack() const
  {
    auto array = newArray<vtkUnsignedCharArray>(
      arrays::kMovedBack, 1, static_cast<std::size_t>(points_) + count_);
    array->Fill(0);
    for (std::size_t n = 0; n < count_; ++n)
    {
      array->SetValue(
        points_ + static_cast<vtkIdType>(n), static_cast<unsigned char>(nodes_.kinds[n]));
    }
    return array;
  }

  vtkPolyData* quads_;
  const SecondOrderNodes& nodes_;
  NodeOrigins origins_;
  const std::vector<std::array<Index, 4>>& corners_;
  vtkIdType points_;
  std::size_t count_;              ///< of the new nodes
  vtkNew<vtkPointData> ofSurface_; ///< point arrays at the new nodes, by their places
  vtkNew<vtkPointData> ofCorners_; ///< the same from the corners
};

/// Cell and field arrays of the polygons.
void passCellArrays(vtkPolyData* quads, vtkUnstructuredGrid* grid)
{
  const vtkIdType first = quads->GetNumberOfVerts() + quads->GetNumberOfLines();
  if (first == 0 && quads->GetNumberOfStrips() == 0)
  {
    grid->GetCellData()->ShallowCopy(quads->GetCellData());
  }
  else
  {
    grid->GetCellData()->CopyAllOn();
    grid->GetCellData()->CopyAllocate(quads->GetCellData(), quads->GetNumberOfPolys());
    for (vtkIdType i = 0; i < quads->GetNumberOfPolys(); ++i)
    {
      grid->GetCellData()->CopyData(quads->GetCellData(), first + i, i);
    }
  }
  grid->GetFieldData()->ShallowCopy(quads->GetFieldData());
}

vtkSmartPointer<vtkPoints> cornersAndNodes(vtkPolyData* quads, const SecondOrderNodes& nodes)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  const vtkIdType corners = quads->GetNumberOfPoints();
  points->SetNumberOfPoints(corners + static_cast<vtkIdType>(nodes.points.size()));
  for (vtkIdType i = 0; i < corners; ++i)
  {
    points->SetPoint(i, quads->GetPoint(i));
  }
  for (std::size_t n = 0; n < nodes.points.size(); ++n)
  {
    points->SetPoint(corners + static_cast<vtkIdType>(n), nodes.points[n].data());
  }
  return points;
}

} // namespace

std::vector<std::array<Index, 4>> readQuads(vtkPolyData* data)
{
  std::vector<std::array<Index, 4>> quads;
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < data->GetNumberOfPolys(); ++i)
  {
    data->GetPolys()->GetCellAtId(i, ids);
    if (ids->GetNumberOfIds() != 4)
    {
      refuse("polygon ", i, " has ", ids->GetNumberOfIds(),
        " corners: the first input must be quads, as of Quad Remesh");
    }
    std::array<Index, 4> quad{};
    for (std::size_t k = 0; k < 4; ++k)
    {
      quad[k] = static_cast<Index>(ids->GetId(static_cast<vtkIdType>(k)));
    }
    quads.push_back(quad);
  }
  return quads;
}

std::vector<std::uint8_t> readFeatureBits(vtkPolyData* data)
{
  vtkDataArray* array = data->GetCellData()->GetArray(arrays::kFeatureEdges);
  if (!array)
  {
    return {};
  }
  const vtkIdType first = data->GetNumberOfVerts() + data->GetNumberOfLines();
  if (array->GetNumberOfComponents() != 1 ||
    array->GetNumberOfTuples() < first + data->GetNumberOfPolys())
  {
    refuse("the cell array FeatureEdges has ", array->GetNumberOfTuples(), " tuples of ",
      array->GetNumberOfComponents(), " for ", data->GetNumberOfPolys(), " quads");
  }
  std::vector<std::uint8_t> bits(static_cast<std::size_t>(data->GetNumberOfPolys()));
  for (std::size_t q = 0; q < bits.size(); ++q)
  {
    bits[q] = static_cast<std::uint8_t>(array->GetComponent(first + static_cast<vtkIdType>(q), 0));
  }
  return bits;
}

ElementSurface readElementSurface(vtkPolyData* data, const std::string& patchArray, int threads)
{
  ElementSurface surface;
  surface.data = data;
  surface.converted = convertSurface(data, patchArray, threads);
  SurfaceInput input = std::move(surface.converted.input);
  input.guideDirections.clear();
  input.guideWeights.clear();
  input.targetValences.clear();
  input.sizing.clear();
  PrepareOptions options;
  options.threads = threads;
  surface.prepared = prepareSurface(input, options);
  return surface;
}

FoundPlaces findPlaces(vtkPolyData* quads, const std::vector<std::array<Index, 4>>& corners,
  const ElementSurface& surface, int threads)
{
  const std::vector<Vector3> points = readPointPositions(quads, threads);
  const Mesh& mesh = surface.prepared.mesh;
  const double near = kOnSurface * surface.prepared.boundingBoxDiagonal;
  const NamedPlaces named(quads, surface);
  FoundPlaces found;
  found.places.resize(points.size());
  std::vector<std::size_t> lost;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const auto place = named.at(static_cast<vtkIdType>(i));
    found.places[i] = place.value_or(SurfacePoint{});
    if (!place || !((positionOf(mesh, *place) - points[i]).norm() <= near))
    {
      lost.push_back(i);
    }
  }
  found.byNearest = lost.size();
  if (!lost.empty())
  {
    const std::unique_ptr<NearestTriangle> tree = treeOf(mesh);
    const std::vector<Vector3> normals = normalsAtPoints(points, corners);
    parallelFor(lost.size(), kElementChunk, threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t k = begin; k < end; ++k)
        {
          SurfacePoint& place = found.places[lost[k]];
          place = nearestPlace(*tree, mesh, points[lost[k]], normals[lost[k]], place, near);
        }
      });
  }
  for (const std::size_t i : lost)
  {
    const double distance = (positionOf(mesh, found.places[i]) - points[i]).norm();
    found.offSurface += distance > near ? 1 : 0;
    if (distance > std::max(near, found.farthest))
    {
      found.farthest = distance;
      found.farthestPoint = static_cast<vtkIdType>(i);
    }
  }
  return found;
}

vtkSmartPointer<vtkUnstructuredGrid> writeFirstOrder(vtkPolyData* quads)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(quads->GetPoints());
  grid->SetCells(VTK_QUAD, quads->GetPolys());
  grid->GetPointData()->ShallowCopy(quads->GetPointData());
  passCellArrays(quads, grid);
  return grid;
}

vtkSmartPointer<vtkUnstructuredGrid> writeSecondOrder(vtkPolyData* quads,
  const std::vector<std::array<Index, 4>>& corners, const SecondOrderNodes& nodes,
  const ElementSurface& surface, int threads)
{
  const bool hasCentres = nodes.points.size() > nodes.edges.size();
  const std::size_t each = hasCentres ? 9 : 8;
  const vtkIdType points = quads->GetNumberOfPoints();
  auto connectivity = newArray<vtkIdTypeArray>("", 1, each * corners.size());
  vtkIdType next = 0;
  for (std::size_t q = 0; q < corners.size(); ++q)
  {
    for (const Index corner : corners[q])
    {
      connectivity->SetValue(next++, corner);
    }
    for (const Index edge : nodes.edgesOfQuad[q])
    {
      connectivity->SetValue(next++, points + edge);
    }
    if (hasCentres)
    {
      connectivity->SetValue(next++, points + static_cast<vtkIdType>(nodes.edges.size() + q));
    }
  }
  auto offsets = newArray<vtkIdTypeArray>("", 1, corners.size() + 1);
  for (std::size_t q = 0; q <= corners.size(); ++q)
  {
    offsets->SetValue(static_cast<vtkIdType>(q), static_cast<vtkIdType>(each * q));
  }
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets.Get(), connectivity.Get());
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(cornersAndNodes(quads, nodes));
  grid->SetCells(hasCentres ? VTK_BIQUADRATIC_QUAD : VTK_QUADRATIC_QUAD, cells);
  NodeArrays(quads, corners, nodes, surface, threads).write(grid->GetPointData());
  passCellArrays(quads, grid);
  return grid;
}

} // namespace quadrille
