// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Error.h"
#include "Base/Types.h"

#include <string>

namespace quadrille
{

/// Invalid input whose place is a polygon of the input, for those who show it.
class InvalidPolygon : public InvalidInput
{
public:
  InvalidPolygon(const std::string& text, Index polygon) : InvalidInput(text), polygon_(polygon) {}

  Index polygon() const { return polygon_; }

private:
  Index polygon_;
};

} // namespace quadrille
