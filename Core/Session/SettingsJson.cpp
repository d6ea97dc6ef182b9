// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
// Settings as JSON: settingsToJson and settingsFromJson.
#include "Session/JsonReader.h"
#include "Session/SessionJson.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace quadrille
{
namespace
{

constexpr std::array<const char*, 4> kMethods{ "scale-aware", "mixed-integer", "quadcover",
  "seamless" };
constexpr std::array<const char*, 2> kFeatureCriteria{ "creases", "angle" };
constexpr std::array<const char*, 3> kFinalQualities{ "coarse", "intermediate", "input" };
constexpr std::array<const char*, 4> kSmallDetails{ "automatic", "resolve", "simplify", "keep" };

} // namespace

SessionJson settingsToJson(const RemeshOptions& options)
{
  // By name, so that an option that is new has to be put on one side or the other here.
  const auto& [quads, edgeLength, relativeEdgeLength, featureAngle, featureCriterion, shapeSizes,
    curvatureGuides, method, coarsestIntegers, coarseVertices, decimationCost, closeHandles,
    smallDetails, removeSmallComponents, anisotropyLimit, finalQuality, distortionMetric,
    maximumNumberOfQuads, preview, smoothingSteps, memoryLimit, keepsPositions, mergeCharts,
    knownMap, threads, warmStart, progress] = options;
  static_cast<void>(decimationCost); // sessions have the default one
  static_cast<void>(preview);
  static_cast<void>(memoryLimit);
  static_cast<void>(keepsPositions);
  static_cast<void>(mergeCharts);
  static_cast<void>(knownMap);
  static_cast<void>(threads);
  static_cast<void>(progress);
  SessionJson json;
  if (quads)
  {
    json["quads"] = *quads;
  }
  else if (edgeLength)
  {
    json["edge_length"] = *edgeLength;
  }
  else
  {
    json["relative_edge_length"] = relativeEdgeLength;
  }
  json["feature_angle"] = featureAngle ? SessionJson(*featureAngle) : SessionJson(nullptr);
  json["feature_criterion"] = kFeatureCriteria[static_cast<std::size_t>(featureCriterion)];
  json["chord_error"] =
    shapeSizes.chordError ? SessionJson(*shapeSizes.chordError) : SessionJson(nullptr);
  json["gap_quads"] = shapeSizes.gapQuads;
  json["smallest_size"] = shapeSizes.smallest;
  json["largest_size"] = shapeSizes.largest;
  json["curvature_guides"] = curvatureGuides ? SessionJson(*curvatureGuides) : SessionJson(nullptr);
  json["method"] = kMethods[static_cast<std::size_t>(method)];
  json["integers"] = coarsestIntegers ? "coarsest" : "keep-sizes";
  json["coarse_vertices"] = coarseVertices;
  json["close_handles"] = closeHandles;
  json["small_details"] = kSmallDetails[static_cast<std::size_t>(smallDetails)];
  json["small_components"] = removeSmallComponents ? "remove" : "keep";
  json["anisotropy_limit"] = anisotropyLimit;
  json["final_quality"] = kFinalQualities[static_cast<std::size_t>(finalQuality)];
  json["distortion_metric"] = distortionMetric;
  json["maximum_number_of_quads"] = maximumNumberOfQuads;
  json["smoothing_steps"] = smoothingSteps;
  json["warm_start"] = warmStart;
  return json;
}

void settingsFromJson(const SessionJson& json, RemeshOptions& options, const std::string& where)
{
  ObjectReader reader(json, where);
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
  }
  if (reader.has("quads"))
  {
    reader.read("quads", options.quads.emplace());
  }
  if (reader.has("edge_length"))
  {
    reader.read("edge_length", options.edgeLength.emplace());
  }
  reader.readIf("relative_edge_length", options.relativeEdgeLength);
  const auto readOptional = [&](const char* name, std::optional<double>& value)
  {
    if (reader.has(name))
    {
      value.reset();
      if (!reader.at(name).is_null())
      {
        reader.read(name, value.emplace());
      }
    }
  };
  readOptional("feature_angle", options.featureAngle);
  if (reader.has("feature_criterion"))
  {
    options.featureCriterion =
      static_cast<FeatureCriterion>(reader.readName("feature_criterion", kFeatureCriteria));
  }
  readOptional("chord_error", options.sizes.chordError);
  readOptional("curvature_guides", options.curvatureGuides);
  reader.readIf("gap_quads", options.sizes.gapQuads);
  reader.readIf("smallest_size", options.sizes.smallest);
  reader.readIf("largest_size", options.sizes.largest);
  constexpr std::array<const char*, 2> kIntegers{ "keep-sizes", "coarsest" };
  constexpr std::array<const char*, 2> kSmall{ "keep", "remove" };
  if (reader.has("method"))
  {
    options.method = static_cast<MapMethod>(reader.readName("method", kMethods));
  }
  if (reader.has("integers"))
  {
    options.coarsestIntegers = reader.readName("integers", kIntegers) == 1;
  }
  if (reader.has("small_details"))
  {
    options.smallDetails =
      static_cast<SmallDetails>(reader.readName("small_details", kSmallDetails));
  }
  if (reader.has("small_components"))
  {
    options.removeSmallComponents = reader.readName("small_components", kSmall) == 1;
  }
  if (reader.has("final_quality"))
  {
    options.finalQuality =
      static_cast<FinalQuality>(reader.readName("final_quality", kFinalQualities));
  }
  reader.readIf("coarse_vertices", options.coarseVertices);
  reader.readIf("close_handles", options.closeHandles);
  reader.readIf("anisotropy_limit", options.anisotropyLimit);
  reader.readIf("distortion_metric", options.distortionMetric);
  reader.readIf("maximum_number_of_quads", options.maximumNumberOfQuads);
  reader.readIf("smoothing_steps", options.smoothingSteps);
  reader.readIf("warm_start", options.warmStart);
  reader.finish();
}

} // namespace quadrille
