// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Sizing.h"

#include "Base/Error.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Mesh/Surface.h"
#include "Mesh/Topology.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <queue>
#include <sstream>
#include <utility>

namespace quadrille
{

namespace
{

/// Least height of a sized triangle over that of the face, with the mean size: the change of its shape that a map can
/// follow.
constexpr double kLeastHeightLeft = 0.3;
/// Sizes in a triangle differ by at most this factor when its integral is taken from the middles of its edges: 0.1 %
/// then.
constexpr double kSmoothRatio = 1.3;
constexpr int kMostSplits = 12;
/// A change of sizes by more than this factor is told.
constexpr double kToldChange = 1.5;

/// The mean of 1 / size^2 over a triangle with these sizes at its corners.
double meanDensity(double a, double b, double c, int splits)
{
  const double ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
  if (splits == 0 || std::max({ a, b, c }) <= kSmoothRatio * std::min({ a, b, c }))
  {
    return (1 / (ab * ab) + 1 / (bc * bc) + 1 / (ca * ca)) / 3;
  }
  return (meanDensity(a, ab, ca, splits - 1) + meanDensity(ab, b, bc, splits - 1) +
           meanDensity(ca, bc, c, splits - 1) + meanDensity(ab, bc, ca, splits - 1)) /
    4;
}

/// The size that the user asked for at a corner.
double askedAt(const SurfaceInput& input, const PreparedSurface& surface, Index h)
{
  const SourceLocation source = surface.locate(Mesh::face(h), cornerWeight(h));
  double size = 0;
  for (std::size_t k = 0; k < 3; ++k)
  {
    // Where a weight is 0, nothing but the other sizes may show.
    size +=
      source.weights[k] != 0 ? source.weights[k] * double{ input.sizing[source.points[k]] } : 0;
  }
  return size;
}

} // namespace

SizedTriangle sizedTriangle(const Mesh& mesh, Index f)
{
  const Vector3 a = mesh.edgeVector(3 * f);
  const Vector3 b = -mesh.edgeVector(3 * f + 2);
  SizedTriangle result;
  result.width = a.norm();
  result.apex = Vector2(a.dot(b), a.cross(b).norm()) / std::max(result.width, 1e-300);
  if (mesh.sizing.empty())
  {
    return result;
  }
  const double mean = std::cbrt(sizeAt(mesh, mesh.origin[3 * f]) *
    sizeAt(mesh, mesh.origin[3 * f + 1]) * sizeAt(mesh, mesh.origin[3 * f + 2]));
  result.width /= mean;
  result.apex /= mean;
  const double l0 = sizedLength(mesh, 3 * f);
  const double l1 = sizedLength(mesh, 3 * f + 1);
  const double l2 = sizedLength(mesh, 3 * f + 2);
  const double along = (l0 * l0 + l2 * l2 - l1 * l1) / (2 * l0);
  const double height = std::sqrt(std::max(l2 * l2 - along * along, 0.0));
  // Comparisons with NaN, of edges without length, are false.
  if (height * l0 > kLeastHeightLeft * result.apex.y() * result.width)
  {
    result.width = l0;
    result.apex = Vector2(along, height);
  }
  return result;
}

double sizedArea(const Mesh& mesh, Index f)
{
  const double area = mesh.faceArea(f);
  return mesh.sizing.empty() ? area
                             : area *
      meanDensity(sizeAt(mesh, mesh.origin[3 * f]), sizeAt(mesh, mesh.origin[3 * f + 1]),
        sizeAt(mesh, mesh.origin[3 * f + 2]), kMostSplits);
}

double sizedArea(const Mesh& mesh)
{
  double area = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    area += sizedArea(mesh, f);
  }
  return area;
}

void checkSizing(const SurfaceInput& input)
{
  refuseIf(!input.sizing.empty() && input.sizing.size() != input.points.size(),
    "the array of sizes has ", input.sizing.size(), " values for ", input.points.size(),
    " points: give one value each, or none.");
  for (std::size_t i = 0; i < input.sizing.size(); ++i)
  {
    pollNowAndThen(i);
    const float size = input.sizing[i];
    if (!(size > 0) || !std::isfinite(size))
    {
      std::ostringstream text;
      text << "the size of point " << i << " is " << size
           << ", but must be positive and finite: 1 leaves the quads there as they are, 0.5 makes "
              "their edges half as long.";
      throw InvalidInput(text.str());
    }
  }
}

void collectSizing(const SurfaceInput& input, PreparedSurface& surface)
{
  if (input.sizing.empty())
  {
    return;
  }
  Mesh& mesh = surface.mesh;
  mesh.sizing.assign(mesh.vertexCount(), std::numeric_limits<float>::infinity());
  float* const sizing = mesh.sizing.edit();
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    float& size = sizing[mesh.origin[h]];
    size = std::min(size, static_cast<float>(askedAt(input, surface, h)));
  }
}

SizingReport limitSizeGrowth(Mesh& mesh, double edgeLength)
{
  refuseIf(!(edgeLength > 0) || !std::isfinite(edgeLength),
    "the edge length that sizes are multiples of must be positive and finite.");
  SizingReport report;
  if (mesh.sizing.empty())
  {
    return report;
  }
  // Smallest first: a size that has come from the queue is final.
  using Entry = std::pair<float, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const std::vector<Index> outgoing = outgoingHalfEdges(mesh);
  const std::vector<float> asked = mesh.sizing;
  const auto mostAt = [&](Index w, float size, Index v)
  {
    const double distance = (mesh.position[w] - mesh.position[v]).norm() / edgeLength;
    return static_cast<float>(double{ size } + kSizeGrowth * distance);
  };
  // Only from where a neighbour is too large: what comes out does not depend on the order.
  std::vector<std::uint8_t> isStart(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    const Index a = mesh.origin[h], b = mesh.target(h);
    const Index v = mesh.sizing[a] <= mesh.sizing[b] ? a : b;
    const Index w = v == a ? b : a;
    if (mesh.sizing[v] < mesh.sizing[w] && mostAt(w, mesh.sizing[v], v) < mesh.sizing[w])
    {
      isStart[v] = 1;
    }
  }
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    if (isStart[v] != 0)
    {
      queue.push({ mesh.sizing[v], v });
    }
  }
  for (std::size_t steps = 0; !queue.empty(); ++steps)
  {
    pollNowAndThen(steps);
    const auto [size, v] = queue.top();
    queue.pop();
    if (size != mesh.sizing[v] || outgoing[v] == kInvalidIndex)
    {
      continue;
    }
    const auto reach = [&, size = size, v = v](Index w)
    {
      const float most = mostAt(w, size, v);
      if (most < mesh.sizing[w])
      {
        mesh.sizing.edit()[w] = most;
        queue.push({ most, w });
      }
    };
    forEachInFan(mesh, outgoing[v],
      [&](Index h)
      {
        reach(mesh.target(h));
        reach(mesh.origin[Mesh::previous(h)]);
      });
  }
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    const double factor = double{ asked[v] } / double{ mesh.sizing[v] };
    report.changed += mesh.sizing[v] != asked[v] ? 1 : 0;
    if (factor > report.most)
    {
      report.most = factor;
      report.vertex = v;
    }
  }
  return report;
}

std::string sizingNotice(const Mesh& mesh, const SizingReport& report)
{
  if (!(report.most > kToldChange))
  {
    return {};
  }
  std::ostringstream text;
  text << "sizes were made smaller at " << report.changed << " of " << mesh.vertexCount()
       << " vertices so that they grow gradually, most by a factor of " << report.most << " near "
       << placeText(mesh.position[report.vertex]);
  return text.str();
}

} // namespace quadrille
