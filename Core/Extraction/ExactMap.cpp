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

void note(MapCheck& check, MapDefect kind, Index face)
{
  ++check.count[kind];
  std::vector<Index>& named = check.faces[kind];
  if (named.size() < kMostTold && (named.empty() || named.back() != face))
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
  const bool onU = e.v == 0 && isInteger(map.at(h).v);
  const bool onV = e.u == 0 && isInteger(map.at(h).u);
  if (!onU && !onV)
  {
    note(check, kOffIsoline, Mesh::face(h));
  }
  check.constrainedLength += toDouble(std::abs(e.u) + std::abs(e.v));
}

void checkRange(const ExactMap& map, Index begin, Index end, MapCheck& check)
{
  for (Index f = begin; f < end; ++f)
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      if (!inRange(map.at(h)))
      {
        check.outOfRange = std::min(check.outOfRange, h);
      }
    }
    if (check.outOfRange != kInvalidIndex)
    {
      return;
    }
    checkFace(map, f, check);
  }
}

void checkTransitions(const ExactMap& map, Index begin, Index end, MapCheck& check)
{
  for (Index h = 3 * begin; h < 3 * end; ++h)
  {
    const Index g = map.mesh.twin[h];
    if (g != kInvalidIndex && g > h)
    {
      checkTransition(map, h, check);
    }
  }
}

void checkCurves(const ExactMap& map, Index begin, Index end, MapCheck& check)
{
  for (Index h = 3 * begin; h < 3 * end; ++h)
  {
    if (map.mesh.isConstrained(h))
    {
      const Index g = map.mesh.twin[h];
      if (g == kInvalidIndex || g > h)
      {
        checkConstrained(map, h, check);
      }
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
      if (into.faces[kind].size() < kMostTold)
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
MapCheck overFaces(Index faces, int threads, const Body& body)
{
  MapCheck whole;
  for (const MapCheck& part : parallelParts<MapCheck>(faces, kLightChunk, threads, body))
  {
    merge(whole, part);
  }
  return whole;
}

} // namespace

MapCheck checkMap(const ExactMap& map, bool isCertified, int threads)
{
  const Index faces = map.mesh.faceCount();
  MapCheck whole = overFaces(faces, threads,
    [&](Index begin, Index end, MapCheck& part) { checkRange(map, begin, end, part); });
  if (whole.outOfRange == kInvalidIndex)
  {
    merge(whole,
      overFaces(faces, threads,
        [&](Index begin, Index end, MapCheck& part)
        {
          if (!isCertified)
          {
            checkTransitions(map, begin, end, part);
          }
          checkCurves(map, begin, end, part);
        }));
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
    std::string list;
    for (const Index f : faces[kind])
    {
      list += (list.empty() ? "" : ", ") + std::to_string(f);
    }
    result += " (faces " + list + (count[kind] > faces[kind].size() ? ", ...)" : ")");
  }
  return result;
}

} // namespace quadrille
