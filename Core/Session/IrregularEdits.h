// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Irregular vertices as things that can be moved, split, merged, cancelled and added.
#pragma once

#include "Pipeline/Pipeline.h"
#include "Requests/SurfacePlaces.h"
#include "Session/Constraints.h"
#include "Session/IrregularMatch.h"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

/// The surface under the quads of a run: still in its frame, where the run shares it with the store.
struct MadeSurface
{
  const PreparedSurface& surface;
  const Frame* frame = nullptr;                 ///< null: it is the user's
  const SharedArray<Vector3>* points = nullptr; ///< of the user's surface; where there is a frame

  Vector3 placeAt(Index halfEdge) const
  {
    return frame == nullptr ? surface.mesh.position[surface.mesh.origin[halfEdge]]
                            : userPosition(surface, halfEdge, *frame, *points);
  }
};

/// What of the surface under the quads lies on features and boundaries.
struct OnCurves
{
  std::vector<std::uint8_t> vertices;        ///< #V; 1: on one
  std::vector<std::array<Vector3, 2>> edges; ///< each once, where they are on the user's surface
};
OnCurves findOnCurves(const MadeSurface& made, int threads);

/// Irregular vertices of a result inside of the surface, off its features, in the order of places. They are those of
/// the map: the quads have them at the same vertices of the surface, from which smoothing may move them; at those that
/// were asked for they are. turns: RemeshResult::turns, 0 inside of faces without a map, which have none. asked: a
/// vertex within takenWithin of one of these, with its valence, is that one, and has its place.
std::vector<IrregularVertex> irregularVertices(const MadeSurface& made,
  const std::vector<int>& turns, const OnCurves& onCurves, const std::vector<ValencePlace>& asked,
  double takenWithin);
/// What operations cannot change. insideOfFaces: RunMap::withoutMap.
FixedPlaces fixedPlaces(
  const MadeSurface& made, const OnCurves& onCurves, const std::vector<Vector3>& insideOfFaces);
/// Why what was asked for cannot be: faces have no map that had one without it, by RunMap::withoutMap of both runs;
/// empty where there are none.
std::string lostMapText(const std::vector<Vector3>& with, const std::vector<Vector3>& without);
/// Ends, corners and bends of features and boundaries, ascending by point of the input. onFeatures: of the
/// RemeshResult.
std::vector<HeldVertex> featureVertices(
  const MadeSurface& made, const std::vector<SectorRequest>& onFeatures);

/// Where operations may put irregular vertices.
struct PlacesOfEdits
{
  const SurfacePlaces& places;
  const FixedPlaces& fixed;
  double sameWithin = 0; ///< places that are no farther apart are one
  /// Of irregular vertices, as places are given by what is seen; a vertex without one is looked for at its own place.
  const ShownPlaces* shown = nullptr;
  /// What these are shown in, as a place means vertices on its side of a thin wall; null: on both.
  const NearestQuads* quads = nullptr;
};

/// Fills before and changes of the operation. A move that ends within half an edge length of where another irregular
/// vertex is shown makes one of the two there. Returns of a move its vertex and where that goes, else nothing. Throws
/// InvalidInput, with name and place, where there is no such vertex, a place cannot be taken, a valence would be out of
/// range, or the sum of indices would change.
std::vector<Vector3> resolveEdit(IrregularEdit& edit, const std::string& name,
  const PlacesOfEdits& where, const std::vector<IrregularVertex>& irregular);

/// The irregular vertices that operations lead to, one after the other.
class IrregularList
{
public:
  bool isInForce() const { return isInForce_; }
  /// Where the operation was made upon those that are in force here, its own list counts; else its changes are made in
  /// the list that there is, or, where none is in force any more, in its own with those before it taken back. Returns
  /// why not, or nothing.
  std::string apply(int id, int revision, const IrregularEdit& edit);
  /// Valences by place, also those that an operation has made regular.
  const std::map<Vector3, int, PlaceOrder>& valences() const { return valences_; }
  int valenceAt(const Vector3& place) const;
  /// Of the places in the list the nearest one that is the same as this; else it itself.
  Vector3 sameAs(const Vector3& place, double sameWithin) const;
  /// Those that are not regular, in the order of places.
  std::vector<IrregularVertex> irregular() const;
  /// Those on features and boundaries, of the last operation that brought its own list.
  const std::vector<HeldVertex>& onFeatures() const { return onFeatures_; }
  /// A point of each face that has no map, of the same.
  const std::vector<Vector3>& withoutMap() const { return withoutMap_; }
  /// What connections join, of the same.
  const std::vector<JoinedEnds>& joined() const { return joined_; }
  /// The points of the quads that are irregular then, see IrregularEdit::shown; none: not known.
  const std::optional<std::vector<IrregularVertex>>& shown() const { return shown_; }
  /// The operation in force that changed the place last; 0: none.
  int changedBy(const Vector3& place) const;
  /// The operations in force.
  const std::vector<IrregularEdit::Link>& links() const { return links_; }

private:
  bool isInForce_ = false;
  std::map<Vector3, int, PlaceOrder> valences_;
  std::map<Vector3, int, PlaceOrder> changedBy_;
  std::vector<HeldVertex> onFeatures_;
  std::vector<Vector3> withoutMap_;
  std::vector<JoinedEnds> joined_;
  std::optional<std::vector<IrregularVertex>> shown_;
  std::vector<IrregularEdit::Link> links_;
};

} // namespace quadrille
