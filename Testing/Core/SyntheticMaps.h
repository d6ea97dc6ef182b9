// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Surfaces with an exactly seamless map that needs no solver: polycubes and plates whose coordinates are the map,
/// and tori. Positions and lengths are random from a fixed seed, never whole.
#pragma once

#include "GridMap/GridMap.h"
#include "TestMeshes.h"

#include <algorithm>
#include <random>

namespace quadrille::test
{

struct SyntheticMap
{
  Mesh mesh;
  CrossField field;
  std::vector<FixedVec2> uv;
};

inline FixedVec2 uvVector(const std::vector<FixedVec2>& uv, Index h)
{
  return uv[Mesh::next(h)] - uv[h];
}

/// Quarter turns that take the direction +u to that of an axis-aligned vector.
inline int axisOf(FixedVec2 d)
{
  return d.v == 0 ? (d.u > 0 ? 0 : 2) : (d.v > 0 ? 1 : 3);
}

/// The field that a seamless map follows.
inline CrossField fieldOf(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  CrossField field;
  const Index halfEdges = mesh.halfEdgeCount();
  field.angle.assign(mesh.faceCount(), 0);
  field.matching.assign(halfEdges, 0);
  field.alignment.assign(halfEdges, -1);
  field.sectorTurns.assign(halfEdges, 0);
  std::vector<double> cornerAngle(halfEdges);
  std::vector<double> sum(mesh.vertexCount(), 0);
  for (Index h = 0; h < halfEdges; ++h)
  {
    const Vector2 a = toDouble(uvVector(uv, h)), b = -toDouble(uvVector(uv, Mesh::previous(h)));
    cornerAngle[h] = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
    sum[mesh.origin[h]] += cornerAngle[h];
    if (!mesh.isBoundary(h))
    {
      int r = 0;
      while (r < 3 && uvVector(uv, mesh.twin[h]) != -rotate(uvVector(uv, h), r))
      {
        ++r;
      }
      field.matching[h] = static_cast<std::int8_t>(r);
    }
    if (mesh.isConstrained(h))
    {
      field.alignment[h] = static_cast<std::int8_t>(axisOf(uvVector(uv, h)));
    }
  }
  for (Index h = 0; h < halfEdges; ++h)
  {
    if (!mesh.isConstrained(h))
    {
      continue;
    }
    double angle = 0;
    Index corner = h;
    do
    {
      angle += cornerAngle[corner];
      corner = mesh.isConstrained(Mesh::previous(corner)) ? kInvalidIndex
                                                          : mesh.rotateCounterclockwise(corner);
    } while (corner != kInvalidIndex);
    field.sectorTurns[h] = static_cast<std::int8_t>(std::lround(angle / (kPi / 2)));
  }
  for (const double angle : sum)
  {
    field.turns.push_back(static_cast<int>(std::lround(angle / (kPi / 2))));
  }
  return field;
}

/// Monotone, random coordinates for lattice lines 0..count; lines at multiples of n are n cells apart as a whole.
inline std::vector<double> randomCoordinates(
  int blocks, int n, double blockLength, std::mt19937& random)
{
  std::uniform_real_distribution<double> stretch(0.35, 1.65);
  std::vector<double> x{ 0 };
  for (int b = 0; b < blocks; ++b)
  {
    const double length = blockLength * stretch(random);
    for (int i = 1; i <= n; ++i)
    {
      x.push_back(x[b * n] + length * i / n);
    }
  }
  return x;
}

/// Which of the three coordinates a vertex may change without leaving the planes of its faces.
inline std::vector<std::array<bool, 3>> freeAxes(const Mesh& mesh)
{
  std::vector<std::array<bool, 3>> result(mesh.vertexCount(), { true, true, true });
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3 normal = faceNormal(mesh, Mesh::face(h)).cwiseAbs();
    for (int axis = 0; axis < 3; ++axis)
    {
      result[mesh.origin[h]][axis] = result[mesh.origin[h]][axis] && normal[axis] < 0.5;
    }
    if (mesh.isBoundary(h))
    {
      const Vector3 along = mesh.edgeVector(h).cwiseAbs();
      for (int axis = 0; axis < 3; ++axis)
      {
        if (along[axis] < 1e-9)
        {
          result[mesh.origin[h]][axis] = result[mesh.target(h)][axis] = false;
        }
      }
    }
  }
  return result;
}

/// Warps an axis-aligned lattice surface (lattice lines at multiples of 1/n) to blocks of random lengths about
/// `blockLength` quads, moves vertices inside their planes, and reads the map off the coordinates.
inline SyntheticMap axisAlignedMap(Mesh mesh, int blocks, int n, double blockLength, unsigned seed)
{
  std::mt19937 random(seed);
  std::array<std::vector<double>, 3> lines;
  for (auto& line : lines)
  {
    line = randomCoordinates(blocks, n, blockLength, random);
  }
  const auto free = freeAxes(mesh);
  std::uniform_real_distribution<double> jitter(-0.28, 0.28);
  std::vector<std::array<std::int64_t, 3>> fixed(mesh.vertexCount());
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    Vector3& p = mesh.position.edit()[v];
    for (int axis = 0; axis < 3; ++axis)
    {
      const int line = static_cast<int>(std::lround(p[axis] * n));
      const int last = static_cast<int>(lines[axis].size()) - 1;
      double x = lines[axis][line];
      const double shift = jitter(random);
      if (free[v][axis])
      {
        const int towards = std::clamp(shift > 0 ? line + 1 : line - 1, 0, last);
        x += std::abs(shift) * (lines[axis][towards] - x);
      }
      fixed[v][axis] = toFixed(x);
      p[axis] = toDouble(fixed[v][axis]);
    }
  }
  SyntheticMap map;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3 normal = faceNormal(mesh, Mesh::face(h));
    int axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    const auto& p = fixed[mesh.origin[h]];
    const std::int64_t a = p[(axis + 1) % 3], b = p[(axis + 2) % 3];
    map.uv.push_back(normal[axis] > 0 ? FixedVec2{ a, b } : FixedVec2{ b, a });
  }
  map.field = fieldOf(mesh, map.uv);
  map.mesh = std::move(mesh);
  return map;
}

/// A plate of unit cells (plateL, ...) in blocks of n x n cells.
inline SyntheticMap plateMap(Mesh mesh, int blocks, int n, double blockLength, unsigned seed)
{
  for (Vector3& p : mesh.position.editAll())
  {
    p /= n;
  }
  return axisAlignedMap(std::move(mesh), blocks, n, blockLength, seed);
}

/// Torus whose map has the two periods, in quads; no singularity, no feature.
inline SyntheticMap torusMap(
  int around, int across, Vector2 periodU, Vector2 periodV, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-0.25, 0.25);
  SyntheticMap map;
  map.mesh = torus(around, across);
  std::vector<Vector2> shift(map.mesh.vertexCount());
  for (Vector2& s : shift)
  {
    s = Vector2(jitter(random) / around, jitter(random) / across);
  }
  const FixedVec2 u = toFixed(periodU), v = toFixed(periodV);
  // One cell is two triangles (a, b, c), (a, c, d); see LatticeBuilder.
  constexpr int kCorner[6][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 0 }, { 1, 1 }, { 0, 1 } };
  for (Index h = 0; h < map.mesh.halfEdgeCount(); ++h)
  {
    const int cell = static_cast<int>(h / 6);
    const int i = cell % around + kCorner[h % 6][0], j = cell / around + kCorner[h % 6][1];
    const Vector2 s =
      shift[map.mesh.origin[h]] + Vector2(double(i % around) / around, double(j % across) / across);
    FixedVec2 p = toFixed(Vector2(s.x() * periodU + s.y() * periodV));
    p = i == around ? p + u : p;
    p = j == across ? p + v : p;
    map.uv.push_back(p);
  }
  map.field = fieldOf(map.mesh, map.uv);
  return map;
}

/// Surface of a random staircase of columns: columns x rows blocks of heights 1..levels, features on all edges.
inline SyntheticMap staircaseMap(
  int columns, int rows, int levels, int n, double blockLength, bool features, unsigned seed)
{
  Mesh mesh = voxelSurface({ columns, rows, levels }, n,
    [&](int x, int y, int z) { return z <= (x + y) * (levels - 1) / (columns + rows - 2); });
  if (features)
  {
    mesh = markFeatures(mesh, 0.7);
  }
  return axisAlignedMap(std::move(mesh), std::max({ columns, rows, levels }), n, blockLength, seed);
}

} // namespace quadrille::test
