// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/PlaneReplay.h"

#include "Base/FixedPoint.h"
#include "Base/RingKernel.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace quadrille
{
namespace
{

/// Half the extent of a star, in units of the grid on which its kernel is looked for.
constexpr double kKernelScale = 64;

} // namespace

Complex rotationBetween(Complex a, Complex b)
{
  const Complex rotation = b * std::conj(a);
  const double length = std::abs(rotation);
  return length > 0 ? rotation / length : Complex(1);
}

std::array<Complex, 3> layOut(const Mesh& mesh, Index f)
{
  const Vector3 a = mesh.edgeVector(3 * f);
  const Vector3 b = -mesh.edgeVector(3 * f + 2);
  const double width = a.norm();
  return { Complex(0), Complex(width),
    width > 0 ? Complex(a.dot(b) / width, a.cross(b).norm() / width) : Complex(b.norm()) };
}

Complex PlaneCharts::after(Complex second, Complex first)
{
  const Complex both = second * first;
  return both / std::abs(both);
}

Complex PlaneCharts::scaled(Complex difference, std::uint32_t weight)
{
  return std::ldexp(double(weight), -32) * difference;
}

Complex intoKernel(const Complex* unfolded, const CollapseRecord& record, Complex p)
{
  const int count = record.ringSize();
  double extent = 0;
  for (int i = 0; i < count; ++i)
  {
    extent = std::max(extent, std::abs(unfolded[i]));
  }
  if (!(extent > 0))
  {
    return p;
  }
  const auto onGrid = [&](Complex q)
  { return toFixed(Vector2(q.real(), q.imag()) * (kKernelScale / extent)); };
  std::array<FixedVec2, kMaximumRing + 1> ring;
  std::transform(unfolded, unfolded + count, ring.begin(), onGrid);
  const bool closed = record.kind == CollapseKind::Interior;
  if (starIsPositive(ring.data(), count, closed, onGrid(p)))
  {
    return p;
  }
  const std::optional<FixedVec2> moved = record.onCurve
    ? kernelPointOnSegment(ring.data(), count, closed, ring[record.ring[0]], ring[record.ring[1]])
    : kernelPoint(ring.data(), count, closed);
  if (!moved)
  {
    return p;
  }
  const Vector2 q = toDouble(*moved) * (extent / kKernelScale);
  return { q.x(), q.y() };
}

} // namespace quadrille
