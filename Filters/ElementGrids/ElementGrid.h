// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads as elements: a vtkUnstructuredGrid of first or second order, with what the quads carry.
#pragma once

#include "Convert/PolyData.h"
#include "Elements/SecondOrder.h"
#include "Mesh/Surface.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

class vtkPolyData;
class vtkUnstructuredGrid;

namespace quadrille
{

namespace arrays
{
constexpr const char* kMovedBack = "MovedBack";
}

/// Corners of the polygons of `data`. Throws InvalidInput naming the polygon that is no quad.
std::vector<std::array<Index, 4>> readQuads(vtkPolyData* data);

/// FeatureEdges of the polygons; empty where there is no such array. Throws InvalidInput where it does not fit.
std::vector<std::uint8_t> readFeatureBits(vtkPolyData* data);

/// The surface that elements of second order lie on, as Core has it and as the user has it.
struct ElementSurface
{
  vtkPolyData* data = nullptr;
  ConvertedSurface converted; ///< without its input
  PreparedSurface prepared;
};

/// Features are FeatureEdges and borders of the patch array, see vtkQuadRemesh; requests of quads do not count. Throws
/// InvalidInput as convertSurface and prepareSurface do.
ElementSurface readElementSurface(vtkPolyData* data, const std::string& patchArray, int threads);

/// How the points of quads were found on a surface.
struct FoundPlaces
{
  std::vector<SurfacePoint> places; ///< one a point
  std::size_t byNearest = 0;        ///< points that SourceCellId does not tell the place of
  std::size_t offSurface = 0;       ///< points farther from the surface than 1e-9 of its diagonal
  double farthest = 0;              ///< distance of these
  vtkIdType farthestPoint = 0;
};

/// By SourceCellId, SourcePointIds and SourceBarycentric of the quads' points where these name a place of `surface`
/// that the point lies on; else the nearest place on a face with about the same side outside, of all faces where there
/// is none or where the point lies on another one.
FoundPlaces findPlaces(vtkPolyData* quads, const std::vector<std::array<Index, 4>>& corners,
  const ElementSurface& surface, int threads);

/// Four corners an element: points, cells, and all arrays of the quads.
vtkSmartPointer<vtkUnstructuredGrid> writeFirstOrder(vtkPolyData* quads);

/// 8 or 9 nodes an element, corners first, with their ids. Cell and field arrays of the quads; their point arrays, at
/// new nodes those of the same name on the surface, at the node's place, and of others the mean of the corners;
/// SourceCellId, SourcePointIds and SourceBarycentric of places; Valence is 0 there. MirrorPoint and RotatedPoint are
/// left out. The point array MovedBack holds a NodePlace, 0 at corners.
vtkSmartPointer<vtkUnstructuredGrid> writeSecondOrder(vtkPolyData* quads,
  const std::vector<std::array<Index, 4>>& corners, const SecondOrderNodes& nodes,
  const ElementSurface& surface, int threads);

} // namespace quadrille
