// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/DrawnConstraints.h"

namespace quadrille
{

const char* nameOf(ConstraintKind kind)
{
  switch (kind)
  {
    case ConstraintKind::Feature:
      return "feature curve";
    case ConstraintKind::Stroke:
      return "guide stroke";
    case ConstraintKind::Valence:
      return "valence";
    case ConstraintKind::Connection:
      return "connection";
    case ConstraintKind::Cleared:
      return "cleared feature";
    case ConstraintKind::Size:
      return "size";
    case ConstraintKind::Move:
      return "move";
    default:
      return "cycle";
  }
}

} // namespace quadrille
