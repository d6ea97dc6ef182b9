// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadElements.h"

#include "Base/PlaceText.h"
#include "Base/Refuse.h"
#include "Extraction/SecondOrder.h"
#include "QuadrilleBlocks.h"
#include "QuadrilleElementGrid.h"
#include "QuadrilleReport.h"

#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <sstream>

vtkStandardNewMacro(vtkQuadElements);

namespace
{

using quadrille::Index;

/// "3 nodes", "1 node".
std::string countOf(std::size_t count, const std::string& one, const std::string& several)
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

} // namespace

//------------------------------------------------------------------------------
vtkQuadElements::vtkQuadElements()
{
  this->SetNumberOfInputPorts(2);
}

vtkQuadElements::~vtkQuadElements() = default;

//------------------------------------------------------------------------------
vtkUnstructuredGrid* vtkQuadElements::GetElements()
{
  return vtkUnstructuredGrid::SafeDownCast(this->GetOutputDataObject(0));
}

//------------------------------------------------------------------------------
vtkQuadrilleAlgorithm::PortRole vtkQuadElements::GetPortRole(int port) const
{
  return port == 0 ? PortRole::Mesh : PortRole::Surface;
}

//------------------------------------------------------------------------------
const char* vtkQuadElements::GetBlockType(int) const
{
  return "vtkUnstructuredGrid";
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
  const vtkSmartPointer<vtkUnstructuredGrid> grid = this->MakeElements(block);
  quadrille::addCount(grid, "ElementOrder", static_cast<std::size_t>(this->Order));
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
    text << countOf(found.offSurface, "point of the quads lies", "points of the quads lie")
         << " off the surface, by up to " << found.farthest << " at "
         << quadrille::placeText(quads.points[static_cast<std::size_t>(found.farthestPoint)])
         << ": is it the surface that they were made of?";
    this->AddNotice(text.str());
  }
  if (moved.along + moved.off > 0)
  {
    this->AddNotice(countOf(moved.along + moved.off, "node", "nodes") +
      " moved back towards the straight edge, so that no element is folded: " +
      std::to_string(moved.along) + " along the surface, " + std::to_string(moved.off) + " off it" +
      (moved.off > 0 ? ", the first at " + nodePlace(nodes, moved.firstOff) : ""));
  }
  if (!nodes.withoutCurve.empty())
  {
    this->AddNotice("no curve of the surface was found along " +
      countOf(nodes.withoutCurve.size(), "edge", "edges") +
      " of a feature or boundary, the first at " + nodePlace(nodes, nodes.withoutCurve.front()) +
      ": the nodes lie on the surface alone");
  }
  if (!nodes.byNearest.empty())
  {
    this->AddNotice("no way over the faces leads to " +
      countOf(nodes.byNearest.size(), "node", "nodes") + ", the first at " +
      nodePlace(nodes, nodes.byNearest.front()) +
      ": taken to the nearest face with the same side outside");
  }
  if (!nodes.invertedQuads.empty())
  {
    const Index first = nodes.invertedQuads.front();
    this->AddWarning(countOf(nodes.invertedQuads.size(), "element is", "elements are") +
      " folded at a corner whatever its nodes are, the first is element " + std::to_string(first) +
      " at " + quadrille::placeText(quads.points[quads.quads[first][0]]));
  }
  return grid;
}

//------------------------------------------------------------------------------
void vtkQuadElements::AddSettings(std::ostream& os) const
{
  this->Superclass::AddSettings(os);
  os << "Order " << this->Order << '\n'
     << "NodesPerElement " << this->NodesPerElement << '\n'
     << "PatchArrayName " << this->PatchArrayName << '\n';
}

//------------------------------------------------------------------------------
void vtkQuadElements::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Order: " << this->Order << "\n";
  os << indent << "NodesPerElement: " << this->NodesPerElement << "\n";
  os << indent << "PatchArrayName: " << this->PatchArrayName << "\n";
}
