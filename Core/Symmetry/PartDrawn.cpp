// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/PartDrawn.h"

#include "Base/Lists.h"
#include "Base/PlaceText.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

namespace quadrille
{
namespace
{

/// A piece of a line that lies in one part, taken to the part that is made.
struct PieceInPart
{
  std::vector<Vector3> points;
  bool isOwn = false;
};

/// Where the segment leaves the part of its first end: the last place there, and the first one beyond.
std::pair<Vector3, Vector3> crossingOf(const PartTask& task, Vector3 inside, Vector3 beyond)
{
  const int steps = task.stepsToPart(inside);
  for (int i = 0; i < std::numeric_limits<double>::digits; ++i)
  {
    const Vector3 middle = 0.5 * (inside + beyond);
    (task.stepsToPart(middle) == steps ? inside : beyond) = middle;
  }
  return { inside, beyond };
}

std::vector<PieceInPart> piecesOf(const PartTask& task, const std::vector<Vector3>& line)
{
  std::vector<PieceInPart> pieces;
  const auto begin = [&](const Vector3& p) {
    pieces.push_back({ { p }, task.stepsToPart(p) == 0 });
  };
  begin(line.front());
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
  {
    Vector3 from = line[i];
    // From part to part, of which a straight segment crosses each once.
    for (int crossed = 0; crossed < task.isometry.order; ++crossed)
    {
      if (task.stepsToPart(from) == task.stepsToPart(line[i + 1]))
      {
        break;
      }
      const auto [last, first] = crossingOf(task, from, line[i + 1]);
      pieces.back().points.push_back(last);
      begin(first);
      from = first;
    }
    pieces.back().points.push_back(line[i + 1]);
  }
  for (PieceInPart& piece : pieces)
  {
    const int steps = task.stepsToPart(piece.points[piece.points.size() / 2]);
    for (Vector3& p : piece.points)
    {
      p = task.isometry.image(p, steps);
    }
  }
  eraseIf(pieces,
    [&](const PieceInPart& piece)
    {
      return std::all_of(piece.points.begin(), piece.points.end(),
        [&](const Vector3& p) { return (p - piece.points.front()).norm() <= task.tolerance; });
    });
  return pieces;
}

template <class Line>
void addLines(const PartTask& task, const std::vector<Line>& lines, std::vector<Line>& added)
{
  std::vector<Line> own;
  for (const Line& line : lines)
  {
    for (PieceInPart& piece : piecesOf(task, line.points))
    {
      Line asked = line;
      asked.points = std::move(piece.points);
      (piece.isOwn ? own : added).push_back(std::move(asked));
    }
  }
  added.insert(added.end(), own.begin(), own.end()); // later ones count
}

class PartPlaces
{
public:
  PartPlaces(const PartTask& task, const SurfacePart& part, std::vector<std::string>& notices)
    : task_(task), part_(part), notices_(notices)
  {
  }

  std::vector<ValencePlace> valences(const DrawnRequests& drawn)
  {
    std::vector<ValencePlace> asked;
    for (const bool own : { true, false })
    {
      // All others regular: those in front say all, and an image that is off would be one too many.
      const bool isSaid = !own && task_.isometry.isReflection &&
        task_.whole.surface.regularElsewhere && !asked.empty();
      for (const ValencePlace& place : drawn.valences)
      {
        if (!isSaid && (task_.stepsToPart(place.place) == 0) == own)
        {
          add(place, asked);
        }
      }
    }
    return asked;
  }

  /// Also the images whose radius reaches into the part.
  std::vector<SizeRequest> sizes(const DrawnRequests& drawn) const
  {
    std::vector<SizeRequest> asked;
    for (const SizeRequest& size : drawn.sizes)
    {
      for (int steps = 0; steps < task_.isometry.order; ++steps)
      {
        SizeRequest image = size;
        image.place = task_.isometry.image(size.place, steps);
        const bool isIn = task_.stepsToPart(image.place) == 0;
        const bool reaches = isIn ||
          std::any_of(part_.input.points.begin(), part_.input.points.end(),
            [&](const Vector3& p) { return (p - image.place).norm() <= size.radius; });
        if (reaches)
        {
          asked.push_back(image);
        }
      }
    }
    return asked;
  }

private:
  void tell(const ValencePlace& asked, const std::string& but)
  {
    notices_.push_back(
      "valence " + std::to_string(asked.valence) + " at " + placeText(asked.place) + " " + but);
  }

  void add(const ValencePlace& place, std::vector<ValencePlace>& asked)
  {
    const int steps = task_.stepsToPart(place.place);
    ValencePlace image{ task_.isometry.image(place.place, steps), place.valence, place.mayDrift };
    if (task_.isometry.fixes(place.place, task_.tolerance) && !share(place, image.valence))
    {
      return;
    }
    const bool isThere = std::any_of(asked.begin(), asked.end(),
      [&](const ValencePlace& other)
      { return (other.place - image.place).norm() <= task_.deviation + task_.tolerance; });
    if (!isThere)
    {
      asked.push_back(image);
    }
  }

  /// What the part's border has at a place that is its own image, as if the quads went on beyond. False, with a notice,
  /// where that cannot be.
  bool share(const ValencePlace& asked, int& valence)
  {
    if (task_.midLine)
    {
      if (asked.valence != kRegularValence)
      {
        tell(asked,
          "lies in the mirror plane, which quads straddle, so that no point of them is there: it "
          "was not asked (move it aside, or choose an isoline for the plane's curve)");
      }
      return false;
    }
    const int order = task_.isometry.order;
    if (asked.valence % order != 0)
    {
      tell(asked,
        task_.isometry.isReflection
          ? "lies in the mirror plane, whose curve is an isoline, so that only even numbers have a "
            "mirror image: it was not asked"
          : "lies on the axis of rotation, where quads come in multiples of " +
            std::to_string(order) + ": it was not asked");
      return false;
    }
    valence = asked.valence / order + kBesideQuads;
    return true;
  }

  const PartTask& task_;
  const SurfacePart& part_;
  std::vector<std::string>& notices_;
};

} // namespace

DrawnRequests drawnOfPart(const PartTask& task, const SurfacePart& part, const DrawnRequests& drawn,
  std::vector<std::string>& notices)
{
  DrawnRequests asked;
  if (drawn.empty())
  {
    return asked;
  }
  addLines(task, drawn.features, asked.features);
  addLines(task, drawn.strokes, asked.strokes);
  PartPlaces places(task, part, notices);
  asked.valences = places.valences(drawn);
  asked.sizes = places.sizes(drawn);
  for (const Vector3& place : drawn.cleared)
  {
    asked.cleared.push_back(task.isometry.image(place, task.stepsToPart(place)));
  }
  return asked;
}

} // namespace quadrille
