// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Native/RemeshCall.h"

#include "Evaluation/ConstraintMeasures.h"
#include "Native/Arrays.h"
#include "Native/Errors.h"
#include "Native/ProgressCall.h"
#include "Native/Results.h"
#include "Pipeline/QuadsOfShape.h"
#include "Prepare/ConstraintPlacement.h"
#include "Session/SessionText.h"

#include <algorithm>
#include <utility>

namespace quadrille::native
{

namespace
{

/// What the run is asked for beside the surface and the settings.
struct HowToRun
{
  bool preview = false;
  bool everything = false;
  double timeLimit = 0;
  std::optional<SymmetryOptions> symmetry;
};

template <class Value>
Value valueOr(const py::dict& how, const char* name, Value otherwise)
{
  return how.contains(name) ? how[name].cast<Value>() : otherwise;
}

/// Two vectors.
std::pair<Vector3, Vector3> vectorPair(const py::handle& pair)
{
  const std::vector<Vector3> both = vectorsFrom(pair.cast<ArrayOf<double>>());
  return { both.at(0), both.at(1) };
}

HowToRun howToRun(const py::dict& how)
{
  HowToRun run;
  run.preview = valueOr(how, "preview", false);
  run.everything = valueOr(how, "everything", false);
  run.timeLimit = valueOr(how, "time_limit", 0.0);
  if (how.contains("symmetry"))
  {
    run.symmetry.emplace();
    run.symmetry->planeCurve = static_cast<PlaneCurve>(valueOr(how, "plane_curve", 0));
    if (how.contains("symmetry_plane"))
    {
      const auto [origin, normal] = vectorPair(how["symmetry_plane"]);
      run.symmetry->plane = MirrorPlane{ origin, normal };
    }
  }
  if (how.contains("rotation_order"))
  {
    run.symmetry.emplace();
    run.symmetry->rotation = RotationRequest{ how["rotation_order"].cast<int>(), std::nullopt };
    if (how.contains("rotation_axis"))
    {
      const auto [origin, direction] = vectorPair(how["rotation_axis"]);
      run.symmetry->rotation->axis = RotationAxis{ origin, direction };
    }
  }
  return run;
}

/// What is drawn, as Line of the package has it.
struct DrawnByKind
{
  int kind = 0;
  std::vector<Vector3> points;
  double radius = 0;
  double factor = 1;
};

std::vector<DrawnByKind> drawnLines(const py::list& lines)
{
  std::vector<DrawnByKind> drawn;
  for (const py::handle& line : lines)
  {
    const auto fields = line.cast<py::tuple>();
    drawn.push_back({ fields[0].cast<int>(), vectorsFrom(fields[1].cast<ArrayOf<double>>()),
      fields[2].cast<double>(), fields[3].cast<double>() });
  }
  return drawn;
}

/// Puts the lines and points on the surface.
PlacedConstraints placeLines(SurfaceInput& input, std::vector<DrawnByKind> lines)
{
  if (lines.empty() || input.polygonPoints.empty())
  {
    return {};
  }
  requirePolygons(input);
  const SurfacePlaces places(input);
  const SurfacePaths paths(input);
  ConstraintPlacement placement(input, places, paths);
  for (std::size_t i = 0; i < lines.size(); ++i)
  {
    const auto source = static_cast<std::int64_t>(i);
    DrawnByKind& line = lines[i];
    switch (line.kind)
    {
      case 0:
        placement.addFeature({ source, std::move(line.points) });
        break;
      case 1:
        placement.addStroke({ source, std::move(line.points) }, 1, line.radius);
        break;
      case 6:
        placement.addCleared(source, line.points.front());
        break;
      case 7:
        placement.addSize(source, line.points.front(), line.radius, line.factor);
        break;
      default:
        placement.addCurve(source, line.kind == 2 ? CurveKind::Connection : CurveKind::Cycle,
          std::move(line.points));
    }
  }
  placement.addTo(input);
  return placement.result();
}

} // namespace

py::dict remeshCall(const py::dict& surface, const std::string& settings, const py::dict& how,
  const py::list& lines, const py::object& progress)
{
  const HowToRun howTo = howToRun(how);
  Remeshed remeshed;
  remeshed.everything = howTo.everything;
  RemeshOptions& options = remeshed.options;
  settingsFromText(settings, options);
  options.preview = howTo.preview;
  options.mergeCharts = howTo.everything;
  options.keepsPositions = false; // unless something asks for them
  ProgressCall call(progress, true, howTo.timeLimit);
  options.progress = call.callback(0.02, 0.95);
  SurfaceInput input = surfaceFrom(surface);
  auto drawn = drawnLines(lines);
  withoutLock(
    [&]
    {
      remeshed.asked.arrays = arrayConstraints(input);
      remeshed.sizing = input.sizing;
      PlacedConstraints placed = placeLines(input, std::move(drawn));
      remeshed.asked.placed = std::move(placed.placed);
      remeshed.notices = std::move(placed.notices);
      QuadProblem problem;
      problem.surface = given(input);
      problem.options = options;
      problem.symmetry = howTo.symmetry;
      remeshed.made = remesh(problem);
    });
  call.rethrow();
  const RemeshResult& result = remeshed.made.remeshed;
  if (result.status.code == StatusCode::Cancelled)
  {
    throw RunFailure(call.stopText());
  }
  if (!result.status.ok())
  {
    throw RunFailure(result.status.message.empty() ? "remeshing failed" : result.status.message);
  }
  remeshed.asked.curves = result.curves;
  remeshed.asked.edgeLength = lengthOfSizeOne(
    result.targetEdgeLength, quadsAsked(options, result.targetQuads), result.quads.quads.size());
  if (remeshed.made.thinning)
  {
    remeshed.notices.push_back(remeshed.made.thinning->text());
  }
  remeshed.notices.insert(remeshed.notices.end(), result.notices.begin(), result.notices.end());
  py::dict dict = resultDict(remeshed);
  if (result.stopped.empty()) // who has asked for a stop is not called again
  {
    call.finish();
    call.rethrow();
  }
  return dict;
}

} // namespace quadrille::native
