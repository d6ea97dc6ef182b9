// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Export/InpWriter.h"

#include "Base/LargeArray.h"
#include "Base/Lists.h"
#include "Base/Refuse.h"
#include "Export/OutputFile.h"
#include "Export/SetNames.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <string_view>

namespace quadrille
{

namespace
{

/// More different thicknesses than this are given by nodes.
constexpr std::size_t kMostThicknesses = 64;
/// What the name of a surface of sides has after that of its set.
constexpr std::string_view kOfSides = "_EDGES";
/// Characters of a real number, in both programs.
constexpr std::size_t kInpReal = 20;

std::string inpReal(double number)
{
  return realText(number, kInpReal);
}

/// Elements with the same thickness and frame; kInvalidIndex: by nodes, or none.
struct Section
{
  Index thickness = kInvalidIndex;
  Index frame = kInvalidIndex;
  bool operator<(const Section& other) const
  {
    return std::tie(thickness, frame) < std::tie(other.thickness, other.frame);
  }
};

/// The first and the second direction of an element.
using InpFrame = std::array<double, 6>;

/// Values in the order of their first elements, and which one each element has.
template <class Value>
struct Distinct
{
  std::vector<Value> values;
  std::vector<Index> of; ///< #E; kInvalidIndex: none

  explicit Distinct(std::size_t elements) { growLarge(of, elements, kInvalidIndex); }
  void set(std::size_t element, const Value& value)
  {
    const auto [found, isNew] = ids_.emplace(value, static_cast<Index>(values.size()));
    if (isNew)
    {
      values.push_back(value);
    }
    of[element] = found->second;
  }

private:
  std::map<Value, Index> ids_;
};

Distinct<double> distinctThicknesses(const ElementMesh& mesh)
{
  Distinct<double> found(mesh.elementCount());
  for (std::size_t e = 0; e < mesh.thickness.size(); ++e)
  {
    pollNowAndThen(e);
    found.set(e, mesh.thickness[e]);
  }
  return found;
}

Distinct<InpFrame> distinctFrames(const ElementMesh& mesh)
{
  Distinct<InpFrame> found(mesh.elementCount());
  for (std::size_t e = 0; e < mesh.axis.size(); ++e)
  {
    pollNowAndThen(e);
    const Vector3& a = mesh.axis[e];
    const Vector3 b = elementNormal(mesh, e).cross(a);
    if (a.squaredNorm() > 0 && b.squaredNorm() > 0)
    {
      // Adding 0 makes +0 of -0, so that equal directions are equal text.
      found.set(e, { a[0] + 0., a[1] + 0., a[2] + 0., b[0] + 0., b[1] + 0., b[2] + 0. });
    }
  }
  return found;
}

void writeFrame(OutputFile& file, const InpFrame& frame)
{
  for (std::size_t k = 0; k < frame.size(); ++k)
  {
    file << (k > 0 ? ", " : "") << inpReal(frame[k]);
  }
  file << '\n';
}

/// Per node, the average over its elements by area; 0 where no element is.
std::vector<double> nodalThickness(const ElementMesh& mesh)
{
  std::vector<double> sums(mesh.nodes.size(), 0.);
  std::vector<double> areas(mesh.nodes.size(), 0.);
  for (std::size_t e = 0; e < mesh.elementCount(); ++e)
  {
    pollNowAndThen(e);
    const double area = elementAreaVector(mesh, e).norm() / 2;
    for (int i = 0; i < mesh.nodesPerElement; ++i)
    {
      const Index node = mesh.element(e)[i];
      sums[node] += area * mesh.thickness[e];
      areas[node] += area;
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i)
  {
    sums[i] = areas[i] > 0 ? sums[i] / areas[i] : 0;
  }
  return sums;
}

void writeNodalThickness(const std::vector<double>& thickness, OutputFile& file)
{
  file << "*NODAL THICKNESS\n";
  for (std::size_t i = 0; i < thickness.size(); ++i)
  {
    pollNowAndThen(i);
    if (thickness[i] > 0)
    {
      file << i + 1 << ", " << inpReal(thickness[i]) << '\n';
    }
  }
}

/// One distribution for all elements; its first line is for those that it leaves out.
void writeDistribution(const Distinct<InpFrame>& frames, InpDialect dialect, OutputFile& file)
{
  if (dialect == InpDialect::Abaqus)
  {
    file << "*DISTRIBUTION TABLE, NAME=AXES_TABLE\nCOORD3D, COORD3D\n";
  }
  file << "*DISTRIBUTION, NAME=AXES_DISTRIBUTION, LOCATION=ELEMENT"
       << (dialect == InpDialect::Abaqus ? ", TABLE=AXES_TABLE\n" : "\n");
  file << ", 1., 0., 0., 0., 1., 0.\n";
  for (std::size_t e = 0; e < frames.of.size(); ++e)
  {
    pollNowAndThen(e);
    if (frames.of[e] != kInvalidIndex)
    {
      file << e + 1 << ", ";
      writeFrame(file, frames.values[frames.of[e]]);
    }
  }
  file << "*ORIENTATION, NAME=AXES\nAXES_DISTRIBUTION\n3, 0.\n";
}

void writeOrientations(const std::vector<InpFrame>& frames, OutputFile& file)
{
  for (std::size_t i = 0; i < frames.size(); ++i)
  {
    pollNowAndThen(i);
    file << "*ORIENTATION, NAME=AXES_" << i + 1 << '\n';
    writeFrame(file, frames[i]);
  }
}

/// Numbers in a line of a deck, at most 16; `first` and the ids count from 0.
void writeInpIds(OutputFile& file, const std::vector<Index>& ids)
{
  constexpr std::size_t kInLine = 16;
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    pollNowAndThen(i);
    const bool isLast = i + 1 == ids.size() || (i + 1) % kInLine == 0;
    file << ids[i] + 1 << (isLast ? "\n" : ", ");
  }
}

/// Nothing where the mesh has neither. Returns what the user should know.
std::vector<std::string> writeInpSections(
  const ElementMesh& mesh, bool areShells, const InpOptions& options, OutputFile& file)
{
  std::vector<std::string> notices;
  if (mesh.thickness.empty() && mesh.axis.empty())
  {
    return notices;
  }
  Distinct<double> thicknesses = distinctThicknesses(mesh);
  const bool byNodes = thicknesses.values.size() > kMostThicknesses;
  const bool byElements = !mesh.thickness.empty() && !byNodes;
  const Distinct<InpFrame> frames = distinctFrames(mesh);
  const bool hasFrames = !frames.values.empty();
  const bool hasDistribution = hasFrames && (!areShells || options.dialect == InpDialect::Abaqus);
  if (mesh.thickness.empty())
  {
    notices.emplace_back("sections are written with the thickness 1, as the mesh has no thickness: "
                         "add the cell array Thickness, or change them in the file");
  }
  if (byNodes)
  {
    writeNodalThickness(nodalThickness(mesh), file);
    notices.push_back("there are " + std::to_string(thicknesses.values.size()) +
      " different thicknesses: they are written by nodes, averaged over the elements at each");
  }
  if (hasDistribution)
  {
    writeDistribution(frames, options.dialect, file);
  }
  else if (hasFrames)
  {
    writeOrientations(frames.values, file);
  }
  // Elements without an axis of their own are in another section, without orientation.
  std::map<Section, std::vector<Index>> sections;
  for (std::size_t e = 0; e < mesh.elementCount(); ++e)
  {
    const Index frame = hasDistribution && frames.of[e] != kInvalidIndex ? 0 : frames.of[e];
    sections[{ byElements ? thicknesses.of[e] : kInvalidIndex, frame }].push_back(
      static_cast<Index>(e));
  }
  Index number = 0;
  for (const auto& [section, elements] : sections)
  {
    const std::string name = "SECTION_" + std::to_string(++number);
    file << "*ELSET, ELSET=" << name << '\n';
    writeInpIds(file, elements);
    file << (areShells ? "*SHELL SECTION" : "*SOLID SECTION") << ", ELSET=" << name
         << ", MATERIAL=" << options.material;
    if (section.frame != kInvalidIndex)
    {
      file << ", ORIENTATION=AXES"
           << (hasDistribution ? std::string() : "_" + std::to_string(section.frame + 1));
    }
    // With nodal thickness this one is not used, but CalculiX reads a line.
    file << (byNodes ? ", NODAL THICKNESS\n" : "\n")
         << (byElements   ? inpReal(thicknesses.values[section.thickness])
                : byNodes ? inpReal(mesh.thickness[elements.front()])
                          : "1.")
         << '\n';
  }
  return notices;
}

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
  if (!contains(types, type))
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
  Eigen::AlignedBox3d box;
  for (const Vector3& p : mesh.nodes)
  {
    box.extend(p);
  }
  const double tolerance = box.isEmpty() ? 0 : kRounding * box.diagonal().norm();
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
      file << ", " << inpReal(value);
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
  file << "*SURFACE, NAME=" << name << kOfSides << ", TYPE=ELEMENT\n";
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
  names.unique({ "NALL", "EALL" });
  InpSetNames result;
  result.boundaries = names.uniqueOf(sets.boundaries, kOfSides.size());
  result.curves = names.uniqueOf(sets.curves, kOfSides.size());
  result.corners = names.uniqueOf(sets.corners);
  // The generated names come first, so that a patch cannot take one of them.
  result.patches = names.uniqueOf(sets.patches);
  return result;
}

void writeInpSets(const ElementMesh& mesh, const MeshSets& sets, const InpSetNames& names,
  bool isPlane, InpDialect dialect, OutputFile& file)
{
  for (std::size_t i = 0; i < sets.patches.size(); ++i)
  {
    file << "*ELSET, ELSET=" << names.patches[i] << '\n';
    writeInpIds(file, sets.patches[i].elements);
    if (sets.patches[i].isNamed)
    {
      // No edge or vertex has this name, as names of all kinds of sets differ.
      file << "*NSET, NSET=" << names.patches[i] << '\n';
      writeInpIds(file, nodesOf(mesh, sets.patches[i]));
    }
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
    if (sets.curves[i].isNamed)
    {
      writeInpSides(sidesOf(sets, sets.curves[i]), names.curves[i], isPlane, dialect, file);
    }
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
  report(options.progress, 0.4, text);
  writeInpElements(mesh, type, file);
  report(options.progress, 0.7, text);
  writeInpSets(mesh, sets, names, isPlane, options.dialect, file);
  report(options.progress, 0.85, text);
  std::vector<std::string> notices = writeInpSections(mesh, type[0] == 'S', options, file);
  file.close();
  report(options.progress, 1, text);
  append(notices, setNames.notices());
  return notices;
}

} // namespace quadrille
