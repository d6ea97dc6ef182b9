// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a run leaves for the next one, so that an edit is answered from the stage that it enters at:
///
///   changed                                        starts again from
///   guides, target valences, coarse vertices       phase 2 (valences: phase 1, unless warmStart is on)
///   number of quads, edge length, handles to close refinement
///   anything else of the input, feature angle      the beginning
#pragma once

#include "GridMap/PreviousMap.h"
#include "Hierarchy/Hierarchy.h"
#include "Mesh/Surface.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

/// Belongs to the caller of remesh(), who only makes it, asks for its size and clears it. It holds the refined surface (about 70 bytes a
/// triangle), the surface before its refinement where that split anything (again as much), the decimation log (about 20) and one coarse
/// map; another surface takes the place of the first. Whatever ends a run, what is held is whole.
class RemeshMemory
{
public:
  /// Bytes that it holds.
  std::size_t bytes() const;
  void clear();

  // The rest is for remesh().

  /// What the refined surface is made from.
  struct Key
  {
    std::uint64_t input = 0; ///< contentHash of the input
    std::optional<double> featureAngle;
    double closeHandles = 0;
    bool removeSmallComponents = false;
    std::uint64_t requests = 0; ///< of guides and valences where closed handles move their corners
    double edgeLength = 0;

    bool preparesAs(const Key& other) const;
    bool refinesAs(const Key& other) const;
  };

  /// Whether it holds what prepareSurface would make.
  bool knowsPrepared(const Key& key) const { return surface_ && key_.preparesAs(key); }
  bool knowsRefined(const Key& key) const { return surface_ && key_.refinesAs(key); }
  /// Of the prepared surface; closed handles change those of the refined one.
  double area() const { return area_; }
  double boundingBoxDiagonal() const { return boundingBoxDiagonal_; }

  /// A copy of the refined surface, with its requests where handles were closed and without them elsewhere; after knowsRefined().
  PreparedSurface refined() const;
  /// The surface before refinement without requests; after knowsPrepared(). Nothing is held any more after the second one.
  PreparedSurface prepared() const;
  PreparedSurface takePrepared();
  /// What refinement told.
  const std::vector<std::string>& notices() const { return notices_; }

  /// Holds a copy of the refined surface; `prepared` is what it was made from. Levels and map of another one go.
  void keep(const Key& key, PreparedSurface prepared, const PreparedSurface& refined,
    std::vector<std::string> notices);
  /// The finest level of `levels`.
  const PreparedSurface& surface() const { return *surface_; }

  std::optional<Redecimation> levels; ///< on surface()
  std::vector<Index> levelsKept;      ///< HierarchyOptions::keepVertices of their phase 1
  std::optional<PreviousMap> map;     ///< the last one; its ids are vertices of surface()
  double mapQuads = 0;                ///< that it was scaled to
  double mapAnisotropyLimit = 0;      ///< that it was made with
  bool mapStretched = false;          ///< RemeshOptions::distortionMetric of it

private:
  /// What refinement changes even where it splits nothing.
  struct Before
  {
    std::vector<std::uint8_t> flags;
    std::uint64_t hash = 0;
    RepairReport repair;
    std::string notice;
  };

  Key key_;
  double area_ = 0;
  double boundingBoxDiagonal_ = 0;
  std::unique_ptr<const PreparedSurface> surface_;
  std::optional<PreparedSurface> prepared_; ///< where refinement split something
  Before before_;                           ///< where it did not
  std::vector<std::string> notices_;
};

/// The key of a run but for its edge length.
RemeshMemory::Key memoryKey(
  const SurfaceInput& input, std::optional<double> featureAngle, double closeHandles, int threads);

} // namespace quadrille
