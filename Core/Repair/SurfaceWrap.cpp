// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: GPL-3.0-or-later
// GPL as it includes headers of CGAL that are.
#include "Repair/SurfaceWrap.h"

#include "Base/Parallel.h"
#include "Base/Refuse.h"
#include "Repair/CgalMesh.h"

#include <CGAL/alpha_wrap_3.h>

#include <algorithm>
#include <cmath>

namespace quadrille
{

namespace
{

constexpr double kDefaultAlpha = 1.0 / 100; // over the diagonal
constexpr double kMostOffsetOverAlpha = 1.0 / 6;

double positive(const char* name, double value)
{
  refuseIf(!(value > 0) || !std::isfinite(value), name,
    " must be a positive, finite length in units of the surface, not ", value);
  return value;
}

/// Tells how far the carving is and stops it. Copied by CGAL, so what changes stands elsewhere.
class WrapVisitor : public CGAL::Alpha_wraps_3::internal::Wrapping_default_visitor
{
public:
  WrapVisitor(const ProgressCallback& progress, double expectedPoints, std::size_t& points)
    : progress_(&progress), expectedPoints_(expectedPoints), points_(&points)
  {
  }

  template <class Wrapper, class Gate>
  void before_facet_treatment(const Wrapper&, const Gate&) const
  {
    poll();
  }
  template <class Wrapper, class VertexHandle>
  void after_Steiner_point_insertion(const Wrapper&, VertexHandle) const
  {
    if (++*points_ % kHeavyChunk == 0)
    {
      const double made = static_cast<double>(*points_);
      report(*progress_, made / (made + expectedPoints_),
        "Wrapping: " + std::to_string(*points_) + " points");
    }
  }

private:
  const ProgressCallback* progress_;
  double expectedPoints_;
  std::size_t* points_;
};

void wrapSoup(const Soup& soup, const WrappedSurface& lengths, const WrapVisitor& visitor,
  cgal::SurfaceMesh& wrap)
{
  const std::vector<cgal::Point> points = cgal::pointsOf(soup.triangles);
  // CGAL 5 looks for the visitor among the options of the output, CGAL 6 among those of the input.
  const auto options = CGAL::parameters::visitor(visitor);
  if (soup.triangles.corners.empty())
  {
    CGAL::alpha_wrap_3(points, lengths.alpha, lengths.offset, wrap, options, options);
  }
  else
  {
    CGAL::alpha_wrap_3(points, cgal::cornersOf(soup.triangles), lengths.alpha, lengths.offset, wrap,
      options, options);
  }
}

} // namespace

WrappedSurface wrapSurface(const Soup& soup, const WrapOptions& options)
{
  refuseIf(
    !(soup.diagonal > 0), "all points of the input lie at one place: there is nothing to wrap");
  WrappedSurface result;
  result.alpha = positive("alpha", options.alpha.value_or(kDefaultAlpha * soup.diagonal));
  result.offset = positive("the offset",
    options.offset.value_or(
      kMostOffsetOverAlpha * std::min(kDefaultAlpha * soup.diagonal, result.alpha)));
  refuseIf(result.alpha < kLeastRelativeAlpha * soup.diagonal, "alpha is ", result.alpha,
    ", below a ", 1 / kLeastRelativeAlpha, "th of the diagonal, which is ", soup.diagonal,
    ": give a larger one");
  const double expected = std::max(1000.0, 2 * soup.area / (result.alpha * result.alpha));
  std::size_t points = 0;
  cgal::SurfaceMesh wrap;
  report(options.progress, 0, "Wrapping: tree of boxes");
  try
  {
    wrapSoup(soup, result, WrapVisitor(options.progress, expected, points), wrap);
  }
  catch (const CGAL::Failure_exception& failure)
  {
    result.status = { StatusCode::NotConverged,
      std::string("CGAL's alpha wrapping failed: ") + failure.what() };
    return result;
  }
  result.surface = cgal::trianglesOf(wrap);
  if (result.surface.corners.empty())
  {
    result.status = { StatusCode::Infeasible,
      "give a smaller alpha, or a larger offset: the wrap is empty" };
  }
  report(options.progress, 1, "Wrapping");
  return result;
}

} // namespace quadrille
