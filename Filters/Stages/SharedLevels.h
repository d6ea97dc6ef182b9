// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What one stage filter has prepared and the next one would have to make again from the data between them.
///
/// The filter that made it holds it, with its block; others find it by contents, in the same process only. What nobody
/// holds any more is gone. Who finds nothing makes the same again, bit for bit: after a file, in another process,
/// behind a filter that has changed the data.
#pragma once

#include "Blocks/Blocks.h"
#include "Mesh/Surface.h"
#include "Pipeline/Options.h"
#include "Prepare/Frame.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

class vtkPolyData;

namespace quadrille
{

/// What the finest level is made from.
struct SurfaceKey
{
  std::uint64_t input = 0; ///< contentHash of the converted surface, in its frame
  std::uint64_t drawn = 0; ///< of what is drawn on it
  std::optional<double> featureAngle;
  FeatureCriterion featureCriterion = FeatureCriterion::Creases;
  double edgeLength = 0;

  bool operator==(const SurfaceKey& other) const
  {
    return input == other.input && drawn == other.drawn && featureAngle == other.featureAngle &&
      featureCriterion == other.featureCriterion && edgeLength == other.edgeLength;
  }
};

/// The finest level in its frame, as sizeSurface makes it. Guides and valences are not in its key: they may be others.
struct SharedSurface
{
  SurfaceKey key;
  PreparedSurface surface;
};

/// A mapped surface that was written, and the level it was written from.
struct SharedMap
{
  std::uint64_t key = 0; ///< mappedSurfaceHash of what was written
  std::shared_ptr<const SharedSurface> finest;
  Frame frame; ///< of the finest level
};

/// What a stage filter holds for a block.
struct SharedLevels : BlockMemory
{
  std::shared_ptr<const SharedSurface> surface;
  std::shared_ptr<const SharedMap> map;
};

/// 64 bits over what is drawn that changes the triangles.
std::uint64_t drawnHash(DrawnRequests drawn);

/// Null where no filter of this process holds it.
std::shared_ptr<const SharedSurface> findSharedSurface(const SurfaceKey& key);
std::shared_ptr<const SharedMap> findSharedMap(std::uint64_t key);

/// Lets others find it for as long as somebody holds it.
void share(const std::shared_ptr<const SharedSurface>& surface);
void share(const std::shared_ptr<const SharedMap>& map);

/// 64 bits over all that readMappedInput reads of a surface with the array IGM; none where an array is not plain
/// memory, or IGM is missing.
std::optional<std::uint64_t> mappedSurfaceHash(vtkPolyData* data, int threads);

} // namespace quadrille
