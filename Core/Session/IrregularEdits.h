// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Irregular vertices as things that can be moved, split, merged, cancelled and added.
#pragma once

#include "Pipeline/Pipeline.h"
#include "Requests/SurfacePlaces.h"
#include "Session/Constraints.h"

#include <map>
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

/// The vertices and points of the user's surface that lie on features and boundaries.
struct OnCurves
{
  std::vector<std::uint8_t> vertices; ///< #V of the surface under the quads; 1: on one
  std::vector<Index> points;          ///< of the user's surface, ascending
};
OnCurves findOnCurves(const PreparedSurface& surface, int threads);

/// Irregular vertices of a result inside of the surface, off its features, ascending by point of the input. They are
/// those of the map: the quads have them at the same vertices of the surface, from which smoothing may move them.
/// turns: RemeshResult::turns.
std::vector<IrregularVertex> irregularVertices(
  const MadeSurface& made, const std::vector<int>& turns, const OnCurves& onCurves);
/// Ends, corners and bends of features and boundaries, ascending by point of the input. onFeatures: of the
/// RemeshResult.
std::vector<HeldVertex> featureVertices(
  const MadeSurface& made, const std::vector<SectorRequest>& onFeatures);

/// Fills before and changes of the operation. fixedPoints: OnCurves::points. Throws InvalidInput, with name and
/// place, where there is no such vertex, a place cannot be taken, a valence would be out of range, or the sum of
/// indices would change.
void resolveEdit(IrregularEdit& edit, const std::string& name, const SurfaceInput& surface,
  const SurfacePlaces& places, const std::vector<IrregularVertex>& irregular,
  const std::vector<Index>& fixedPoints);

/// The irregular vertices that operations lead to, one after the other.
class IrregularList
{
public:
  bool isInForce() const { return isInForce_; }
  /// Where the operation was made upon those that are in force here, its own list counts; else its changes are made in
  /// the list that there is, or, where none is in force any more, in its own with those before it taken back. Returns
  /// why not, or nothing.
  std::string apply(int id, int revision, const IrregularEdit& edit, const SurfaceInput& surface);
  /// Valences by point, also those that an operation has made regular.
  const std::map<Index, int>& valences() const { return valences_; }
  int valenceAt(Index point) const;
  /// Those that are not regular, ascending by point, where they are on the surface.
  std::vector<IrregularVertex> irregular(const SurfaceInput& surface) const;
  /// Those on features and boundaries, of the last operation that brought its own list.
  const std::vector<HeldVertex>& onFeatures() const { return onFeatures_; }
  /// The operation in force that changed the point last; 0: none.
  int changedBy(Index point) const;
  /// The operations in force.
  const std::vector<IrregularEdit::Link>& links() const { return links_; }

private:
  bool isInForce_ = false;
  std::map<Index, int> valences_;
  std::map<Index, int> changedBy_;
  std::map<Index, Vector3> places_; ///< of vertices that are not at their points
  std::vector<HeldVertex> onFeatures_;
  std::vector<IrregularEdit::Link> links_;
};

} // namespace quadrille
