// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/SpaceFillingOrder.h"

#include "Base/Parallel.h"

#include <algorithm>

namespace quadrille
{

namespace
{

/// 2^11 cells an axis: on a surface some 10^7 cells, so ten million vertices are about one a cell.
constexpr int kGridBits = 11;
constexpr std::size_t kChunk = 65536;

struct KeyedPoint
{
  std::uint64_t key;
  Index point;
};

std::vector<KeyedPoint> computeKeys(const std::vector<Vector3>& points, int threads)
{
  Vector3 low = Vector3::Constant(std::numeric_limits<double>::max());
  Vector3 high = -low;
  for (const Vector3& p : points)
  {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double extent = points.empty() ? 0 : (high - low).maxCoeff();
  const double cells = (1 << kGridBits) - 1;
  const double scale = extent > 0 ? cells / extent : 0;

  std::vector<KeyedPoint> keys(points.size());
  parallelFor(points.size(), kChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        std::array<std::uint32_t, 3> cell{};
        for (int k = 0; k < 3; ++k)
        {
          const double x = (points[i][k] - low[k]) * scale;
          cell[k] = static_cast<std::uint32_t>(std::clamp(x, 0.0, cells));
        }
        keys[i] = { hilbertKey(cell, kGridBits), static_cast<Index>(i) };
      }
    });
  return keys;
}

/// Least significant digit first, so that equal keys keep their order.
void radixSort(std::vector<KeyedPoint>& items)
{
  constexpr unsigned kDigitBits = kGridBits;
  constexpr std::size_t kBuckets = std::size_t{ 1 } << kDigitBits;
  std::vector<KeyedPoint> sorted(items.size());
  for (unsigned shift = 0; shift < 3 * kGridBits; shift += kDigitBits)
  {
    std::array<std::size_t, kBuckets + 1> begin{};
    for (const KeyedPoint& item : items)
    {
      ++begin[(item.key >> shift & (kBuckets - 1)) + 1];
    }
    for (std::size_t b = 1; b <= kBuckets; ++b)
    {
      begin[b] += begin[b - 1];
    }
    for (const KeyedPoint& item : items)
    {
      sorted[begin[item.key >> shift & (kBuckets - 1)]++] = item;
    }
    items.swap(sorted);
  }
}

bool isRemoved(const Mesh& mesh, Index f)
{
  return mesh.origin[3 * f] == kInvalidIndex;
}

/// Puts the vertices that have a face into curve order and renames the corners.
void orderVertices(Mesh& mesh, int threads)
{
  std::vector<Index> newId(mesh.vertexCount(), kInvalidIndex);
  for (const Index v : mesh.origin)
  {
    if (v != kInvalidIndex)
    {
      newId[v] = 0;
    }
  }
  std::vector<Index> used;
  std::vector<Vector3> points;
  used.reserve(mesh.vertexCount());
  points.reserve(mesh.vertexCount());
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    if (newId[v] == 0)
    {
      used.push_back(v);
      points.push_back(mesh.position[v]);
    }
  }
  const std::vector<Index> order = spaceFillingOrder(points, threads);
  mesh.position.resize(points.size());
  for (Index i = 0; i < order.size(); ++i)
  {
    mesh.position[i] = points[order[i]];
    newId[used[order[i]]] = i;
  }
  parallelFor(mesh.origin.size(), kChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t h = begin; h < end; ++h)
      {
        mesh.origin[h] = mesh.origin[h] == kInvalidIndex ? kInvalidIndex : newId[mesh.origin[h]];
      }
    });
}

/// Faces that are left, by their lowest vertex; ties keep their order.
std::vector<Index> facesByLowestVertex(const Mesh& mesh)
{
  const auto lowest = [&mesh](Index f) {
    return std::min({ mesh.origin[3 * f], mesh.origin[3 * f + 1], mesh.origin[3 * f + 2] });
  };
  std::vector<Index> begin(std::size_t{ mesh.vertexCount() } + 1, 0);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    if (!isRemoved(mesh, f))
    {
      ++begin[lowest(f) + 1];
    }
  }
  for (std::size_t v = 1; v < begin.size(); ++v)
  {
    begin[v] += begin[v - 1];
  }
  std::vector<Index> order(begin.back());
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    if (!isRemoved(mesh, f))
    {
      order[begin[lowest(f)]++] = f;
    }
  }
  return order;
}

/// values[i] = old values[order[i]], `width` values an element.
template <typename T>
void permute(
  std::vector<T>& values, const std::vector<Index>& order, std::size_t width, int threads)
{
  if (values.empty())
  {
    return;
  }
  std::vector<T> permuted(order.size() * width);
  parallelFor(order.size(), kChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        std::copy_n(values.begin() + order[i] * width, width, permuted.begin() + i * width);
      }
    });
  values.swap(permuted);
}

/// Keeps of the corner weights what a face still uses, in the order of the faces.
void orderWeights(PreparedSurface& surface)
{
  std::vector<std::array<std::array<double, 3>, 3>> weights;
  for (Index& entry : surface.refinedEntry)
  {
    if (entry != kInvalidIndex)
    {
      weights.push_back(surface.cornerWeights[entry]);
      entry = static_cast<Index>(weights.size() - 1);
    }
  }
  surface.cornerWeights.swap(weights);
}

void orderFaces(PreparedSurface& surface, int threads)
{
  Mesh& mesh = surface.mesh;
  const std::vector<Index> order = facesByLowestVertex(mesh);
  std::vector<Index> newFace(mesh.faceCount(), kInvalidIndex);
  for (Index i = 0; i < order.size(); ++i)
  {
    newFace[order[i]] = i;
  }
  permute(mesh.origin, order, 3, threads);
  permute(mesh.flags, order, 3, threads);
  permute(mesh.twin, order, 3, threads);
  for (Index& g : mesh.twin)
  {
    g = g == kInvalidIndex ? kInvalidIndex : 3 * newFace[g / 3] + g % 3;
  }
  permute(surface.sourcePolygon, order, 1, threads);
  permute(surface.sourcePoints, order, 1, threads);
  permute(surface.refinedEntry, order, 1, threads);
  orderWeights(surface);
}

} // namespace

std::uint64_t hilbertKey(std::array<std::uint32_t, 3> cell, int bits)
{
  // Undo the rotations and reflections of the sub-cubes, coarsest first, then Gray code.
  for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1)
  {
    for (std::uint32_t& x : cell)
    {
      if ((x & q) != 0)
      {
        cell[0] ^= q - 1;
      }
      else
      {
        const std::uint32_t t = (cell[0] ^ x) & (q - 1);
        cell[0] ^= t;
        x ^= t;
      }
    }
  }
  cell[1] ^= cell[0];
  cell[2] ^= cell[1];
  std::uint32_t t = 0;
  for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1)
  {
    t ^= (cell[2] & q) != 0 ? q - 1 : 0;
  }
  std::uint64_t key = 0;
  for (int b = bits - 1; b >= 0; --b)
  {
    for (const std::uint32_t x : cell)
    {
      key = key << 1 | ((x ^ t) >> b & 1u);
    }
  }
  return key;
}

std::vector<Index> spaceFillingOrder(const std::vector<Vector3>& points, int threads)
{
  std::vector<KeyedPoint> items = computeKeys(points, threads);
  radixSort(items);
  std::vector<Index> order(items.size());
  std::transform(
    items.begin(), items.end(), order.begin(), [](const KeyedPoint& item) { return item.point; });
  return order;
}

void orderSurface(PreparedSurface& surface, int threads)
{
  orderVertices(surface.mesh, threads);
  orderFaces(surface, threads);
}

} // namespace quadrille
