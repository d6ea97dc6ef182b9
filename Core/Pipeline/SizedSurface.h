// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// From the input in its frame to the surface that attempts begin with: repaired, with features, refined for the size
/// of the quads.
#pragma once

#include "Base/Error.h"
#include "Features/GivenUpFeatures.h"
#include "Mesh/Surface.h"
#include "Pipeline/Options.h"
#include "Pipeline/ResultStore.h"
#include "Pipeline/SmallDetails.h"
#include "Pipeline/StageRecords.h"
#include "Pipeline/WorkBound.h"

#include <memory>
#include <string>
#include <vector>

namespace quadrille
{

/// What sizing has set, and what is to be told of it.
struct SizeReport
{
  double edgeLength = 0;       ///< s, in the frame
  std::size_t targetQuads = 0; ///< predicted where an edge length was asked for
  std::vector<std::string> notices;
  std::vector<GivenUpCurve> givenUpFeatures; ///< lengths and places in the frame
  std::vector<SmallDetail> details;          ///< components that were left out
};

struct SizedSurface : SizeReport
{
  Status status; ///< TooLarge where more quads would be made than may
  std::shared_ptr<const PreparedSurface> surface;
  std::size_t work =
    WorkBound::kNoBound;    ///< that its attempts may take, where it is a part of a surface
  bool isTriedOnce = false; ///< one attempt is made
  bool hasBeside =
    false; ///< faces beside it are filled: quads of both are improved when they are one
  std::size_t quadsOfWhole = 0; ///< of the surface that it is a part of; 0: of none
  std::size_t quadsOfAll() const { return quadsOfWhole != 0 ? quadsOfWhole : targetQuads; }
  ResultKey key = 0; ///< of all but guides and valences
  /// Components that become the smallest blocks of quads, and a word on them, see countBlocks.
  std::vector<SmallDetail> blocks;
  std::string blocksNotice;
  std::vector<std::string> reused; ///< names of stages whose result the store had
  StageRecords stages;
};

/// Where earlier runs have left what they made of an input.
struct KnownInput
{
  ResultStore* store = nullptr; ///< null: none
  std::uint64_t inputHash = 0;  ///< contentHash of the input in its frame; where there is a store
};

/// Whether the store has the prepared surface of the input: then sizeSurface needs no points and polygons.
bool isPrepared(const KnownInput& known, const RemeshOptions& options);

/// Lengths in options are in the frame. The input is let go as soon as the surface is prepared. Throws InvalidInput as
/// prepareSurface does.
SizedSurface sizeSurface(
  SurfaceInput& input, const RemeshOptions& options, const KnownInput& known = {});

/// The steps of sizeSurface for a surface that becomes another between them and stays nowhere else. First: repaired,
/// in order, with its features, and with those and the sizes that are drawn. What is drawn is left of the input. sized:
/// gets stages and notices. options: get the number of quads where that grows with the shape.
PreparedSurface prepareDrawn(SurfaceInput& input, RemeshOptions& options,
  const ProgressCallback& progress, SizedSurface& sized);
/// Then from the prepared surface on. sized: as the first step has left it. drawn: in the frame; its features are drawn
/// already, so that one at a cleared place is cleared with what was there.
SizedSurface sizePrepared(PreparedSurface surface, const DrawnRequests& drawn,
  const RemeshOptions& options, SizedSurface sized);

/// Sizes that the shape of the surface asks for. Where a number of quads is asked for, the edge length is the one
/// with which they make as many, and the lengths that the shape asks for stay what they are.
/// sized: its edge length, number of quads and stages change. Returns what to tell of the sizes.
std::string adaptSizes(PreparedSurface& surface, const RemeshOptions& options, SizedSurface& sized);

/// Leaves components with less area than a closed block of quads out, on request, or where their blocks alone would be
/// more quads than are asked for; before anything depends on them. sized: its details tell them. Returns what to tell;
/// empty where none was left out.
std::string dropSmallComponents(
  PreparedSurface& surface, const RemeshOptions& options, SizedSurface& sized);

/// Counts the components that become blocks on the surface as it is: handles that were cut need no quads. Where an edge
/// length is asked for, the number of quads follows.
void countBlocks(SizedSurface& sized, const RemeshOptions& options, ResultStore* store);

/// Whether detected features are judged as creases, see removeFalseCreases.
bool judgesCreases(const RemeshOptions& options);

/// s for a number of quads, an edge length or a relative one, whichever the options ask for, kept to the bits of
/// Frame::lengthOf.
/// sizedArea: the surface's area over its sizes.
double targetEdgeLength(const RemeshOptions& options, double sizedArea, double boundingBoxDiagonal);
/// At least one, at most 1e15.
std::size_t predictedQuads(double sizedArea, double edgeLength);

} // namespace quadrille
