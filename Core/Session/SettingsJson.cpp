// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
// Settings as JSON: settingsToJson and settingsFromJson.
#include "Pipeline/QuadsOfShape.h"
#include "Session/JsonFields.h"
#include "Session/SessionJson.h"

#include <array>
#include <cstddef>
#include <string>

namespace quadrille
{
namespace
{

/// The number of quads where the shape of the surface says how many.
constexpr std::size_t kByShape = 0;
constexpr std::array<const char*, 4> kMethods{ "scale-aware", "mixed-integer", "quadcover",
  "seamless" };
constexpr std::array<const char*, 2> kFeatureCriteria{ "creases", "angle" };
constexpr std::array<const char*, 3> kFinalQualities{ "coarse", "intermediate", "input" };
constexpr std::array<const char*, 4> kSmallDetails{ "automatic", "resolve", "simplify", "keep" };

constexpr std::array<const char*, 2> kIntegers{ "keep-sizes", "coarsest" };
constexpr std::array<const char*, 2> kSmallComponents{ "keep", "remove" };

/// All but the size.
template <typename Fields, typename Options>
void settingsFields(Fields& fields, Options& options)
{
  // By name, so that an option that is new has to be put on one side or the other here.
  auto& [quads, edgeLength, relativeEdgeLength, growsWithShape, featureAngle, featureCriterion,
    shapeSizes, curvatureGuides, method, coarsestIntegers, coarseVertices, decimationCost,
    smallestDetail, smallDetails, removeSmallComponents, leavesOutFailed, anisotropyLimit,
    finalQuality, distortionMetric, maximumNumberOfQuads, preview, smoothingSteps, memoryLimit,
    keepsPositions, mergeCharts, knownMap, threads, warmStart, progress] = options;
  const auto notThese = [](const auto&... /*values*/) {};
  notThese(quads, edgeLength, relativeEdgeLength, growsWithShape);
  notThese(decimationCost, leavesOutFailed); // sessions have the default ones
  notThese(preview, memoryLimit, keepsPositions, mergeCharts, knownMap, threads, progress);
  fields.orNull("feature_angle", featureAngle);
  fields.mayName("feature_criterion", featureCriterion, kFeatureCriteria);
  fields.orNull("chord_error", shapeSizes.chordError);
  fields.orNull("angle_a_quad", shapeSizes.turn);
  fields.may("gap_quads", shapeSizes.gapQuads);
  fields.may("smallest_size", shapeSizes.smallest);
  fields.may("largest_size", shapeSizes.largest);
  fields.orNull("curvature_guides", curvatureGuides);
  fields.mayName("method", method, kMethods);
  fields.mayName("integers", coarsestIntegers, kIntegers);
  fields.may("coarse_vertices", coarseVertices);
  fields.may("smallest_detail", smallestDetail);
  fields.mayName("small_details", smallDetails, kSmallDetails);
  fields.mayName("small_components", removeSmallComponents, kSmallComponents);
  fields.may("anisotropy_limit", anisotropyLimit);
  fields.mayName("final_quality", finalQuality, kFinalQualities);
  fields.may("distortion_metric", distortionMetric);
  fields.may("maximum_number_of_quads", maximumNumberOfQuads);
  fields.may("smoothing_steps", smoothingSteps);
  fields.may("warm_start", warmStart);
}

} // namespace

SessionJson settingsToJson(const RemeshOptions& options)
{
  SessionJson json;
  FieldWriter writer(json);
  if (options.quads && options.growsWithShape)
  {
    writer.need("quads", kByShape);
    if (*options.quads != kLeastQuadsOfShape)
    {
      writer.need("least_quads", *options.quads);
    }
  }
  else if (options.quads)
  {
    writer.need("quads", *options.quads);
  }
  else if (options.edgeLength)
  {
    writer.need("edge_length", *options.edgeLength);
  }
  else
  {
    writer.need("relative_edge_length", options.relativeEdgeLength);
  }
  settingsFields(writer, options);
  return json;
}

void settingsFromJson(const SessionJson& json, RemeshOptions& options, const std::string& where)
{
  FieldReader reader(json, where);
  const int sizes = static_cast<int>(reader.has("quads")) +
    static_cast<int>(reader.has("edge_length")) +
    static_cast<int>(reader.has("relative_edge_length"));
  if (sizes > 1)
  {
    refuse(where, " has more than one of \"quads\", \"edge_length\", \"relative_edge_length\"");
  }
  if (sizes == 1)
  {
    options.quads.reset();
    options.edgeLength.reset();
    options.growsWithShape = false;
  }
  if (reader.has("quads"))
  {
    reader.need("quads", options.quads.emplace());
    if (*options.quads == kByShape)
    {
      askForQuadsOfShape(options);
      reader.may("least_quads", *options.quads);
    }
  }
  if (reader.has("edge_length"))
  {
    reader.need("edge_length", options.edgeLength.emplace());
  }
  reader.may("relative_edge_length", options.relativeEdgeLength);
  settingsFields(reader, options);
  reader.finish();
}

} // namespace quadrille
