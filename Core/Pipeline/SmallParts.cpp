// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/SmallParts.h"

#include "Base/PlaceText.h"

#include <cmath>
#include <sstream>

namespace quadrille
{
namespace
{

/// Handles with loops below so many edge lengths are sure to be among the places where quads meet themselves.
constexpr double kHopelessLoop = 2;

void collectHandles(
  const HandleReport& found, const Level& level, double edgeLength, ShortLoops& loops)
{
  for (const HandleLoop& loop : found.loops)
  {
    const bool hopeless = loop.length < kHopelessLoop * edgeLength;
    HandleLoop onSurface{ {}, loop.length };
    for (const Index v : loop.vertices)
    {
      onSurface.vertices.push_back(level.fineVertex[v]);
      if (hopeless)
      {
        loops.hopelessPlaces.push_back(level.mesh.position[v]);
      }
    }
    loops.loops.push_back(std::move(onSurface));
  }
}

/// Of a loop that is too short: how long, where, and what would resolve it.
void appendLoop(std::ostringstream& text, double length, const Vector3& place, const QuadSize& size)
{
  const double s = size.edgeLength;
  const double factor = kQuadsOfLoop * s / length;
  const double quads = std::ceil(static_cast<double>(size.quads) * factor * factor);
  text << length * size.unit << " = " << length / s << " edge lengths near " << placeText(place)
       << ": ";
  if (quads <= static_cast<double>(size.maximumOfQuads))
  {
    text << "ask for smaller quads (about " << static_cast<std::size_t>(quads)
         << " resolve all) or ";
  }
}

} // namespace

ShortLoops measureSmallParts(const Level& intermediate, const Mesh& finest, double edgeLength)
{
  const double limit = kQuadsOfLoop * edgeLength;
  const Mesh& mesh = intermediate.mesh;
  const HandleReport found = findHandles(mesh, limit);
  ShortLoops loops;
  SmallParts& parts = loops.parts;
  parts.handles = found.handles;
  parts.unresolvedHandles = found.loops.size();
  parts.complete = found.complete;
  collectHandles(found, intermediate, edgeLength, loops);
  if (found.shortest)
  {
    parts.shortestLoop = found.shortest->length;
    for (const Index v : found.shortest->vertices)
    {
      parts.place += mesh.position[v] / static_cast<double>(found.shortest->vertices.size());
    }
  }
  parts.boundary = measureBoundary(finest, limit);
  loops.loops.insert(
    loops.loops.end(), parts.boundary.tooShort.begin(), parts.boundary.tooShort.end());
  return loops;
}

std::string unresolvedHandlesText(const SmallParts& parts, const QuadSize& size)
{
  if (parts.unresolvedHandles == 0)
  {
    return {};
  }
  std::ostringstream text;
  text << (parts.complete ? "" : "at least ") << parts.unresolvedHandles << " of " << parts.handles
       << " handles are shorter round than three quads, the shortest is ";
  appendLoop(text, parts.shortestLoop, parts.place, size);
  text
    << "have them closed (Small Details Simplify, --small-details simplify), or quads there have a "
       "poor shape or fail";
  return text.str();
}

std::string tinyHolesText(const SmallParts& parts, const QuadSize& size)
{
  const BoundaryReport& boundary = parts.boundary;
  if (boundary.shortLoops == 0)
  {
    return {};
  }
  std::ostringstream text;
  text << boundary.shortLoops << " of " << boundary.loops
       << " boundary loops are shorter than three quads, the shortest is ";
  appendLoop(text, boundary.shortest, boundary.place, size);
  text
    << "have these holes filled (Small Details Simplify, --small-details simplify), or quads there "
       "have a poor shape or fail";
  return text.str();
}

} // namespace quadrille
