// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The faces of a part as a surface of its own.
#pragma once

#include "Assembly/FaceParts.h"
#include "Pipeline/Pipeline.h"

#include <cstddef>

namespace quadrille
{

void writePartSurface(
  const CutSource& source, const FaceParts& faceParts, std::size_t part, RemeshResult& to);

} // namespace quadrille
