// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Which elements of a surface are still those that it had before some places of it were changed.
#pragma once

#include "Base/Types.h"

#include <numeric>
#include <vector>

namespace quadrille
{

struct NamesBefore
{
  Index vertices = 0, faces = 0; ///< numbers of them before
  std::vector<Index> vertex;     ///< #V; the id before; kInvalidIndex for a vertex made since
  std::vector<Index> face;       ///< #F; the same

  /// Of a surface that has not been changed yet.
  static NamesBefore of(Index vertices, Index faces)
  {
    NamesBefore names{ vertices, faces, std::vector<Index>(vertices), std::vector<Index>(faces) };
    std::iota(names.vertex.begin(), names.vertex.end(), Index{ 0 });
    std::iota(names.face.begin(), names.face.end(), Index{ 0 });
    return names;
  }
};

} // namespace quadrille
