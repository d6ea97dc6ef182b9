// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Shapes.h"

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <TDF_Label.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

namespace quadrille
{

TopoDS_Shape boxWithHole()
{
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(4, 3, 2).Shape();
  const TopoDS_Shape drill =
    BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(2, 1.5, -1), gp_Dir(0, 0, 1)), 0.5, 4).Shape();
  return BRepAlgoAPI_Cut(box, drill).Shape();
}

TopoDS_Shape roundedCylinder()
{
  const TopoDS_Shape cylinder = BRepPrimAPI_MakeCylinder(1, 2).Shape();
  BRepFilletAPI_MakeFillet fillet(cylinder);
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(cylinder, TopAbs_EDGE, edges);
  for (int i = 1; i <= edges.Extent(); ++i)
  {
    GProp_GProps properties;
    BRepGProp::LinearProperties(edges(i), properties);
    if (properties.CentreOfMass().Z() > 1.9)
    {
      fillet.Add(0.25, TopoDS::Edge(edges(i)));
    }
  }
  return fillet.Shape();
}

namespace
{

void writeDocument(const Handle(TDocStd_Document) & document, const std::string& path)
{
  STEPCAFControl_Writer writer;
  writer.SetNameMode(Standard_True);
  if (!writer.Transfer(document) || writer.Write(path.c_str()) != IFSelect_RetDone)
  {
    throw std::runtime_error(path + " cannot be written");
  }
}

} // namespace

ShapeNames namesOfBox()
{
  const TopoDS_Shape shape = boxWithHole();
  ShapeNames names{ { { 1, "support" }, { 7, "bore" } } };
  TopTools_IndexedMapOfShape edges, vertices;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  TopExp::MapShapes(shape, TopAbs_VERTEX, vertices);
  for (int i = 1; i <= edges.Extent(); ++i)
  {
    GProp_GProps properties;
    BRepGProp::LinearProperties(edges(i), properties);
    const gp_Pnt centre = properties.CentreOfMass();
    if (centre.Distance(gp_Pnt(2, 1.5, 2)) < 1e-6)
    {
      names.edges[i] = "upper rim";
    }
    else if (centre.Distance(gp_Pnt(2, 0, 0)) < 1e-6)
    {
      names.edges[i] = "front edge";
    }
  }
  for (int i = 1; i <= vertices.Extent(); ++i)
  {
    if (BRep_Tool::Pnt(TopoDS::Vertex(vertices(i))).Distance(gp_Pnt(0, 0, 0)) < 1e-6)
    {
      names.vertices[i] = "origin";
    }
  }
  return names;
}

void writeStep(const TopoDS_Shape& shape, const std::string& path, const ShapeNames& names,
  const std::string& unit)
{
  STEPCAFControl_Controller::Init();
  Interface_Static::SetCVal("write.step.unit", unit.c_str());
  Interface_Static::SetIVal("write.stepcaf.subshapes.name", 1);
  Handle(TDocStd_Document) document = new TDocStd_Document("BinXCAF");
  const Handle(XCAFDoc_ShapeTool) tool = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const TDF_Label label = tool->AddShape(shape, Standard_False);
  TDataStd_Name::Set(label, "the part");
  const auto setNames = [&](TopAbs_ShapeEnum kind, const std::map<int, std::string>& ofKind)
  {
    TopTools_IndexedMapOfShape parts;
    TopExp::MapShapes(shape, kind, parts);
    for (const auto& [number, name] : ofKind)
    {
      TDataStd_Name::Set(tool->AddSubShape(label, parts(number)), name.c_str());
    }
  };
  setNames(TopAbs_FACE, names.faces);
  setNames(TopAbs_EDGE, names.edges);
  setNames(TopAbs_VERTEX, names.vertices);
  writeDocument(document, path);
  Interface_Static::SetCVal("write.step.unit", "MM");
}

void writeAssembly(const TopoDS_Shape& part, const std::string& path)
{
  STEPCAFControl_Controller::Init();
  Handle(TDocStd_Document) document = new TDocStd_Document("BinXCAF");
  const Handle(XCAFDoc_ShapeTool) tool = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const TDF_Label label = tool->AddShape(part, Standard_False);
  TDataStd_Name::Set(label, "plate");
  const TDF_Label assembly = tool->NewShape();
  TDataStd_Name::Set(assembly, "both");
  gp_Trsf turn, move;
  turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 0.5);
  move.SetTranslation(gp_Vec(10, 0, 0));
  TDataStd_Name::Set(tool->AddComponent(assembly, label, TopLoc_Location()), "left");
  TDataStd_Name::Set(tool->AddComponent(assembly, label, TopLoc_Location(move * turn)), "right");
  tool->UpdateAssemblies();
  writeDocument(document, path);
}

void writeIges(const TopoDS_Shape& shape, const std::string& path)
{
  IGESControl_Writer writer("MM", 0); // faces, each with borders of its own
  if (!writer.AddShape(shape) || !writer.Write(path.c_str()))
  {
    throw std::runtime_error(path + " cannot be written");
  }
}

void writeBrep(const TopoDS_Shape& shape, const std::string& path)
{
  if (!BRepTools::Write(shape, path.c_str()))
  {
    throw std::runtime_error(path + " cannot be written");
  }
}

double exactArea(const TopoDS_Shape& shape)
{
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(shape, properties);
  return properties.Mass();
}

double exactVolume(const TopoDS_Shape& shape)
{
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass();
}

double area(const CadSurface& surface)
{
  double sum = 0;
  for (const auto& [a, b, c] : surface.triangles)
  {
    const std::vector<Vector3>& p = surface.points;
    sum += (p[b] - p[a]).cross(p[c] - p[a]).norm() / 2;
  }
  return sum;
}

double volume(const CadSurface& surface)
{
  double sum = 0;
  for (const auto& [a, b, c] : surface.triangles)
  {
    const std::vector<Vector3>& p = surface.points;
    sum += p[a].dot(p[b].cross(p[c])) / 6;
  }
  return sum;
}

MeshEdges meshEdges(const CadSurface& surface)
{
  std::map<std::pair<Index, Index>, std::pair<int, int>> uses; // both ways
  for (const std::array<Index, 3>& t : surface.triangles)
  {
    for (std::size_t i = 0; i < 3; ++i)
    {
      const Index a = t[i], b = t[(i + 1) % 3];
      auto& use = uses[{ std::min(a, b), std::max(a, b) }];
      ++(a < b ? use.first : use.second);
    }
  }
  MeshEdges edges;
  for (const auto& [ends, use] : uses)
  {
    const int all = use.first + use.second;
    edges.open += all == 1 ? 1 : 0;
    edges.crowded += all > 2 ? 1 : 0;
    edges.reversed += all == 2 && use.first != 1 ? 1 : 0;
  }
  return edges;
}

std::size_t count(const CadSurface& surface, CadEdgeKind kind)
{
  return static_cast<std::size_t>(std::count_if(surface.edges.begin(), surface.edges.end(),
    [kind](const CadEdge& edge) { return edge.kind == kind; }));
}

std::string testFile(const std::string& name)
{
  const std::filesystem::path folder =
    std::filesystem::temp_directory_path() / "quadrille-cad-tests";
  std::filesystem::create_directories(folder);
  return (folder / name).string();
}

} // namespace quadrille
