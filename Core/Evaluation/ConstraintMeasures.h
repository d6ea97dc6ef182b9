// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Whether the quads do what was asked for, by how much not, and why not. What "met" means is said here, for all that
/// tells it: the table, the notices, the output Constraints, and sessions.
#pragma once

#include "Evaluation/LinesInQuads.h"
#include "Evaluation/QuadPlaces.h"
#include "Mesh/Requests.h"
#include "Requests/DrawnConstraints.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace quadrille
{

/// Guides and strokes: degrees on average.
constexpr double kMetAngle = 5;
/// Places (valences, moves) and feature lines: edge lengths of the quads there, at most. So near to a place is the
/// vertex that was asked for there.
constexpr double kMetDistance = 0.3;
/// Guides: a share of irregular vertices in the guided region above this is worth a word.
constexpr double kNotableShare = 0.1;
/// Edge lengths of the quads beyond which a drawn point lies off the surface, which is told.
constexpr double kFarOffSurface = 0.5;

/// The reason where there are none.
constexpr const char* kNoQuads = "no quads were made";

/// What was found of one constraint. What could not be measured is not a number.
struct ConstraintMeasure
{
  Vector3 place = Vector3::Zero(); ///< where it deviates most
  bool isMet = false;
  double deviation = 0;
  double deviation95 = 0; ///< the 95th percentile of what deviation is the mean of
  const char* unit = "";
  std::string reason; ///< why it is not met; empty where it is
  std::string remark; ///< what else is to be known of it, met or not; mostly empty

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

/// A place, and how much it counts.
struct WeightedPlace
{
  Vector3 place = Vector3::Zero();
  double weight = 1;
};

/// What sizes are compared with.
struct AskedSize
{
  double factor = 1;     ///< asked for
  double edgeLength = 0; ///< of quads where the size is 1
};

/// AskedSize::edgeLength for a target edge length, where so many quads were made; asked: the number that was asked for,
/// against which lengths count then; none: it was not a number.
double lengthOfSizeOne(
  double targetEdgeLength, std::optional<std::size_t> asked, std::size_t quads);

class ConstraintMeasures
{
public:
  /// mesh: what was made, without quads where there are none; it stays as it is while this is used.
  explicit ConstraintMeasures(const QuadMesh& mesh) : mesh_(mesh) {}

  /// "degrees": the angle between the asked direction at a place and the nearer of the two families of edges of the
  /// quad there, in the plane of the surface; mean by area. measured: not empty; at most mostPlaces of them are looked
  /// at. irregularShare, where given, gets the share of the area in quads at irregular vertices.
  ConstraintMeasure guide(const std::vector<GuidedPlace>& measured, std::size_t mostPlaces,
    double* irregularShare = nullptr);
  /// "edge lengths": the largest distance from the quads' edges on features and boundaries, over the length of the
  /// edges there; infinite where there are none. Some of all edges pass near any line. curve: not empty.
  ConstraintMeasure curve(const std::vector<std::array<Vector3, 2>>& curve);
  ConstraintMeasure curve(const std::vector<Vector3>& path);
  /// "edge lengths": from the place to the nearest feature of the quads, 0.3 at least; infinite where they have none.
  ConstraintMeasure cleared(const Vector3& place);
  /// "edge lengths": from the place to the nearest point of the quads with the valence, on boundaries one more than the
  /// edges there; of a regular one 0, if the nearest point is one.
  ConstraintMeasure valence(const Vector3& place, int asked);
  /// The same where an operation has changed a vertex. irregular: all that the quads were to have with it; null: not
  /// known. Also a regular one is met where all irregular points within an edge length are among these, as smoothing
  /// brings some nearer; one of another valence only there.
  ConstraintMeasure changedValence(
    const Vector3& place, int asked, const std::vector<ValencePlace>* irregular);
  /// The same of a vertex that was moved: at its new place, and at its old one; of the last move also that all others
  /// are where they were.
  ConstraintMeasure move(const PlacedConstraint& constraint);
  /// "edge lengths": of a connection or cycle, met where there is a straight chain of edges within kMetLine of it, of a
  /// cycle a closed one: the largest distance from the chain to the line or back. outcomes: see AskedConstraints, for
  /// the reason.
  ConstraintMeasure line(
    const PlacedConstraint& constraint, const std::vector<CurveOutcome>& outcomes);
  /// The chain that is judged for a connection or cycle; none: there is none.
  std::optional<LineInQuads> lineInQuads(const PlacedConstraint& constraint);
  /// "factor": by which the median by area of the edge lengths of quads, the roots of their areas, differs from what
  /// was asked: of those with their centre within the radius, or else of those round the point next to the place.
  /// quads, where given, gets them.
  ConstraintMeasure size(const Vector3& place, double radius, const AskedSize& asked,
    std::vector<Index>* quads = nullptr);
  /// The same of the quads at places.
  ConstraintMeasure size(const std::vector<WeightedPlace>& places, const AskedSize& asked);
  /// Of the points that were drawn the one farthest from the quads, if that is more than half an edge length of the
  /// quads there: a sentence on where it lies, how far off, and which place counts in its stead. Empty: there is none,
  /// or there are no quads.
  std::string offSurface(const std::vector<Vector3>& given);
  /// Of the places the share by area that a stroke runs over, or has within its radius.
  double shareUnder(
    const std::vector<Vector3>& path, double radius, const std::vector<GuidedPlace>& places);
  /// Whether a place is under a stroke, or within its radius.
  bool isUnder(const NearestSegments& stroke, double radius, const Vector3& place);
  /// Which valence is shown for a place where one is asked for.
  int valenceShown(const Vector3& place, int asked);
  Vector3 centreOf(Index quad) const;
  /// Of the quad next to a place; 0 where there are no quads.
  double edgeLengthAt(const Vector3& p);

private:
  bool isAtIrregularVertex(Index quad) const;
  const NearestQuads& quads();
  const ReachedValences& valences();
  std::optional<Index> pointFor(const NearestQuads::Place& there, const Vector3& place, int asked);
  std::optional<Index> strangerAt(const Vector3& place, const std::vector<ValencePlace>& irregular);
  ConstraintMeasure sizeOf(const std::vector<std::pair<Index, double>>& quads, const Vector3& place,
    const AskedSize& asked) const;

  const QuadMesh& mesh_;
  std::optional<ReachedValences> valences_; ///< these are made when they are needed first
  std::optional<NearestQuads> quads_;
  std::optional<NearestLines> nearestLines_;
  std::optional<LinesInQuads> lines_;
};

} // namespace quadrille
