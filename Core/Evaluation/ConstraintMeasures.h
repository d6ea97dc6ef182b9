// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Whether the quads do what was asked for, by how much not, and why not.
#pragma once

#include "Evaluation/QuadPlaces.h"
#include "Requests/DrawnConstraints.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

/// Degrees on average, edge lengths at most, and the factor on average, up to which a constraint counts as met.
constexpr double kMetAngle = 5;
constexpr double kMetDistance = 0.1;
constexpr double kMetFactor = 1.25;
/// Edge lengths beyond which a drawn point lies off the surface.
constexpr double kFarOffSurface = 1;

/// What was found of one constraint. What could not be measured is not a number.
struct ConstraintMeasure
{
  Vector3 place = Vector3::Zero(); ///< where it deviates most
  bool isMet = false;
  double deviation = 0;
  double deviation95 = 0; ///< the 95th percentile of what deviation is the mean of
  const char* unit = "";
  std::string
    reason; ///< why it is not met; where it is, empty or that a point lies off the surface

  static ConstraintMeasure unknown(const Vector3& place, const char* unit, std::string reason);
};

/// A deviation, and how much it counts.
struct WeightedDeviation
{
  double value = 0;
  double weight = 0;
};
/// Not a number where there is no weight.
double meanOf(const std::vector<WeightedDeviation>& values);
/// The least value that is not exceeded by 95 % of the weight.
double percentile95(std::vector<WeightedDeviation> values);

/// A number with three digits; a share as whole percent.
std::string shortText(double number);
std::string percentText(double share);
/// Both of them, where there are both.
std::string withRemark(const std::string& reason, const std::string& remark);

/// The most places at which each of so many guides, or a curve, is measured.
std::size_t mostPlacesOf(std::size_t guides);
/// From one of `count` elements to the next, so that at most `most` are taken; at least 1.
std::size_t strideOf(std::size_t count, std::size_t most);

class ConstraintMeasures
{
public:
  /// mesh: what was made, without quads where there are none; it stays as it is while this is used.
  explicit ConstraintMeasures(const QuadMesh& mesh) : mesh_(mesh) {}

  /// "degrees": the angle between the asked direction at the centre of a polygon and the nearer of the two families of
  /// edges of the quad there, in the plane of the polygon; mean by area. measured: not empty; at most mostPlaces of
  /// them are looked at. irregularShare, where given, gets the share of the area in quads at irregular vertices.
  ConstraintMeasure guide(const std::vector<GuidedPolygon>& measured, std::size_t mostPlaces,
    double* irregularShare = nullptr);
  /// "edge lengths": the largest distance from the quads' edges, over the mean length of the edges near it. curve: not
  /// empty.
  ConstraintMeasure curve(const std::vector<std::array<Vector3, 2>>& curve);
  /// "valence": the number of edges there, on boundaries one more, less the one asked for.
  ConstraintMeasure valence(const Vector3& place, int asked);
  /// Of the points that were drawn the one farthest from the quads, if that is more than an edge length of the quads
  /// there: a sentence on where it lies, how far off, and which place counts in its stead. Empty: there is none, or
  /// there are no quads.
  std::string offSurface(const std::vector<Vector3>& given);

private:
  bool isAtIrregularVertex(Index quad) const;

  const QuadMesh& mesh_;
  std::optional<ReachedValences> valences_; ///< these are made when they are needed first
  std::optional<NearestQuads> quads_;
  std::optional<NearestEdges> edges_;
};

} // namespace quadrille
