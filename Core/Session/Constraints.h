// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a user can ask of a surface in a session. All places are in units of the input; a place means the nearest point
/// of the surface, wherever its vertices are.
#pragma once

#include "Base/Types.h"
#include "Requests/HeldVertices.h"
#include "Symmetry/Isometry.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace quadrille
{

/// A polyline that becomes edges of the quads, see ConstraintPlacement::addFeature.
struct FeatureLine
{
  std::vector<Vector3> points; ///< 2 or more
};

/// The feature curve at a place is none, see clearFeatures.
struct ClearedAt
{
  Vector3 point = Vector3::Zero();
};

/// A polyline that edges of the quads should follow, see ConstraintPlacement::addStroke.
struct GuideStroke
{
  std::vector<Vector3> points; ///< 2 or more
  double weight = 1;           ///< in (0, 1]
  double radius = 0;           ///< >= 0
};

/// Polygons with a direction that edges of the quads there should have.
struct GuideRegion
{
  std::vector<Index> polygons;
  Vector3 direction = Vector3::Zero(); ///< of any length but 0
  double weight = 1;                   ///< in (0, 1]
};

struct ValenceAt
{
  Vector3 point = Vector3::Zero();
  int valence = 4; ///< see ValenceRequest
};

/// Quads near a point have another size.
struct SizeAt
{
  Vector3 point = Vector3::Zero();
  double radius = 0; ///< >= 0: within this straight distance; 0: at the point
  double factor = 1; ///< > 0: the edge length there as a multiple of the target edge length
};

/// Quads at the corners of polygons have another size.
struct SizeRegion
{
  std::vector<Index> polygons;
  double factor = 1; ///< see SizeAt
};

/// The order of places by which lists are sorted: by x, then y, then z.
struct PlaceOrder
{
  bool operator()(const Vector3& a, const Vector3& b) const
  {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  }
};

/// An irregular vertex; those that operations take are inside of the surface, off its features. Its place names it.
struct IrregularVertex
{
  Vector3 place = Vector3::Zero();
  int valence = 4;

  bool operator==(const IrregularVertex& other) const
  {
    return place == other.place && valence == other.valence;
  }
};

/// Of the surface under quads, where operations may not take irregular vertices from, or put them.
struct FixedPlaces
{
  std::vector<std::array<Vector3, 2>> edges;      ///< of features and boundaries, each once
  std::vector<std::array<Vector3, 3>> withoutMap; ///< triangles of faces that have no map
  std::vector<Vector3> insideOfFaces;             ///< a point of each of these faces
};

enum class IrregularOperation
{
  Move,  ///< the vertex nearest to points[0] goes to points[1]
  Split, ///< that nearest to points[0] becomes two, at points[1] and points[2]
  Merge, ///< those nearest to points[0] and points[1] become one, at points[2], or where the first one was
  Cancel, ///< those nearest to points[0] and points[1], of opposite indices, become regular
  Add     ///< two come to points[0] and points[1], of opposite indices
};

/// What a connection joins.
struct JoinedEnds
{
  int id = 0, revision = 0; ///< of the connection, and how often it had been changed
  Vector3 start = Vector3::Zero(), end = Vector3::Zero();
  int startValence = 0, endValence = 0; ///< 0: a feature or boundary
};

/// An operation on the irregular vertices of the quads. All others stay. The sum of indices (4 - valence) stays the
/// same.
struct IrregularEdit
{
  IrregularOperation operation = IrregularOperation::Move;
  std::vector<Vector3> points;
  /// Of Split and Add, empty or two: the valences; by default an even index is split in halves, and 3 and 5 are added.
  std::vector<int> valences;

  /// What the session makes of it when it is added, from the irregular vertices that there are then.
  struct Change
  {
    Vector3 place = Vector3::Zero();
    int before = 4, after = 4; ///< valences
  };
  /// An operation that was in force then: its id, how often it had been changed, and what it did, so that it can be
  /// taken back.
  struct Link
  {
    int id = 0, revision = 0;
    std::vector<Change> changes;

    bool operator==(const Link& other) const
    {
      return id == other.id && revision == other.revision;
    }
  };
  std::vector<IrregularVertex> before; ///< all of them, in the order of places
  std::vector<Change> changes;         ///< the same
  std::vector<Link> upon;              ///< in their order
  /// Ends, corners and bends of features and boundaries then, ascending by point.
  std::vector<HeldVertex> onFeatures = {};
  /// All irregular points that the quads had then, see irregularPoints: what a user saw. Files of version 1 have none.
  std::vector<IrregularVertex> shown = {};
  std::vector<Vector3> withoutMap = {}; ///< FixedPlaces::insideOfFaces then
  std::vector<JoinedEnds> joined = {};  ///< by the connections that were in force then
};

/// A chain of edges of quads, straight in the map, that joins two irregular vertices, features or boundaries.
struct Connection
{
  std::vector<Vector3> points; ///< 2 or more, see CurveRequest
};

/// A closed chain of edges of quads, straight in the map.
struct Cycle
{
  std::vector<Vector3> points; ///< 3 or more, see CurveRequest
};

/// Quads that are their own mirror image, see remeshSymmetric. One symmetry at most is in force.
struct MirrorSymmetry
{
  /// The normal may have any length but 0. None: found, see findIsometry.
  std::optional<MirrorPlane> plane;
  PlaneCurve planeCurve = PlaneCurve::Isoline;
};

/// Quads that are their own image when they are turned by one step of an order, see remeshSymmetric.
struct RotationalSymmetry
{
  int order = 2; ///< in [kLeastOrder, kMostOrder]
  /// The direction may have any length but 0. None: found, see findIsometry.
  std::optional<RotationAxis> axis;
};

using ConstraintContent = std::variant<FeatureLine, GuideStroke, GuideRegion, ValenceAt, SizeAt,
  SizeRegion, IrregularEdit, Connection, Cycle, MirrorSymmetry, RotationalSymmetry, ClearedAt>;

/// "feature", "guide", "guide region", "valence", "size", "size region", "irregular", "connection", "cycle",
/// "symmetry", "rotation", "cleared feature".
const char* kindOf(const ConstraintContent& content);
/// The points that it was drawn at; none of regions and symmetries.
std::vector<Vector3> pointsOf(const ConstraintContent& content);
/// Where it is, for messages: its first point.
std::optional<Vector3> placeOf(const ConstraintContent& content);

/// Throws InvalidInput for numbers out of their range, too few points, and points that are not finite; polygonCount: of
/// the input. name: for the message, such as "constraint 3".
void checkConstraint(
  const ConstraintContent& content, const std::string& name, std::size_t polygonCount);

struct SessionConstraint
{
  int id = 0;       ///< never changes, and is never given again
  int revision = 0; ///< how often it was changed
  ConstraintContent content;

  std::string name() const { return std::string(kindOf(content)) + " " + std::to_string(id); }
};

} // namespace quadrille
