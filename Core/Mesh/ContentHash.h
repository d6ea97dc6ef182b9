// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

#include <cstddef>
#include <cstdint>

namespace quadrille
{

struct SurfaceInput;

/// 64 bits over positions, connectivity and features; the same for any number of threads. It tells
/// whether two meshes are the same, and is no defence against a forger.
std::uint64_t contentHash(const Mesh& mesh, int threads);

/// The same over what the prepared surface depends on, but for guides and target valences, which it only carries along.
std::uint64_t contentHash(const SurfaceInput& input, int threads);

/// Of the points and polygons of an input: 64 bits for each array.
struct GeometryHash
{
  std::uint64_t points = 0;
  std::uint64_t polygonOffsets = 0;
  std::uint64_t polygonPoints = 0;
  std::uint64_t faceOrder = 0;
  std::uint64_t precision = 0;
};
GeometryHash geometryHash(const SurfaceInput& input, int threads);
/// That of an input with these points and polygons; of the one given the other arrays count alone.
std::uint64_t contentHash(const GeometryHash& geometry, const SurfaceInput& input, int threads);

/// The same over bytes, with their number.
std::uint64_t contentHash(const void* bytes, std::size_t count, int threads);
/// Of two hashes in this order.
std::uint64_t combineHashes(std::uint64_t first, std::uint64_t second);

} // namespace quadrille
