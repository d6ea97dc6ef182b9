// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "ElementGrids/NodeArrays.h"

#include "Common/NewArray.h"
#include "Convert/Attributes.h"
#include "Convert/Quads.h"
#include "ElementGrids/ElementGrid.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>

namespace quadrille
{

namespace
{

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

} // namespace

void addNodeArrays(vtkPolyData* quads, const std::vector<std::array<Index, 4>>& corners,
  const SecondOrderNodes& nodes, const ElementSurface& surface, int threads, vtkPointData* target)
{
  NodeArrays(quads, corners, nodes, surface, threads).write(target);
}

} // namespace quadrille
