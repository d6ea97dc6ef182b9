// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The second stage of an integer-grid map: integers for a seamless one.
#pragma once

#include "Base/FixedPoint.h"
#include "Base/Progress.h"
#include "Base/WorkCount.h"
#include "CrossField/CrossField.h"

#include <memory>
#include <utility>
#include <vector>

namespace quadrille
{

struct QuantizeOptions
{
  /// The integers come near to so many times the seamless map; >= 0. 0: as near to nothing as a valid map can.
  double pull = 1;
  /// s, in units of the mesh: how far edges may leave curves follows it, see sharesOfCurves. 0: they do not count.
  double edgeLength = 0;
  /// Vertices, as EmbedResult::failedAt, whose triangles the integers must leave positive as they are.
  std::vector<Index> watched;
  /// #H: an integer-grid map along the same field, or null. Its integers are the start where they are valid, or can be
  /// repaired, and are only improved then.
  const std::vector<FixedVec2>* previousUv = nullptr;
  /// Whether integers are found anew where those of previousUv lead to none.
  bool anew = true;
  ProgressCallback progress;
};
struct QuantizeResult
{
  /// #H: integer translations, integer vertices and isolines locked; triangles may be inverted
  /// (embedMap mends that).
  std::vector<FixedVec2> uv;
  Status status;
  double refinement = 1; ///< factor by which the seamless map had to grow to be valid
  bool startedFromPrevious = false;
  /// Triangles, of the face between features that a broken one of the decimated map lies in, where there are no valid
  /// integers; empty where that is not known.
  std::vector<Index> failedFaces;
};
/// Thrown by quantizeMap() in place of WorkSpent where it had no valid integers yet: faces as QuantizeResult has them.
class QuantizingSpent : public WorkSpent
{
public:
  explicit QuantizingSpent(std::vector<Index> broken) : faces(std::move(broken)) {}
  std::vector<Index> faces;
};

/// Integers for a seamless map without a T-mesh [Coudert-Osmont et al. 2023]. Once they are valid they stay so, and
/// become those for another number of quads strip by strip.
class Quantizer
{
public:
  /// Finds valid ones, without regard to options.pull. The mesh and the maps are not used afterwards.
  Quantizer(const Mesh& mesh, const CrossField& field, const std::vector<FixedVec2>& seamlessUv,
    const QuantizeOptions& options);
  ~Quantizer();
  Quantizer(const Quantizer&) = delete;
  Quantizer& operator=(const Quantizer&) = delete;

  /// Not ok where there are none.
  const Status& status() const;
  /// Whether they began as those of options.previousUv.
  bool startedFromPrevious() const;
  /// From what they are to those near to `pull` times the seamless map, until nothing helps or half of the work that is
  /// left is done. They have to be valid.
  void improve(double pull, const ProgressCallback& progress);
  /// Of the map, in quads.
  double area() const;
  /// As they are now. Not ok, too, where sizes had to grow too much.
  QuantizeResult result() const;

private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Finds and improves them.
QuantizeResult quantizeMap(const Mesh& mesh, const CrossField& field,
  const std::vector<FixedVec2>& seamlessUv, const QuantizeOptions& options);

} // namespace quadrille
