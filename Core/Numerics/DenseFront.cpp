// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Numerics/DenseFront.h"

#include "Base/Progress.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{

namespace
{

/// Columns that are eliminated together.
constexpr std::size_t kPanel = 48;

// Loops over rows are also compiled for processors with wider vectors; no instruction set here fuses multiplications
// and additions, and no sum runs across rows, so the bytes are the same on all of them.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__gnu_linux__) &&   \
  !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define QUADRILLE_WIDE_VECTORS __attribute__((target_clones("avx2", "default")))
#else
#define QUADRILLE_WIDE_VECTORS
#endif

/// Two columns minus four others times their factors, rows [0, rows).
QUADRILLE_WIDE_VECTORS
void subtractFour(double* c0, double* c1, const double* a, std::size_t stride, std::size_t rows,
  const double* f0, const double* f1)
{
  const double* a0 = a;
  const double* a1 = a + stride;
  const double* a2 = a + 2 * stride;
  const double* a3 = a + 3 * stride;
  const double p0 = f0[0], p1 = f0[1], p2 = f0[2], p3 = f0[3];
  const double q0 = f1[0], q1 = f1[1], q2 = f1[2], q3 = f1[3];
  for (std::size_t i = 0; i < rows; ++i)
  {
    c0[i] -= (a0[i] * p0 + a1[i] * p1) + (a2[i] * p2 + a3[i] * p3);
    c1[i] -= (a0[i] * q0 + a1[i] * q1) + (a2[i] * q2 + a3[i] * q3);
  }
}

QUADRILLE_WIDE_VECTORS
void subtractOne(double* c, const double* a, std::size_t rows, double factor)
{
  for (std::size_t i = 0; i < rows; ++i)
  {
    c[i] -= a[i] * factor;
  }
}

/// Column c of rows [row, ...) minus the panel's columns times their entries at `row`; the same for the next column, if
/// it is there.
void subtractPanel(double* c0, double* c1, const double* panel, std::size_t stride,
  std::size_t columns, std::size_t row, std::size_t rows)
{
  std::size_t q = 0;
  for (; c1 != nullptr && q + 4 <= columns; q += 4)
  {
    double f0[4], f1[4];
    for (std::size_t k = 0; k < 4; ++k)
    {
      f0[k] = panel[(q + k) * stride + row];
      f1[k] = panel[(q + k) * stride + row + 1];
    }
    subtractFour(c0, c1, panel + q * stride + row, stride, rows, f0, f1);
  }
  for (; q < columns; ++q)
  {
    const double* a = panel + q * stride;
    subtractOne(c0, a + row, rows, a[row]);
    if (c1 != nullptr)
    {
      subtractOne(c1, a + row, rows, a[row + 1]);
    }
  }
}

/// Cholesky of columns [begin, end) of a (rows by ...) array, among themselves. False where a pivot is not positive.
bool factorizePanel(double* columns, std::size_t rows, std::size_t begin, std::size_t end)
{
  for (std::size_t j = begin; j < end; ++j)
  {
    double* column = columns + j * rows;
    for (std::size_t q = begin; q < j; ++q)
    {
      const double* a = columns + q * rows;
      subtractOne(column + j, a + j, rows - j, a[j]);
    }
    if (!(column[j] > 0) || !std::isfinite(column[j]))
    {
      return false;
    }
    const double inverse = 1 / std::sqrt(column[j]);
    for (std::size_t i = j; i < rows; ++i)
    {
      column[i] *= inverse;
    }
  }
  return true;
}

} // namespace

bool eliminate(
  std::vector<double>& left, std::vector<double>& right, std::size_t rows, std::size_t own)
{
  for (std::size_t begin = 0; begin < own; begin += kPanel)
  {
    poll();
    const std::size_t end = std::min(own, begin + kPanel);
    if (!factorizePanel(left.data(), rows, begin, end))
    {
      return false;
    }
    const double* panel = left.data() + begin * rows;
    for (std::size_t j = end; j < own; j += 2)
    {
      double* c = left.data() + j * rows + j;
      subtractPanel(c, j + 1 < own ? c + rows : nullptr, panel, rows, end - begin, j, rows - j);
    }
    const std::size_t rest = rows - own;
    for (std::size_t j = 0; j + 1 < rest; j += 2)
    {
      double* c = right.data() + j * rest + j;
      subtractPanel(
        c, j + 2 < rest ? c + rest : nullptr, panel, rows, end - begin, own + j, rest - j);
    }
  }
  return true;
}

} // namespace quadrille
