// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/Certificate.h"

#include "Base/ChartRotation.h"
#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "GridMap/MapCheck.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>

namespace quadrille
{
namespace
{

using FaceValue = std::pair<Int128, Index>;

/// What one chunk of faces adds to the certificate.
struct Partial
{
  Certificate counts;
  Int128 area = 0;                ///< sum of determinants
  std::vector<FaceValue> worst;   ///< smallest determinants, ascending
  std::vector<Index> offIntegers; ///< vertices, some of them several times
};

void insertWorst(std::vector<FaceValue>& worst, const FaceValue& value)
{
  if (worst.size() == kWorstFaces && !(value < worst.back()))
  {
    return;
  }
  worst.insert(std::upper_bound(worst.begin(), worst.end(), value), value);
  if (worst.size() > kWorstFaces)
  {
    worst.pop_back();
  }
}

/// The rotation that brings `from` nearest to `to`, for images that agree under none.
int nearestRotation(FixedVec2 from, FixedVec2 to)
{
  const auto dot = [&](int r)
  {
    const FixedVec2 d = rotate(from, r);
    return Int128{ d.u } * to.u + Int128{ d.v } * to.v;
  };
  int best = 0;
  for (int r = 1; r < 4; ++r)
  {
    if (dot(r) > dot(best))
    {
      best = r;
    }
  }
  return best;
}

void checkSeam(const Mesh& mesh, const std::vector<FixedVec2>& uv, Index h, Certificate& counts)
{
  const Index g = mesh.twin[h];
  const FixedVec2 shift = uv[Mesh::next(g)] - uv[h];
  if (shift == uv[g] - uv[Mesh::next(h)] && uv[g] != uv[Mesh::next(g)])
  {
    // Nearly all edges: a translation.
    counts.fractionalTransitions += isInteger(shift) ? 0 : 1;
    return;
  }
  bool residual = false;
  const Transition transition = transitionOf(mesh, uv, h, 0, &residual);
  counts.seamResiduals += residual ? 1 : 0;
  bool whole = isInteger(transition.translation);
  if (uv[g] == uv[Mesh::next(g)])
  {
    // The image is a point, which any rotation carries over.
    for (int r = 1; r < 4; ++r)
    {
      whole = whole || isInteger(uv[Mesh::next(g)] - rotate(uv[h], r));
    }
  }
  counts.fractionalTransitions += whole ? 0 : 1;
}

void checkConstraint(FixedVec2 a, FixedVec2 b, Certificate& counts)
{
  const bool alongU = a.v == b.v;
  const bool alongV = a.u == b.u;
  counts.offAxes += alongU || alongV ? 0 : 1;
  const bool whole = (alongU && isInteger(a.v)) || (alongV && isInteger(a.u));
  counts.offIsolines += whole ? 0 : 1;
}

void checkEdge(const Mesh& mesh, const std::vector<FixedVec2>& uv, Index h, Certificate& counts)
{
  const Index g = mesh.twin[h];
  if (g != kInvalidIndex && h < g)
  {
    checkSeam(mesh, uv, h, counts);
  }
  if (mesh.isConstrained(h) && (g == kInvalidIndex || h < g))
  {
    checkConstraint(uv[h], uv[Mesh::next(h)], counts);
  }
}

/// Checks faces [begin, end); entered: #H, quadrants entered in each corner.
void checkFaces(const Mesh& mesh, const std::vector<FixedVec2>& uv,
  const std::vector<std::uint8_t>& integerVertex, Index begin, Index end,
  std::vector<std::int8_t>& entered, Partial& result)
{
  for (Index f = begin; f < end; ++f)
  {
    const FixedVec2* p = &uv[3 * f];
    const Int128 det = determinant(p[0], p[1], p[2]);
    result.area += det;
    result.counts.notPositive += det > 0 ? 0 : 1;
    insertWorst(result.worst, { det, f });
    const std::array<std::int8_t, 3> turns = quadrantsEnteredByAll(p, (det > 0) - (det < 0));
    std::copy(turns.begin(), turns.end(), entered.begin() + 3 * f);
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      checkEdge(mesh, uv, h, result.counts);
      if (integerVertex[mesh.origin[h]] != 0 && !isInteger(uv[h]))
      {
        result.offIntegers.push_back(mesh.origin[h]);
      }
    }
  }
}

void checkTurns(const Mesh& mesh, const std::vector<std::int8_t>& entered,
  const std::vector<int>& expectedTurns, Certificate& result)
{
  const std::vector<int> turns = sumTurns(mesh, [&](Index h) { return entered[h]; });
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    pollNowAndThen(v);
    result.wrongTurns += turns[v] == expectedTurns[v] ? 0 : 1;
  }
}

void merge(const std::vector<Partial>& partials, Certificate& result)
{
  Int128 area = 0;
  std::vector<FaceValue> worst;
  std::vector<Index> offIntegers;
  for (const Partial& partial : partials)
  {
    result.notPositive += partial.counts.notPositive;
    result.seamResiduals += partial.counts.seamResiduals;
    result.offAxes += partial.counts.offAxes;
    result.offIsolines += partial.counts.offIsolines;
    result.fractionalTransitions += partial.counts.fractionalTransitions;
    area += partial.area;
    for (const FaceValue& value : partial.worst)
    {
      insertWorst(worst, value);
    }
    append(offIntegers, partial.offIntegers);
  }
  sortUnique(offIntegers);
  result.offIntegers = offIntegers.size();
  result.area = std::ldexp(static_cast<double>(area), -2 * kFractionBits - 1);
  for (const FaceValue& value : worst)
  {
    result.worstFaces.push_back(value.second);
  }
  if (!worst.empty())
  {
    result.minimumDeterminant = std::ldexp(static_cast<double>(worst[0].first), -2 * kFractionBits);
  }
}

void checkSizes(const Mesh& mesh, std::size_t uv, std::size_t turns, std::size_t integers)
{
  refuseIf(
    uv != mesh.origin.size() || turns != mesh.position.size() || integers != mesh.position.size(),
    "certificate: map, turns or flags do not have the size of the mesh");
}

} // namespace

std::string Certificate::text() const
{
  std::ostringstream out;
  out << triangles << " triangles, " << notPositive << " not positive, " << wrongTurns
      << " wrong turns, " << seamResiduals << " seam residuals, " << offAxes << " off axes, "
      << offIsolines << " off isolines, " << offIntegers << " off integers, "
      << fractionalTransitions << " fractional transitions, min det " << minimumDeterminant
      << ", area " << area;
  return out.str();
}

Transition transitionOf(
  const Mesh& mesh, const std::vector<FixedVec2>& uv, Index h, int fallbackRotation, bool* residual)
{
  const Index g = mesh.twin[h];
  refuseIf(g == kInvalidIndex, "half-edge ", h, " lies on the boundary and has no transition");
  const FixedVec2 from = uv[Mesh::next(h)] - uv[h];
  const FixedVec2 to = uv[g] - uv[Mesh::next(g)];
  Transition result;
  const std::optional<int> rotation = rotationBetween(from, to);
  if (rotation)
  {
    result.rotation = *rotation;
  }
  else
  {
    result.rotation =
      from == FixedVec2{} || to == FixedVec2{} ? fallbackRotation & 3 : nearestRotation(from, to);
  }
  result.translation = uv[Mesh::next(g)] - rotate(uv[h], result.rotation);
  if (residual)
  {
    *residual = !rotation && from != to;
  }
  return result;
}

std::vector<std::int8_t> matchingOf(const Mesh& mesh, const std::vector<FixedVec2>& uv, int threads)
{
  std::vector<std::int8_t> matching(mesh.halfEdgeCount(), 0);
  parallelForEach<Index>(mesh.halfEdgeCount(), 1 << 16, threads,
    [&](Index h)
    {
      if (!mesh.isBoundary(h))
      {
        matching[h] = static_cast<std::int8_t>(transitionOf(mesh, uv, h).rotation);
      }
    });
  return matching;
}

Certificate certify(const Mesh& mesh, const std::vector<FixedVec2>& uv,
  const std::vector<int>& expectedTurns, const std::vector<std::uint8_t>& integerVertex,
  int threads)
{
  checkSizes(mesh, uv.size(), expectedTurns.size(), integerVertex.size());
  Certificate result;
  result.triangles = mesh.faceCount();
  std::vector<std::int8_t> entered(mesh.halfEdgeCount(), 0);
  const std::vector<Partial> partials =
    parallelParts<Partial>(mesh.faceCount(), kMediumChunk, threads,
      [&](std::size_t begin, std::size_t end, Partial& partial)
      {
        checkFaces(mesh, uv, integerVertex, static_cast<Index>(begin), static_cast<Index>(end),
          entered, partial);
      });
  merge(partials, result);
  checkTurns(mesh, entered, expectedTurns, result);
  return result;
}

} // namespace quadrille
