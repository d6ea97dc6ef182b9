// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Base/Parallel.h"
#include "GridMap/GridMap.h"
#include "GridMap/MapCheck.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace quadrille
{
namespace
{

constexpr std::size_t kWorstFaces = 16;
constexpr std::size_t kChunk = 1 << 14; ///< faces; their uv and twins fit a second level cache

using FaceValue = std::pair<Int128, Index>;

/// What one chunk of faces adds to the certificate.
struct Partial
{
  Certificate counts;
  Int128 area = 0;              ///< sum of determinants
  std::vector<FaceValue> worst; ///< smallest determinants, ascending
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

/// Quarter turns r with R90^r from == to, if any. Zero vectors match every rotation.
bool rotationBetween(FixedVec2 from, FixedVec2 to, int fallback, int& r)
{
  const FixedVec2 zero;
  r = fallback & 3;
  if (from == zero || to == zero)
  {
    return from == to;
  }
  for (r = 0; r < 4; ++r)
  {
    if (rotate(from, r) == to)
    {
      return true;
    }
  }
  return false;
}

/// The rotation that turns `from` nearest to `to`, for images that agree under none.
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

void checkEdge(const Mesh& mesh, const std::vector<FixedVec2>& uv, Index h, Certificate& counts)
{
  const Index g = mesh.twin[h];
  if (g != kInvalidIndex && h < g)
  {
    bool residual = false;
    const Transition transition = transitionOf(mesh, uv, h, 0, &residual);
    counts.seamResiduals += residual ? 1 : 0;
    counts.fractionalTransitions += isInteger(transition.translation) ? 0 : 1;
  }
  if (mesh.isConstrained(h) && (g == kInvalidIndex || h < g))
  {
    const FixedVec2 a = uv[h];
    const FixedVec2 b = uv[Mesh::next(h)];
    const bool alongU = a.v == b.v;
    const bool alongV = a.u == b.u;
    counts.offAxes += alongU || alongV ? 0 : 1;
    const bool whole = (alongU && isInteger(a.v)) || (alongV && isInteger(a.u));
    counts.offIsolines += whole ? 0 : 1;
  }
}

/// Checks faces [begin, end); entered: #H, quadrants entered in each corner.
void checkFaces(const Mesh& mesh, const std::vector<FixedVec2>& uv, Index begin, Index end,
  std::vector<std::int8_t>& entered, Partial& result)
{
  for (Index f = begin; f < end; ++f)
  {
    const FixedVec2* p = &uv[3 * f];
    const Int128 det = determinant(p[0], p[1], p[2]);
    const int sign = (det > 0) - (det < 0);
    result.area += det;
    result.counts.notPositive += sign > 0 ? 0 : 1;
    insertWorst(result.worst, { det, f });
    for (int i = 0; i < 3; ++i)
    {
      const Index h = 3 * f + i;
      entered[h] = static_cast<std::int8_t>(quadrantsEntered(p, i, sign));
      checkEdge(mesh, uv, h, result.counts);
    }
  }
}

/// Seams and features are exact quarter turns, so what the corners of a vertex enter adds up to the
/// quarter turns of the map round it, whatever charts they lie in.
void checkTurns(const Mesh& mesh, const std::vector<std::int8_t>& entered,
  const std::vector<int>& expectedTurns, Certificate& result)
{
  std::vector<int> turns(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    turns[mesh.origin[h]] += entered[h];
  }
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    result.wrongTurns += turns[v] == expectedTurns[v] ? 0 : 1;
  }
}

void checkIntegerVertices(const Mesh& mesh, const std::vector<FixedVec2>& uv,
  const std::vector<std::uint8_t>& integerVertex, Certificate& result)
{
  std::vector<std::uint8_t> off(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Index v = mesh.origin[h];
    if (integerVertex[v] && !isInteger(uv[h]))
    {
      off[v] = 1;
    }
  }
  result.offIntegers = static_cast<std::size_t>(std::count(off.begin(), off.end(), 1));
}

void merge(const std::vector<Partial>& partials, Certificate& result)
{
  Int128 area = 0;
  std::vector<FaceValue> worst;
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
  }
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
  if (uv != mesh.origin.size() || turns != mesh.position.size() || integers != mesh.position.size())
  {
    throw InvalidInput("certificate: map, turns or flags do not have the size of the mesh");
  }
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
  if (g == kInvalidIndex)
  {
    throw InvalidInput(
      "half-edge " + std::to_string(h) + " lies on the boundary and has no transition");
  }
  const FixedVec2 from = uv[Mesh::next(h)] - uv[h];
  const FixedVec2 to = uv[g] - uv[Mesh::next(g)];
  Transition result;
  const bool agree = rotationBetween(from, to, fallbackRotation, result.rotation);
  if (!agree)
  {
    result.rotation =
      from == FixedVec2{} || to == FixedVec2{} ? fallbackRotation & 3 : nearestRotation(from, to);
  }
  result.translation = uv[Mesh::next(g)] - rotate(uv[h], result.rotation);
  if (residual)
  {
    *residual = !agree;
  }
  return result;
}

Certificate certify(const Mesh& mesh, const std::vector<FixedVec2>& uv,
  const std::vector<int>& expectedTurns, const std::vector<std::uint8_t>& integerVertex)
{
  checkSizes(mesh, uv.size(), expectedTurns.size(), integerVertex.size());
  Certificate result;
  result.triangles = mesh.faceCount();
  std::vector<std::int8_t> entered(mesh.halfEdgeCount(), 0);
  std::vector<Partial> partials((mesh.faceCount() + kChunk - 1) / kChunk);
  parallelFor(mesh.faceCount(), kChunk, 0,
    [&](std::size_t begin, std::size_t end)
    {
      checkFaces(mesh, uv, static_cast<Index>(begin), static_cast<Index>(end), entered,
        partials[begin / kChunk]);
    });
  merge(partials, result);
  checkTurns(mesh, entered, expectedTurns, result);
  checkIntegerVertices(mesh, uv, integerVertex, result);
  return result;
}

} // namespace quadrille
