// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The decimation log backwards on the triangles of a coarser level, laid out flat. The level is a flat surface but for
/// cones at its vertices; no removed vertex is one, so its star lies in a plane, and its weights put it there.
#pragma once

#include "Mesh/Mesh.h"
#include "Transfer/StarReplay.h"

#include <array>
#include <complex>
#include <cstdint>

namespace quadrille
{

/// A point or vector of a plane; a product with one of length 1 rotates it.
using Complex = std::complex<double>;

/// The rotation from a to b; none where one of them has no length.
Complex rotationBetween(Complex a, Complex b);

/// Corners of a face in the plane whose first axis is half-edge 3f.
std::array<Complex, 3> layOut(const Mesh& mesh, Index f);

/// Charts that are planes of coarser faces.
struct PlaneCharts
{
  using Point = Complex;
  using Rotation = Complex; ///< of length 1

  static Complex none() { return 1; }
  static Complex between(Complex from, Complex to) { return rotationBetween(from, to); }
  static Complex after(Complex second, Complex first);
  static Complex rotate(Complex r, Complex p) { return r * p; }
  static Complex rotateBack(Complex r, Complex p) { return std::conj(r) * p; }
  static Complex scaled(Complex difference, std::uint32_t weight);
};

/// p beside the ring of the record's vertex, as it was unfolded, or where it would invert its star a point well inside
/// of it, if there is one. ring: record.ringSize() points.
Complex intoKernel(const Complex* ring, const CollapseRecord& record, Complex p);

} // namespace quadrille
