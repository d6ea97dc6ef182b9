// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/GridMap.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace quadrille
{
namespace
{

constexpr int kMaximumScalings = 4;
/// How often other integers are tried where embedding fails.
constexpr int kMaximumEmbeddings = 4;
/// The number of quads is accepted when it is this close to the target (relative).
constexpr double kCountTolerance = 0.06;

class Stopwatch
{
public:
  explicit Stopwatch(double& seconds) : seconds_(seconds) {}
  ~Stopwatch()
  {
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Area of the map in quads.
double mapArea(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  double area = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Vector2 p = toDouble(uv[3 * f + 1] - uv[3 * f]);
    const Vector2 q = toDouble(uv[3 * f + 2] - uv[3 * f]);
    area += 0.5 * (p.x() * q.y() - p.y() * q.x());
  }
  return area;
}

std::vector<Index> cornerVertices(const Mesh& mesh, const std::vector<Index>& faces)
{
  std::vector<Index> vertices;
  for (const Index f : faces)
  {
    for (Index corner = 0; corner < 3; ++corner)
    {
      vertices.push_back(mesh.origin[3 * f + corner]);
    }
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

ProgressCallback subProgress(const ProgressCallback& progress, double begin, double end)
{
  if (!progress)
  {
    return {};
  }
  return [=](double fraction, const std::string& text)
  { return progress(begin + (end - begin) * fraction, text); };
}

/// The seamless map whose area is the target: a second solve only when the first one's area is off.
SeamlessResult seamlessNear(const Mesh& mesh, const CrossField& field, double targetQuads,
  const ProgressCallback& progress, double& edgeLength)
{
  SeamlessResult result;
  for (int attempt = 0; attempt < 2; ++attempt)
  {
    SeamlessOptions options;
    options.edgeLength = edgeLength;
    options.progress = progress;
    result = computeSeamlessMap(mesh, field, options);
    const double area = mapArea(mesh, result.uv);
    if (!result.status.ok() || targetQuads <= 0 || !(area > 0) ||
      std::abs(area / targetQuads - 1) < 0.02)
    {
      break;
    }
    edgeLength *= std::sqrt(area / targetQuads);
  }
  return result;
}

} // namespace

GridMapResult computeGridMap(const Mesh& mesh, const GridMapOptions& options)
{
  if (!(options.edgeLength > 0) || !std::isfinite(options.edgeLength))
  {
    throw InvalidInput("the target edge length must be a positive number");
  }
  GridMapResult result;
  if (mesh.vertexCount() > options.maximumVertices)
  {
    result.status = { StatusCode::TooLarge,
      "the coarse level has " + std::to_string(mesh.vertexCount()) + " vertices, more than " +
        std::to_string(options.maximumVertices) +
        "; folds, noise or features hold them: smooth or repair the surface, raise the feature "
        "angle, or ask for longer "
        "edges" };
    return result;
  }
  {
    const Stopwatch watch(result.secondsField);
    CrossFieldOptions fieldOptions;
    fieldOptions.targetEdgeLength = options.edgeLength;
    fieldOptions.progress = subProgress(options.progress, 0.0, 0.1);
    result.field = computeCrossField(mesh, fieldOptions);
  }
  const CrossField& field = result.field;
  if (!field.status.ok())
  {
    result.status = field.status;
    result.offenders = field.offenders;
    return result;
  }
  const std::vector<std::uint8_t> integerVertex = integerVertices(mesh, field);
  const auto fail = [&](const Status& status, std::vector<FixedVec2> uv,
                      const std::vector<Index>& faces, const std::vector<Index>& vertices)
  {
    result.status = status;
    result.uv = std::move(uv);
    result.offenders = cornerVertices(mesh, faces);
    result.offenders.insert(result.offenders.end(), vertices.begin(), vertices.end());
    result.certificate = certify(mesh, result.uv, field.turns, integerVertex);
    return result;
  };

  double edgeLength = options.edgeLength;
  double mapEdgeLength = edgeLength;
  double bestDeviation = std::numeric_limits<double>::infinity();
  std::vector<FixedVec2> seamlessUv; // that result.uv was quantized from
  for (int scaling = 0; scaling < kMaximumScalings; ++scaling)
  {
    SeamlessResult seamless;
    {
      const Stopwatch watch(result.secondsSeamless);
      seamless = seamlessNear(mesh, field, scaling == 0 ? options.targetQuads : 0,
        subProgress(options.progress, 0.1, 0.4), edgeLength);
    }
    if (!seamless.status.ok())
    {
      return fail(seamless.status, std::move(seamless.uv), seamless.inverted, seamless.offenders);
    }
    QuantizeResult quantized;
    {
      const Stopwatch watch(result.secondsQuantize);
      QuantizeOptions quantizeOptions;
      quantizeOptions.progress = subProgress(options.progress, 0.4, 0.7);
      quantized = quantizeMap(mesh, field, seamless.uv, quantizeOptions);
    }
    if (!quantized.status.ok())
    {
      return fail(quantized.status, std::move(quantized.uv), {}, {});
    }
    const double area = mapArea(mesh, quantized.uv);
    const double ratio = options.targetQuads > 0 ? area / options.targetQuads : 1.0;
    const double deviation = std::abs(std::log(ratio));
    if (deviation < bestDeviation)
    {
      bestDeviation = deviation;
      mapEdgeLength = edgeLength;
      result.refinement = quantized.refinement;
      result.uv = std::move(quantized.uv);
      seamlessUv = std::move(seamless.uv);
    }
    if (deviation <= kCountTolerance)
    {
      break;
    }
    edgeLength *= std::sqrt(ratio);
  }

  EmbedResult embedded;
  std::vector<Index> watched;
  for (int round = 0; round < kMaximumEmbeddings; ++round)
  {
    if (round > 0)
    {
      // Other integers, that leave room round the places where embedding failed.
      const Stopwatch watch(result.secondsQuantize);
      QuantizeOptions quantizeOptions;
      quantizeOptions.watched = watched;
      quantizeOptions.progress = subProgress(options.progress, 0.4, 0.7);
      QuantizeResult quantized = quantizeMap(mesh, field, seamlessUv, quantizeOptions);
      if (!quantized.status.ok())
      {
        break;
      }
      result.refinement = quantized.refinement;
      result.uv = std::move(quantized.uv);
    }
    const Stopwatch watch(result.secondsEmbed);
    EmbedOptions embedOptions;
    embedOptions.edgeLength = mapEdgeLength;
    embedOptions.seamlessUv = &seamlessUv;
    embedOptions.progress = subProgress(options.progress, 0.7, 1.0);
    embedded = embedMap(mesh, field, result.uv, embedOptions);
    if (embedded.status.ok())
    {
      break;
    }
    watched.insert(watched.end(), embedded.offenders.begin(), embedded.offenders.end());
  }
  if (!embedded.status.ok())
  {
    return fail(embedded.status, std::move(embedded.uv), embedded.inverted, embedded.offenders);
  }
  result.uv = std::move(embedded.uv);
  result.certificate = certify(mesh, result.uv, field.turns, integerVertex);
  if (!result.certificate.valid())
  {
    result.status = { StatusCode::NotConverged,
      "the coarse map does not pass its certificate: " + result.certificate.text() };
    result.offenders = cornerVertices(mesh, result.certificate.worstFaces);
  }
  return result;
}

} // namespace quadrille
