// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Export/InpSections.h"

#include "Base/LargeArray.h"

#include <array>
#include <map>

namespace quadrille
{

namespace
{

/// More different thicknesses than this are given by nodes.
constexpr std::size_t kMostThicknesses = 64;
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

} // namespace

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

} // namespace quadrille
