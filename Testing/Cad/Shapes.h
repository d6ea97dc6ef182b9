// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Shapes and files for the tests, made by Open CASCADE.
#pragma once

#include "Cad/CadFile.h"
#include "Cad/Tessellation.h"

#include <TopoDS_Shape.hxx>

#include <map>
#include <string>
#include <vector>

namespace quadrille
{

/// 4 x 3 x 2 with a hole of radius 0.5 through it: 7 faces, 15 edges, one of them a seam.
TopoDS_Shape boxWithHole();
/// Radius 1, height 2, with a fillet of radius 0.25 round the top: 4 faces.
TopoDS_Shape roundedCylinder();

/// Names of parts of a shape, by their numbers from 1 in the shape's maps.
struct ShapeNames
{
  std::map<int, std::string> faces;
  std::map<int, std::string> edges = {};
  std::map<int, std::string> vertices = {};
};

/// Of boxWithHole(): the faces "support" and "bore", the edges "upper rim" (of the hole) and "front edge" (from the
/// origin along x), and the vertex "origin".
ShapeNames namesOfBox();

/// A STEP file of one part. unit: "MM", "M" or "INCH".
void writeStep(const TopoDS_Shape& shape, const std::string& path, const ShapeNames& names = {},
  const std::string& unit = "MM");
/// Two instances of the part called "plate", of which the second one is moved by (10, 0, 0) and turned.
void writeAssembly(const TopoDS_Shape& part, const std::string& path);
void writeIges(const TopoDS_Shape& shape, const std::string& path);
void writeBrep(const TopoDS_Shape& shape, const std::string& path);

/// Of the exact shape.
double exactArea(const TopoDS_Shape& shape);
double exactVolume(const TopoDS_Shape& shape);
/// Of the triangles.
double area(const CadSurface& surface);
double volume(const CadSurface& surface);

struct MeshEdges
{
  std::size_t open = 0;     ///< of one triangle
  std::size_t crowded = 0;  ///< of three or more
  std::size_t reversed = 0; ///< of two triangles that run along it the same way
};
MeshEdges meshEdges(const CadSurface& surface);

std::size_t count(const CadSurface& surface, CadEdgeKind kind);
/// A path in the folder of the tests' files.
std::string testFile(const std::string& name);

} // namespace quadrille
