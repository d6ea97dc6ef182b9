// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "ElementGrids/ElementGrid.h"

#include "Base/Parallel.h"
#include "Base/Refuse.h"
#include "Common/NewArray.h"
#include "ElementGrids/NodeArrays.h"
#include "Mesh/NearestTriangle.h"
#include "Prepare/Prepare.h"
#include "Quads/QuadShape.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

namespace quadrille
{

namespace
{

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
  return std::make_unique<NearestTriangle>(trianglesOf(mesh));
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
  const double near = kRounding * surface.prepared.boundingBoxDiagonal;
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
    parallelForEach(lost.size(), kHeavyChunk, threads,
      [&](std::size_t k)
      {
        SurfacePoint& place = found.places[lost[k]];
        place = nearestPlace(*tree, mesh, points[lost[k]], normals[lost[k]], place, near);
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
  addNodeArrays(quads, corners, nodes, surface, threads, grid->GetPointData());
  passCellArrays(quads, grid);
  return grid;
}

} // namespace quadrille
