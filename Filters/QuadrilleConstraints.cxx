// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleConstraints.h"

#include "Base/PlaceText.h"
#include "Mesh/CurveRequests.h"
#include "Mesh/Distance.h"
#include "Mesh/Guides.h"
#include "QuadrilleArrayNames.h"
#include "QuadrilleRefuse.h"
#include "QuadrilleSnapping.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

namespace quadrille
{

namespace
{

/// What was moved by more than this part of the surface's bounding-box diagonal is worth a warning. Points of lines
/// that are clicked in a window lie in front of the surface as a rule.
constexpr double kFarPoint = 0.05;
constexpr double kFarLine = 0.1;
/// Samples of a stroke in each edge length of the polygons below.
constexpr double kSamplesAnEdge = 3;
constexpr double kMostSamples = 4096;
/// Barycentric nearness to an edge of a sample that lies on it.
constexpr double kOnEdge = 1e-6;

void markPath(
  const EdgeGraph& graph, const std::vector<Index>& path, std::map<Index, std::uint8_t>& marks)
{
  for (std::size_t k = 0; k + 1 < path.size(); ++k)
  {
    for (std::size_t i = graph.first[path[k]]; i < graph.first[path[k] + 1]; ++i)
    {
      if (graph.uses[i].target == path[k + 1])
      {
        marks[graph.uses[i].polygon] |= graph.uses[i].bit;
      }
    }
  }
}
//------------------------------------------------------------------------------
// One polyline

struct Polyline
{
  vtkIdType cell = 0;
  std::vector<Vector3> points;
};

std::vector<Polyline> readLines(vtkPolyData* data, const char* what)
{
  std::vector<Polyline> lines;
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
        refuse(what, " ", lines.back().cell, " has a point that is not finite; draw it anew");
      }
      lines.back().points.push_back(p);
    }
  }
  return lines;
}

/// Everything that is put on the surface, until it is written to the input at once.
class Placement
{
public:
  explicit Placement(ConvertedSurface& surface)
    : surface_(surface), input_(surface.input), diagonal_(diagonalOf(surface.input))
  {
  }

  void addFeature(const Polyline& line);
  void addStroke(const Polyline& line, double weight);
  void addValence(vtkIdType source, const Vector3& point, int valence);
  void addCurve(vtkIdType source, CurveKind kind, std::vector<Vector3> points);
  PlacedConstraints finish();

private:
  const EdgeGraph& graph()
  {
    if (!madeGraph_)
    {
      madeGraph_.emplace(makeEdgeGraph(input_));
    }
    return *madeGraph_;
  }
  const Snapper& snapper()
  {
    if (!madeSnapper_)
    {
      madeSnapper_.emplace(input_);
    }
    return *madeSnapper_;
  }

  struct Stroke
  {
    Vector3 direction = Vector3::Zero();
    double weight = 1;
  };

  std::vector<Index> pathBetween(const char* what, vtkIdType line, Index a, Index b);
  /// Places below the straight segment from one to the other; none where the way jumps.
  std::vector<Snapper::Place> sampleBetween(
    const Snapper::Place& first, const Snapper::Place& last);
  bool isOnBoundary(Index point);
  void guide(const Snapper::Place& place, const Stroke& stroke);
  void guideAlong(const std::vector<Index>& path, const Stroke& stroke);
  void tellIfFar(const char* what, const PlacedConstraint& placed);
  /// A line that is not followed.
  void drop(const char* what, PlacedConstraint line, const std::string& whyNot);

  ConvertedSurface& surface_;
  SurfaceInput& input_;
  std::optional<EdgeGraph>
    madeGraph_; ///< these take as long as a run's map on a large surface: only where asked for
  std::optional<Snapper> madeSnapper_;
  double diagonal_;
  std::map<Index, std::uint8_t> features_;
  std::map<Index, Stroke> strokes_;
  std::map<Index, Stroke> ofThisStroke_; ///< the part of strokes_ that addStroke is at
  PlacedConstraints result_;
};

std::vector<Index> Placement::pathBetween(const char* what, vtkIdType line, Index a, Index b)
{
  std::vector<Index> path = findEdgePath(input_, graph(), a, b);
  if (path.empty())
  {
    refuse(what, " ", line, ": no path of edges leads from ", placeText(input_.points[a]), " to ",
      placeText(input_.points[b]),
      "; the places lie on different parts of the surface, or points at the same place are not "
      "merged: draw one line for "
      "each part, or apply Clean to the surface first");
  }
  std::reverse(path.begin(), path.end());
  return path;
}

void Placement::tellIfFar(const char* what, const PlacedConstraint& placed)
{
  const double far = placed.kind == ConstraintKind::Valence ? kFarPoint : kFarLine;
  if (placed.distance > far * diagonal_)
  {
    std::ostringstream text;
    text << what << " " << placed.source << " was moved by up to " << placed.distance
         << " to lie on the surface, near " << placeText(placed.path.front())
         << ": look at the output Constraints, and move its points if that is not what was meant";
    result_.notices.push_back(text.str());
  }
}

void Placement::drop(const char* what, PlacedConstraint line, const std::string& whyNot)
{
  result_.notices.push_back(std::string(what) + " " + std::to_string(line.source) + " " + whyNot);
  line.whyNot = whyNot;
  result_.placed.push_back(std::move(line));
}

/// An edge from there has one polygon only.
bool Placement::isOnBoundary(Index point)
{
  std::map<Index, int> polygons;
  for (std::size_t i = graph().first[point]; i < graph().first[point + 1]; ++i)
  {
    ++polygons[graph().uses[i].target];
  }
  return std::any_of(
    polygons.begin(), polygons.end(), [](const auto& edge) { return edge.second == 1; });
}

void Placement::addFeature(const Polyline& line)
{
  PlacedConstraint placed;
  placed.kind = ConstraintKind::Feature;
  placed.source = line.cell;
  Index previous = kInvalidIndex;
  for (const Vector3& p : line.points)
  {
    const Index v = snapper().nearestCorner(p);
    placed.distance = std::max(placed.distance, (input_.points[v] - p).norm());
    if (previous == kInvalidIndex)
    {
      placed.path.push_back(input_.points[v]);
    }
    else if (v != previous)
    {
      const std::vector<Index> path = pathBetween("feature curve", line.cell, previous, v);
      markPath(graph(), path, features_);
      for (std::size_t i = 1; i < path.size(); ++i)
      {
        placed.path.push_back(input_.points[path[i]]);
      }
    }
    previous = v;
  }
  if (placed.path.size() < 2)
  {
    drop("feature curve", std::move(placed),
      "has no edge of the surface along it and is not followed: all its points have the same "
      "nearest point of the surface");
    return;
  }
  tellIfFar("feature curve", placed);
  result_.placed.push_back(std::move(placed));
}

std::vector<Snapper::Place> Placement::sampleBetween(
  const Snapper::Place& first, const Snapper::Place& last)
{
  const Vector3& a = first.point;
  const Vector3& b = last.point;
  const double edge = std::min(meanEdge(input_, first.polygon), meanEdge(input_, last.polygon));
  const double wanted = kSamplesAnEdge * (b - a).norm() / std::max(edge, 1e-300);
  const int count = static_cast<int>(std::clamp(std::ceil(wanted), 4.0, kMostSamples));
  const double step = (b - a).norm() / count;
  std::vector<Snapper::Place> places{ first };
  for (int i = 0; i < count; ++i)
  {
    places.push_back(snapper().nearestPlace(a + (i + 0.5) / count * (b - a)));
  }
  places.push_back(last);
  // Over a bulge places move apart, but where they jump the segment left this part of the surface.
  constexpr double kJump = 6;
  for (std::size_t i = 0; i + 1 < places.size(); ++i)
  {
    if ((places[i + 1].point - places[i].point).norm() > kJump * std::max(step, 1e-300))
    {
      return {};
    }
  }
  return places;
}

/// The polygon of the place, and where it lies on an edge that beyond it. At a corner none: which one is not said.
void Placement::guide(const Snapper::Place& place, const Stroke& stroke)
{
  const Index begin = input_.polygonOffsets[place.polygon];
  const Index corners = input_.polygonOffsets[place.polygon + 1] - begin;
  const double near = kOnEdge * meanEdge(input_, place.polygon);
  for (Index i = 0; i < corners; ++i)
  {
    if ((input_.points[input_.polygonPoints[begin + i]] - place.point).norm() < near)
    {
      return;
    }
  }
  ofThisStroke_[place.polygon] = stroke;
  for (Index i = 0; i < corners; ++i)
  {
    const Index a = input_.polygonPoints[begin + i];
    const Index b = input_.polygonPoints[begin + (i + 1) % corners];
    if (distanceToSegment(place.point, input_.points[a], input_.points[b]) < near)
    {
      guideAlong({ a, b }, stroke);
    }
  }
}

/// The polygons on both sides of a path of edges.
void Placement::guideAlong(const std::vector<Index>& path, const Stroke& stroke)
{
  for (std::size_t k = 0; k + 1 < path.size(); ++k)
  {
    for (std::size_t i = graph().first[path[k]]; i < graph().first[path[k] + 1]; ++i)
    {
      if (graph().uses[i].target == path[k + 1])
      {
        ofThisStroke_[graph().uses[i].polygon] = stroke;
      }
    }
  }
}

void Placement::addStroke(const Polyline& line, double weight)
{
  PlacedConstraint placed;
  placed.kind = ConstraintKind::Stroke;
  placed.source = line.cell;
  placed.weight = weight;
  std::vector<Snapper::Place> ends;
  ofThisStroke_.clear();
  for (const Vector3& p : line.points)
  {
    ends.push_back(snapper().nearestPlace(p));
    placed.distance = std::max(placed.distance, (ends.back().point - p).norm());
  }
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
  {
    const Vector3& a = ends[i].point;
    const Vector3& b = ends[i + 1].point;
    if (a == b)
    {
      continue;
    }
    const Stroke stroke{ (b - a).stableNormalized(), weight };
    const std::vector<Snapper::Place> places = sampleBetween(ends[i], ends[i + 1]);
    for (const Snapper::Place& place : places)
    {
      guide(place, stroke);
      placed.path.push_back(place.point);
    }
    if (places.empty())
    {
      const std::vector<Index> path = pathBetween(
        "guiding stroke", line.cell, snapper().nearestCorner(a), snapper().nearestCorner(b));
      guideAlong(path, stroke);
      for (const Index v : path)
      {
        placed.path.push_back(input_.points[v]);
      }
    }
  }
  if (placed.path.size() < 2)
  {
    placed.path.assign(1, ends.empty() ? Vector3(Vector3::Zero()) : ends.front().point);
    drop("guiding stroke", std::move(placed),
      "has no length and is not followed: give it two different points");
    return;
  }
  for (const auto& [polygon, stroke] : ofThisStroke_)
  {
    strokes_[polygon] = stroke;
    placed.guided.push_back(guidedPolygon(input_, polygon, stroke.direction, stroke.weight));
  }
  tellIfFar("guiding stroke", placed);
  result_.placed.push_back(std::move(placed));
}

void Placement::addValence(vtkIdType source, const Vector3& point, int valence)
{
  const Index v = snapper().nearestCorner(point);
  if (valence == kLeastValence && isOnBoundary(v))
  {
    refuse("valence ", valence, " is asked for at ", placeText(input_.points[v]),
      ", on the boundary of the surface, where the least is 3, a corner with one quad: ask for 3 "
      "or more there, or move the "
      "point inside");
  }
  input_.targetValences.resize(input_.points.size(), 0);
  int& asked = input_.targetValences[v];
  if (asked != 0 && asked != valence)
  {
    refuse("valence point ", source, " asks for valence ", valence, " at ",
      placeText(input_.points[v]), ", where ", asked,
      " is asked for already: give both the same, or take one away");
  }
  asked = valence;
  PlacedConstraint placed;
  placed.kind = ConstraintKind::Valence;
  placed.source = source;
  placed.path = { input_.points[v] };
  placed.distance = (input_.points[v] - point).norm();
  placed.valence = valence;
  tellIfFar("valence point", placed);
  result_.placed.push_back(std::move(placed));
}

void Placement::addCurve(vtkIdType source, CurveKind kind, std::vector<Vector3> points)
{
  PlacedConstraint placed;
  placed.kind = kind == CurveKind::Cycle ? ConstraintKind::Cycle : ConstraintKind::Connection;
  placed.source = source;
  placed.path = points;
  if (kind == CurveKind::Cycle)
  {
    if (points.size() > 1 && points.front() == points.back())
    {
      points.pop_back();
    }
    placed.path = points;
    placed.path.push_back(points.front());
  }
  placed.curve = input_.curves.size();
  input_.curves.push_back({ kind, std::move(points) });
  checkCurve(input_.curves.back(), static_cast<std::size_t>(source));
  result_.placed.push_back(std::move(placed));
}

PlacedConstraints Placement::finish()
{
  for (const auto& [polygon, bits] : features_)
  {
    surface_.curveMarks.push_back({ polygon, bits });
  }
  addFeatureMarks(input_, surface_.curveMarks);
  std::vector<GuideMark> marks;
  for (const auto& [polygon, stroke] : strokes_)
  {
    marks.push_back({ polygon, stroke.direction, stroke.weight });
  }
  addGuideMarks(input_, marks);
  return std::move(result_);
}

//------------------------------------------------------------------------------
// The inputs

bool hasLines(vtkPolyData* data)
{
  return data && data->GetNumberOfLines() > 0;
}

bool hasPoints(vtkPolyData* data)
{
  return data && data->GetNumberOfPoints() > 0;
}

/// What a line of the curves is, by the array. What cannot be honoured must not pass for done.
ConstraintKind kindOf(vtkDataArray* types, vtkIdType cell)
{
  const double type = types ? types->GetComponent(cell, 0) : 0;
  if (type == 0 || type == 1)
  {
    return type == 0 ? ConstraintKind::Feature : ConstraintKind::Stroke;
  }
  if (type != 2 && type != 3)
  {
    refuse("curve ", cell, " has ", arrays::kConstraintType, " ", type,
      ", but only 0 (feature curve), 1 (guiding stroke), 2 (connection) and 3 (cycle) can be asked "
      "for: correct the array, or use the inputs Feature Curves and Guiding Strokes without it");
  }
  return type == 2 ? ConstraintKind::Connection : ConstraintKind::Cycle;
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

void addCurves(vtkPolyData* curves, double strokeWeight, Placement& placement)
{
  vtkDataArray* types = curves->GetCellData()->GetArray(arrays::kConstraintType);
  vtkDataArray* weights = curves->GetCellData()->GetArray(arrays::kGuidingWeight);
  for (const Polyline& line : readLines(curves, "feature curve"))
  {
    switch (kindOf(types, line.cell))
    {
      case ConstraintKind::Stroke:
        placement.addStroke(line, weightOf(weights, line.cell, strokeWeight));
        break;
      case ConstraintKind::Connection:
        placement.addCurve(line.cell, CurveKind::Connection, line.points);
        break;
      case ConstraintKind::Cycle:
        placement.addCurve(line.cell, CurveKind::Cycle, line.points);
        break;
      default:
        placement.addFeature(line);
    }
  }
}

void addCurves(vtkPolyData* data, CurveKind kind, Placement& placement)
{
  for (const Polyline& line : hasLines(data)
      ? readLines(data, kind == CurveKind::Cycle ? "cycle" : "connection")
      : std::vector<Polyline>{})
  {
    placement.addCurve(line.cell, kind, line.points);
  }
}

/// Joins the two points of each value of ConnectId but 0.
void addConnections(vtkPolyData* data, const char* what, Placement& placement)
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

void addStrokes(vtkPolyData* strokes, double strokeWeight, Placement& placement)
{
  vtkDataArray* weights = strokes->GetCellData()->GetArray(arrays::kGuidingWeight);
  for (const Polyline& line : readLines(strokes, "guiding stroke"))
  {
    placement.addStroke(line, weightOf(weights, line.cell, strokeWeight));
  }
}

void addPoints(vtkPolyData* points, int valence, Placement& placement)
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
    placement.addValence(i, p, static_cast<int>(value));
  }
}

/// What of an input is not used.
void tellUnused(vtkPolyData* data, const char* name, std::vector<std::string>& notices)
{
  if (data && data->GetNumberOfPoints() > 0 && data->GetNumberOfLines() == 0)
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

GuidedPolygon guidedPolygon(
  const SurfaceInput& input, Index polygon, const Vector3& direction, double weight)
{
  const Index begin = input.polygonOffsets[polygon];
  const Index end = input.polygonOffsets[polygon + 1];
  const auto corner = [&](Index i) { return input.points[input.polygonPoints[i]]; };
  GuidedPolygon guided;
  guided.polygon = polygon;
  guided.weight = weight;
  Vector3 normal = Vector3::Zero(); // twice as long as the area is large
  for (Index i = begin; i < end; ++i)
  {
    guided.centre += corner(i) / static_cast<double>(end - begin);
    normal +=
      (corner(i) - corner(begin)).cross(corner(i + 1 < end ? i + 1 : begin) - corner(begin));
  }
  guided.area = 0.5 * normal.norm();
  guided.normal = normal.stableNormalized();
  const Vector3 along = direction.stableNormalized();
  guided.direction = (along - guided.normal * guided.normal.dot(along)).stableNormalized();
  return guided;
}

const char* nameOf(ConstraintKind kind)
{
  switch (kind)
  {
    case ConstraintKind::Feature:
      return "feature curve";
    case ConstraintKind::Stroke:
      return "guide stroke";
    case ConstraintKind::Valence:
      return "valence";
    case ConstraintKind::Connection:
      return "connection";
    default:
      return "cycle";
  }
}

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
    connects(inputs.surface);
  if (!any || surface.input.polygonPoints.empty())
  {
    return unused;
  }
  Placement placement(surface);
  if (hasLines(inputs.curves))
  {
    addCurves(inputs.curves, inputs.strokeWeight, placement);
  }
  if (hasLines(inputs.strokes))
  {
    addStrokes(inputs.strokes, inputs.strokeWeight, placement);
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
  PlacedConstraints result = placement.finish();
  result.notices.insert(result.notices.begin(), unused.notices.begin(), unused.notices.end());
  return result;
}

} // namespace quadrille
