// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Values of the arrays by which a user asks for something, each with the words that refuse it. All throw InvalidInput.
#pragma once

#include "Base/Types.h"

#include <cstdint>

namespace quadrille
{

/// The direction of a guide has to be finite.
void requireDirection(std::int64_t cell, const Vector3& direction);
/// The weight of a guide has to be above 0 and at most 1.
void requireGuideWeight(std::int64_t cell, double weight);
/// A target valence has to be 0, or one that quads can have.
void requireValence(std::int64_t point, const Vector3& place, double valence);
/// A size has to be positive and finite, also in single precision, which it is returned in.
float requireSize(std::int64_t point, double size);

} // namespace quadrille
