// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// How far nodes of a mesh are from the exact shape, by Open CASCADE's own search, which knows nothing of how they were
/// put there.
///
///   cad_measure PART.step NODES.bin
///
/// NODES.bin: five doubles a node: its place, 1, 2 or 3 (it belongs to a face, an edge, a vertex), and the id of that.
/// Prints, in this order: diagonal, exact area, exact volume, and the distance of each node, one a line.
#include "Cad/CadFile.h"
#include "Cad/ShapeData.h"

#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepGProp.hxx>
#include <GProp_GProps.hxx>

#include <array>
#include <cstdio>
#include <exception>
#include <fstream>

namespace
{

using namespace quadrille;

double distance(const CadShape::Data& data, const std::array<double, 5>& node)
{
  const int number = static_cast<int>(node[4]) + 1;
  const TopTools_IndexedMapOfShape& map = node[3] == 1 ? data.faces
    : node[3] == 2                                     ? data.edges
                                                       : data.vertices;
  const TopoDS_Shape point = BRepBuilderAPI_MakeVertex(gp_Pnt(node[0], node[1], node[2])).Vertex();
  return BRepExtrema_DistShapeShape(point, map(number)).Value();
}

int measure(const char* part, const char* nodes)
{
  CadReadOptions options;
  options.joined = true;
  const CadFile file = readCadFile(part, options);
  const CadShape::Data& data = *file.parts.front().shape.data();
  GProp_GProps area, volume;
  BRepGProp::SurfaceProperties(data.shape, area);
  BRepGProp::VolumeProperties(data.shape, volume);
  std::printf("%.17g\n%.17g\n%.17g\n", data.diagonal, area.Mass(), volume.Mass());
  std::ifstream stream(nodes, std::ios::binary);
  std::array<double, 5> node{};
  while (stream.read(reinterpret_cast<char*>(node.data()), sizeof(node)))
  {
    std::printf("%.17g\n", distance(data, node));
  }
  return 0;
}

} // namespace

int main(int argc, char* argv[])
{
  if (argc != 3)
  {
    std::fprintf(stderr, "usage: cad_measure PART.step NODES.bin\n");
    return 2;
  }
  try
  {
    return measure(argv[1], argv[2]);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "cad_measure: %s\n", error.what());
    return 2;
  }
}
