// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/PlaceText.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace quadrille
{

namespace
{

thread_local PlaceScope* currentPlaceScope = nullptr;
thread_local PlaceFold* currentPlaceFold = nullptr;

/// What a stream takes by default.
constexpr int kLeastDigits = 6;

/// Of places that lie `unit` from each other at most.
int digitsFor(double magnitude, double unit)
{
  if (!(magnitude > unit))
  {
    return kLeastDigits;
  }
  return std::min(std::numeric_limits<double>::max_digits10,
    kLeastDigits + static_cast<int>(std::ceil(std::log10(magnitude / unit))));
}

} // namespace

PlaceScope::PlaceScope(const Vector3& centre, double unit, const Vector3& sign)
  : centre_(centre), unit_(unit), sign_(sign), outer_(currentPlaceScope)
{
  currentPlaceScope = this;
}

PlaceScope::~PlaceScope()
{
  currentPlaceScope = outer_;
}

void PlaceScope::set(const Vector3& centre, double unit, const Vector3& sign)
{
  centre_ = centre;
  unit_ = unit;
  sign_ = sign;
}

PlaceFold::PlaceFold(std::function<Vector3(const Vector3&)> fold)
  : fold_(std::move(fold)), outer_(currentPlaceFold)
{
  currentPlaceFold = this;
}

PlaceFold::~PlaceFold()
{
  currentPlaceFold = outer_;
}

std::string placeText(const Vector3& p)
{
  std::ostringstream text;
  Vector3 place = p;
  if (const PlaceScope* scope = currentPlaceScope)
  {
    place = scope->centre_ + scope->unit_ * scope->sign_.cwiseProduct(p);
    text.precision(digitsFor(scope->centre_.cwiseAbs().maxCoeff(), scope->unit_));
  }
  if (currentPlaceFold != nullptr)
  {
    place = currentPlaceFold->fold_(place);
  }
  const double least = kLastDigits * place.cwiseAbs().maxCoeff();
  place = place.unaryExpr([least](double x) { return std::abs(x) < least ? 0.0 : x; });
  text << "(" << place.x() << ", " << place.y() << ", " << place.z() << ")";
  return text.str();
}

} // namespace quadrille
