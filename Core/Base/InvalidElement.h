// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Error.h"

#include <cstdint>
#include <string>

namespace quadrille
{

/// Invalid input whose place is a point or cell of the data in which it came, for those who show it.
class InvalidElement : public InvalidInput
{
public:
  enum class Kind
  {
    Point,
    Cell
  };

  InvalidElement(const std::string& text, Kind kind, std::int64_t id)
    : InvalidInput(text), kind_(kind), id_(id)
  {
  }

  Kind kind() const { return kind_; }
  std::int64_t id() const { return id_; }

private:
  Kind kind_;
  std::int64_t id_;
};

} // namespace quadrille
