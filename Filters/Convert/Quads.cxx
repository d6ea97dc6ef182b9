// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Convert/Quads.h"

#include "Base/Parallel.h"
#include "Common/NewArray.h"
#include "Convert/PolyData.h"
#include "Extraction/QuadCoverage.h"
#include "Quads/QuadLayout.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkLongLongArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace quadrille
{

namespace
{

vtkSmartPointer<vtkPoints> newPoints(std::size_t count)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(count));
  return points;
}

/// Cells of `corners` points each.
vtkSmartPointer<vtkCellArray> newCells(vtkIdTypeArray* connectivity, vtkIdType corners)
{
  vtkNew<vtkIdTypeArray> offsets;
  offsets->SetNumberOfValues(connectivity->GetNumberOfValues() / corners + 1);
  for (vtkIdType i = 0; i < offsets->GetNumberOfValues(); ++i)
  {
    offsets->SetValue(i, corners * i);
  }
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, connectivity);
  return cells;
}

std::size_t partialPolygonCount(const QuadMesh& mesh)
{
  return mesh.polygonSourceFace.size();
}

/// The quads, then the polygons.
void writeGeometry(const QuadMesh& mesh, vtkPolyData* data)
{
  vtkSmartPointer<vtkPoints> points = newPoints(mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
  {
    points->SetPoint(static_cast<vtkIdType>(i), mesh.points[i].data());
  }
  auto connectivity =
    newArray<vtkIdTypeArray>("", 1, 4 * mesh.quads.size() + mesh.polygonPoints.size());
  vtkIdType next = 0;
  for (const std::array<Index, 4>& quad : mesh.quads)
  {
    for (const Index corner : quad)
    {
      connectivity->SetValue(next++, corner);
    }
  }
  data->SetPoints(points);
  if (partialPolygonCount(mesh) == 0)
  {
    data->SetPolys(newCells(connectivity, 4));
    return;
  }
  for (const Index corner : mesh.polygonPoints)
  {
    connectivity->SetValue(next++, corner);
  }
  const auto quads = static_cast<vtkIdType>(mesh.quads.size());
  auto offsets = newArray<vtkIdTypeArray>("", 1, mesh.quads.size() + partialPolygonCount(mesh) + 1);
  for (vtkIdType i = 0; i < quads; ++i)
  {
    offsets->SetValue(i, 4 * i);
  }
  for (std::size_t i = 0; i < mesh.polygonOffsets.size(); ++i)
  {
    offsets->SetValue(quads + static_cast<vtkIdType>(i), 4 * quads + mesh.polygonOffsets[i]);
  }
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets.Get(), connectivity.Get());
  data->SetPolys(cells);
}

using PointFunction = std::function<PointOrigin(Index, const std::array<double, 3>&)>;

/// Per point of the quads. known: empty, or what it is.
std::vector<PointOrigin> originsOf(const QuadMesh& mesh, const PointFunction& origin,
  const std::vector<PointOrigin>& known, int threads)
{
  if (!known.empty())
  {
    return known;
  }
  std::vector<PointOrigin> origins(mesh.points.size());
  parallelForEach(origins.size(), kMediumChunk, threads,
    [&](std::size_t i) { origins[i] = origin(mesh.sourceFace[i], mesh.sourceWeights[i]); });
  return origins;
}

/// Per quad the cell under its centre, then a cell under each polygon. known: empty, or those of the quads, where there
/// are no polygons.
std::vector<vtkIdType> centresOf(const QuadMesh& mesh,
  const std::function<vtkIdType(Index)>& cellOf, const std::vector<vtkIdType>& known)
{
  if (!known.empty())
  {
    return known;
  }
  std::vector<vtkIdType> cells(mesh.quads.size() + partialPolygonCount(mesh));
  const auto rest =
    std::transform(mesh.quadSourceFace.begin(), mesh.quadSourceFace.end(), cells.begin(), cellOf);
  std::transform(mesh.polygonSourceFace.begin(), mesh.polygonSourceFace.end(), rest, cellOf);
  return cells;
}

CellOrigins areasOf(const QuadMesh& mesh, const Mesh& mapped, const std::vector<FixedVec2>& uv,
  const QuadSource& source)
{
  const QuadCoverage coverage = coverQuads(mapped, uv, mesh, source.threads);
  CellOrigins origins;
  origins.first = coverage.first;
  origins.shares.resize(coverage.shares.size());
  // Polygons have the one cell that is known to lie under them.
  std::transform(coverage.shares.begin(), coverage.shares.end(), origins.shares.begin(),
    [&](const FaceShare& share) {
      return CellOrigins::Share{ source.carrierCell(share.face), share.weight };
    });
  for (const Index face : mesh.polygonSourceFace)
  {
    origins.shares.push_back({ source.carrierCell(face), 1 });
    origins.first.push_back(origins.shares.size());
  }
  return origins;
}

void append(std::vector<std::string>& list, const std::vector<std::string>& more)
{
  list.insert(list.end(), more.begin(), more.end());
}

/// Point and cell arrays of the carrier. Returns what could not be carried.
std::vector<std::string> carryArrays(const QuadMesh& mesh, const Mesh& mapped,
  const std::vector<FixedVec2>& uv, const QuadSource& source,
  const std::vector<PointOrigin>& origins, vtkPolyData* data)
{
  vtkPolyData* carrier = source.carrier;
  std::vector<std::string> notCarried = carryPointArrays(carrier->GetPointData(),
    carrier->GetNumberOfPoints(), data->GetPointData(), origins, source.threads);
  vtkCellData* from = carrier->GetCellData();
  const vtkIdType cells = carrier->GetNumberOfCells();
  append(notCarried,
    source.cellDataFrom == CellDataFrom::Area
      ? carryCellArrays(
          from, cells, data->GetCellData(), areasOf(mesh, mapped, uv, source), source.threads)
      : carryCellArrays(from, cells, data->GetCellData(),
          centresOf(mesh, source.carrierCell, source.quadCells), source.threads));
  return notCarried;
}

void addPointArrays(const QuadMesh& mesh, const QuadSource& source,
  const std::vector<PointOrigin>& origins, vtkPointData* data)
{
  const auto& cellOf = source.sourceCell ? source.sourceCell : source.carrierCell;
  const std::size_t count = mesh.points.size();
  auto valence = newArray<vtkIntArray>(arrays::kValence, 1, count);
  auto boundary = newArray<vtkUnsignedCharArray>(arrays::kOnBoundary, 1, count);
  auto cell = newArray<vtkIdTypeArray>(arrays::kSourceCellId, 1, count);
  auto ids = newArray<vtkIdTypeArray>(arrays::kSourcePointIds, 3, count);
  auto weights = newArray<vtkDoubleArray>(arrays::kSourceBarycentric, 3, count);
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto id = static_cast<vtkIdType>(i);
    valence->SetValue(id, mesh.valence[i]);
    boundary->SetValue(id, mesh.onBoundary[i]);
    cell->SetValue(
      id, source.pointCells.empty() ? cellOf(mesh.sourceFace[i]) : source.pointCells[i]);
    ids->SetTypedTuple(id, origins[i].ids.data());
    weights->SetTypedTuple(id, origins[i].weights.data());
  }
  data->AddArray(cell);
  data->AddArray(ids);
  data->AddArray(weights);
  data->AddArray(boundary);
  data->AddArray(valence);
}

/// Normals by which a surface without features is drawn smooth. A point on a feature has none: there the quads stay
/// flat, and the normals of the carrier, which would smear sharp edges, are an array like others.
void addNormals(const QuadMesh& mesh, vtkPointData* data)
{
  if (std::any_of(
        mesh.lines.begin(), mesh.lines.end(), [](const QuadLine& line) { return !line.boundary; }))
  {
    data->SetActiveAttribute(-1, vtkDataSetAttributes::NORMALS);
    return;
  }
  if (partialPolygonCount(mesh) > 0 || data->GetNormals())
  {
    return;
  }
  std::vector<Vector3> sums(mesh.points.size(), Vector3::Zero());
  for (const std::array<Index, 4>& quad : mesh.quads)
  {
    const Vector3 normal = (mesh.points[quad[2]] - mesh.points[quad[0]])
                             .cross(mesh.points[quad[3]] - mesh.points[quad[1]]);
    for (const Index corner : quad)
    {
      sums[corner] += normal;
    }
  }
  auto normals = newArray<vtkFloatArray>(arrays::kQuadNormals, 3, sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i)
  {
    normals->SetTuple(static_cast<vtkIdType>(i), Vector3(sums[i].stableNormalized()).data());
  }
  data->SetNormals(normals);
}

void addSourceCells(const QuadMesh& mesh, const QuadSource& source, vtkCellData* data)
{
  const auto& cellOf = source.sourceCell ? source.sourceCell : source.carrierCell;
  const std::vector<vtkIdType> cells = centresOf(mesh, cellOf, source.quadCells);
  auto cell = newArray<vtkIdTypeArray>(arrays::kSourceCellId, 1, cells.size());
  std::copy(cells.begin(), cells.end(), cell->GetPointer(0));
  data->AddArray(cell);
}

/// Polygons are in no patch: -1.
void addLayout(const QuadLayout& layout, std::size_t polygons, vtkPolyData* data)
{
  auto patch = newArray<vtkIntArray>(arrays::kLayoutPatch, 1, layout.patchOf.size() + polygons);
  int* const rest = std::copy(layout.patchOf.begin(), layout.patchOf.end(), patch->GetPointer(0));
  std::fill_n(rest, polygons, -1);
  data->GetCellData()->AddArray(patch);
  auto shape = newArray<vtkUnsignedCharArray>("LayoutPatchShape", 1, layout.patches.size());
  auto size = newArray<vtkIntArray>("LayoutPatchSize", 2, layout.patches.size());
  for (std::size_t i = 0; i < layout.patches.size(); ++i)
  {
    const auto id = static_cast<vtkIdType>(i);
    shape->SetValue(id, static_cast<unsigned char>(layout.patches[i].shape));
    size->SetValue(2 * id, static_cast<int>(layout.patches[i].size[0]));
    size->SetValue(2 * id + 1, static_cast<int>(layout.patches[i].size[1]));
  }
  data->GetFieldData()->AddArray(shape);
  data->GetFieldData()->AddArray(size);
}

void addQuadFeatureEdges(const QuadMesh& mesh, vtkCellData* data)
{
  const std::vector<std::uint8_t> bits = featureEdgeBits(mesh);
  auto array = newArray<vtkUnsignedCharArray>(arrays::kFeatureEdges, 1, bits.size());
  std::copy(bits.begin(), bits.end(), array->GetPointer(0));
  data->AddArray(array);
}

/// Which cells are no whole quads of the map.
void addPartial(const QuadMesh& mesh, vtkCellData* data)
{
  auto array = newArray<vtkUnsignedCharArray>(
    arrays::kPartial, 1, mesh.quads.size() + partialPolygonCount(mesh));
  std::fill_n(array->GetPointer(0), mesh.quads.size(), static_cast<unsigned char>(0));
  std::fill_n(array->GetPointer(0) + mesh.quads.size(), partialPolygonCount(mesh),
    static_cast<unsigned char>(1));
  data->AddArray(array);
}

/// Only the points that lines use, in the order of their first use; they replace `ids`, points of the quads.
vtkSmartPointer<vtkPoints> writeUsedPoints(
  const QuadMesh& mesh, vtkIdTypeArray* ids, vtkPointData* data)
{
  std::vector<Index> lineId(mesh.points.size(), kInvalidIndex);
  std::vector<Index> used;
  for (vtkIdType i = 0; i < ids->GetNumberOfValues(); ++i)
  {
    const auto point = static_cast<std::size_t>(ids->GetValue(i));
    if (lineId[point] == kInvalidIndex)
    {
      lineId[point] = static_cast<Index>(used.size());
      used.push_back(static_cast<Index>(point));
    }
    ids->SetValue(i, lineId[point]);
  }
  vtkSmartPointer<vtkPoints> points = newPoints(used.size());
  auto quadPoint = newArray<vtkIdTypeArray>("QuadPointId", 1, used.size());
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    points->SetPoint(static_cast<vtkIdType>(i), mesh.points[used[i]].data());
    quadPoint->SetValue(static_cast<vtkIdType>(i), used[i]);
  }
  data->AddArray(quadPoint);
  return points;
}

void writeLineGeometry(const QuadMesh& mesh, vtkPolyData* data)
{
  auto connectivity = newArray<vtkIdTypeArray>("", 1, 2 * mesh.lines.size());
  vtkIdType next = 0;
  for (const QuadLine& line : mesh.lines)
  {
    connectivity->SetValue(next++, line.a);
    connectivity->SetValue(next++, line.b);
  }
  data->SetPoints(writeUsedPoints(mesh, connectivity, data->GetPointData()));
  data->SetLines(newCells(connectivity, 2));
}

void addPatchPairs(
  const QuadMesh& mesh, const Mesh& mapped, const QuadSource& source, vtkCellData* data)
{
  vtkDataArray* patches = source.patchArray.empty()
    ? nullptr
    : source.carrier->GetCellData()->GetArray(source.patchArray.c_str());
  if (!patches)
  {
    return;
  }
  const auto patchOf = [&](Index h)
  { return patches->GetVariantValue(source.carrierCell(Mesh::face(h))).ToLongLong(); };
  auto pairs = newArray<vtkLongLongArray>("PatchIds", 2, mesh.lines.size());
  for (std::size_t i = 0; i < mesh.lines.size(); ++i)
  {
    const Index h = mesh.lines[i].halfEdge;
    const long long left = patchOf(h);
    const long long right = mapped.isBoundary(h) ? left : patchOf(mapped.twin[h]);
    pairs->SetValue(static_cast<vtkIdType>(2 * i), std::min(left, right));
    pairs->SetValue(static_cast<vtkIdType>(2 * i + 1), std::max(left, right));
  }
  data->AddArray(pairs);
}

vtkSmartPointer<vtkPolyData> writeQuads(const QuadMesh& mesh, const Mesh& mapped,
  const std::vector<FixedVec2>& uv, const QuadLayout& layout, const QuadSource& source,
  std::vector<std::string>& notCarried)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  writeGeometry(mesh, data);
  std::vector<PointOrigin> origins =
    originsOf(mesh, source.carrierPoint, source.pointOrigins, source.threads);
  notCarried = carryArrays(mesh, mapped, uv, source, origins, data);
  if (source.sourcePoint)
  {
    origins = originsOf(mesh, source.sourcePoint, source.sourceOrigins, source.threads);
  }
  addPointArrays(mesh, source, origins, data->GetPointData());
  addNormals(mesh, data->GetPointData());
  addSourceCells(mesh, source, data->GetCellData());
  addQuadFeatureEdges(mesh, data->GetCellData());
  data->GetFieldData()->PassData(source.carrier->GetFieldData());
  addLayout(layout, partialPolygonCount(mesh), data); // replaces that of a remeshed quad mesh
  if (partialPolygonCount(mesh) > 0)
  {
    addPartial(mesh, data->GetCellData());
  }
  return data;
}

vtkSmartPointer<vtkPolyData> writeLines(
  const QuadMesh& mesh, const Mesh& mapped, const QuadLayout& layout, const QuadSource& source)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  writeLineGeometry(mesh, data);
  auto boundary = newArray<vtkUnsignedCharArray>("Boundary", 1, mesh.lines.size());
  auto separatrix = newArray<vtkUnsignedCharArray>("Separatrix", 1, mesh.lines.size());
  auto patches = newArray<vtkIntArray>("LayoutPatchIds", 2, mesh.lines.size());
  for (std::size_t i = 0; i < mesh.lines.size(); ++i)
  {
    const auto id = static_cast<vtkIdType>(i);
    boundary->SetValue(id, mesh.lines[i].boundary ? 1 : 0);
    separatrix->SetValue(id, layout.lineOnSeparatrix[i]);
    patches->SetValue(2 * id, static_cast<int>(layout.patchesOfLine[i][0]));
    patches->SetValue(2 * id + 1, static_cast<int>(layout.patchesOfLine[i][1]));
  }
  data->GetCellData()->AddArray(boundary);
  addPatchPairs(mesh, mapped, source, data->GetCellData());
  data->GetCellData()->AddArray(patches);
  data->GetCellData()->AddArray(separatrix);
  return data;
}

vtkSmartPointer<vtkPolyData> writeSeparatrices(const QuadMesh& mesh, const QuadLayout& layout)
{
  const std::size_t count = layout.lines.size();
  auto data = vtkSmartPointer<vtkPolyData>::New();
  auto connectivity = newArray<vtkIdTypeArray>("", 1, layout.linePoints.size());
  std::copy(layout.linePoints.begin(), layout.linePoints.end(), connectivity->GetPointer(0));
  auto offsets = newArray<vtkIdTypeArray>("", 1, count + 1);
  auto start = newArray<vtkUnsignedCharArray>("StartKind", 1, count);
  auto end = newArray<vtkUnsignedCharArray>("EndKind", 1, count);
  auto feature = newArray<vtkUnsignedCharArray>("Feature", 1, count);
  auto separatrix = newArray<vtkUnsignedCharArray>("Separatrix", 1, count);
  offsets->SetValue(0, 0);
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto id = static_cast<vtkIdType>(i);
    const LayoutLine& line = layout.lines[i]; // one after the other in linePoints
    offsets->SetValue(id + 1, static_cast<vtkIdType>(line.first + line.count));
    start->SetValue(id, static_cast<unsigned char>(line.start));
    end->SetValue(id, static_cast<unsigned char>(line.end));
    feature->SetValue(id, line.feature ? 1 : 0);
    separatrix->SetValue(id, line.separatrix ? 1 : 0);
  }
  data->SetPoints(writeUsedPoints(mesh, connectivity, data->GetPointData()));
  vtkNew<vtkCellArray> lines;
  lines->SetData(offsets.Get(), connectivity.Get());
  data->SetLines(lines);
  for (const auto& array : { start, end, feature, separatrix })
  {
    data->GetCellData()->AddArray(array);
  }
  return data;
}

/// Per point of the quads: it is on a feature or boundary, or none of its quads is a square of the map, as in faces
/// that were filled. No irregular vertex of the map is there, which is what moves.
std::vector<std::uint8_t> stayingPoints(const QuadMesh& mesh)
{
  const bool isFromMap = mesh.quadSourceWeights.size() == mesh.quads.size();
  std::vector<std::uint8_t> stays(mesh.points.size(), isFromMap ? 1 : 0);
  for (std::size_t q = 0; isFromMap && q < mesh.quads.size(); ++q)
  {
    if (mesh.quadSourceWeights[q] != std::array<double, 3>{})
    {
      for (const Index p : mesh.quads[q])
      {
        stays[p] = 0;
      }
    }
  }
  for (const QuadLine& line : mesh.lines)
  {
    stays[line.a] = stays[line.b] = 1;
  }
  for (std::size_t p = 0; p < mesh.points.size(); ++p)
  {
    stays[p] = mesh.onBoundary[p] != 0 ? 1 : stays[p];
  }
  return stays;
}

vtkSmartPointer<vtkPolyData> writeIrregular(const QuadMesh& mesh)
{
  const std::vector<std::uint8_t> stays = stayingPoints(mesh);
  std::vector<Index> found;
  const auto indexOf = [&mesh](std::size_t i)
  { return (mesh.onBoundary[i] != 0 ? 3 : 4) - mesh.valence[i]; };
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
  {
    if (indexOf(i) != 0)
    {
      found.push_back(static_cast<Index>(i));
    }
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkSmartPointer<vtkPoints> points = newPoints(found.size());
  auto connectivity = newArray<vtkIdTypeArray>("", 1, found.size());
  auto valence = newArray<vtkIntArray>(arrays::kValence, 1, found.size());
  auto movable = newArray<vtkIntArray>(arrays::kMovableValence, 1, found.size());
  auto index = newArray<vtkIntArray>(arrays::kIndex, 1, found.size());
  auto boundary = newArray<vtkUnsignedCharArray>(arrays::kOnBoundary, 1, found.size());
  auto quadPoint = newArray<vtkIdTypeArray>("QuadPointId", 1, found.size());
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    const auto id = static_cast<vtkIdType>(i);
    const Index p = found[i];
    points->SetPoint(id, mesh.points[p].data());
    connectivity->SetValue(id, id);
    valence->SetValue(id, mesh.valence[p]);
    movable->SetValue(id, stays[p] != 0 ? 0 : mesh.valence[p]);
    index->SetValue(id, indexOf(p));
    boundary->SetValue(id, mesh.onBoundary[p]);
    quadPoint->SetValue(id, p);
  }
  data->SetPoints(points);
  data->SetVerts(newCells(connectivity, 1));
  for (vtkDataArray* array :
    std::initializer_list<vtkDataArray*>{ valence, movable, index, boundary, quadPoint })
  {
    data->GetPointData()->AddArray(array);
  }
  data->GetPointData()->SetActiveScalars(arrays::kMovableValence);
  return data;
}

} // namespace

PointOrigin pointOrigin(const PreparedSurface& surface, const ConvertedSurface& converted,
  vtkPolyData* data, Index face, const std::array<double, 3>& weights)
{
  return pointOrigin(surface.locate(face, weights), converted, data);
}

PointOrigin pointOrigin(
  const SourceLocation& at, const ConvertedSurface& converted, vtkPolyData* data)
{
  PointOrigin origin{ { at.points[0], at.points[1], at.points[2] }, at.weights };
  if (const auto corners = converted.triangle(data, at.polygon))
  {
    // Repair may have turned the triangle round or started it at another corner.
    for (std::size_t i = 0; i < 3; ++i)
    {
      const Index id = (*corners)[i];
      const auto found = std::find(at.points.begin(), at.points.end(), id);
      if (found == at.points.end())
      {
        return { { at.points[0], at.points[1], at.points[2] }, at.weights };
      }
      origin.ids[i] = id;
      origin.weights[i] = at.weights[static_cast<std::size_t>(found - at.points.begin())];
    }
  }
  return origin;
}

QuadOutputs writeOutputs(const QuadMesh& mesh, const Mesh& mapped, const std::vector<FixedVec2>& uv,
  const QuadSource& source)
{
  const QuadLayout layout = layoutOf(mesh, source.threads);
  QuadOutputs outputs;
  outputs.quads = writeQuads(mesh, mapped, uv, layout, source, outputs.notCarried);
  outputs.lines = writeLines(mesh, mapped, layout, source);
  outputs.separatrices = writeSeparatrices(mesh, layout);
  outputs.irregular = writeIrregular(mesh);
  return outputs;
}

void reverseQuads(vtkPolyData* quads, const std::vector<std::uint8_t>& reversed)
{
  if (std::none_of(reversed.begin(), reversed.end(), [](std::uint8_t r) { return r != 0; }))
  {
    return;
  }
  auto connectivity = newArray<vtkIdTypeArray>("", 1, 4 * reversed.size());
  auto* bits =
    vtkUnsignedCharArray::SafeDownCast(quads->GetCellData()->GetArray(arrays::kFeatureEdges));
  auto* normals =
    vtkFloatArray::SafeDownCast(quads->GetPointData()->GetArray(arrays::kQuadNormals));
  std::vector<std::uint8_t> isTurned(static_cast<std::size_t>(quads->GetNumberOfPoints()), 0);
  for (std::size_t q = 0; q < reversed.size(); ++q)
  {
    const auto id = static_cast<vtkIdType>(q);
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    quads->GetCellPoints(id, count, ids);
    // The first side stays the first one: b a d c of a b c d.
    const std::array<vtkIdType, 4> corners = reversed[q] != 0
      ? std::array<vtkIdType, 4>{ ids[1], ids[0], ids[3], ids[2] }
      : std::array<vtkIdType, 4>{ ids[0], ids[1], ids[2], ids[3] };
    for (std::size_t i = 0; i < 4; ++i)
    {
      connectivity->SetValue(4 * id + static_cast<vtkIdType>(i), corners[i]);
      isTurned[static_cast<std::size_t>(corners[i])] |= reversed[q];
    }
    if (reversed[q] != 0)
    {
      const int old = bits->GetValue(id);
      bits->SetValue(id, static_cast<unsigned char>((old & 5) | (old & 2) << 2 | (old & 8) >> 2));
    }
  }
  quads->SetPolys(newCells(connectivity, 4));
  for (std::size_t p = 0; normals && p < isTurned.size(); ++p)
  {
    for (vtkIdType i = 3 * static_cast<vtkIdType>(p);
         isTurned[p] != 0 && i < 3 * static_cast<vtkIdType>(p) + 3; ++i)
    {
      normals->SetValue(i, -normals->GetValue(i));
    }
  }
}

QuadOutputs writePreview(const QuadMesh& mesh)
{
  QuadOutputs outputs;
  outputs.quads = vtkSmartPointer<vtkPolyData>::New();
  vtkSmartPointer<vtkPoints> points = newPoints(mesh.points.size());
  auto valence = newArray<vtkIntArray>(arrays::kValence, 1, mesh.points.size());
  auto boundary = newArray<vtkUnsignedCharArray>(arrays::kOnBoundary, 1, mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
  {
    const auto id = static_cast<vtkIdType>(i);
    points->SetPoint(id, mesh.points[i].data());
    valence->SetValue(id, mesh.valence[i]);
    boundary->SetValue(id, mesh.onBoundary[i]);
  }
  auto corners = newArray<vtkIdTypeArray>("", 1, 4 * mesh.quads.size());
  for (std::size_t i = 0; i < 4 * mesh.quads.size(); ++i)
  {
    corners->SetValue(static_cast<vtkIdType>(i), mesh.quads[i / 4][i % 4]);
  }
  outputs.quads->SetPoints(points);
  outputs.quads->SetPolys(newCells(corners, 4));
  outputs.quads->GetPointData()->AddArray(valence);
  outputs.quads->GetPointData()->AddArray(boundary);
  outputs.irregular = writeIrregular(mesh);
  return outputs;
}

} // namespace quadrille
