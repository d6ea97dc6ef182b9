// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Api/quadrille/quadrille.h"

#include "Base/Angles.h"
#include "Base/Error.h"
#include "Base/Refuse.h"
#include "Pipeline/QuadsOfShape.h"
#include "Ways/Ways.h"

#include <algorithm>
#include <utility>

namespace quadrille
{

namespace
{

template <class Values>
void requireOneEach(
  const Values& values, std::size_t count, const std::string& name, const std::string& element)
{
  refuseIf(!values.empty() && values.size() != count, name, " has ", values.size(),
    " values, but there are ", count, " ", element, ": it has to have one each, or none");
}

std::vector<Vector3> vectorsOf(const std::vector<std::array<double, 3>>& tuples)
{
  std::vector<Vector3> vectors(tuples.size());
  std::transform(tuples.begin(), tuples.end(), vectors.begin(),
    [](const std::array<double, 3>& t) { return Vector3(t[0], t[1], t[2]); });
  return vectors;
}

SurfaceInput inputOf(const TriangleMesh& mesh)
{
  const std::size_t triangles = mesh.triangles.size();
  requireOneEach(mesh.featureEdges, triangles, "featureEdges", "triangles");
  requireOneEach(mesh.patchIds, triangles, "patchIds", "triangles");
  requireOneEach(mesh.guidingDirections, triangles, "guidingDirections", "triangles");
  requireOneEach(mesh.sizing, mesh.points.size(), "sizing", "points");
  // Corners of triangles are half-edges of the mesh, whose ids have 32 bits.
  refuseIf(triangles >= kInvalidIndex / 3 || mesh.points.size() >= kInvalidIndex, "the mesh has ",
    triangles, " triangles and ", mesh.points.size(),
    " points: that is more than 32-bit ids can name");
  SurfaceInput input;
  input.points = vectorsOf(mesh.points);
  input.polygonOffsets.resize(triangles + 1);
  input.polygonPoints.reserve(3 * triangles);
  for (std::size_t t = 0; t < triangles; ++t)
  {
    input.polygonOffsets.edit()[t + 1] = static_cast<Index>(3 * (t + 1));
    input.polygonPoints.append(mesh.triangles[t].begin(), mesh.triangles[t].end());
  }
  input.featureEdges = mesh.featureEdges;
  input.patchIds = mesh.patchIds;
  input.guideDirections = vectorsOf(mesh.guidingDirections);
  input.sizing = mesh.sizing;
  return input;
}

RemeshOptions runOptionsOf(const QuadOptions& options)
{
  refuseIf(options.quads.has_value() + options.edgeLength.has_value() +
        options.relativeEdgeLength.has_value() >
      1,
    "only one of quads, edgeLength and relativeEdgeLength can be given");
  if (options.featureAngle && !(*options.featureAngle > 0 && *options.featureAngle <= 180))
  {
    throw InvalidInput("featureAngle is " + std::to_string(*options.featureAngle) +
      ", but has to be above 0 and at most 180 degrees, or none");
  }
  RemeshOptions run;
  run.quads = options.quads;
  run.edgeLength = options.edgeLength;
  if (options.relativeEdgeLength)
  {
    run.relativeEdgeLength = *options.relativeEdgeLength;
  }
  else if (!options.quads && !options.edgeLength)
  {
    askForQuadsOfShape(run);
  }
  run.featureAngle.reset();
  if (options.featureAngle)
  {
    run.featureAngle = radians(*options.featureAngle);
  }
  run.smoothingSteps = options.smoothingSteps;
  run.maximumNumberOfQuads = options.maximumQuads;
  run.threads = options.threads;
  run.progress = options.progress;
  run.keepsPositions = false;
  return run;
}

QuadResult resultOf(QuadsMade& made, int threads)
{
  RemeshResult& run = made.remeshed;
  const QuadMesh& mesh = run.quads;
  QuadResult result;
  result.points.resize(mesh.points.size());
  std::transform(mesh.points.begin(), mesh.points.end(), result.points.begin(),
    [](const Vector3& p) {
      return std::array<double, 3>{ p.x(), p.y(), p.z() };
    });
  const std::vector<SourceLocation> places = made.pointSources(threads);
  result.pointPlaces.resize(places.size());
  std::transform(places.begin(), places.end(), result.pointPlaces.begin(),
    [](const SourceLocation& at) {
      return SurfacePlace{ at.polygon, at.points, at.weights };
    });
  result.quads = mesh.quads;
  result.quadTriangles = made.quadPolygons(places);
  for (const QuadLine& line : mesh.lines)
  {
    if (!line.boundary)
    {
      result.featureEdges.push_back({ line.a, line.b });
    }
  }
  result.edgeLength = run.targetEdgeLength;
  result.notices = std::move(run.notices);
  if (made.thinning)
  {
    result.notices.insert(result.notices.begin(), made.thinning->text());
  }
  result.stopped = std::move(run.stopped);
  return result;
}

} // namespace

QuadResult makeQuads(const TriangleMesh& mesh, const QuadOptions& options)
{
  try
  {
    SurfaceInput input = inputOf(mesh);
    QuadProblem problem;
    problem.surface = given(input);
    problem.options = runOptionsOf(options);
    QuadsMade made = remesh(problem);
    const RemeshResult& run = made.remeshed;
    if (run.status.code == StatusCode::Cancelled)
    {
      throw StoppedError(run.status.message);
    }
    if (!run.status.ok())
    {
      throw NoQuadsError(run.status.message);
    }
    return resultOf(made, options.threads);
  }
  catch (const InvalidInput& error)
  {
    throw InputError(error.what());
  }
}

const char* libraryVersion()
{
  return QUADRILLE_VERSION;
}

} // namespace quadrille
