// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/ContentHash.h"

#include "Base/Parallel.h"
#include "Mesh/Surface.h"

#include <algorithm>
#include <cstring>

namespace quadrille
{

namespace
{

constexpr std::size_t kChunkBytes = std::size_t{ 1 } << 20;

/// One step of a multiply and fold hash; the constant is 2^64 over the golden ratio, made odd.
std::uint64_t mix(std::uint64_t hash, std::uint64_t word)
{
  hash = (hash ^ word) * 0x9E3779B97F4A7C15ull;
  return hash ^ hash >> 32;
}

std::uint64_t hashBytes(const unsigned char* bytes, std::size_t count)
{
  std::uint64_t hash = mix(0, count);
  for (std::size_t i = 0; i < count; i += sizeof(std::uint64_t))
  {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + i, std::min(sizeof(word), count - i));
    hash = mix(hash, word);
  }
  return hash;
}

template <typename Array>
std::uint64_t hashVector(const Array& values, int threads)
{
  return contentHash(values.data(), values.size() * sizeof(typename Array::value_type), threads);
}

} // namespace

/// Hashes chunks of fixed size on their own, then the hashes.
std::uint64_t contentHash(const void* bytes, std::size_t count, int threads)
{
  const auto* first = static_cast<const unsigned char*>(bytes);
  const auto parts = parallelParts<std::uint64_t>(count, kChunkBytes, threads,
    [&](std::size_t begin, std::size_t end, std::uint64_t& part)
    { part = hashBytes(first + begin, end - begin); });
  std::uint64_t hash = mix(0, count);
  for (const std::uint64_t part : parts)
  {
    hash = mix(hash, part);
  }
  return hash;
}

std::uint64_t combineHashes(std::uint64_t first, std::uint64_t second)
{
  return mix(first, second);
}

std::uint64_t contentHash(const Mesh& mesh, int threads)
{
  std::uint64_t hash = hashVector(mesh.position, threads);
  hash = mix(hash, hashVector(mesh.origin, threads));
  hash = mix(hash, hashVector(mesh.twin, threads));
  return mix(hash, hashVector(mesh.flags, threads));
}

GeometryHash geometryHash(const SurfaceInput& input, int threads)
{
  return { hashVector(input.points, threads), hashVector(input.polygonOffsets, threads),
    hashVector(input.polygonPoints, threads), static_cast<std::uint64_t>(input.faceOrder),
    hashVector(std::vector<double>{ input.precision }, 1) };
}

std::uint64_t contentHash(const SurfaceInput& input, int threads)
{
  return contentHash(geometryHash(input, threads), input, threads);
}

std::uint64_t contentHash(const GeometryHash& geometry, const SurfaceInput& input, int threads)
{
  // By name, so that an array that is new has to be looked at here. What is asked for has keys of its own, and with it
  // what is drawn and the orders of its sizes.
  [[maybe_unused]] const auto& [points, polygonOffsets, polygonPoints, featureEdges, patchIds,
    isDesigned, detectedFeatures, guideDirections, guideWeights, guideOrders, targetValences,
    sizing, sizingOrders, curvatures, drawn, curves, regularElsewhere, held, regularOnFeatures,
    withoutMap, seams, straight, faceOrder, precision] = input;
  std::uint64_t hash = mix(geometry.points, geometry.polygonOffsets);
  hash = mix(hash, geometry.polygonPoints);
  hash = mix(hash, hashVector(featureEdges, threads));
  hash = mix(hash, hashVector(patchIds, threads));
  hash = isDesigned ? mix(hash, 2) : hash;
  hash = mix(hash, hashVector(detectedFeatures, threads));
  hash = mix(hash, hashVector(sizing, threads));
  hash = curvatures.empty() ? hash : mix(hash, hashVector(curvatures, threads));
  return mix(mix(hash, geometry.faceOrder), geometry.precision);
}

} // namespace quadrille
