// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/FieldTopology.h"

#include "Base/Angles.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

/// Where two corners of a face lie in one place, no direction gives their angles; they still have to add up to half a
/// turn, or the turns counted round a vertex would not be those of the matchings. Such a face counts as the limit of an
/// isosceles one, and a face in one point as equilateral.
void closeAngles(FieldTopology& topology, Index f)
{
  const auto isShort = [&](Index h) { return !(topology.edgeLength[h] > 0); };
  const Index first = 3 * f;
  for (Index h = first; h < first + 3; ++h)
  {
    if (isShort(first) && isShort(first + 1) && isShort(first + 2))
    {
      topology.cornerAngle[h] = kPi / 3;
    }
    else if (isShort(h))
    {
      topology.cornerAngle[h] = topology.cornerAngle[Mesh::next(h)] = kPi / 2;
      topology.cornerAngle[Mesh::previous(h)] = 0;
    }
  }
}

/// In the metric of the sizes: angles at corners, lengths and areas without their least value.
void measureSizedFaces(const Mesh& mesh, FieldTopology& topology)
{
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const SizedTriangle triangle = sizedTriangle(mesh, f);
    const std::array<Vector2, 3> p{ Vector2(0, 0), Vector2(triangle.width, 0), triangle.apex };
    for (std::size_t i = 0; i < 3; ++i)
    {
      const Vector2 out = p[(i + 1) % 3] - p[i];
      const Vector2 in = p[(i + 2) % 3] - p[i];
      topology.cornerAngle[3 * f + i] =
        std::atan2(std::abs(out.x() * in.y() - out.y() * in.x()), out.dot(in));
      topology.edgeLength[3 * f + i] = sizedLength(mesh, 3 * f + static_cast<Index>(i));
    }
    topology.area[f] = 0.5 * triangle.width * triangle.apex.y();
  }
}

void measureFaces(const Mesh& mesh, FieldTopology& topology)
{
  const Index halfEdges = mesh.halfEdgeCount();
  topology.direction.resize(halfEdges);
  topology.cornerAngle.resize(halfEdges);
  topology.edgeLength.resize(halfEdges);
  topology.area.resize(mesh.faceCount());
  double lengthSum = 0;
  if (!mesh.sizing.empty())
  {
    measureSizedFaces(mesh, topology);
  }
  for (Index h = 0; h < halfEdges; ++h)
  {
    if (mesh.sizing.empty())
    {
      const Vector3 out = mesh.edgeVector(h);
      topology.edgeLength[h] = out.norm();
      topology.cornerAngle[h] = angleBetween(out, -mesh.edgeVector(Mesh::previous(h)));
    }
    lengthSum += topology.edgeLength[h];
  }
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    closeAngles(topology, f);
  }
  topology.meanEdgeLength = halfEdges > 0 ? lengthSum / halfEdges : 0;
  // A face without area still needs a mass; a millionth of a typical one leaves others untouched.
  const double smallest = 1e-6 * topology.meanEdgeLength * topology.meanEdgeLength;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Index h = 3 * f;
    topology.direction[h] = 0;
    topology.direction[h + 1] = kPi - topology.cornerAngle[h + 1];
    topology.direction[h + 2] = kPi + topology.cornerAngle[h];
    const double area = mesh.sizing.empty()
      ? 0.5 * mesh.edgeVector(h).cross(mesh.edgeVector(h + 1)).norm()
      : topology.area[f];
    topology.area[f] = std::max(area, smallest);
    topology.totalArea += topology.area[f];
  }
}

void measureEdges(const Mesh& mesh, FieldTopology& topology)
{
  const Index halfEdges = mesh.halfEdgeCount();
  topology.transport.assign(halfEdges, 0.0);
  topology.edgeWeight.assign(halfEdges, 0.0);
  for (Index h = 0; h < halfEdges; ++h)
  {
    const Index twin = mesh.twin[h];
    if (twin == kInvalidIndex || twin < h)
    {
      continue;
    }
    topology.transport[h] = wrapAngle(topology.direction[twin] + kPi - topology.direction[h]);
    topology.transport[twin] = -topology.transport[h];
    if (mesh.isConstrained(h))
    {
      continue;
    }
    topology.edges.push_back({ h, twin });
    // Length over the distance of the barycentres; unlike cotangents it is positive for any triangle.
    const double length = topology.edgeLength[h];
    const double areas = topology.area[Mesh::face(h)] + topology.area[Mesh::face(twin)];
    const double weight = std::max(kRounding, 1.5 * length * length / areas);
    topology.edgeWeight[h] = topology.edgeWeight[twin] = weight;
  }
}

// Walks counterclockwise from corner `first` until a constrained half-edge, or round the vertex.
Fan walkFan(const Mesh& mesh, FieldTopology& topology, Index first)
{
  Fan fan;
  fan.vertex = mesh.origin[first];
  fan.first = first;
  fan.sector = mesh.isConstrained(first);
  const Index id = static_cast<Index>(topology.fans.size());
  Index h = first;
  while (true)
  {
    topology.fanOfCorner[h] = id;
    fan.last = h;
    fan.angle += topology.cornerAngle[h];
    ++fan.corners;
    if (mesh.isConstrained(Mesh::previous(h)))
    {
      return fan;
    }
    h = mesh.rotateCounterclockwise(h);
    if (h == first)
    {
      return fan;
    }
  }
}

void buildFans(const Mesh& mesh, FieldTopology& topology)
{
  topology.fanOfCorner.assign(mesh.halfEdgeCount(), kInvalidIndex);
  // Sectors first: they start at constrained half-edges. What is left are whole rings.
  for (const bool sectors : { true, false })
  {
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      if (topology.fanOfCorner[h] == kInvalidIndex && (!sectors || mesh.isConstrained(h)))
      {
        topology.fans.push_back(walkFan(mesh, topology, h));
      }
    }
  }
}

} // namespace

double wrapAngle(double x)
{
  return x - 2 * kPi * std::ceil((x - kPi) / (2 * kPi));
}

int constrainedEdges(const Mesh& mesh, Index f)
{
  int count = 0;
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    count += mesh.isConstrained(h) ? 1 : 0;
  }
  return count;
}

std::vector<Index> regionsOf(const Mesh& mesh)
{
  DisjointSets sets = joinedFaces(mesh, 1, [&](Index h) { return !mesh.isFeature(h); });
  std::vector<Index> region(mesh.faceCount());
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    region[f] = sets.find(f);
  }
  return region;
}

FieldTopology buildFieldTopology(const Mesh& mesh)
{
  FieldTopology topology;
  measureFaces(mesh, topology);
  measureEdges(mesh, topology);
  buildFans(mesh, topology);
  return topology;
}

} // namespace quadrille
