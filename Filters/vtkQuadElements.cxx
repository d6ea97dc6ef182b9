// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadElements.h"

#include "Base/PlaceText.h"
#include "Base/Refuse.h"
#include "Blocks/Blocks.h"
#include "Common/NewArray.h"
#include "Common/Report.h"
#include "ElementGrids/ElementFrames.h"
#include "ElementGrids/ElementGrid.h"
#include "ElementGrids/ElementQuality.h"
#include "Elements/SecondOrder.h"

#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

vtkStandardNewMacro(vtkQuadElements);

namespace
{

using quadrille::Index;

/// "3 nodes", "1 node".
std::string countText(std::size_t count, const std::string& one, const std::string& several)
{
  return std::to_string(count) + " " + (count == 1 ? one : several);
}

std::string nodePlace(const quadrille::SecondOrderNodes& nodes, std::size_t n)
{
  return quadrille::placeText(nodes.points[n]);
}

struct MovedNodes
{
  std::size_t along = 0, off = 0;
  std::size_t firstOff = 0; ///< of those off the surface
};

MovedNodes countMoved(const quadrille::SecondOrderNodes& nodes)
{
  MovedNodes moved;
  for (std::size_t n = 0; n < nodes.kinds.size(); ++n)
  {
    moved.along += nodes.kinds[n] == quadrille::NodePlace::MovedAlong ? 1 : 0;
    if (nodes.kinds[n] == quadrille::NodePlace::MovedOff && moved.off++ == 0)
    {
      moved.firstOff = n;
    }
  }
  return moved;
}

/// Measures of elements, each taken when it is asked for first, and what is told of them.
class MeasuredElements
{
public:
  MeasuredElements(vtkUnstructuredGrid* grid, std::size_t numberOfWorst, int threads)
    : grid_(grid), numberOfWorst_(numberOfWorst), threads_(threads),
      fails_(static_cast<std::size_t>(grid->GetNumberOfCells()), 0)
  {
  }

  const std::vector<double>& valuesOf(std::size_t measure)
  {
    std::vector<double>& values = values_[measure];
    if (values.empty())
    {
      values = quadrille::measureElements(grid_, measure, threads_);
    }
    return values;
  }

  /// Once for each measure and side.
  void listWorst(std::size_t measure, bool isLowBad)
  {
    const auto list = std::make_pair(measure, isLowBad);
    if (std::find(listed_.begin(), listed_.end(), list) != listed_.end())
    {
      return;
    }
    listed_.push_back(list);
    const std::vector<double>& values = valuesOf(measure);
    for (const vtkIdType id : quadrille::worstElements(values, isLowBad, numberOfWorst_))
    {
      worst_.push_back({ id, measure, values[static_cast<std::size_t>(id)] });
    }
  }

  /// How many elements fail; their worst are listed.
  std::size_t judge(const quadrille::ElementRequirement& requirement)
  {
    const std::vector<double>& values = valuesOf(requirement.measure);
    std::size_t failed = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      const bool fails = !requirement.isKeptBy(values[i]);
      failed += fails ? 1 : 0;
      fails_[i] = fails ? 1 : fails_[i];
    }
    listWorst(requirement.measure, requirement.isLowBad());
    return failed;
  }

  /// "3 of 2500 elements fail scaled-jacobian>0.2, the worst: element 12 with 0.1 at (x, y, z); ...".
  std::string failureText(const quadrille::ElementRequirement& requirement, std::size_t failed)
  {
    const std::vector<double>& values = valuesOf(requirement.measure);
    std::ostringstream text;
    text << failed << " of " << countText(values.size(), "element", "elements")
         << (failed == 1 ? " fails " : " fail ") << requirement.text;
    const char* separator = ", the worst: ";
    for (const vtkIdType id :
      quadrille::worstElements(values, requirement.isLowBad(), std::min(numberOfWorst_, failed)))
    {
      text << separator << "element " << id << " with " << values[static_cast<std::size_t>(id)]
           << " at " << quadrille::placeText(quadrille::centreOfElement(grid_, id));
      separator = "; ";
    }
    return text.str();
  }

  std::ptrdiff_t failedElements() const { return std::count(fails_.begin(), fails_.end(), 1); }
  const std::vector<quadrille::WorstElement>& worst() const { return worst_; }

private:
  vtkUnstructuredGrid* grid_;
  std::size_t numberOfWorst_;
  int threads_;
  std::array<std::vector<double>, quadrille::kMeasureCount> values_;
  std::vector<std::uint8_t> fails_; ///< 1: fails a requirement
  std::vector<std::pair<std::size_t, bool>> listed_;
  std::vector<quadrille::WorstElement> worst_;
};

} // namespace

//------------------------------------------------------------------------------
vtkQuadElements::vtkQuadElements()
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(3);
}

vtkQuadElements::~vtkQuadElements() = default;

//------------------------------------------------------------------------------
vtkUnstructuredGrid* vtkQuadElements::GetElements()
{
  return vtkUnstructuredGrid::SafeDownCast(this->GetOutputDataObject(0));
}

//------------------------------------------------------------------------------
vtkTable* vtkQuadElements::GetHistograms()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(1));
}

//------------------------------------------------------------------------------
vtkPolyData* vtkQuadElements::GetWorstElements()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(2));
}

//------------------------------------------------------------------------------
void vtkQuadElements::AddRequirement(const char* text)
{
  if (text && *text != '\0') // an empty line of ParaView's panel
  {
    this->Requirements.emplace_back(text);
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkQuadElements::RemoveAllRequirements()
{
  if (!this->Requirements.empty())
  {
    this->Requirements.clear();
    this->Modified();
  }
}

//------------------------------------------------------------------------------
const char* vtkQuadElements::GetRequirement(int i)
{
  return i >= 0 && i < this->GetNumberOfRequirements()
    ? this->Requirements[static_cast<std::size_t>(i)].c_str()
    : nullptr;
}

//------------------------------------------------------------------------------
std::string vtkQuadElements::GetRequirementError(const char* text)
{
  try
  {
    quadrille::parseRequirement(text ? text : "");
    return {};
  }
  catch (const quadrille::InvalidInput& error)
  {
    return error.what();
  }
}

//------------------------------------------------------------------------------
vtkIdType vtkQuadElements::GetNumberOfFailedElements() const
{
  return static_cast<vtkIdType>(this->SumOverBlocks("FailedElements"));
}

//------------------------------------------------------------------------------
void vtkQuadElements::AddVectorArrayName(const char* name)
{
  if (name && *name != '\0')
  {
    this->VectorArrayNames.emplace_back(name);
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkQuadElements::RemoveAllVectorArrayNames()
{
  if (!this->VectorArrayNames.empty())
  {
    this->VectorArrayNames.clear();
    this->Modified();
  }
}

//------------------------------------------------------------------------------
vtkQuadrilleAlgorithm::PortRole vtkQuadElements::GetPortRole(int port) const
{
  return port == 0 ? PortRole::Mesh : PortRole::Surface;
}

//------------------------------------------------------------------------------
const char* vtkQuadElements::GetBlockType(int outputPort) const
{
  return outputPort == 0 ? "vtkUnstructuredGrid" : outputPort == 1 ? "vtkTable" : "vtkPolyData";
}

//------------------------------------------------------------------------------
int vtkQuadElements::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return this->Superclass::FillInputPortInformation(port, info);
}

//------------------------------------------------------------------------------
void vtkQuadElements::Execute(quadrille::Block& block)
{
  // What cannot be understood is told before the work.
  std::vector<quadrille::ElementRequirement> requirements;
  for (const std::string& text : this->Requirements)
  {
    requirements.push_back(quadrille::parseRequirement(text));
  }
  const vtkSmartPointer<vtkUnstructuredGrid> grid = this->MakeElements(block);
  quadrille::addCount(grid, "ElementOrder", static_cast<std::size_t>(this->Order));
  this->AddProperties(grid);
  this->Measure(grid, requirements, block);
  block.outputs[0]->ShallowCopy(grid);
  this->SetResult(std::to_string(grid->GetNumberOfCells()) + " elements of " +
    (this->Order == FIRST ? "first" : "second") + " order, " +
    std::to_string(grid->GetNumberOfPoints()) + " nodes");
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkUnstructuredGrid> vtkQuadElements::MakeElements(quadrille::Block& block)
{
  if (this->Order == FIRST)
  {
    quadrille::readQuads(block.input()); // refuses what are no quads
    return quadrille::writeFirstOrder(block.input());
  }
  if (!block.input(1) || block.input(1)->GetNumberOfCells() == 0)
  {
    quadrille::refuse("elements of second order have nodes on the surface, which is missing: "
                      "connect the second input, the surface that the quads were made of");
  }
  return this->MakeSecondOrder(block.input(), block.input(1));
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkUnstructuredGrid> vtkQuadElements::MakeSecondOrder(
  vtkPolyData* data, vtkPolyData* surfaceData)
{
  quadrille::report(this->MakeProgress(0, 1), 0, "Reading the surface");
  quadrille::QuadsOnSurface quads;
  quads.quads = quadrille::readQuads(data);
  quads.points = quadrille::readPointPositions(data, this->NumberOfThreads);
  quads.featureEdges = quadrille::readFeatureBits(data);
  const quadrille::ElementSurface surface =
    quadrille::readElementSurface(surfaceData, this->PatchArrayName, this->NumberOfThreads);
  quadrille::report(this->MakeProgress(0, 1), 0.2, "Finding the quads on the surface");
  quadrille::FoundPlaces found =
    quadrille::findPlaces(data, quads.quads, surface, this->NumberOfThreads);
  quads.places = std::move(found.places);
  quadrille::SecondOrderOptions options;
  options.nodes = this->NodesPerElement;
  options.threads = this->NumberOfThreads;
  options.progress = this->MakeProgress(0.4, 0.9);
  const quadrille::SecondOrderNodes nodes =
    quadrille::placeSecondOrderNodes(surface.prepared.mesh, quads, options);
  quadrille::report(this->MakeProgress(0, 1), 0.9, "Writing the elements");
  vtkSmartPointer<vtkUnstructuredGrid> grid =
    quadrille::writeSecondOrder(data, quads.quads, nodes, surface, this->NumberOfThreads);

  const MovedNodes moved = countMoved(nodes);
  quadrille::addCount(grid, "NodesPerElement", static_cast<std::size_t>(this->NodesPerElement));
  quadrille::addCount(grid, "NodesMovedAlong", moved.along);
  quadrille::addCount(grid, "NodesMovedOff", moved.off);
  quadrille::addCount(grid, "NodesByNearest", nodes.byNearest.size());
  quadrille::addCount(grid, "EdgesWithoutCurve", nodes.withoutCurve.size());
  quadrille::addCount(grid, "InvertedElements", nodes.invertedQuads.size());
  if (found.offSurface > 0)
  {
    std::ostringstream text;
    text << countText(found.offSurface, "point of the quads lies", "points of the quads lie")
         << " off the surface, by up to " << found.farthest << " at "
         << quadrille::placeText(quads.points[static_cast<std::size_t>(found.farthestPoint)])
         << ": is it the surface that they were made of?";
    this->AddNotice(text.str());
  }
  if (moved.along + moved.off > 0)
  {
    this->AddNotice(countText(moved.along + moved.off, "node", "nodes") +
      " moved back towards the straight edge, so that no element is folded: " +
      std::to_string(moved.along) + " along the surface, " + std::to_string(moved.off) + " off it" +
      (moved.off > 0 ? ", the first at " + nodePlace(nodes, moved.firstOff) : ""));
  }
  if (!nodes.withoutCurve.empty())
  {
    this->AddNotice("no curve of the surface was found along " +
      countText(nodes.withoutCurve.size(), "edge", "edges") +
      " of a feature or boundary, the first at " + nodePlace(nodes, nodes.withoutCurve.front()) +
      ": the nodes lie on the surface alone");
  }
  if (!nodes.byNearest.empty())
  {
    this->AddNotice("no short way over the faces leads to " +
      countText(nodes.byNearest.size(), "node", "nodes") + ", the first at " +
      nodePlace(nodes, nodes.byNearest.front()) +
      ": taken to the nearest face with the same side outside, or left on the straight edge; "
      "smaller "
      "quads would follow the surface there");
  }
  if (!nodes.invertedQuads.empty())
  {
    const Index first = nodes.invertedQuads.front();
    this->AddWarning(countText(nodes.invertedQuads.size(), "element is", "elements are") +
      " folded at a corner whatever its nodes are, the first is element " + std::to_string(first) +
      " at " + quadrille::placeText(quads.points[quads.quads[first][0]]));
  }
  return grid;
}

//------------------------------------------------------------------------------
void vtkQuadElements::AddProperties(vtkUnstructuredGrid* grid)
{
  const auto placeOf = [grid](vtkIdType element)
  {
    return "element " + std::to_string(element) + " at " +
      quadrille::placeText(quadrille::centreOfElement(grid, element));
  };
  if (!this->ThicknessArrayName.empty())
  {
    const quadrille::ElementNotice wrong =
      quadrille::addThickness(grid, this->ThicknessArrayName, this->NumberOfThreads);
    if (wrong.count > 0)
    {
      this->AddWarning("the thickness of " + countText(wrong.count, "element", "elements") +
        " is not positive, the first is " + placeOf(wrong.first));
    }
  }
  if (this->AxisArrayName.empty() && this->VectorArrayNames.empty())
  {
    return;
  }
  std::vector<quadrille::ElementFrame> frames =
    quadrille::elementFrames(grid, this->NumberOfThreads);
  if (!this->AxisArrayName.empty())
  {
    const quadrille::ElementNotice replaced = quadrille::addElementAxis(grid, this->AxisArrayName,
      static_cast<quadrille::AxisFallback>(this->AxisFallback), frames, this->NumberOfThreads);
    quadrille::addCount(grid, "ElementsWithoutDirection", replaced.count);
    if (replaced.count > 0)
    {
      constexpr std::array<const char*, 5> kDirectionNames{ "", "the x axis", "the y axis",
        "the z axis", "their own direction" };
      this->AddNotice("the direction '" + this->AxisArrayName +
        "' is zero or along the normal of " + countText(replaced.count, "element", "elements") +
        ", the first is " + placeOf(replaced.first) + ": they got " +
        kDirectionNames[static_cast<std::size_t>(this->AxisFallback)]);
    }
  }
  for (const std::string& name : this->VectorArrayNames)
  {
    quadrille::addVectorsInElement(grid, name, frames, this->NumberOfThreads);
  }
}

//------------------------------------------------------------------------------
void vtkQuadElements::Measure(vtkUnstructuredGrid* grid,
  const std::vector<quadrille::ElementRequirement>& requirements, quadrille::Block& block)
{
  MeasuredElements elements(
    grid, static_cast<std::size_t>(this->NumberOfWorst), this->NumberOfThreads);
  if (this->Quality)
  {
    for (std::size_t measure = 0; measure < quadrille::kMeasureCount; ++measure)
    {
      quadrille::addMeasure(grid, measure, elements.valuesOf(measure));
      quadrille::addHistogram(
        block.outputTable(1), measure, elements.valuesOf(measure), this->HistogramBins);
    }
    const auto measure = static_cast<std::size_t>(this->WorstMeasure);
    elements.listWorst(measure, quadrille::elementMeasures()[measure].isBetterLarge);
  }
  if (!requirements.empty())
  {
    std::vector<std::string> texts;
    auto counts = quadrille::newArray<vtkIdTypeArray>("FailedElements", 1, 0);
    for (const quadrille::ElementRequirement& requirement : requirements)
    {
      const std::size_t failed = elements.judge(requirement);
      texts.push_back(requirement.text);
      counts->InsertNextValue(static_cast<vtkIdType>(failed));
      if (failed > 0)
      {
        this->AddWarning(elements.failureText(requirement, failed));
      }
    }
    quadrille::addText(grid, "Requirements", texts);
    grid->GetFieldData()->AddArray(counts);
    block.state->report.numbers["FailedElements"] = static_cast<double>(elements.failedElements());
  }
  quadrille::writeWorst(grid, elements.worst(), block.output(2));
}

//------------------------------------------------------------------------------
void vtkQuadElements::AddSettings(std::ostream& os) const
{
  this->Superclass::AddSettings(os);
  os << "Order " << this->Order << '\n'
     << "NodesPerElement " << this->NodesPerElement << '\n'
     << "PatchArrayName " << this->PatchArrayName << '\n'
     << "Quality " << this->Quality << '\n'
     << "HistogramBins " << this->HistogramBins << '\n'
     << "WorstMeasure " << this->WorstMeasure << '\n'
     << "NumberOfWorst " << this->NumberOfWorst << '\n'
     << "ThicknessArrayName " << this->ThicknessArrayName << '\n'
     << "AxisArrayName " << this->AxisArrayName << '\n'
     << "AxisFallback " << this->AxisFallback << '\n';
  for (const std::string& text : this->Requirements)
  {
    os << "Requirement " << text << '\n';
  }
  for (const std::string& name : this->VectorArrayNames)
  {
    os << "VectorArrayName " << name << '\n';
  }
}

//------------------------------------------------------------------------------
void vtkQuadElements::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Order: " << this->Order << "\n";
  os << indent << "NodesPerElement: " << this->NodesPerElement << "\n";
  os << indent << "PatchArrayName: " << this->PatchArrayName << "\n";
  os << indent << "Quality: " << this->Quality << "\n";
  os << indent << "HistogramBins: " << this->HistogramBins << "\n";
  os << indent << "WorstMeasure: " << this->WorstMeasure << "\n";
  os << indent << "NumberOfWorst: " << this->NumberOfWorst << "\n";
  os << indent << "Requirements: " << this->Requirements.size() << "\n";
  os << indent << "ThicknessArrayName: " << this->ThicknessArrayName << "\n";
  os << indent << "AxisArrayName: " << this->AxisArrayName << "\n";
  os << indent << "AxisFallback: " << this->AxisFallback << "\n";
  os << indent << "VectorArrayNames: " << this->VectorArrayNames.size() << "\n";
}
