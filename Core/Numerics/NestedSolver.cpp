// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Numerics/NestedSolver.h"

#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

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

/// The first `own` columns of a symmetric matrix with a right side as its last row are eliminated. left: rows by own;
/// right: the remaining lower triangle, (rows - own) by (rows - own - 1).
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

/// Vertices of a leaf: smaller ones have more fronts, larger ones are denser than they need to be.
constexpr Index kLeafVertices = 20;
/// Subtrees that are factorized in parallel: enough for many threads, few enough that most of the work lies in them.
constexpr Index kSubtrees = 64;

} // namespace

/// Recursive bisection: halves along the axis that needs the smallest separator.
struct NestedSolver::Dissection
{
  const std::vector<Vector3>& position;
  Grouped<> neighbours;        ///< of vertices with unknowns
  std::vector<Index> vertices; ///< those with unknowns; parts are ranges of it
  std::vector<Index> part;     ///< #V: which part it is in, for neighbours
  Index parts = 0;
  std::vector<Front>& fronts;
  std::vector<Index>& vertexAt;

  using Iterator = std::vector<Index>::iterator;

  void sortHalves(Iterator begin, Iterator middle, Iterator end, int axis) const
  {
    std::nth_element(begin, middle, end,
      [&](Index a, Index b)
      {
        const double x = position[a][axis], y = position[b][axis];
        return x < y || (x == y && a < b);
      });
  }

  /// Vertices of [begin, end) with a neighbour in part `other`.
  bool touches(Index v, Index other) const
  {
    return std::any_of(
      neighbours.begin(v), neighbours.end(v), [&](Index w) { return part[w] == other; });
  }
  void label(Iterator begin, Iterator end, Index id)
  {
    for (Iterator v = begin; v != end; ++v)
    {
      part[*v] = id;
    }
  }

  /// Returns the front of [begin, end).
  int run(Iterator begin, Iterator end)
  {
    const auto size = end - begin;
    const int firstFront = static_cast<int>(fronts.size());
    std::array<int, 2> children{ -1, -1 };
    if (size > kLeafVertices)
    {
      pollNowAndThen(static_cast<std::size_t>(size), 1);
      const Iterator middle = begin + size / 2;
      const Index low = ++parts, high = ++parts;
      int best = 0;
      bool bestLow = true;
      std::ptrdiff_t fewest = size + 1;
      for (int axis = 0; axis < 3; ++axis)
      {
        sortHalves(begin, middle, end, axis);
        label(begin, middle, low);
        label(middle, end, high);
        const auto inLow = std::count_if(begin, middle, [&](Index v) { return touches(v, high); });
        const auto inHigh = std::count_if(middle, end, [&](Index v) { return touches(v, low); });
        if (std::min(inLow, inHigh) < fewest)
        {
          fewest = std::min(inLow, inHigh);
          best = axis;
          bestLow = inLow <= inHigh;
        }
      }
      sortHalves(begin, middle, end, best);
      label(begin, middle, low);
      label(middle, end, high);
      // The separator goes to the end of the range.
      Iterator endLow = middle;
      Iterator beginHigh = middle;
      if (bestLow)
      {
        endLow = std::partition(begin, middle, [&](Index v) { return !touches(v, high); });
      }
      else
      {
        beginHigh = std::partition(middle, end, [&](Index v) { return touches(v, low); });
      }
      std::vector<Index> separator(endLow, beginHigh);
      label(separator.begin(), separator.end(), 0);
      children[0] = endLow > begin ? run(begin, endLow) : -1;
      children[1] = end > beginHigh ? run(beginHigh, end) : -1;
      append(separator.begin(), separator.end(), firstFront, children);
      return static_cast<int>(fronts.size()) - 1;
    }
    append(begin, end, firstFront, children);
    return static_cast<int>(fronts.size()) - 1;
  }

  void append(Iterator begin, Iterator end, int firstFront, const std::array<int, 2>& children)
  {
    Front front;
    front.first = static_cast<Index>(vertexAt.size());
    vertexAt.insert(vertexAt.end(), begin, end);
    front.end = static_cast<Index>(vertexAt.size());
    front.firstFront = firstFront;
    front.children = children;
    fronts.push_back(std::move(front));
  }
};

NestedSolver::NestedSolver(const std::vector<Vector3>& position,
  const std::vector<std::uint8_t>& unknowns, const std::vector<std::array<Index, 3>>& triangles)
  : triangles_(triangles)
{
  const Index count = static_cast<Index>(position.size());
  bool fits = unknowns.size() == position.size();
  for (const std::array<Index, 3>& t : triangles)
  {
    fits = fits && t[0] < count && t[1] < count && t[2] < count;
  }
  refuseIf(!fits, "nested solver: positions, unknowns and triangles disagree in size");
  // Over both directions of a triangle's edges: those inside of the mesh come twice, which does no harm.
  const auto forEachEdge = [&](const auto& visit)
  {
    for (const std::array<Index, 3>& t : triangles)
    {
      for (std::size_t i = 0; i < 3; ++i)
      {
        const Index a = t[i], b = t[(i + 1) % 3];
        if (unknowns[a] != 0 && unknowns[b] != 0)
        {
          visit(a, b);
          visit(b, a);
        }
      }
    }
  };
  Dissection dissection{ position, { count, forEachEdge },
    idsWhere(count, [&](Index v) { return unknowns[v] != 0; }), std::vector<Index>(count, 0), 0,
    fronts_, vertexAt_ };
  poll();
  dissection.run(dissection.vertices.begin(), dissection.vertices.end());
  poll();
  collectTriangles(unknowns);
  findBorders();
  measure();
}

void NestedSolver::collectTriangles(const std::vector<std::uint8_t>& unknowns)
{
  const Index places = static_cast<Index>(vertexAt_.size());
  std::vector<std::size_t> numbering(unknowns.size() + 1, 0);
  for (std::size_t v = 0; v < unknowns.size(); ++v)
  {
    numbering[v + 1] = numbering[v] + unknowns[v];
  }
  std::vector<Index> place(unknowns.size(), kInvalidIndex);
  offset_.assign(1, 0);
  for (Index i = 0; i < places; ++i)
  {
    place[vertexAt_[i]] = i;
    offset_.push_back(offset_.back() + unknowns[vertexAt_[i]]);
    firstUnknown_.push_back(numbering[vertexAt_[i]]);
  }
  std::vector<int> frontOf(places);
  for (std::size_t f = 0; f < fronts_.size(); ++f)
  {
    std::fill(
      frontOf.begin() + fronts_[f].first, frontOf.begin() + fronts_[f].end, static_cast<int>(f));
  }
  for (std::size_t t = 0; t < triangles_.size(); ++t)
  {
    Index earliest = kInvalidIndex;
    for (Index& v : triangles_[t])
    {
      v = place[v];
      earliest = std::min(earliest, v); // kInvalidIndex is the largest one
    }
    if (earliest != kInvalidIndex)
    {
      fronts_[frontOf[earliest]].triangles.push_back(static_cast<Index>(t));
    }
  }
}

void NestedSolver::findBorders()
{
  for (Front& front : fronts_)
  {
    std::vector<Index>& border = front.border;
    const auto add = [&](Index v)
    {
      if (v != kInvalidIndex && v >= front.end)
      {
        border.push_back(v);
      }
    };
    for (const Index t : front.triangles)
    {
      std::for_each(triangles_[t].begin(), triangles_[t].end(), add);
    }
    for (const int child : front.children)
    {
      if (child >= 0)
      {
        std::for_each(fronts_[child].border.begin(), fronts_[child].border.end(), add);
      }
    }
    sortUnique(border);
    front.own = offset_[front.end] - offset_[front.first];
    for (const Index v : border)
    {
      front.rest += count(v);
    }
  }
}

/// Memory and work, and where the tree is cut into subtrees.
void NestedSolver::measure()
{
  const Index most = std::max<Index>(1, static_cast<Index>(vertexAt_.size()) / kSubtrees);
  double kept = 0, waiting = 0, peak = 0;
  std::vector<int> parent(fronts_.size(), -1);
  for (std::size_t f = 0; f < fronts_.size(); ++f)
  {
    const Front& front = fronts_[f];
    const double own = static_cast<double>(front.own), rest = static_cast<double>(front.rest);
    kept += (own + rest + 1) * own;
    waiting += (rest + 1) * rest;
    peak = std::max(peak, kept + waiting);
    for (const int child : front.children)
    {
      if (child >= 0)
      {
        const double size = static_cast<double>(fronts_[child].rest);
        waiting -= (size + 1) * size;
        parent[child] = static_cast<int>(f);
      }
    }
    operations_ += own * (own * own / 3 + own * rest + rest * rest) / 2;
  }
  bytes_ = sizeof(double) * peak;
  const auto subtree = [&](int f) { return fronts_[f].end - fronts_[fronts_[f].firstFront].first; };
  for (int f = 0; f < static_cast<int>(fronts_.size()); ++f)
  {
    if (subtree(f) <= most && (parent[f] < 0 || subtree(parent[f]) > most))
    {
      roots_.push_back(f);
    }
  }
}

std::size_t NestedSolver::indexIn(const Front& front, Index vertex) const
{
  if (vertex < front.end)
  {
    return offset_[vertex] - offset_[front.first];
  }
  std::size_t index = front.own;
  // Borders of one and of two unknowns a vertex alternate on curves only, but there they do.
  for (const Index v : front.border)
  {
    if (v == vertex)
    {
      break;
    }
    index += count(v);
  }
  return index;
}

double& NestedSolver::entry(Front& front, std::size_t row, std::size_t column) const
{
  return column < front.own
    ? front.left[column * (front.own + front.rest + 1) + row]
    : front.right[(column - front.own) * (front.rest + 1) + row - front.own];
}

void NestedSolver::addTriangles(Front& front, const Element& element) const
{
  Matrix6 matrix;
  Vector6 rightSide;
  const std::size_t last = front.own + front.rest;
  for (const Index t : front.triangles)
  {
    element(t, matrix, rightSide);
    std::array<std::size_t, 6> place{};
    std::size_t size = 0;
    for (const Index v : triangles_[t])
    {
      const std::size_t at = v == kInvalidIndex ? 0 : indexIn(front, v);
      for (std::size_t k = 0; v != kInvalidIndex && k < count(v); ++k)
      {
        place[size++] = at + k;
      }
    }
    for (std::size_t i = 0; i < size; ++i)
    {
      for (std::size_t j = 0; j <= i; ++j)
      {
        const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(j);
        entry(front, std::max(place[i], place[j]), std::min(place[i], place[j])) +=
          matrix(row, column);
      }
      entry(front, last, place[i]) += rightSide[static_cast<Eigen::Index>(i)];
    }
  }
}

void NestedSolver::addChild(Front& front, Front& child) const
{
  std::vector<std::size_t> place;
  place.reserve(child.rest + 1);
  std::size_t restPlace = front.own;
  auto next = front.border.begin();
  for (const Index v : child.border)
  {
    std::size_t at = offset_[v] - offset_[front.first];
    if (v >= front.end)
    {
      for (; *next != v; ++next)
      {
        restPlace += count(*next);
      }
      at = restPlace;
    }
    for (std::size_t k = 0; k < count(v); ++k)
    {
      place.push_back(at + k);
    }
  }
  place.push_back(front.own + front.rest);
  for (std::size_t j = 0; j < child.rest; ++j)
  {
    const double* column = child.right.data() + j * (child.rest + 1);
    for (std::size_t i = j; i <= child.rest; ++i)
    {
      entry(front, place[i], place[j]) += column[i]; // both ascend
    }
  }
  std::vector<double>().swap(child.right);
}

bool NestedSolver::factorize(Front& front, const Element& element, double shift)
{
  const std::size_t rows = front.own + front.rest + 1;
  front.left.assign(rows * front.own, 0.0);
  front.right.assign((front.rest + 1) * front.rest, 0.0);
  addTriangles(front, element);
  for (const int child : front.children)
  {
    if (child >= 0)
    {
      addChild(front, fronts_[child]);
    }
  }
  for (std::size_t j = 0; j < front.own; ++j)
  {
    front.left[j * rows + j] += shift;
  }
  return eliminate(front.left, front.right, rows, front.own);
}

bool NestedSolver::factorizeAll(const Element& element, double shift, int threads)
{
  std::atomic<bool> failed{ false };
  const auto factorizeOne = [&](int f)
  {
    if (!failed && !factorize(fronts_[f], element, shift))
    {
      failed = true;
    }
  };
  parallelFor(roots_.size(), 1, threads,
    [&](std::size_t i, std::size_t)
    {
      for (int f = fronts_[roots_[i]].firstFront; f <= roots_[i]; ++f)
      {
        factorizeOne(f);
      }
    });
  std::size_t next = 0;
  for (int f = 0; f < static_cast<int>(fronts_.size()); ++f)
  {
    if (next < roots_.size() && f == fronts_[roots_[next]].firstFront)
    {
      f = roots_[next++]; // this subtree is done
      continue;
    }
    factorizeOne(f);
  }
  return !failed;
}

/// From the last front to the first one; in the order of the elimination.
std::vector<double> NestedSolver::substituteBack() const
{
  std::vector<double> solution(offset_.back());
  std::vector<double> border;
  for (std::size_t f = fronts_.size(); f-- > 0;)
  {
    pollNowAndThen(f, 1024);
    const Front& front = fronts_[f];
    border.clear();
    for (const Index v : front.border)
    {
      border.insert(border.end(), solution.begin() + static_cast<std::ptrdiff_t>(offset_[v]),
        solution.begin() + static_cast<std::ptrdiff_t>(offset_[v + 1]));
    }
    const std::size_t rows = front.own + front.rest + 1;
    double* own = solution.data() + offset_[front.first];
    for (std::size_t j = front.own; j-- > 0;)
    {
      const double* column = front.left.data() + j * rows;
      double sum = column[rows - 1];
      for (std::size_t i = j + 1; i < front.own; ++i)
      {
        sum -= column[i] * own[i];
      }
      for (std::size_t i = 0; i < front.rest; ++i)
      {
        sum -= column[front.own + i] * border[i];
      }
      own[j] = sum / column[j];
    }
  }
  return solution;
}

bool NestedSolver::solve(const Element& element, double shift, int threads, Eigen::VectorXd& x)
{
  if (!factorizeAll(element, shift, threads))
  {
    return false;
  }
  const std::vector<double> solution = substituteBack();
  x.resize(unknowns());
  for (std::size_t i = 0; i < vertexAt_.size(); ++i)
  {
    for (std::size_t k = 0; k < count(static_cast<Index>(i)); ++k)
    {
      x[static_cast<Eigen::Index>(firstUnknown_[i] + k)] = solution[offset_[i] + k];
    }
  }
  return true;
}

} // namespace quadrille
