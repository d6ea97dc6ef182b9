// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/ExactMap.h"

#include "Base/Lists.h"
#include "Base/Parallel.h"

#include <algorithm>
#include <cstdlib>

namespace quadrille
{
namespace
{

constexpr std::size_t kMapChunk = 1 << 15;
constexpr std::size_t kNamedFaces = 8;
/// Base/FixedPoint.h: differences of coordinates below this have exact determinants.
constexpr std::int64_t kCoordinateLimit = std::int64_t{ 1 } << 44;

void note(MapCheck& check, MapDefect kind, Index face)
{
  ++check.count[kind];
  std::vector<Index>& named = check.faces[kind];
  if (named.size() < kNamedFaces && (named.empty() || named.back() != face))
  {
    named.push_back(face);
  }
}

bool inRange(FixedVec2 p)
{
  return p.u > -kCoordinateLimit && p.u < kCoordinateLimit && p.v > -kCoordinateLimit &&
    p.v < kCoordinateLimit;
}

void checkFace(const ExactMap& map, Index f, MapCheck& check)
{
  const Index h = 3 * f;
  const FixedVec2 a = map.at(h);
  const FixedVec2 b = map.at(h + 1);
  const FixedVec2 c = map.at(h + 2);
  const Int128 det = determinant(a, b, c);
  if (det <= 0)
  {
    note(check, kNotPositive, f);
  }
  constexpr double kUnitArea = static_cast<double>(kOne) * static_cast<double>(kOne);
  check.area += 0.5 * std::abs(static_cast<double>(det)) / kUnitArea;
  const std::int64_t width = std::max({ a.u, b.u, c.u }) - std::min({ a.u, b.u, c.u });
  const std::int64_t height = std::max({ a.v, b.v, c.v }) - std::min({ a.v, b.v, c.v });
  check.extent += toDouble(std::max(width, height));
}

void checkTransition(const ExactMap& map, Index h, MapCheck& check)
{
  Transition t;
  if (map.transition(h, t))
  {
    if (!isInteger(t.translation))
    {
      note(check, kFractional, Mesh::face(h));
    }
  }
  else if (map.edge(h) != -map.edge(map.mesh.twin[h])) // not simply zero on both sides
  {
    note(check, kResidual, Mesh::face(h));
  }
}

void checkConstrained(const ExactMap& map, Index h, MapCheck& check)
{
  const FixedVec2 e = map.edge(h);
  if (!map.isOnIsoline(h))
  {
    note(check, kOffIsoline, Mesh::face(h));
  }
  check.constrainedLength += toDouble(std::abs(e.u) + std::abs(e.v));
}

void checkCorners(const ExactMap& map, Index f, MapCheck& check)
{
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    if (!inRange(map.at(h)))
    {
      check.outOfRange = std::min(check.outOfRange, h);
    }
  }
  if (check.outOfRange == kInvalidIndex)
  {
    checkFace(map, f, check);
  }
}

/// The edges of a face, each by its lower half-edge.
void checkEdges(const ExactMap& map, Index f, bool isCertified, MapCheck& check)
{
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    const bool isInner = !map.mesh.isBoundary(h);
    if (isInner && map.mesh.twin[h] < h)
    {
      continue;
    }
    if (isInner && !isCertified)
    {
      checkTransition(map, h, check);
    }
    if (map.mesh.isConstrained(h))
    {
      checkConstrained(map, h, check);
    }
  }
}

void merge(MapCheck& into, const MapCheck& from)
{
  for (int kind = 0; kind < kMapDefects; ++kind)
  {
    into.count[kind] += from.count[kind];
    for (const Index f : from.faces[kind])
    {
      if (into.faces[kind].size() < kNamedFaces)
      {
        into.faces[kind].push_back(f);
      }
    }
  }
  into.area += from.area;
  into.extent += from.extent;
  into.constrainedLength += from.constrainedLength;
  into.outOfRange = std::min(into.outOfRange, from.outOfRange);
}

/// Runs a check over chunks of faces and merges in the order of the chunks.
template <typename Body>
void overFaces(Index faces, int threads, MapCheck& whole, const Body& body)
{
  for (const MapCheck& part : parallelParts<MapCheck>(faces, kMapChunk, threads,
         [&](std::size_t begin, std::size_t end, MapCheck&check)
         {
           for (std::size_t f = begin; f < end && check.outOfRange == kInvalidIndex; ++f)
           {
             body(static_cast<Index>(f), check);
           }
         }))
  {
    merge(whole, part);
  }
}

} // namespace

MapCheck checkMap(const ExactMap& map, bool isCertified, int threads)
{
  const Index faces = map.mesh.faceCount();
  MapCheck whole;
  overFaces(faces, threads, whole, [&](Index f, MapCheck& part) { checkCorners(map, f, part); });
  if (whole.outOfRange == kInvalidIndex)
  {
    overFaces(faces, threads, whole,
      [&](Index f, MapCheck& part) { checkEdges(map, f, isCertified, part); });
  }
  return whole;
}

std::string MapCheck::text() const
{
  static const char* const kNames[kMapDefects] = { "triangles that are inverted or degenerate",
    "edges whose two images do not match", "transitions that are not whole",
    "feature or boundary edges off the integer isolines" };
  std::string result;
  for (int kind = 0; kind < kMapDefects; ++kind)
  {
    if (count[kind] == 0)
    {
      continue;
    }
    result += (result.empty() ? "" : ", ") + std::to_string(count[kind]) + " " + kNames[kind];
    result += " (faces " +
      joined(faces[kind], kNamedFaces, [](Index f) { return std::to_string(f); }) +
      (count[kind] > faces[kind].size() ? ", ...)" : ")");
  }
  return result;
}

} // namespace quadrille
