// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Assembly/JointSheets.h"

#include "Base/DisjointSets.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Requests/SurfacePlaces.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace quadrille
{

namespace
{

/// How far sheets lie apart, over the size of the box round all.
constexpr double kSheetGap = 0.25;

struct PolygonSide
{
  Index low = 0, high = 0; ///< points
  Index polygon = 0, corner = 0;
};

class SheetCutter
{
public:
  SheetCutter(
    const SurfaceInput& joint, std::optional<double> featureAngle, TouchingSheets touching)
    : joint_(joint), featureAngle_(featureAngle), touching_(touching)
  {
  }

  JointSheets cut()
  {
    keepOnce();
    cutUp();
    for (const auto& [begin, end] : joints_)
    {
      sheets_.edges.emplace_back(sides_[begin].low, sides_[begin].high);
    }
    writePoints();
    writePolygons();
    if (featureAngle_)
    {
      askForFeatures();
    }
    moveApart();
    return std::move(sheets_);
  }

private:
  std::vector<Index> cornersOf(Index polygon) const
  {
    return { joint_.polygonPoints.begin() + joint_.polygonOffsets[polygon],
      joint_.polygonPoints.begin() + joint_.polygonOffsets[polygon + 1] };
  }

  /// Polygons with the same corners are one.
  void keepOnce()
  {
    const auto count = static_cast<Index>(joint_.polygonOffsets.size() - 1);
    std::vector<std::pair<std::vector<Index>, Index>> sorted;
    for (Index i = 0; i < count; ++i)
    {
      sorted.emplace_back(cornersOf(i), i);
      std::sort(sorted.back().first.begin(), sorted.back().first.end());
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<Index> first(count);
    for (Index i = 0; i < count; ++i)
    {
      const bool isSame = i > 0 && sorted[i].first == sorted[i - 1].first;
      first[sorted[i].second] = isSame ? first[sorted[i - 1].second] : sorted[i].second;
    }
    std::vector<Index> kept(count, kInvalidIndex);
    for (Index i = 0; i < count; ++i)
    {
      if (first[i] == i)
      {
        kept[i] = static_cast<Index>(sheets_.polygons.size());
        sheets_.polygons.emplace_back();
      }
      sheets_.polygons[kept[first[i]]].push_back(i);
    }
  }

  Index polygonCount() const { return static_cast<Index>(sheets_.polygons.size()); }

  void findSides()
  {
    for (Index i = 0; i < polygonCount(); ++i)
    {
      const std::vector<Index> corners = cornersOf(sheets_.polygons[i].front());
      for (std::size_t k = 0; k < corners.size(); ++k)
      {
        const Index a = corners[k], b = corners[(k + 1) % corners.size()];
        sides_.push_back({ std::min(a, b), std::max(a, b), i, static_cast<Index>(k) });
      }
    }
    std::stable_sort(sides_.begin(), sides_.end(),
      [](const PolygonSide& a, const PolygonSide& b)
      { return std::tie(a.low, a.high) < std::tie(b.low, b.high); });
  }

  /// Whether polygons of other patches, or of other parts, lie there.
  bool isBorder(Index polygon, Index other) const
  {
    const auto patchesAt = [this](Index i)
    {
      std::vector<std::int64_t> ids;
      for (const Index same : sheets_.polygons[i])
      {
        ids.push_back(joint_.patchIds[same]);
      }
      return ids;
    };
    return patchesAt(polygon) != patchesAt(other);
  }

  /// Polygons hang together by edges of two. cutAtBorders: per polygon, whether not by those between patches.
  void findSheets(const std::vector<std::uint8_t>& cutAtBorders)
  {
    DisjointSets sets(polygonCount(), 1);
    joints_.clear();
    sheets_.sheetOf.clear();
    for (std::size_t begin = 0, end = 0; begin < sides_.size(); begin = end)
    {
      const PolygonSide& side = sides_[begin];
      while (end < sides_.size() && sides_[end].low == side.low && sides_[end].high == side.high)
      {
        ++end;
      }
      const bool isCut = end - begin == 2 && cutAtBorders[side.polygon] != 0 &&
        isBorder(side.polygon, sides_[begin + 1].polygon);
      if (end - begin == 2 && !isCut)
      {
        sets.join(side.polygon, sides_[begin + 1].polygon);
      }
      else if (end - begin >= 2)
      {
        joints_.emplace_back(begin, end);
      }
    }
    std::vector<Index> number(polygonCount(), kInvalidIndex);
    Index count = 0;
    for (Index i = 0; i < polygonCount(); ++i)
    {
      Index& sheet = number[sets.find(i)];
      sheet = sheet == kInvalidIndex ? count++ : sheet;
      sheets_.sheetOf.push_back(sheet);
    }
    sheets_.offset.assign(count, Vector3::Zero());
    if (touching_ == TouchingSheets::Left)
    {
      leaveTouching();
    }
  }

  std::vector<Index> sheetsAt(const std::pair<std::size_t, std::size_t>& joint) const
  {
    std::vector<Index> at;
    for (std::size_t i = joint.first; i < joint.second; ++i)
    {
      at.push_back(sheets_.sheetOf[sides_[i].polygon]);
    }
    std::sort(at.begin(), at.end());
    return at;
  }

  void leaveTouching()
  {
    const auto isTouching = [this](const std::pair<std::size_t, std::size_t>& joint)
    {
      const std::vector<Index> at = sheetsAt(joint);
      bool goOn = at.size() > 2 && at.size() % 2 == 0;
      for (std::size_t i = 0; i + 1 < at.size() && goOn; i += 2)
      {
        goOn = at[i] == at[i + 1];
      }
      return goOn;
    };
    const auto left = std::stable_partition(joints_.begin(), joints_.end(),
      [&](const std::pair<std::size_t, std::size_t>& joint) { return !isTouching(joint); });
    sheets_.touching = static_cast<std::size_t>(joints_.end() - left);
    if (left != joints_.end())
    {
      const PolygonSide& side = sides_[left->first];
      sheets_.touchingPlace = 0.5 * (joint_.points[side.low] + joint_.points[side.high]);
    }
    joints_.erase(left, joints_.end());
  }

  /// Per polygon, whether its sheet meets itself; all 0 where none does. first: the joint where one does.
  std::vector<std::uint8_t> meetThemselves(std::size_t& first) const
  {
    std::vector<std::uint8_t> sheetMeets(sheets_.offset.size(), 0);
    for (std::size_t j = joints_.size(); j-- > 0;)
    {
      const std::vector<Index> at = sheetsAt(joints_[j]);
      for (std::size_t i = 0; i + 1 < at.size(); ++i)
      {
        if (at[i] == at[i + 1])
        {
          sheetMeets[at[i]] = 1;
          first = joints_[j].first;
        }
      }
    }
    std::vector<std::uint8_t> meets;
    for (const Index sheet : sheets_.sheetOf)
    {
      meets.push_back(sheetMeets[sheet]);
    }
    return meets;
  }

  /// Where a sheet meets itself, it is cut at all borders of patches, too.
  void cutUp()
  {
    findSides();
    findSheets(std::vector<std::uint8_t>(polygonCount(), 0));
    const auto any = [](const std::vector<std::uint8_t>& flags)
    { return std::find(flags.begin(), flags.end(), 1) != flags.end(); };
    std::size_t first = 0;
    const std::vector<std::uint8_t> meets = meetThemselves(first);
    if (!any(meets))
    {
      return;
    }
    findSheets(meets);
    if (any(meetThemselves(first)) && touching_ == TouchingSheets::Joined)
    {
      touching_ = TouchingSheets::Left;
      findSheets(meets);
    }
    if (any(meetThemselves(first)))
    {
      refuse("a sheet meets itself at a curve of more than two sheets, near ",
        placeText(0.5 * (joint_.points[sides_[first].low] + joint_.points[sides_[first].high])),
        ": conforming blocks cannot have that. Cut the block in two there, or switch Conforming "
        "off");
    }
  }

  void writePoints()
  {
    std::map<std::pair<Index, Index>, Index> known; // point, sheet
    SurfaceInput& input = sheets_.input;
    input.polygonOffsets.push_back(0);
    for (Index i = 0; i < polygonCount(); ++i)
    {
      pollNowAndThen(i);
      for (const Index point : cornersOf(sheets_.polygons[i].front()))
      {
        const auto next = static_cast<Index>(input.points.size());
        const auto [found, isNew] = known.emplace(std::make_pair(point, sheets_.sheetOf[i]), next);
        if (isNew)
        {
          input.points.push_back(joint_.points[point]);
          sheets_.jointPoint.push_back(point);
          sheets_.sheetOfPoint.push_back(sheets_.sheetOf[i]);
          if (!joint_.targetValences.empty())
          {
            input.targetValences.push_back(joint_.targetValences[point]);
          }
          if (!joint_.sizing.empty())
          {
            input.sizing.push_back(joint_.sizing[point]);
          }
          if (!joint_.sizingOrders.empty())
          {
            input.sizingOrders.push_back(joint_.sizingOrders[point]);
          }
        }
        input.polygonPoints.push_back(found->second);
      }
      input.polygonOffsets.push_back(static_cast<Index>(input.polygonPoints.size()));
    }
  }

  /// Faces of several parts are patches of their own.
  void writePolygons()
  {
    SurfaceInput& input = sheets_.input;
    std::map<std::vector<std::int64_t>, std::int64_t> patches;
    for (const std::vector<Index>& same : sheets_.polygons)
    {
      std::vector<std::int64_t> ids;
      ids.reserve(same.size());
      for (const Index polygon : same)
      {
        ids.push_back(joint_.patchIds[polygon]);
      }
      const auto next = static_cast<std::int64_t>(patches.size());
      input.patchIds.push_back(patches.emplace(ids, next).first->second);
      const Index polygon = same.front();
      const auto copy = [polygon](const auto& from, auto& to)
      {
        if (!from.empty())
        {
          to.push_back(from[polygon]);
        }
      };
      copy(joint_.featureEdges, input.featureEdges);
      copy(joint_.guideDirections, input.guideDirections);
      copy(joint_.guideWeights, input.guideWeights);
      copy(joint_.guideOrders, input.guideOrders);
      copy(joint_.curvatures, input.curvatures);
    }
    input.isDesigned = joint_.isDesigned;
    input.curves = joint_.curves;
  }

  /// Not of unit length; zero where the polygon has no area.
  Vector3 normalOf(Index polygon) const
  {
    const std::vector<Index> corners = cornersOf(sheets_.polygons[polygon].front());
    Vector3 normal = Vector3::Zero();
    for (std::size_t k = 2; k < corners.size(); ++k)
    {
      const Vector3& a = joint_.points[corners[0]];
      normal += (joint_.points[corners[k - 1]] - a).cross(joint_.points[corners[k]] - a);
    }
    return normal;
  }

  void askForFeatures()
  {
    constexpr Index bits = 8; // of an entry of featureEdges
    std::vector<std::uint8_t> isOnJoint(joint_.points.size(), 0);
    for (const auto& [a, b] : sheets_.edges)
    {
      isOnJoint[a] = isOnJoint[b] = 1;
    }
    std::vector<std::uint8_t>& features = sheets_.input.featureEdges;
    features.resize(sheets_.polygons.size(), 0);
    for (std::size_t i = 0; i + 1 < sides_.size(); ++i)
    {
      const PolygonSide &side = sides_[i], &other = sides_[i + 1];
      const auto isAt = [&side](const PolygonSide& s)
      { return s.low == side.low && s.high == side.high; };
      const bool isPair = isAt(other) && (i == 0 || !isAt(sides_[i - 1])) &&
        (i + 2 == sides_.size() || !isAt(sides_[i + 2]));
      if (!isPair || (isOnJoint[side.low] == 0 && isOnJoint[side.high] == 0))
      {
        continue;
      }
      const Vector3 a = normalOf(side.polygon);
      // Where both run along the edge in one direction, one of them is the other way round.
      const auto from = [this](const PolygonSide& s)
      { return cornersOf(sheets_.polygons[s.polygon].front())[s.corner]; };
      const Vector3 b =
        from(side) == from(other) ? Vector3(-normalOf(other.polygon)) : normalOf(other.polygon);
      const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
      if (angle > *featureAngle_ && side.corner < bits)
      {
        features[side.polygon] |= static_cast<std::uint8_t>(1U << side.corner);
      }
    }
  }

  /// Each request goes with the sheet that its middle lies on.
  void moveDrawn()
  {
    sheets_.input.drawn = joint_.drawn;
    DrawnRequests& drawn = sheets_.input.drawn;
    if (drawn.empty())
    {
      return;
    }
    const SurfacePlaces places(sheets_.input);
    const auto offsetAt = [&](const Vector3& p)
    { return sheets_.offset[sheets_.sheetOf[places.nearestPlace(p).polygon]]; };
    const auto move = [&](std::vector<Vector3>& points)
    {
      const Vector3 offset = offsetAt(points[points.size() / 2]);
      for (Vector3& p : points)
      {
        p += offset;
      }
    };
    for (FeatureRequest& feature : drawn.features)
    {
      move(feature.points);
    }
    for (StrokeRequest& stroke : drawn.strokes)
    {
      move(stroke.points);
    }
    for (ValencePlace& asked : drawn.valences)
    {
      asked.place += offsetAt(asked.place);
    }
    for (SizeRequest& size : drawn.sizes)
    {
      size.place += offsetAt(size.place);
    }
    for (Vector3& place : drawn.cleared)
    {
      place += offsetAt(place);
    }
  }

  void moveApart()
  {
    Vector3 low = Vector3::Constant(kInfinity), high = -low;
    for (const Vector3& p : sheets_.input.points)
    {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const auto count = static_cast<double>(sheets_.offset.size());
    const int side = static_cast<int>(std::ceil(std::cbrt(count) - 1e-9));
    // A power of two, by which coordinates lose no more bits than they must.
    const double step = std::exp2(std::ceil(std::log2((1 + kSheetGap) * (high - low).maxCoeff())));
    for (std::size_t i = 0; i < sheets_.offset.size(); ++i)
    {
      const int n = static_cast<int>(i);
      const int column = n % side, row = n / side % side, layer = n / side / side;
      sheets_.offset[i] = step * Vector3(column, row, layer);
    }
    sheets_.centre = 0.5 * (low + high);
    moveDrawn();
    for (std::size_t i = 0; i < sheets_.input.points.size(); ++i)
    {
      sheets_.input.points.edit()[i] += sheets_.offset[sheets_.sheetOfPoint[i]];
    }
  }

  const SurfaceInput& joint_;
  std::optional<double> featureAngle_;
  TouchingSheets touching_;
  JointSheets sheets_;
  /// Of the polygons that are kept, those of an edge one after the other.
  std::vector<PolygonSide> sides_;
  std::vector<std::pair<std::size_t, std::size_t>> joints_; ///< edges, as ranges of sides
};

} // namespace

Vector3 JointSheets::movedBack(const Vector3& place) const
{
  Vector3 best = place;
  double least = kInfinity;
  for (const Vector3& moved : offset)
  {
    const double distance = (place - moved - centre).cwiseAbs().maxCoeff();
    if (distance < least)
    {
      least = distance;
      best = place - moved;
    }
  }
  return best;
}

JointSheets cutIntoSheets(
  const SurfaceInput& joint, std::optional<double> featureAngle, TouchingSheets touching)
{
  return SheetCutter(joint, featureAngle, touching).cut();
}

} // namespace quadrille
