// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

namespace quadrille
{

/// 64 bits over positions, connectivity and features; the same for any number of threads. It tells
/// whether two meshes are the same, and is no defence against a forger.
std::uint64_t contentHash(const Mesh& mesh, int threads);

} // namespace quadrille
