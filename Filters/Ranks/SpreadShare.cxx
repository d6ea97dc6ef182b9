// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/SpreadShare.h"

#include "Common/NewArray.h"
#include "Convert/Attributes.h"
#include "Convert/Pieces.h"
#include "Convert/PolyData.h"
#include "Ranks/Packing.h"
#include "Ranks/PlacedQuads.h"
#include "Ranks/SpreadCells.h"

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
#include <vtkUnsignedCharArray.h>

namespace quadrille
{

namespace
{

vtkSmartPointer<vtkIdTypeArray> idArray(const char* name, const std::vector<std::size_t>& ids)
{
  auto array = newArray<vtkIdTypeArray>(name, 1, ids.size());
  std::copy(ids.begin(), ids.end(), array->GetPointer(0));
  return array;
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

} // namespace

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

ReceivedItems::ReceivedItems(vtkDataArray* ids)
{
  for (vtkIdType i = 0; i < ids->GetNumberOfTuples(); ++i)
  {
    local_.emplace_back(static_cast<std::int64_t>(ids->GetComponent(i, 0)), i);
  }
  std::sort(local_.begin(), local_.end());
  origins_.resize(local_.size());
}

void ReceivedItems::write(vtkDataSetAttributes* model, vtkDataSetAttributes* target) const
{
  std::vector<vtkDataSetAttributes*> sources;
  for (const vtkSmartPointer<vtkPointData>& source : sources_)
  {
    sources.push_back(source);
  }
  gatherInModelsOrder(sources, origins_, model, target);
}

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

} // namespace quadrille
