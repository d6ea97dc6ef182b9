// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/FaceFilling.h"

#include "Base/Angles.h"
#include "Base/Lists.h"
#include "Base/TryCount.h"
#include "Filling/BoundaryFit.h"
#include "Filling/FaceGround.h"
#include "Filling/FaceTriangulation.h"
#include "Filling/QuadCleanUp.h"
#include "Filling/TrianglePairing.h"
#include "Mesh/Topology.h"
#include "Quads/QuadTopology.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace quadrille
{

namespace
{

bool canBeFilled(
  const TopologySummary& topology, const std::vector<std::uint8_t>& isPin, const FaceGround& ground)
{
  const std::vector<std::size_t>& pins = ground.pinsOfLoops();
  const std::size_t sum = std::accumulate(pins.begin(), pins.end(), std::size_t{ 0 });
  const bool hasArea = std::any_of(ground.normals().begin(), ground.normals().end(),
    [](const Vector3& normal) { return !normal.isZero(); });
  const auto asked = std::count(isPin.begin(), isPin.end(), 1);
  return topology.components == 1 && hasArea && static_cast<std::size_t>(asked) == sum &&
    sum >= 4 && sum % 2 == 0 &&
    std::all_of(pins.begin(), pins.end(), [](std::size_t count) { return count >= 3; });
}

/// That are the boundary of a disc; none where their quad would be turned over, as where the disc is a sphere with a
/// small hole.
std::optional<FaceFill> quadOfPins(const Mesh& face, const FaceGround& ground, Index pin)
{
  std::array<Index, 4> quad{};
  std::array<Vector3, 4> corners;
  Vector3 normal = Vector3::Zero();
  for (std::size_t i = 0; i < 4; ++i)
  {
    quad[i] = pin;
    corners[i] = face.position[pin];
    normal += ground.normals()[pin];
    pin = ground.nextPin(pin);
  }
  return quadShape(corners, normal) > 0 ? std::optional<FaceFill>({ {}, {}, {}, { quad } })
                                        : std::nullopt;
}

/// The quads with their own points; ids: of pins, first.
FaceQuads ownPoints(const FaceGround& ground, const FaceTriangles& triangles,
  const std::vector<std::array<Index, 4>>& quads, const std::vector<Index>& pins)
{
  const Mesh& mesh = triangles.surface.mesh;
  std::vector<Index> own(mesh.vertexCount(), kInvalidIndex);
  FaceQuads result;
  result.pinCount = static_cast<Index>(pins.size());
  const auto add = [&](Index v)
  {
    if (own[v] == kInvalidIndex)
    {
      own[v] = static_cast<Index>(result.points.size());
      result.points.push_back(mesh.position[v]);
      result.normals.push_back(triangles.normals[v]);
      result.fitting.push_back(ground.angleAt(v) / kRightAngle);
    }
    return own[v];
  };
  std::for_each(pins.begin(), pins.end(), add);
  for (const std::array<Index, 4>& quad : quads)
  {
    result.quads.push_back({ add(quad[0]), add(quad[1]), add(quad[2]), add(quad[3]) });
  }
  return result;
}

/// Is the boundary the one of the pins, and all else like the face?
bool fillsFace(const FaceQuads& quads, const std::vector<Index>& pins, const FaceGround& ground,
  long long eulerCharacteristic)
{
  const QuadTopology topology = analyzeQuads(quads.quads, quads.points.size());
  // Points that were dropped are isolated.
  const bool isManifold = topology.nonManifoldEdges == 0 && topology.nonManifoldVertices == 0 &&
    topology.degenerateQuads == 0;
  if (!isManifold || topology.eulerCharacteristic != eulerCharacteristic ||
    topology.components != 1)
  {
    return false;
  }
  std::size_t count = 0;
  for (Index h = 0; h < topology.twin.size(); ++h)
  {
    if (topology.twin[h] == kInvalidIndex)
    {
      const Index from = quads.quads[h / 4][h % 4], to = quads.quads[h / 4][(h + 1) % 4];
      if (from >= pins.size() || to >= pins.size() || ground.nextPin(pins[from]) != pins[to])
      {
        return false;
      }
      ++count;
    }
  }
  return count == pins.size();
}

/// Points that were dropped get no id.
FaceFill toFill(const FaceQuads& mesh, const std::vector<Index>& pins, Index vertexCount,
  const FaceGround& ground)
{
  FaceFill fill;
  fill.quads = mesh.quads;
  std::vector<Index> ids = pins;
  ids.resize(mesh.points.size(), kInvalidIndex);
  for (std::array<Index, 4>& quad : fill.quads)
  {
    for (Index& v : quad)
    {
      if (ids[v] == kInvalidIndex)
      {
        const Vector3& p = mesh.points[v];
        const auto facing = ground.at(p, mesh.normals[v], p);
        const FaceGround::Spot spot = facing ? *facing : *ground.at(p, Vector3::Zero(), p);
        ids[v] = vertexCount + static_cast<Index>(fill.points.size());
        fill.points.push_back(spot.point);
        fill.sourceFace.push_back(spot.face);
        fill.sourceWeights.push_back(spot.weights);
      }
      v = ids[v];
    }
  }
  return fill;
}

double meanShape(const FaceQuads& mesh)
{
  double sum = 0;
  for (const std::array<Index, 4>& quad : mesh.quads)
  {
    sum += shapeOfQuad(mesh, quad);
  }
  return sum / static_cast<double>(mesh.quads.size());
}

/// The face with the sizes that its pins ask for.
Mesh withSizes(const Mesh& face, const FaceGround& ground)
{
  Mesh sized = face;
  sized.sizing = std::vector<float>(ground.sizes().begin(), ground.sizes().end());
  return sized;
}

} // namespace

std::optional<FaceFill> fillFace(const Mesh& face, const std::vector<std::uint8_t>& isPin,
  double edgeLength, const QuadsOfFace& quadsOf)
{
  if (!validate(face).empty() || isPin.size() != face.vertexCount() || !(edgeLength > 0))
  {
    return std::nullopt;
  }
  const FaceGround ground(face, isPin, edgeLength);
  const TopologySummary topology = summarizeTopology(face);
  if (!canBeFilled(topology, isPin, ground))
  {
    return std::nullopt;
  }
  const std::vector<Index> pins =
    idsWhere(face.vertexCount(), [&](Index v) { return ground.isPin(v); });
  const bool isQuad = topology.eulerCharacteristic == 1 && pins.size() == 4;
  if (std::optional<FaceFill> one = isQuad ? quadOfPins(face, ground, pins[0]) : std::nullopt)
  {
    return one;
  }
  const auto cleanedUp = [&](FaceQuads quads)
  {
    cleanUpQuads(quads, ground);
    return fillsFace(quads, pins, ground, topology.eulerCharacteristic)
      ? std::optional<FaceQuads>(std::move(quads))
      : std::nullopt;
  };
  FaceTriangles triangles = triangulateFace(face, ground);
  std::optional<FaceQuads> best =
    cleanedUp(ownPoints(ground, triangles, pairTriangles(triangles), pins));
  if (quadsOf)
  {
    countTry(Try::FacesAlone);
    std::optional<FaceQuads> fitting =
      fitBoundary(quadsOf(withSizes(face, ground)), face, ground, pins);
    fitting = fitting ? cleanedUp(std::move(*fitting)) : std::nullopt;
    // Inverted ones are few, and untangled when the quads of all faces are one mesh.
    if (fitting && (!best || meanShape(*fitting) > meanShape(*best)))
    {
      countTryLed(Try::FacesAlone);
      best = std::move(fitting);
    }
  }
  return best ? std::optional<FaceFill>(toFill(*best, pins, face.vertexCount(), ground))
              : std::nullopt;
}

} // namespace quadrille
