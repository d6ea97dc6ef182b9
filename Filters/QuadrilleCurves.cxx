// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleCurves.h"

#include "Base/Error.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStaticPointLocator.h>

#include <algorithm>
#include <map>
#include <queue>
#include <sstream>
#include <unordered_map>

namespace quadrille
{

namespace
{

constexpr const char* kConstraintType = "ConstraintType";
/// A path may be this many times longer than needed rather than leave the segment by its own length.
constexpr double kDetourPenalty = 10;
/// A curve point farther from the surface than this part of the surface's bounding-box diagonal is worth a notice.
constexpr double kFarAway = 0.05;

struct EdgeUse
{
  Index target = 0;
  Index polygon = 0;
  std::uint8_t bit = 0;
};

/// Edges of the polygons by their start, both directions: CSR.
struct EdgeGraph
{
  std::vector<std::size_t> first;
  std::vector<EdgeUse> uses;
};

template <class Visit>
void forEachEdge(const SurfaceInput& input, Visit visit)
{
  for (std::size_t p = 0; p + 1 < input.polygonOffsets.size(); ++p)
  {
    const Index begin = input.polygonOffsets[p];
    const Index corners = input.polygonOffsets[p + 1] - begin;
    for (Index i = 0; i < corners && i < 8; ++i) // eight bits a polygon
    {
      visit(static_cast<Index>(p), i, input.polygonPoints[begin + i],
        input.polygonPoints[begin + (i + 1) % corners]);
    }
  }
}

EdgeGraph makeGraph(const SurfaceInput& input)
{
  EdgeGraph graph;
  graph.first.assign(input.points.size() + 2, 0);
  forEachEdge(input,
    [&](Index, Index, Index a, Index b)
    {
      ++graph.first[a + 2];
      ++graph.first[b + 2];
    });
  for (std::size_t i = 2; i < graph.first.size(); ++i)
  {
    graph.first[i] += graph.first[i - 1];
  }
  graph.uses.resize(graph.first.back());
  forEachEdge(input,
    [&](Index p, Index i, Index a, Index b)
    {
      const auto bit = static_cast<std::uint8_t>(1 << i);
      graph.uses[graph.first[a + 1]++] = { b, p, bit };
      graph.uses[graph.first[b + 1]++] = { a, p, bit };
    });
  return graph;
}

double distanceToSegment(const Vector3& p, const Vector3& a, const Vector3& b)
{
  const Vector3 d = b - a;
  const double length2 = d.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0;
  return (p - (a + t * d)).norm();
}

/// Dijkstra from a to b; edges cost more the farther they are from the straight segment. Empty: no path.
std::vector<Index> findPath(const SurfaceInput& input, const EdgeGraph& graph, Index a, Index b)
{
  struct Reached
  {
    double cost;
    Index from;
  };
  using Entry = std::pair<double, Index>;
  std::unordered_map<Index, Reached> reached; // only looked up, so its order does not matter
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  const Vector3& start = input.points[a];
  const Vector3& end = input.points[b];
  const double scale = kDetourPenalty / std::max((end - start).norm(), 1e-300);
  reached[a] = { 0, a };
  front.push({ 0, a });
  while (!front.empty() && front.top().second != b)
  {
    const auto [cost, v] = front.top();
    front.pop();
    if (cost > reached[v].cost)
    {
      continue;
    }
    for (std::size_t i = graph.first[v]; i < graph.first[v + 1]; ++i)
    {
      const Index w = graph.uses[i].target;
      const Vector3& p = input.points[v];
      const Vector3& q = input.points[w];
      const double away = distanceToSegment(0.5 * (p + q), start, end);
      const double next = cost + (q - p).norm() * (1 + scale * away);
      const auto found = reached.find(w);
      if (found == reached.end() || next < found->second.cost)
      {
        reached[w] = { next, v };
        front.push({ next, w });
      }
    }
  }
  std::vector<Index> path;
  if (!front.empty())
  {
    for (Index v = b; v != a; v = reached[v].from)
    {
      path.push_back(v);
    }
    path.push_back(a);
  }
  return path;
}

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

constexpr double kFeatureCurve = 0;
constexpr double kGuidingStroke = 1;

/// What cannot be honoured must not pass for done.
void checkTypes(vtkPolyData* curves)
{
  vtkDataArray* types = curves->GetCellData()->GetArray(kConstraintType);
  for (vtkIdType i = 0; types && i < curves->GetNumberOfLines(); ++i)
  {
    const vtkIdType cell = curves->GetNumberOfVerts() + i;
    const double type = types->GetTuple1(cell);
    if (type != kFeatureCurve && type != kGuidingStroke)
    {
      std::ostringstream text;
      text << "curve " << cell << " has " << kConstraintType << " " << type
           << "; this version supports only types 0 (feature curve) and 1 (guiding stroke)";
      throw InvalidInput(text.str());
    }
  }
}

/// Nearest points that polygons use: an isolated one would be nobody's edge.
class Snapper
{
public:
  Snapper(const SurfaceInput& input, vtkPolyData* data)
  {
    std::vector<char> used(input.points.size(), 0);
    for (const Index p : input.polygonPoints)
    {
      used[p] = 1;
    }
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (std::size_t i = 0; i < used.size(); ++i)
    {
      if (used[i])
      {
        points->InsertNextPoint(data->GetPoint(static_cast<vtkIdType>(i)));
        id_.push_back(static_cast<Index>(i));
      }
    }
    data_->SetPoints(points);
    locator_->SetDataSet(data_);
    locator_->BuildLocator();
  }
  Index nearest(const Vector3& p) const
  {
    return id_[static_cast<std::size_t>(locator_->FindClosestPoint(p.data()))];
  }

private:
  vtkNew<vtkPolyData> data_;
  vtkNew<vtkStaticPointLocator> locator_;
  std::vector<Index> id_;
};

/// The polygons on both sides of the path take the direction of the segment that it follows.
void guidePath(const EdgeGraph& graph, const std::vector<Index>& path, const Vector3& direction,
  std::map<Index, Vector3>& guides)
{
  for (std::size_t k = 0; k + 1 < path.size(); ++k)
  {
    for (std::size_t i = graph.first[path[k]]; i < graph.first[path[k] + 1]; ++i)
    {
      if (graph.uses[i].target == path[k + 1])
      {
        guides[graph.uses[i].polygon] = direction;
      }
    }
  }
}

std::string farAwayNotice(vtkIdType curve, double distance)
{
  std::ostringstream text;
  text << "curve " << curve << " runs up to " << distance
       << " away from the nearest surface points that it was projected to";
  return text.str();
}

} // namespace

std::vector<std::string> applyCurves(
  ConvertedSurface& surface, vtkPolyData* surfaceData, vtkPolyData* curves)
{
  std::vector<std::string> notices;
  if (curves->GetNumberOfVerts() + curves->GetNumberOfPolys() + curves->GetNumberOfStrips() > 0)
  {
    notices.push_back("cells of the curves input that are no lines are not used");
  }
  if (curves->GetNumberOfLines() == 0 || surface.input.polygonPoints.empty())
  {
    return notices;
  }
  checkTypes(curves);
  const EdgeGraph graph = makeGraph(surface.input);
  const Snapper snapper(surface.input, surfaceData);
  std::map<Index, std::uint8_t> marks;
  std::map<Index, Vector3> guides;
  vtkDataArray* types = curves->GetCellData()->GetArray(kConstraintType);
  vtkIdType curve = curves->GetNumberOfVerts();
  auto lines = vtk::TakeSmartPointer(curves->GetLines()->NewIterator());
  for (lines->GoToFirstCell(); !lines->IsDoneWithTraversal(); lines->GoToNextCell(), ++curve)
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    lines->GetCurrentCell(count, ids);
    double farthest = 0;
    Index previous = kInvalidIndex;
    Vector3 before = Vector3::Zero();
    for (vtkIdType i = 0; i < count; ++i)
    {
      Vector3 p;
      curves->GetPoint(ids[i], p.data());
      if (!p.allFinite())
      {
        throw InvalidInput("curve " + std::to_string(curve) + " has a point that is not finite");
      }
      const Index v = snapper.nearest(p);
      farthest = std::max(farthest, (surface.input.points[v] - p).norm());
      if (i > 0 && v != previous)
      {
        const std::vector<Index> path = findPath(surface.input, graph, previous, v);
        if (path.empty())
        {
          throw InvalidInput("curve " + std::to_string(curve) +
            ": no path of edges leads from surface point " + std::to_string(previous) + " to " +
            std::to_string(v) +
            "; they lie on different components, or coincident points are not merged");
        }
        if (types && types->GetTuple1(curve) == kGuidingStroke)
        {
          guidePath(graph, path, (p - before).stableNormalized(), guides);
        }
        else
        {
          markPath(graph, path, marks);
        }
        before = p;
      }
      if (i == 0)
      {
        before = p;
      }
      previous = v;
    }
    if (farthest > kFarAway * surfaceData->GetLength())
    {
      notices.push_back(farAwayNotice(curve, farthest));
    }
  }
  for (const auto& [polygon, bits] : marks)
  {
    surface.curveMarks.push_back({ polygon, bits });
  }
  addFeatureMarks(surface.input, surface.curveMarks);
  std::vector<GuideMark> strokes;
  for (const auto& [polygon, direction] : guides)
  {
    strokes.push_back({ polygon, direction });
  }
  addGuideMarks(surface.input, strokes);
  return notices;
}

} // namespace quadrille
