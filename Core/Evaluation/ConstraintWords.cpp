// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Evaluation/ConstraintWords.h"

#include "Base/Lists.h"
#include "Base/PlaceText.h"
#include "Evaluation/ConstraintMeasures.h"
#include "Quads/QuadShape.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

namespace quadrille
{

namespace
{

ConstraintWord worded(const char* kind, std::int64_t source, const ConstraintMeasure& measure)
{
  return { measure, kind, source, false };
}

ConstraintWord unknownWord(const char* kind, std::int64_t source, const char* unit,
  std::string reason, const Vector3& place = Vector3::Zero())
{
  return worded(kind, source, ConstraintMeasure::unknown(place, unit, std::move(reason)));
}

class Judge
{
public:
  Judge(const AskedConstraints& asked, const QuadMesh& mesh)
    : asked_(asked), mesh_(mesh), measures_(mesh)
  {
    std::size_t guides = asked.arrays.guides.size();
    for (std::size_t i = 0; i < asked.placed.size(); ++i)
    {
      guides += asked.placed[i].guided.empty() ? 0 : 1;
    }
    mostPlaces_ = mostPlacesOf(guides);
  }

  ConstraintWord guideArray(const ArrayConstraints::Region& region)
  {
    return guide("guide array", region.firstCell, region.measured, std::nullopt);
  }
  ConstraintWord featureEdges(const ArrayConstraints::Curve& curve)
  {
    return feature(curve.firstPoint, curve.edges);
  }
  ConstraintWord valence(const ArrayConstraints::Valence& asked)
  {
    return asked.isUsed
      ? valenceAt(asked.point, asked.place, asked.asked)
      : unknownWord("valence", asked.point, "edge lengths", "no face uses the point", asked.place);
  }
  ConstraintWord sizes(const std::vector<double>& sizes) const;
  ConstraintWord drawn(std::size_t i)
  {
    ConstraintWord word = measured(i);
    const std::string off = measures_.offSurface(asked_.placed[i].given);
    word.remark = withRemark(word.remark, off);
    word.isOffSurface = !off.empty();
    return word;
  }

private:
  ConstraintWord measured(std::size_t i);
  ConstraintWord guide(const char* kind, std::int64_t source,
    const std::vector<GuidedPlace>& measured, std::optional<std::size_t> stroke);
  ConstraintWord feature(std::int64_t source, const std::vector<std::array<Vector3, 2>>& edges)
  {
    return worded("feature curve", source, measures_.curve(edges));
  }
  ConstraintWord valenceAt(std::int64_t source, const Vector3& place, int asked)
  {
    return worded("valence", source, measures_.valence(place, asked));
  }
  std::string whyNotAlong(const std::vector<GuidedPlace>& measured,
    std::optional<std::size_t> stroke, double irregularShare);

  const AskedConstraints& asked_;
  const QuadMesh& mesh_;
  std::size_t mostPlaces_ = mostPlacesOf(1);
  ConstraintMeasures measures_;
};

ConstraintWord Judge::guide(const char* kind, std::int64_t source,
  const std::vector<GuidedPlace>& measured, std::optional<std::size_t> stroke)
{
  double irregularShare = 0;
  ConstraintWord word =
    worded(kind, source, measures_.guide(measured, mostPlaces_, &irregularShare));
  // Where nothing was measured the reason says why.
  if (!word.isMet && !std::isnan(word.deviation))
  {
    word.reason += whyNotAlong(measured, stroke, irregularShare);
  }
  return word;
}

std::string Judge::whyNotAlong(const std::vector<GuidedPlace>& measured,
  std::optional<std::size_t> stroke, double irregularShare)
{
  std::ostringstream text;
  double least = 1;
  for (const GuidedPlace& asked : measured)
  {
    least = std::min(least, asked.weight);
  }
  for (std::size_t by = asked_.placed.size(); by-- > (stroke ? *stroke + 1 : 0);)
  {
    const PlacedConstraint& later = asked_.placed[by];
    const double share = later.kind == ConstraintKind::Stroke && later.whyNot.empty()
      ? measures_.shareUnder(later.path, later.radius, measured)
      : 0;
    if (share > 0)
    {
      text << "; " << percentText(share) << " of it is under guiding stroke " << later.source
           << ", which goes before it";
      break;
    }
  }
  if (irregularShare > kNotableShare)
  {
    text << "; " << percentText(irregularShare) << " of its area is in quads at irregular vertices";
  }
  if (least < 1)
  {
    text << "; its weight is " << shortText(least) << (stroke ? "" : " at least")
         << ", a larger one is followed more closely";
  }
  return text.str();
}

/// By how much the sizes of the quads differ, against each other, from those asked for: the logarithms of the ratios
/// against their median.
ConstraintWord Judge::sizes(const std::vector<double>& sizes) const
{
  ConstraintWord word = unknownWord("size", -1, "factor", kNoQuads);
  if (mesh_.quads.empty() || sizes.empty())
  {
    return word;
  }
  std::vector<WeightedDeviation> ratios;
  std::vector<double> logarithms;
  std::vector<std::size_t> quadOf;
  for (std::size_t q = 0; q < mesh_.quads.size(); ++q)
  {
    const std::array<Index, 4>& quad = mesh_.quads[q];
    double asked = 0;
    for (const Index p : quad)
    {
      asked += 0.25 * sizes[p];
    }
    const double area = 0.5 * diagonalNormal(cornersOf(mesh_.points, quad)).norm();
    if (area > 0 && asked > 0)
    {
      ratios.push_back({ std::log(std::sqrt(area) / asked), area });
      logarithms.push_back(ratios.back().value);
      quadOf.push_back(q);
    }
  }
  if (ratios.empty())
  {
    word.reason = "the quads have no area";
    return word;
  }
  const double middle = middleOf(logarithms);
  double worst = -1;
  for (std::size_t i = 0; i < ratios.size(); ++i)
  {
    ratios[i].value = std::abs(ratios[i].value - middle);
    if (ratios[i].value > worst)
    {
      worst = ratios[i].value;
      const std::array<Index, 4>& quad = mesh_.quads[quadOf[i]];
      word.place = 0.25 *
        (mesh_.points[quad[0]] + mesh_.points[quad[1]] + mesh_.points[quad[2]] +
          mesh_.points[quad[3]]);
    }
  }
  word.deviation = std::exp(meanOf(ratios));
  word.deviation95 = std::exp(percentile95(std::move(ratios)));
  word.isMet = word.deviation <= kMetFactor;
  word.reason = word.isMet ? ""
                           : "the sizes of the quads differ from those asked for by a factor of " +
      shortText(word.deviation) + " on average, at most " + shortText(kMetFactor) +
      " counts as met";
  return word;
}

ConstraintWord Judge::measured(std::size_t i)
{
  const PlacedConstraint& constraint = asked_.placed[i];
  const char* const kind = nameOf(constraint.kind);
  const bool isStroke = constraint.kind == ConstraintKind::Stroke;
  const Vector3 place =
    constraint.path.empty() ? Vector3(Vector3::Zero()) : constraint.path.front();
  if (!constraint.whyNot.empty() || (isStroke && constraint.guided.empty()))
  {
    const char* const unit = isStroke           ? "degrees"
      : constraint.kind == ConstraintKind::Size ? "factor"
                                                : "edge lengths";
    return unknownWord(kind, constraint.source, unit,
      constraint.whyNot.empty() ? "it runs over no face" : constraint.whyNot, place);
  }
  switch (constraint.kind)
  {
    case ConstraintKind::Stroke:
    {
      ConstraintWord word = guide(kind, constraint.source, constraint.guided, i);
      word.remark = withRemark(word.remark, constraint.remark);
      return word;
    }
    case ConstraintKind::Valence:
      return valenceAt(constraint.source, place, constraint.valence);
    case ConstraintKind::Size:
      return worded(kind, constraint.source,
        measures_.size(place, constraint.radius, { constraint.factor, asked_.edgeLength }));
    case ConstraintKind::Cleared:
      return worded(kind, constraint.source, measures_.cleared(place));
    case ConstraintKind::Move:
      return worded(kind, constraint.source, measures_.move(constraint));
    case ConstraintKind::Feature:
    {
      ConstraintWord word = worded(kind, constraint.source, measures_.curve(constraint.path));
      word.isMet = word.isMet && constraint.remark.empty(); // it is not there all along
      word.reason = withRemark(word.reason, constraint.remark);
      return word;
    }
    default: // connections and cycles
      return worded(kind, constraint.source, measures_.line(constraint, asked_.curves));
  }
}

} // namespace

//------------------------------------------------------------------------------
std::vector<ConstraintWord> judgeConstraints(
  const AskedConstraints& asked, const QuadMesh& mesh, const std::vector<double>& sizes)
{
  std::vector<ConstraintWord> words;
  Judge judge(asked, mesh);
  for (const ArrayConstraints::Region& region : asked.arrays.guides)
  {
    words.push_back(judge.guideArray(region));
  }
  for (const ArrayConstraints::Curve& curve : asked.arrays.curves)
  {
    words.push_back(judge.featureEdges(curve));
  }
  for (const ArrayConstraints::Valence& valence : asked.arrays.valences)
  {
    words.push_back(judge.valence(valence));
  }
  if (asked.arrays.sizes)
  {
    words.push_back(judge.sizes(sizes));
  }
  for (std::size_t i = 0; i < asked.placed.size(); ++i)
  {
    words.push_back(judge.drawn(i));
  }
  return words;
}

std::vector<bool> metOfDrawn(
  const std::vector<ConstraintWord>& words, const AskedConstraints& asked)
{
  std::vector<bool> met;
  for (std::size_t i = words.size() - asked.placed.size(); i < words.size(); ++i)
  {
    met.push_back(words[i].isMet);
  }
  return met;
}

std::vector<std::string> offSurfaceNotices(const std::vector<ConstraintWord>& words)
{
  std::vector<std::string> notices;
  for (const ConstraintWord& word : words)
  {
    if (word.isOffSurface)
    {
      notices.push_back(std::string(word.kind) + " " + std::to_string(word.source) + ": " +
        withRemark(word.reason, word.remark));
    }
  }
  return notices;
}

std::vector<std::string> unmetNotices(
  const std::vector<ConstraintWord>& words, const AskedConstraints& asked)
{
  std::vector<std::string> notices;
  for (std::size_t i = 0; i < asked.placed.size(); ++i)
  {
    const PlacedConstraint& placed = asked.placed[i];
    const ConstraintWord& word = words[words.size() - asked.placed.size() + i];
    const bool isTold = placed.kind == ConstraintKind::Valence || isLine(placed);
    if (isTold && placed.whyNot.empty() && !word.isMet && word.reason != kNoQuads)
    {
      notices.push_back(std::string(word.kind) + " " + std::to_string(word.source) + " at " +
        placeText(placed.path.front()) + " is not met: " + word.reason +
        (placed.kind == ConstraintKind::Valence
            ? "; move the point away from sharp edges and other points, or ask for smaller quads"
            : ""));
    }
  }
  return notices;
}

} // namespace quadrille
