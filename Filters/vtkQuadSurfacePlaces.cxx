// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadSurfacePlaces.h"

#include "vtkCommunicator.h"
#include "vtkDataSet.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"

#include <algorithm>
#include <cmath>
#include <limits>

vtkStandardNewMacro(vtkQuadSurfacePlaces);

namespace
{

constexpr double kTolerance =
  1e-5; // of the size of the cells: rays to a vertex would slip between them
constexpr double kNone = std::numeric_limits<double>::infinity();

vtkSmartPointer<vtkStaticCellLocator> locatorOf(vtkDataSet* cells)
{
  auto locator = vtkSmartPointer<vtkStaticCellLocator>::New();
  locator->SetDataSet(cells);
  locator->BuildLocator();
  return locator;
}

/// Where each ray first hits the cells, as the share of its length; what is nearer already stays.
template <class Rays>
void shorten(std::vector<double>& hits, const Rays& rays, vtkStaticCellLocator* locator)
{
  const double tolerance = kTolerance * locator->GetDataSet()->GetLength();
  for (std::size_t i = 0; i < rays.size(); ++i)
  {
    double share = 0, place[3], local[3];
    int part = 0;
    if (locator->IntersectWithLine(
          rays[i].data(), rays[i].data() + 3, tolerance, share, place, local, part) != 0)
    {
      hits[i] = std::min(hits[i], share);
    }
  }
}

} // namespace

vtkQuadSurfacePlaces::vtkQuadSurfacePlaces() : Places(vtkSmartPointer<vtkDoubleArray>::New()) {}

vtkQuadSurfacePlaces::~vtkQuadSurfacePlaces() = default;

//------------------------------------------------------------------------------
void vtkQuadSurfacePlaces::SetNumberOfRays(vtkIdType number)
{
  this->Rays.resize(static_cast<std::size_t>(std::max<vtkIdType>(number, 0)), Ray{});
  this->Modified();
}

//------------------------------------------------------------------------------
void vtkQuadSurfacePlaces::SetRay(
  vtkIdType index, double ax, double ay, double az, double bx, double by, double bz)
{
  if (index < 0)
  {
    vtkErrorMacro("Ray " << index << " of a line: numbers begin at 0.");
    return;
  }
  if (index >= static_cast<vtkIdType>(this->Rays.size()))
  {
    this->SetNumberOfRays(index + 1);
  }
  this->Rays[static_cast<std::size_t>(index)] = { ax, ay, az, bx, by, bz };
  this->Modified();
}

//------------------------------------------------------------------------------
void vtkQuadSurfacePlaces::Hold()
{
  this->IsHeld = true;
  this->Held.clear();
  for (vtkDataSet* cells : this->GetAll())
  {
    this->Held.push_back(locatorOf(cells));
  }
  this->Modified();
}

//------------------------------------------------------------------------------
std::vector<double> vtkQuadSurfacePlaces::HitsOfThisRank()
{
  std::vector<double> hits(this->Rays.size(), kNone);
  if (this->IsHeld)
  {
    for (vtkStaticCellLocator* locator : this->Held)
    {
      shorten(hits, this->Rays, locator);
    }
  }
  else if (this->IsComplete())
  {
    for (vtkDataSet* cells : this->GetSelected())
    {
      shorten(hits, this->Rays, locatorOf(cells));
    }
  }
  return hits;
}

//------------------------------------------------------------------------------
void vtkQuadSurfacePlaces::Compute()
{
  std::vector<double> hits = this->HitsOfThisRank();
  vtkMultiProcessController* ranks = vtkMultiProcessController::GetGlobalController();
  if (ranks && ranks->GetNumberOfProcesses() > 1 && !hits.empty())
  {
    const std::vector<double> mine = hits;
    ranks->AllReduce(
      mine.data(), hits.data(), static_cast<vtkIdType>(hits.size()), vtkCommunicator::MIN_OP);
  }
  this->Places->Initialize();
  for (std::size_t i = 0; i < hits.size(); ++i)
  {
    const Ray& ray = this->Rays[i];
    for (std::size_t c = 0; c < 3; ++c)
    {
      this->Places->InsertNextValue(std::isfinite(hits[i])
          ? ray[c] + hits[i] * (ray[3 + c] - ray[c])
          : std::numeric_limits<double>::quiet_NaN());
    }
  }
}

//------------------------------------------------------------------------------
void vtkQuadSurfacePlaces::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Rays: " << this->Rays.size() << "\n";
}
