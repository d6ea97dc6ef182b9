// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// All files of the shared data, where they are at hand.
#include "Cad/CadFile.h"
#include "Cad/CadFormat.h"
#include "Cad/ShapeData.h"
#include "Shapes.h"

#include <IGESControl_Reader.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iostream>

#ifdef QUADRILLE_STEP_DATA

namespace quadrille
{

namespace
{

struct Counts
{
  int solids = 0;
  int faces = 0;
  int edges = 0;
};

bool operator==(const Counts& a, const Counts& b)
{
  return a.solids == b.solids && a.faces == b.faces && a.edges == b.edges;
}

std::ostream& operator<<(std::ostream& os, const Counts& counts)
{
  return os << counts.solids << " solids, " << counts.faces << " faces, " << counts.edges
            << " edges";
}

int countOf(const TopoDS_Shape& shape, TopAbs_ShapeEnum type)
{
  TopTools_IndexedMapOfShape faces, map; // lines of construction are in no face
  TopExp::MapShapes(shape, TopAbs_FACE, faces);
  for (int i = 1; type == TopAbs_EDGE && i <= faces.Extent(); ++i)
  {
    TopExp::MapShapes(faces(i), type, map);
  }
  if (type != TopAbs_EDGE)
  {
    TopExp::MapShapes(shape, type, map);
  }
  return map.Extent();
}

Counts countsOf(const TopoDS_Shape& shape)
{
  return { countOf(shape, TopAbs_SOLID), countOf(shape, TopAbs_FACE), countOf(shape, TopAbs_EDGE) };
}

/// By Open CASCADE's readers without assemblies.
Counts ownCounts(const std::string& path)
{
  STEPControl_Reader step;
  IGESControl_Reader iges;
  XSControl_Reader& reader = path.substr(path.size() - 4) == ".igs"
    ? static_cast<XSControl_Reader&>(iges)
    : static_cast<XSControl_Reader&>(step);
  reader.ReadFile(path.c_str());
  reader.TransferRoots();
  return countsOf(reader.OneShape());
}

class SharedFile : public testing::TestWithParam<std::string>
{
};

std::vector<std::string> names()
{
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(QUADRILLE_STEP_DATA))
  {
    if (cadFormatOf(entry.path().string()))
    {
      found.push_back(entry.path().filename().string());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

} // namespace

TEST_P(SharedFile, IsReadAsOpenCascadeCountsAndWatertight)
{
  const std::string path = std::string(QUADRILLE_STEP_DATA) + "/" + GetParam();
  CadReadOptions options;
  options.joined = true;
  const CadFile file = readCadFile(path, options);
  const CadPart& all = file.parts.front();
  const Counts here = countsOf(all.shape.data()->shape);
  bool isSewn = false;
  for (const std::string& notice : file.notices)
  {
    isSewn = isSewn || notice.find("sewn") != std::string::npos;
    std::cout << GetParam() << ": " << notice << "\n";
  }
  if (!isSewn) // which makes two edges one
  {
    EXPECT_EQ(here, ownCounts(path));
  }
  const CadSurface& surface = all.surface;
  std::cout << GetParam() << ": " << all.name << ": " << here << ", " << surface.triangles.size()
            << " triangles; sharp " << count(surface, CadEdgeKind::Sharp) << ", tangent "
            << count(surface, CadEdgeKind::Tangent) << ", seam "
            << count(surface, CadEdgeKind::Seam) << ", free " << count(surface, CadEdgeKind::Free)
            << "\n";
  // Only along free edges is the surface open.
  std::size_t free = 0;
  for (const CadEdge& edge : surface.edges)
  {
    free += edge.kind == CadEdgeKind::Free ? edge.points.size() - 1 : 0;
  }
  const MeshEdges edges = meshEdges(surface);
  EXPECT_EQ(edges.open, free);
  EXPECT_EQ(edges.reversed, 0U);
}

INSTANTIATE_TEST_SUITE_P(Step, SharedFile, testing::ValuesIn(names()),
  [](const auto& file)
  {
    std::string name = file.param;
    std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
    return name;
  });

} // namespace quadrille

#endif
