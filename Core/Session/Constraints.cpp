// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/Constraints.h"

#include "Base/Refuse.h"
#include "Symmetry/Symmetry.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

/// One function for each kind.
template <class... Functions>
struct ByKind : Functions...
{
  using Functions::operator()...;
};
template <class... Functions>
ByKind(Functions...) -> ByKind<Functions...>;

/// Checks of one constraint, by the name that messages have.
class ConstraintCheck
{
public:
  ConstraintCheck(const std::string& name, std::size_t polygonCount)
    : name_(name), polygonCount_(polygonCount)
  {
  }

  void operator()(const FeatureLine& line) const { requirePoints(line.points, 2); }
  void operator()(const ClearedAt& at) const { requirePoints({ at.point }, 1); }
  void operator()(const GuideStroke& stroke) const
  {
    requirePoints(stroke.points, 2);
    requireWeight(stroke.weight);
    requireLength("radius", stroke.radius);
  }
  void operator()(const GuideRegion& region) const
  {
    requireIds(region.polygons);
    if (!region.direction.allFinite() || region.direction.isZero(0))
    {
      refuse(name_, " needs a direction that is finite and not zero");
    }
    requireWeight(region.weight);
  }
  void operator()(const ValenceAt& at) const
  {
    requirePoints({ at.point }, 1);
    requireValence(at.valence);
  }
  void operator()(const SizeAt& at) const
  {
    requirePoints({ at.point }, 1);
    requireLength("radius", at.radius);
    requireFactor(at.factor);
  }
  void operator()(const SizeRegion& region) const
  {
    requireIds(region.polygons);
    requireFactor(region.factor);
  }
  void operator()(const IrregularEdit& edit) const
  {
    const bool may3 = edit.operation == IrregularOperation::Merge;
    const std::size_t count = edit.operation == IrregularOperation::Split ? 3 : 2;
    requirePoints(edit.points, count);
    if (edit.points.size() > count + (may3 ? 1 : 0))
    {
      refuse(name_, " has ", edit.points.size(), " points, but its operation takes ", count);
    }
    const bool takesValences =
      edit.operation == IrregularOperation::Split || edit.operation == IrregularOperation::Add;
    if (!edit.valences.empty() && (!takesValences || edit.valences.size() != 2))
    {
      refuse(name_, " has ", edit.valences.size(), " valences, but its operation takes ",
        takesValences ? "two, or none" : "none");
    }
    std::for_each(edit.valences.begin(), edit.valences.end(), [this](int v) { requireValence(v); });
  }
  void operator()(const Connection& connection) const { requirePoints(connection.points, 2); }
  void operator()(const Cycle& cycle) const { requirePoints(cycle.points, 3); }
  void operator()(const MirrorSymmetry& symmetry) const
  {
    if (symmetry.plane)
    {
      requirePoints({ symmetry.plane->origin }, 1);
      requireDirection(symmetry.plane->normal, "normal", "plane");
    }
  }
  void operator()(const RotationalSymmetry& rotation) const
  {
    if (rotation.order < kLeastOrder || rotation.order > kMostOrder)
    {
      refuse(name_, " has the order ", rotation.order, ", but needs one of ", kLeastOrder, " to ",
        kMostOrder);
    }
    if (rotation.axis)
    {
      requirePoints({ rotation.axis->origin }, 1);
      requireDirection(rotation.axis->direction, "direction", "axis");
    }
  }

private:
  void requirePoints(const std::vector<Vector3>& points, std::size_t least) const
  {
    if (points.size() < least)
    {
      refuse(name_, " has ", points.size(), " points, but needs at least ", least);
    }
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      if (!points[i].allFinite())
      {
        refuse("point ", i, " of ", name_, " is not finite: place it anew");
      }
    }
  }
  void requireDirection(const Vector3& direction, const char* what, const char* of) const
  {
    const double length = direction.stableNorm();
    if (!(length > 0 && std::isfinite(length)))
    {
      refuse(
        name_, " needs a ", what, " that is finite and not zero, or no ", of, ": then it is found");
    }
  }
  void requireIds(const std::vector<Index>& polygons) const
  {
    if (polygons.empty())
    {
      refuse(name_, " names no polygon");
    }
    for (const Index polygon : polygons)
    {
      if (polygon >= polygonCount_)
      {
        refuse(name_, " names polygon ", polygon, ", but there are only ", polygonCount_);
      }
    }
  }
  void requireWeight(double weight) const
  {
    if (!(weight > 0 && weight <= 1))
    {
      refuse(name_, " has the weight ", weight, ", but it must be above 0 and at most 1");
    }
  }
  void requireLength(const char* what, double length) const
  {
    if (!(length >= 0 && std::isfinite(length)))
    {
      refuse(name_, " has the ", what, " ", length, ", but it must be 0 or a positive number");
    }
  }
  void requireFactor(double factor) const
  {
    if (!(factor > 0 && std::isfinite(static_cast<float>(factor)) &&
          static_cast<float>(factor) > 0))
    {
      refuse(name_, " has the factor ", factor, ", but it must be a positive number");
    }
  }
  void requireValence(int valence) const
  {
    if (valence < kLeastValence || valence > kMostValence)
    {
      refuse(name_, " asks for valence ", valence, ", but only ", kLeastValence, " to ",
        kMostValence, " can be asked for");
    }
  }

  const std::string& name_;
  std::size_t polygonCount_;
};

} // namespace

const char* kindOf(const ConstraintContent& content)
{
  constexpr const char* kConstraintKinds[] = { "feature", "guide", "guide region", "valence",
    "size", "size region", "irregular", "connection", "cycle", "symmetry", "rotation",
    "cleared feature" };
  static_assert(std::variant_size_v<ConstraintContent> == std::size(kConstraintKinds));
  return kConstraintKinds[content.index()];
}

std::vector<Vector3> pointsOf(const ConstraintContent& content)
{
  using Points = std::vector<Vector3>;
  return std::visit(
    ByKind{ [](const ValenceAt& at) { return Points{ at.point }; },
      [](const SizeAt& at) { return Points{ at.point }; },
      [](const ClearedAt& at) { return Points{ at.point }; },
      [](const GuideRegion&) { return Points{}; }, [](const SizeRegion&) { return Points{}; },
      [](const MirrorSymmetry&) { return Points{}; },
      [](const RotationalSymmetry&) { return Points{}; },
      [](const auto& line) { return line.points; } },
    content);
}

std::optional<Vector3> placeOf(const ConstraintContent& content)
{
  const std::vector<Vector3> points = pointsOf(content);
  const auto* mirror = std::get_if<MirrorSymmetry>(&content);
  const auto* rotation = std::get_if<RotationalSymmetry>(&content);
  return !points.empty()         ? std::optional<Vector3>(points.front())
    : mirror && mirror->plane    ? std::optional<Vector3>(mirror->plane->origin)
    : rotation && rotation->axis ? std::optional<Vector3>(rotation->axis->origin)
                                 : std::nullopt;
}

void checkConstraint(
  const ConstraintContent& content, const std::string& name, std::size_t polygonCount)
{
  std::visit(ConstraintCheck(name, polygonCount), content);
}

} // namespace quadrille
