// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Constraints/Constraints.h"

#include "Base/PlaceText.h"
#include "Base/Refuse.h"
#include "Convert/ArrayNames.h"
#include "Prepare/ConstraintPlacement.h"
#include "Prepare/InputPlaces.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>

namespace quadrille
{

namespace
{

//------------------------------------------------------------------------------
// One polyline

std::vector<DrawnLine> readLines(vtkPolyData* data, const char* what)
{
  std::vector<DrawnLine> lines;
  vtkIdType cell = data->GetNumberOfVerts();
  auto iterator = vtk::TakeSmartPointer(data->GetLines()->NewIterator());
  for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal(); iterator->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    iterator->GetCurrentCell(count, ids);
    lines.push_back({ cell++, {} });
    for (vtkIdType i = 0; i < count; ++i)
    {
      Vector3 p;
      data->GetPoint(ids[i], p.data());
      if (!p.allFinite())
      {
        refuse(what, " ", lines.back().source, " has a point that is not finite; draw it anew");
      }
      lines.back().points.push_back(p);
    }
  }
  return lines;
}

//------------------------------------------------------------------------------
// The inputs

bool hasLines(vtkPolyData* data)
{
  return data && data->GetNumberOfLines() > 0;
}

/// Values of ConstraintType of vertices.
constexpr double kClearedType = 6;
constexpr double kSizeType = 7;

bool hasPoints(vtkPolyData* data)
{
  return data && data->GetNumberOfPoints() > 0;
}

/// What a line of the curves is, by the array. What cannot be honoured must not pass for done.
ConstraintKind kindOfLine(vtkDataArray* types, vtkIdType cell)
{
  const double type = types ? types->GetComponent(cell, 0) : 0;
  if (type == 0 || type == 1)
  {
    return type == 0 ? ConstraintKind::Feature : ConstraintKind::Stroke;
  }
  if (type != 2 && type != 3 && type != 4)
  {
    refuse("curve ", cell, " has ", arrays::kConstraintType, " ", type,
      ", but only 0 (feature curve), 1 (guiding stroke), 2 (connection), 3 (cycle) and 4 (move of "
      "an "
      "irregular vertex) can be asked for: correct the array, or use the inputs Feature Curves and "
      "Guiding Strokes without it");
  }
  return type == 2 ? ConstraintKind::Connection
    : type == 3    ? ConstraintKind::Cycle
                   : ConstraintKind::Move;
}

double weightOf(vtkDataArray* weights, vtkIdType cell, double otherwise)
{
  const double weight = weights ? weights->GetComponent(cell, 0) : otherwise;
  if (!(weight > 0 && weight <= 1))
  {
    refuse("guiding stroke ", cell, " has the weight ", weight,
      ", but it must be above 0 and at most 1");
  }
  return weight;
}

double radiusOf(vtkDataArray* radii, vtkIdType cell, double otherwise)
{
  const double radius = radii ? radii->GetComponent(cell, 0) : otherwise;
  if (!(radius >= 0) || std::isinf(radius))
  {
    refuse("guiding stroke ", cell, " has the ", arrays::kGuidingRadius, " ", radius,
      ", but it must be a number of at least 0");
  }
  return radius;
}

/// The cells and points of vertices of a type.
std::vector<std::pair<vtkIdType, Vector3>> placesOfType(vtkPolyData* data, double type)
{
  std::vector<std::pair<vtkIdType, Vector3>> places;
  vtkDataArray* types = data ? data->GetCellData()->GetArray(arrays::kConstraintType) : nullptr;
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; types && cell < data->GetNumberOfVerts(); ++cell)
  {
    if (types->GetComponent(cell, 0) != type)
    {
      continue;
    }
    data->GetVerts()->GetCellAtId(cell, corners);
    for (vtkIdType i = 0; i < corners->GetNumberOfIds(); ++i)
    {
      Vector3 p;
      data->GetPoint(corners->GetId(i), p.data());
      if (!p.allFinite())
      {
        refuse(type == kSizeType ? "size " : "cleared feature ", cell,
          " has a point that is not finite; place it anew");
      }
      places.emplace_back(cell, p);
    }
  }
  return places;
}

bool hasPlaces(vtkPolyData* data)
{
  return !placesOfType(data, kClearedType).empty() || !placesOfType(data, kSizeType).empty();
}

/// Cleared features and sizes.
void addPlaces(vtkPolyData* data, ConstraintPlacement& placement)
{
  for (const auto& [cell, place] : placesOfType(data, kClearedType))
  {
    placement.addCleared(cell, place);
  }
  for (const auto& [cell, place] : placesOfType(data, kSizeType))
  {
    vtkDataArray* factors = data->GetCellData()->GetArray(arrays::kSizeFactor);
    vtkDataArray* radii = data->GetCellData()->GetArray(arrays::kGuidingRadius);
    if (!factors)
    {
      refuse("size ", cell, " at ", placeText(place), " has no factor: give the cells an array '",
        arrays::kSizeFactor, "', the edge length there over the target edge length");
    }
    placement.addSize(
      cell, place, radii ? radii->GetComponent(cell, 0) : 0, factors->GetComponent(cell, 0));
  }
}

void addCurves(vtkPolyData* curves, const ConstraintInputs& inputs, ConstraintPlacement& placement)
{
  vtkDataArray* types = curves->GetCellData()->GetArray(arrays::kConstraintType);
  vtkDataArray* weights = curves->GetCellData()->GetArray(arrays::kGuidingWeight);
  vtkDataArray* radii = curves->GetCellData()->GetArray(arrays::kGuidingRadius);
  for (const DrawnLine& line : readLines(curves, "curve"))
  {
    switch (kindOfLine(types, line.source))
    {
      case ConstraintKind::Stroke:
        placement.addStroke(line, weightOf(weights, line.source, inputs.strokeWeight),
          radiusOf(radii, line.source, inputs.strokeRadius));
        break;
      case ConstraintKind::Move:
        break; // see drawnMoves
      case ConstraintKind::Connection:
        placement.addCurve(line.source, CurveKind::Connection, line.points);
        break;
      case ConstraintKind::Cycle:
        placement.addCurve(line.source, CurveKind::Cycle, line.points);
        break;
      default:
        placement.addFeature(line);
    }
  }
}

void addCurves(vtkPolyData* data, CurveKind kind, ConstraintPlacement& placement)
{
  for (const DrawnLine& line : hasLines(data)
      ? readLines(data, kind == CurveKind::Cycle ? "cycle" : "connection")
      : std::vector<DrawnLine>{})
  {
    placement.addCurve(line.source, kind, line.points);
  }
}

/// Joins the two points of each value of ConnectId but 0.
void addConnections(vtkPolyData* data, const char* what, ConstraintPlacement& placement)
{
  vtkDataArray* ids = data ? data->GetPointData()->GetArray(arrays::kConnectId) : nullptr;
  if (!ids)
  {
    return;
  }
  requireWhole(ids, "point");
  std::map<double, std::vector<vtkIdType>> groups;
  for (vtkIdType i = 0; i < ids->GetNumberOfTuples(); ++i)
  {
    if (ids->GetComponent(i, 0) != 0)
    {
      groups[ids->GetComponent(i, 0)].push_back(i);
    }
  }
  for (const auto& [id, points] : groups)
  {
    if (points.size() != 2)
    {
      refuse("the value ", id, " of ", arrays::kConnectId, " stands at ", points.size(),
        " points of ", what, ", but a connection joins two: give each pair a value of its own");
    }
    std::vector<Vector3> ends(2);
    data->GetPoint(points[0], ends[0].data());
    data->GetPoint(points[1], ends[1].data());
    placement.addCurve(static_cast<vtkIdType>(id), CurveKind::Connection, std::move(ends));
  }
}

bool connects(vtkPolyData* data)
{
  return data && data->GetPointData()->HasArray(arrays::kConnectId);
}

void addStrokes(const ConstraintInputs& inputs, ConstraintPlacement& placement)
{
  vtkDataArray* weights = inputs.strokes->GetCellData()->GetArray(arrays::kGuidingWeight);
  vtkDataArray* radii = inputs.strokes->GetCellData()->GetArray(arrays::kGuidingRadius);
  for (const DrawnLine& line : readLines(inputs.strokes, "guiding stroke"))
  {
    placement.addStroke(line, weightOf(weights, line.source, inputs.strokeWeight),
      radiusOf(radii, line.source, inputs.strokeRadius));
  }
}

void addPoints(vtkPolyData* points, int valence, ConstraintPlacement& placement)
{
  vtkDataArray* asked = points->GetPointData()->GetArray(arrays::kTargetValence);
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    Vector3 p;
    points->GetPoint(i, p.data());
    if (!p.allFinite())
    {
      refuse("valence point ", i, " is not finite; place it anew");
    }
    const double value = asked ? asked->GetComponent(i, 0) : valence;
    if (value == 0)
    {
      continue;
    }
    if (!(value >= kLeastValence && value <= kMostValence) || value != std::floor(value))
    {
      refuse("the valence point at ", placeText(p), " asks for valence ", value, ", but only ",
        kLeastValence, " to ", kMostValence, ", and 0 for none, can be asked for");
    }
    try
    {
      placement.addValence(i, p, static_cast<int>(value));
    }
    catch (const InvalidInput& error)
    {
      // Of two that contradict each other the later one goes, and the rest is done.
      placement.leaveOutValence(i, p, static_cast<int>(value), error.what());
    }
  }
}

/// Points of the input of all classes ask for a valence by their array; without it those do that are no part of lines.
int valenceOfMixed(vtkPolyData* mixed, int valence)
{
  return mixed->GetPointData()->HasArray(arrays::kTargetValence) || hasLines(mixed) ||
      connects(mixed) || hasPlaces(mixed)
    ? 0
    : valence;
}

/// The lines of an input that are moves, as they are.
void addMoves(vtkPolyData* data, PlacedConstraints& result)
{
  vtkDataArray* types = data ? data->GetCellData()->GetArray(arrays::kConstraintType) : nullptr;
  for (const DrawnLine& line :
    types&& hasLines(data) ? readLines(data, "move") : std::vector<DrawnLine>{})
  {
    if (kindOfLine(types, line.source) != ConstraintKind::Move)
    {
      continue;
    }
    if (line.points.size() < 2)
    {
      refuse("move ", line.source, " of an irregular vertex has ", line.points.size(),
        " points, but it leads from one place to another: draw it anew");
    }
    PlacedConstraint move;
    move.kind = ConstraintKind::Move;
    move.source = line.source;
    move.path = { line.points.front(), line.points.back() };
    move.given = move.path;
    result.placed.push_back(std::move(move));
  }
}

/// What of an input is not used.
void tellUnused(vtkPolyData* data, const char* name, std::vector<std::string>& notices)
{
  if (data && data->GetNumberOfPoints() > 0 && data->GetNumberOfLines() == 0 && !hasPlaces(data))
  {
    notices.push_back(std::string("the input ") + name +
      " has no lines and is not used: give it polylines, as Poly Line Source makes them");
  }
  else if (data && data->GetNumberOfPolys() + data->GetNumberOfStrips() > 0)
  {
    notices.push_back(
      std::string("the input ") + name + " has cells that are no lines; they are not used");
  }
}

} // namespace

//------------------------------------------------------------------------------
PlacedConstraints applyConstraints(ConvertedSurface& surface, const ConstraintInputs& inputs)
{
  PlacedConstraints unused;
  tellUnused(inputs.curves, "Feature Curves", unused.notices);
  tellUnused(inputs.strokes, "Guiding Strokes", unused.notices);
  tellUnused(inputs.connections, "Connections", unused.notices);
  tellUnused(inputs.cycles, "Cycles", unused.notices);
  const bool any = hasLines(inputs.curves) || hasLines(inputs.strokes) ||
    hasLines(inputs.connections) || hasLines(inputs.cycles) || hasPoints(inputs.points) ||
    hasPoints(inputs.mixed) || connects(inputs.surface) || hasPlaces(inputs.curves);
  if (!any || surface.input.polygonPoints.empty())
  {
    return unused;
  }
  std::unique_ptr<InputPlaces> made;
  std::unique_ptr<InputPlaces>& where = inputs.places != nullptr ? *inputs.places : made;
  if (!where)
  {
    where = std::make_unique<InputPlaces>(surface.input, inputs.threads);
  }
  ConstraintPlacement placement(surface.input, where->places, where->paths, inputs.sameWithin);
  if (hasLines(inputs.curves))
  {
    addCurves(inputs.curves, inputs, placement);
  }
  addPlaces(inputs.curves, placement);
  if (hasLines(inputs.strokes))
  {
    addStrokes(inputs, placement);
  }
  if (hasPoints(inputs.points))
  {
    // Points that are there to be joined ask for a valence only where they say so.
    addPoints(inputs.points, connects(inputs.points) ? 0 : inputs.valence, placement);
    addConnections(inputs.points, "the valence points", placement);
  }
  addConnections(inputs.surface, "the surface", placement);
  addCurves(inputs.connections, CurveKind::Connection, placement);
  addCurves(inputs.cycles, CurveKind::Cycle, placement);
  if (hasPoints(inputs.mixed))
  {
    addCurves(inputs.mixed, inputs, placement);
    addPoints(inputs.mixed, valenceOfMixed(inputs.mixed, inputs.valence), placement);
    addConnections(inputs.mixed, "the constraints", placement);
    addPlaces(inputs.mixed, placement);
  }
  placement.addTo(surface.input);
  PlacedConstraints result = placement.result();
  addMoves(inputs.curves, result);
  addMoves(inputs.mixed, result);
  result.notices.insert(result.notices.begin(), unused.notices.begin(), unused.notices.end());
  return result;
}

} // namespace quadrille
