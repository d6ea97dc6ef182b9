// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/SmallParts.h"

#include "Base/PlaceText.h"
#include "Details/NearLoops.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

namespace quadrille
{
namespace
{

/// Loops of up to so many times the length that decides are measured on the finest mesh.
constexpr double kMostTightened = 2;

/// Decimation moves a loop off the shortest way round a handle, by chance: at the length that decides about a cut the
/// finest mesh has the last word, where it says that the loop is short. loops: of the level, shortest first, before and
/// afterwards. limit: that length.
void tighten(
  std::vector<HandleLoop>& loops, const Level& level, const Mesh& finest, double limit, int threads)
{
  const auto isBelow = [](const HandleLoop& loop, double length) { return loop.length < length; };
  const auto begin = std::lower_bound(loops.begin(), loops.end(), limit, isBelow);
  const auto end = std::lower_bound(begin, loops.end(), kMostTightened * limit, isBelow);
  if (begin == end)
  {
    return;
  }
  std::vector<std::vector<Index>> places;
  std::transform(begin, end, std::back_inserter(places),
    [&](const HandleLoop& loop) { return onFinest(loop.vertices, level); });
  if (const auto lengths = lengthsNear(finest, places, limit, threads))
  {
    for (std::size_t i = 0; i < lengths->size(); ++i)
    {
      HandleLoop& loop = begin[static_cast<std::ptrdiff_t>(i)];
      loop.length = (*lengths)[i] > 0 ? (*lengths)[i] : loop.length;
    }
    std::stable_sort(loops.begin(), loops.end(),
      [](const HandleLoop& a, const HandleLoop& b) { return a.length < b.length; });
  }
}

void collectHandles(const HandleReport& found, const Level& level, ShortLoops& loops)
{
  for (const HandleLoop& loop : found.loops)
  {
    HandleLoop onSurface{ {}, loop.length };
    for (const Index v : loop.vertices)
    {
      onSurface.vertices.push_back(level.fineVertex[v]);
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

ShortLoops measureSmallParts(
  const Level& intermediate, const Mesh& finest, double edgeLength, double smallest, int threads)
{
  const double limit = kQuadsOfLoop * edgeLength;
  const Mesh& mesh = intermediate.mesh;
  HandleReport found = findHandles(mesh, limit);
  tighten(found.loops, intermediate, finest, smallest * edgeLength, threads);
  if (!found.loops.empty())
  {
    found.shortest = found.loops.front();
  }
  ShortLoops loops;
  SmallParts& parts = loops.parts;
  parts.handles = found.handles;
  parts.unresolvedHandles = found.loops.size();
  parts.complete = found.complete;
  collectHandles(found, intermediate, loops);
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
