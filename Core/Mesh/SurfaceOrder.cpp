// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/SpaceFillingOrder.h"

#include "Base/LargeArray.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Mesh/Buckets.h"
#include "Mesh/PointSets.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace quadrille
{

namespace
{

/// Buckets of vertices by which faces are sorted.
constexpr std::size_t kVertexBuckets = 2048;

/// Rearranges arrays through one buffer, which keeps its memory from one array to the next.
class Permuter
{
public:
  explicit Permuter(int threads) : threads_(threads) {}

  /// values[i] = old values[order[i]], kWidth values an element. Empty arrays stay empty.
  template <std::size_t kWidth, typename T>
  void operator()(std::vector<T>& values, const std::vector<Index>& order)
  {
    if (values.empty())
    {
      return;
    }
    constexpr std::size_t kBytes = kWidth * sizeof(T);
    const std::size_t bytes = values.size() * sizeof(T);
    reserveLarge(buffer_, bytes, threads_);
    growLarge(buffer_, std::max(buffer_.size(), bytes));
    parallelFor(bytes, kBytes * kLightChunk, threads_,
      [&](std::size_t begin, std::size_t end)
      { std::memcpy(&buffer_[begin], bytesOf(values) + begin, end - begin); });
    values.resize(order.size() * kWidth);
    parallelForEach(order.size(), kLightChunk, threads_,
      [&](std::size_t i) {
        std::memcpy(
          bytesOf(values) + i * kBytes, &buffer_[std::size_t{ order[i] } * kBytes], kBytes);
      });
  }

  template <std::size_t kWidth, typename T>
  void operator()(SharedArray<T>& values, const std::vector<Index>& order)
  {
    values.change([&](std::vector<T>& own) { this->operator()<kWidth>(own, order); });
  }

private:
  template <typename T>
  static char* bytesOf(std::vector<T>& values)
  {
    return reinterpret_cast<char*>(values.data());
  }

  int threads_;
  std::vector<char> buffer_;
};

bool isRemoved(const Mesh& mesh, Index f)
{
  return mesh.origin[3 * f] == kInvalidIndex;
}

/// Drops the vertices without a face; returns the old ids of the others, or nothing when all stay.
std::vector<Index> dropUnused(Mesh& mesh, int threads)
{
  const UsedPoints used(mesh.origin, mesh.vertexCount(), threads);
  std::vector<Index> kept;
  if (used.hasAll(threads))
  {
    return kept;
  }
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    pollNowAndThen(v);
    if (used.has(v))
    {
      mesh.position.edit()[kept.size()] = mesh.position[v];
      if (!mesh.sizing.empty())
      {
        mesh.sizing.edit()[kept.size()] = mesh.sizing[v];
      }
      kept.push_back(v);
    }
  }
  mesh.position.resize(kept.size());
  mesh.sizing.resize(mesh.sizing.empty() ? 0 : kept.size());
  return kept;
}

/// newId: of each element; kInvalidIndex for those that go. Elements behind the names have none.
void orderNames(const std::vector<Index>& newId, std::size_t count, std::vector<Index>& names)
{
  names.resize(newId.size(), kInvalidIndex);
  std::vector<Index> ordered(count);
  for (std::size_t i = 0; i < newId.size(); ++i)
  {
    pollNowAndThen(i);
    if (newId[i] != kInvalidIndex)
    {
      ordered[newId[i]] = names[i];
    }
  }
  names.swap(ordered);
}

template <typename NewId>
void renameRequests(PreparedSurface& surface, const NewId& newId)
{
  for (ValenceRequest& request : surface.valenceRequests)
  {
    request.vertex = newId(request.vertex);
  }
  sortByVertex(surface.valenceRequests);
  for (SectorRequest& request : surface.sectorRequests)
  {
    request.vertex = newId(request.vertex);
  }
  sortByVertex(surface.sectorRequests);
}

/// Puts the vertices that have a face into curve order and renames the corners.
void orderVertices(PreparedSurface& surface, Permuter& permute, int threads)
{
  Mesh& mesh = surface.mesh;
  std::vector<Index> newId(mesh.vertexCount(), kInvalidIndex);
  const std::vector<Index> kept = dropUnused(mesh, threads);
  {
    const std::vector<Index> order = spaceFillingOrder(mesh.position, threads);
    permute.operator()<1>(mesh.position, order);
    if (!mesh.sizing.empty())
    {
      permute.operator()<1>(mesh.sizing, order);
    }
    parallelForEach(order.size(), kLightChunk, threads,
      [&](std::size_t i)
      { newId[kept.empty() ? order[i] : kept[order[i]]] = static_cast<Index>(i); });
    if (!surface.vertexBefore.empty())
    {
      orderNames(newId, order.size(), surface.vertexBefore);
    }
  }
  Index* origin = mesh.origin.edit();
  parallelForEach(mesh.origin.size(), kLightChunk, threads,
    [&](std::size_t h)
    { origin[h] = origin[h] == kInvalidIndex ? kInvalidIndex : newId[origin[h]]; });
  renameRequests(surface, [&](Index v) { return newId[v]; });
}

/// A face under the name of its lowest vertex.
struct FaceByLowest
{
  Index lowest;
  Index face;
};

/// Sorts the faces of a bucket, whose lowest vertices are in [first, first + width), by these; ties keep their order.
void sortFaceBucket(
  const FaceByLowest* faces, std::size_t count, Index first, std::size_t width, Index* order)
{
  std::vector<Index> begin(width + 1, 0);
  for (std::size_t i = 0; i < count; ++i)
  {
    ++begin[faces[i].lowest - first + 1];
  }
  for (std::size_t v = 1; v <= width; ++v)
  {
    begin[v] += begin[v - 1];
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    order[begin[faces[i].lowest - first]++] = faces[i].face;
  }
}

/// Faces that are left, by their lowest vertex; ties keep their order. First into buckets of vertices, then each bucket
/// by itself.
std::vector<Index> facesByLowestVertex(const Mesh& mesh, int threads)
{
  const auto lowest = [&mesh](std::size_t f) {
    return std::min({ mesh.origin[3 * f], mesh.origin[3 * f + 1], mesh.origin[3 * f + 2] });
  };
  const std::size_t width = mesh.vertexCount() / kVertexBuckets + 1;
  const auto faces = sortIntoBuckets<kVertexBuckets, FaceByLowest>(
    mesh.faceCount(), threads,
    [&](std::size_t f)
    { return isRemoved(mesh, static_cast<Index>(f)) ? kVertexBuckets : lowest(f) / width; },
    [&](std::size_t f) {
      return FaceByLowest{ lowest(f), static_cast<Index>(f) };
    });
  std::vector<Index> order;
  growLarge(order, faces.items.size());
  parallelForEach(kVertexBuckets, 16, threads,
    [&](std::size_t b)
    {
      sortFaceBucket(faces.items.data() + faces.begin[b], faces.begin[b + 1] - faces.begin[b],
        static_cast<Index>(b * width), width, order.data() + faces.begin[b]);
    });
  return order;
}

/// Keeps of the corner weights what a face still uses, in the order of the faces.
void orderWeights(PreparedSurface& surface)
{
  std::vector<std::array<std::array<double, 3>, 3>> weights;
  std::vector<FlippedFace> flipped;
  Index* entry = surface.refinedEntry.edit();
  for (std::size_t f = 0; f < surface.refinedEntry.size(); ++f)
  {
    if (entry[f] != kInvalidIndex)
    {
      weights.push_back(surface.cornerWeights[entry[f]]);
      if (!surface.flipped.empty())
      {
        flipped.push_back(surface.flipped[entry[f]]);
      }
      entry[f] = static_cast<Index>(weights.size() - 1);
    }
  }
  surface.cornerWeights = std::move(weights);
  surface.flipped = std::move(flipped);
}

void orderTwins(Mesh& mesh, const std::vector<Index>& order, Permuter& permute)
{
  if (mesh.twin.empty())
  {
    return;
  }
  std::vector<Index> newFace(mesh.faceCount(), kInvalidIndex);
  for (Index i = 0; i < order.size(); ++i)
  {
    pollNowAndThen(i);
    newFace[order[i]] = i;
  }
  permute.operator()<3>(mesh.twin, order);
  Index* twin = mesh.twin.edit();
  for (std::size_t h = 0; h < mesh.twin.size(); ++h)
  {
    pollNowAndThen(h);
    Index& g = twin[h];
    g = g == kInvalidIndex ? kInvalidIndex : 3 * newFace[g / 3] + g % 3;
  }
}

void orderFaces(PreparedSurface& surface, Permuter& permute, int threads)
{
  Mesh& mesh = surface.mesh;
  const std::vector<Index> order = facesByLowestVertex(mesh, threads);
  orderTwins(mesh, order, permute);
  permute.operator()<3>(mesh.origin, order);
  permute.operator()<3>(mesh.flags, order);
  permute.operator()<1>(surface.sourcePolygon, order);
  permute.operator()<1>(surface.sourcePoints, order);
  permute.operator()<1>(surface.refinedEntry, order);
  orderWeights(surface);
}

} // namespace

void orderSurface(PreparedSurface& surface, int threads)
{
  Permuter permute(threads);
  orderVertices(surface, permute, threads);
  orderFaces(surface, permute, threads);
}

} // namespace quadrille
