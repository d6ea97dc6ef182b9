// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Parts of a mesh as arrays of a vtkPolyData: points, triangles, features, twins, ids.
#pragma once

#include "Mesh/Mesh.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <cstddef>
#include <vector>

class vtkCellArray;
class vtkDataArray;
class vtkDataSetAttributes;
class vtkIdTypeArray;
class vtkPoints;
class vtkPolyData;

namespace quadrille
{

/// The array with so many components. Throws InvalidInput, naming the filter that makes it, where there is none.
vtkDataArray* requireArray(
  vtkDataSetAttributes* attributes, const char* name, int components, const char* madeBy);

/// Throws InvalidInput where the cell has a point that is not there.
void checkPointId(vtkIdType id, vtkIdType pointCount, vtkIdType cell);

/// Throws InvalidInput where an id is not below the limit.
std::vector<Index> readIds(vtkDataArray* array, std::size_t limit, int threads = 1);
vtkSmartPointer<vtkIdTypeArray> writeIds(
  const char* name, const std::vector<Index>& ids, int threads = 1);
/// 0, 1, 2, ...
std::vector<Index> identity(Index count);

/// The vertices of a mesh that the points are of.
vtkSmartPointer<vtkPoints> writePoints(
  const Mesh& mesh, const std::vector<Index>& pointVertex, int threads);
vtkSmartPointer<vtkCellArray> writeTriangles(const std::vector<Index>& corners, int threads);
void addFeatureEdges(vtkPolyData* data, const Mesh& mesh, int threads);
/// Adds Twin where the corners' points do not tell it.
void addTwinsWhereNeeded(vtkPolyData* data, const Mesh& mesh, int threads);
/// Twins from the array, where it is there and fits the corners.
bool readTwins(vtkPolyData* data, Mesh& mesh);

} // namespace quadrille
