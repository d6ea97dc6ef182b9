// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "RemeshProblems.h"

#include "FetchedData.h"

#include "vtkCamera.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkIdList.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPVDataInformation.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkPolygon.h"
#include "vtkSMIntVectorProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTrace.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace quadrille
{
namespace
{

constexpr int kQuads = 0;
constexpr vtkIdType kCorners = 4;
constexpr double kEdgesSeen = 12; // across the view, so that each of them is clearly seen

/// The output Problems.
int problemPort(vtkSMSourceProxy* filter)
{
  return static_cast<int>(filter->GetOutputPortIndex("Problems"));
}

Place sum(const Place& a, const Place& b, double share)
{
  return { a[0] + share * b[0], a[1] + share * b[1], a[2] + share * b[2] };
}

double distance(const Place& a, const Place& b)
{
  return std::sqrt(vtkMath::Distance2BetweenPoints(a.data(), b.data()));
}

struct Polygon
{
  Place middle;
  Place normal; ///< as long as its area
  double edge = 0;
};

std::vector<Polygon> polygonsOf(vtkSMSourceProxy* filter, int port)
{
  std::vector<Polygon> polygons;
  vtkNew<vtkIdList> ids;
  forEach<vtkPointSet>(fetched(filter, port),
    [&polygons, &ids](vtkPointSet& data)
    {
      for (vtkIdType i = 0; i < data.GetNumberOfCells(); ++i)
      {
        data.GetCellPoints(i, ids);
        // Of elements of second order the corners come first.
        const vtkIdType size = data.IsA("vtkPolyData") ? ids->GetNumberOfIds()
                                                       : std::min(ids->GetNumberOfIds(), kCorners);
        if (size < 3)
        {
          continue;
        }
        Polygon polygon{};
        std::vector<Place> corners(static_cast<std::size_t>(size));
        for (std::size_t c = 0; c < corners.size(); ++c)
        {
          data.GetPoint(ids->GetId(static_cast<vtkIdType>(c)), corners[c].data());
          polygon.middle = sum(polygon.middle, corners[c], 1.0 / static_cast<double>(size));
        }
        for (std::size_t c = 0; c < corners.size(); ++c)
        {
          const Place& next = corners[(c + 1) % corners.size()];
          const Place from = sum(corners[c], polygon.middle, -1);
          const Place to = sum(next, polygon.middle, -1);
          Place twice;
          vtkMath::Cross(from.data(), to.data(), twice.data());
          polygon.normal = sum(polygon.normal, twice, 0.5);
          polygon.edge += distance(corners[c], next) / static_cast<double>(size);
        }
        polygons.push_back(polygon);
      }
    });
  return polygons;
}

std::vector<Place> verticesOf(vtkSMSourceProxy* filter, int port)
{
  std::vector<Place> places;
  forEach<vtkPolyData>(fetched(filter, port),
    [&places](vtkPolyData& data)
    {
      vtkDataArray* kind = data.GetCellData()->GetArray("Problem"); // 0: a vertex of the input
      for (vtkIdType i = 0; i < data.GetNumberOfVerts(); ++i)
      {
        if (kind && kind->GetComponent(i, 0) == 0)
        {
          continue;
        }
        const vtkIdType* ids = nullptr;
        vtkIdType size = 0;
        data.GetCellPoints(i, size, ids); // vertices come first
        places.emplace_back();
        data.GetPoint(ids[0], places.back().data());
      }
    });
  return places;
}

/// The polygons within two edge lengths of the nearest one say what is outward.
ProblemPlace placedOn(const std::vector<Polygon>& polygons, const Place& place)
{
  const auto nearest = std::min_element(polygons.begin(), polygons.end(),
    [&place](const Polygon& a, const Polygon& b)
    { return distance(a.middle, place) < distance(b.middle, place); });
  ProblemPlace problem{ place, { 0, 0, 0 }, 0 };
  if (nearest == polygons.end())
  {
    return problem;
  }
  problem.edge = nearest->edge;
  const double reach = distance(nearest->middle, place) + 2 * nearest->edge;
  for (const Polygon& polygon : polygons)
  {
    if (distance(polygon.middle, place) <= reach)
    {
      problem.outward = sum(problem.outward, polygon.normal, 1);
    }
  }
  vtkMath::Normalize(problem.outward.data());
  return problem;
}

} // namespace

std::optional<Remedy> remedyOf(vtkSMSourceProxy* filter)
{
  Remedy remedy;
  const char* text =
    filter->GetProperty("Remedy") ? vtkSMPropertyHelper(filter, "Remedy").GetAsString() : nullptr;
  std::istringstream words(text ? text : "");
  vtkSMProperty* property = words >> remedy.property >> remedy.value
    ? filter->GetProperty(remedy.property.c_str())
    : nullptr;
  if (!property)
  {
    return std::nullopt;
  }
  remedy.label = property->GetXMLLabel();
  return remedy;
}

void apply(vtkSMSourceProxy* filter, const Remedy& remedy)
{
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", filter);
  vtkSMPropertyHelper helper(filter, remedy.property.c_str());
  if (vtkSMIntVectorProperty::SafeDownCast(filter->GetProperty(remedy.property.c_str())))
  {
    helper.Set(static_cast<int>(remedy.value));
  }
  else
  {
    helper.Set(remedy.value);
  }
  filter->UpdateVTKObjects();
}

bool hasProblems(vtkSMSourceProxy* filter)
{
  return filter->GetOutputPortsCreated() &&
    filter->GetDataInformation(problemPort(filter))->GetNumberOfCells() > 0;
}

std::vector<ProblemPlace> problemPlaces(vtkSMSourceProxy* filter)
{
  std::vector<Polygon> polygons = polygonsOf(filter, problemPort(filter));
  std::vector<Place> places = verticesOf(filter, problemPort(filter));
  if (places.empty() && !polygons.empty())
  {
    places.push_back(polygons[polygons.size() / 2].middle);
  }
  const std::vector<Polygon> quads = polygonsOf(filter, kQuads);
  polygons.insert(polygons.end(), quads.begin(), quads.end());
  std::vector<ProblemPlace> problems;
  for (const Place& place : places)
  {
    problems.push_back(placedOn(polygons, place));
  }
  return problems;
}

void lookAt(vtkSMRenderViewProxy* view, const ProblemPlace& problem)
{
  vtkCamera* camera = view->GetActiveCamera();
  Place outward = problem.outward;
  if (vtkMath::Norm(outward.data()) == 0)
  {
    camera->GetDirectionOfProjection(outward.data());
    outward = { -outward[0], -outward[1], -outward[2] };
  }
  const double half = kEdgesSeen / 2 * problem.edge;
  const double away = half / std::tan(vtkMath::RadiansFromDegrees(camera->GetViewAngle() / 2));
  const Place eye = sum(problem.place, outward, away);
  std::array<double, 3> up{};
  camera->GetViewUp(up.data());
  if (std::abs(vtkMath::Dot(up.data(), outward.data())) > 0.99 * vtkMath::Norm(up.data()))
  {
    vtkMath::Perpendiculars(outward.data(), up.data(), nullptr, 0);
  }
  vtkSMPropertyHelper(view, "CameraFocalPoint").Set(problem.place.data(), 3);
  vtkSMPropertyHelper(view, "CameraPosition").Set(eye.data(), 3);
  vtkSMPropertyHelper(view, "CameraViewUp").Set(up.data(), 3);
  vtkSMPropertyHelper(view, "CameraParallelScale").Set(half);
  vtkSMPropertyHelper(view, "CenterOfRotation").Set(problem.place.data(), 3);
  view->UpdateVTKObjects();
}

} // namespace quadrille
