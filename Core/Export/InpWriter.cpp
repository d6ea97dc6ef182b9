// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Export/InpWriter.h"

#include "Base/Lists.h"
#include "Base/Refuse.h"
#include "Export/InpSections.h"
#include "Export/SetNames.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace quadrille
{

namespace
{

constexpr std::size_t kMostCharacters = 20; // of a real number, in both programs

std::string upperCased(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
    [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string typeOf(const ElementMesh& mesh, const InpOptions& options)
{
  const std::vector<std::string> types = inpElementTypes(mesh.nodesPerElement, options.dialect);
  refuseIf(
    types.empty(), "CalculiX has no elements of 9 nodes: make them with 8, or write for Abaqus");
  if (options.elementType.empty())
  {
    return types.front();
  }
  std::string type = upperCased(options.elementType);
  if (std::find(types.begin(), types.end(), type) == types.end())
  {
    refuse("elements of ", mesh.nodesPerElement, " nodes cannot be of type ", options.elementType,
      "; choose one of ", joined(types, types.size(), [](const std::string& one) { return one; }));
  }
  return type;
}

bool isPlaneType(const std::string& type)
{
  return type[0] == 'C';
}

void requireInPlane(const ElementMesh& mesh, const std::string& type)
{
  constexpr double kPlaceTolerance = 1e-9;
  Eigen::AlignedBox3d box;
  for (const Vector3& p : mesh.nodes)
  {
    box.extend(p);
  }
  const double tolerance = box.isEmpty() ? 0 : kPlaceTolerance * box.diagonal().norm();
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
  {
    refuseIf(std::abs(mesh.nodes[i][2]) > tolerance, "elements of type ", type,
      " lie in the plane z = 0, but node ", i, " has z = ", mesh.nodes[i][2],
      ": move the mesh there, or choose shells (S4, S8R)");
  }
  for (std::size_t e = 0; e < mesh.elementCount(); ++e)
  {
    pollNowAndThen(e);
    refuseIf(elementNormal(mesh, e)[2] < 0, "elements of type ", type,
      " are counterclockwise seen from above (z), but element ", e,
      " is clockwise: reverse the surface");
  }
}

void writeInpNodes(const ElementMesh& mesh, bool isPlane, OutputFile& file)
{
  file << "*NODE, NSET=NALL\n";
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
  {
    pollNowAndThen(i);
    file << i + 1;
    for (int k = 0; k < 3; ++k)
    {
      // CalculiX takes nothing but zero for plane elements.
      const double value = isPlane && k == 2 ? 0. : mesh.nodes[i][k];
      file << ", " << realText(value, kMostCharacters);
    }
    file << '\n';
  }
}

void writeInpElements(const ElementMesh& mesh, const std::string& type, OutputFile& file)
{
  file << "*ELEMENT, TYPE=" << type << ", ELSET=EALL\n";
  for (std::size_t e = 0; e < mesh.elementCount(); ++e)
  {
    pollNowAndThen(e);
    file << e + 1;
    for (int i = 0; i < mesh.nodesPerElement; ++i)
    {
      file << ", " << mesh.element(e)[i] + 1;
    }
    file << '\n';
  }
}

/// The sides of a loop by their number, and the surface of all.
void writeInpSides(const std::vector<ElementSide>& sides, const std::string& name, bool isPlane,
  InpDialect dialect, OutputFile& file)
{
  std::array<std::vector<Index>, 4> elements;
  for (const ElementSide& side : sides)
  {
    elements[side.side].push_back(side.element);
  }
  for (std::size_t i = 0; i < 4; ++i)
  {
    std::sort(elements[i].begin(), elements[i].end());
    if (!elements[i].empty())
    {
      file << "*ELSET, ELSET=" << name << "_E" << i + 1 << '\n';
      writeInpIds(file, elements[i]);
    }
  }
  const bool isAbaqusShell = !isPlane && dialect == InpDialect::Abaqus;
  const int firstSide = isPlane || isAbaqusShell ? 1 : 3; // S1 and S2 of a shell are its faces
  file << "*SURFACE, NAME=" << name << "_EDGES, TYPE=ELEMENT\n";
  for (std::size_t i = 0; i < 4; ++i)
  {
    if (!elements[i].empty())
    {
      file << name << "_E" << i + 1 << ", " << (isAbaqusShell ? "E" : "S")
           << static_cast<int>(i) + firstSide << '\n';
    }
  }
}

/// Names of sets in the order of MeshSets.
struct InpSetNames
{
  std::vector<std::string> patches, boundaries, curves, corners;
};

InpSetNames uniqueNames(const MeshSets& sets, SetNames& names)
{
  constexpr std::size_t kRoomForSides = 6; // _EDGES
  names.unique({ "NALL", "EALL" });
  InpSetNames result;
  result.boundaries = names.uniqueOf(sets.boundaries, kRoomForSides);
  result.curves = names.uniqueOf(sets.curves);
  result.corners = names.uniqueOf(sets.corners);
  // The generated names come first, so that a patch cannot take one of them.
  result.patches = names.uniqueOf(sets.patches);
  return result;
}

void writeInpSets(const MeshSets& sets, const InpSetNames& names, bool isPlane, InpDialect dialect,
  OutputFile& file)
{
  for (std::size_t i = 0; i < sets.patches.size(); ++i)
  {
    file << "*ELSET, ELSET=" << names.patches[i] << '\n';
    writeInpIds(file, sets.patches[i].elements);
  }
  for (std::size_t i = 0; i < sets.boundaries.size(); ++i)
  {
    file << "*NSET, NSET=" << names.boundaries[i] << '\n';
    writeInpIds(file, nodesOf(sets, sets.boundaries[i]));
    writeInpSides(sidesOf(sets, sets.boundaries[i]), names.boundaries[i], isPlane, dialect, file);
  }
  for (std::size_t i = 0; i < sets.curves.size(); ++i)
  {
    file << "*NSET, NSET=" << names.curves[i] << '\n';
    writeInpIds(file, nodesOf(sets, sets.curves[i]));
  }
  for (std::size_t i = 0; i < sets.corners.size(); ++i)
  {
    file << "*NSET, NSET=" << names.corners[i] << '\n' << sets.corners[i].node + 1 << '\n';
  }
}

} // namespace

std::vector<std::string> inpElementTypes(int nodesPerElement, InpDialect dialect)
{
  switch (nodesPerElement)
  {
    case 4:
      return { "S4", "S4R", "CPS4", "CPS4R", "CPE4", "CPE4R" };
    case 8:
      return { "S8R", "S8", "CPS8", "CPS8R", "CPE8", "CPE8R" };
    default:
      return dialect == InpDialect::Abaqus ? std::vector<std::string>{ "S9R5" }
                                           : std::vector<std::string>{};
  }
}

std::vector<std::string> writeInp(
  const ElementMesh& mesh, const MeshSets& sets, const std::string& path, const InpOptions& options)
{
  constexpr double kAfterNodesOfInp = 0.4, kAfterElements = 0.7, kAfterSets = 0.85;
  const std::string type = typeOf(mesh, options);
  const bool isPlane = isPlaneType(type);
  if (isPlane)
  {
    requireInPlane(mesh, type);
  }
  SetNames setNames(kInpNames);
  const InpSetNames names = uniqueNames(sets, setNames);
  const std::string text = writingText(mesh);
  report(options.progress, 0, text);
  OutputFile file(path);
  file << "*HEADING\nQuads made by Quadrille: " << mesh.nodes.size() << " nodes, "
       << mesh.elementCount() << " elements\n";
  writeInpNodes(mesh, isPlane, file);
  report(options.progress, kAfterNodesOfInp, text);
  writeInpElements(mesh, type, file);
  report(options.progress, kAfterElements, text);
  writeInpSets(sets, names, isPlane, options.dialect, file);
  report(options.progress, kAfterSets, text);
  std::vector<std::string> notices = writeInpSections(mesh, type[0] == 'S', options, file);
  file.close();
  report(options.progress, 1, text);
  append(notices, setNames.notices());
  return notices;
}

} // namespace quadrille
