// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// How messages name a place.
#pragma once

#include "Base/Types.h"

#include <functional>
#include <string>

namespace quadrille
{

/// Where a run works in coordinates of its own (see Prepare/Frame.h), messages of the thread that makes the scope name
/// places in those of the user: centre + unit * sign . p. Scopes nest; the innermost one counts.
class PlaceScope
{
public:
  PlaceScope() : PlaceScope(Vector3::Zero(), 1, Vector3::Ones()) {}
  PlaceScope(const Vector3& centre, double unit, const Vector3& sign);
  ~PlaceScope();
  PlaceScope(const PlaceScope&) = delete;
  PlaceScope& operator=(const PlaceScope&) = delete;

  void set(const Vector3& centre, double unit, const Vector3& sign);

private:
  friend std::string placeText(const Vector3& p);

  Vector3 centre_;
  double unit_;
  Vector3 sign_;
  PlaceScope* outer_;
};

/// What was moved before a run, as sheets that must not meet, is named where it was: places in the coordinates of the
/// user go through the function, of this thread and while this lives. The innermost one counts.
class PlaceFold
{
public:
  explicit PlaceFold(std::function<Vector3(const Vector3&)> fold);
  ~PlaceFold();
  PlaceFold(const PlaceFold&) = delete;
  PlaceFold& operator=(const PlaceFold&) = delete;

private:
  friend std::string placeText(const Vector3& p);

  std::function<Vector3(const Vector3&)> fold_;
  PlaceFold* outer_;
};

/// "(x, y, z)", with as many digits as it takes to tell places apart that lie a thousandth of the surface's size from
/// each other.
std::string placeText(const Vector3& p);

} // namespace quadrille
