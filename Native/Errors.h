// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What becomes an exception of Python.
#pragma once

#include <stdexcept>

namespace quadrille::native
{

/// There are no quads, and the message says why: RemeshError. InvalidInput of Core becomes InvalidInput, WriteError
/// OSError.
class RunFailure : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

} // namespace quadrille::native
