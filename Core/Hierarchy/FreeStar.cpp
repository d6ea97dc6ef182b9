// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/FreeStar.h"

#include "Base/Angles.h"
#include "Hierarchy/RingTable.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadrille
{

namespace
{

constexpr float kSinglePi = static_cast<float>(kPi);
constexpr float kEquilateralSingle = static_cast<float>(kEquilateral);
/// Stars with a flatter face go to VertexRemoval: their normals and their weights need more digits.
constexpr float kFlattestFace = 0.022F;

/// Angle of the vector (x, y), y >= 0; error 3e-7 [Abramowitz and Stegun 1964, 4.4.49].
inline float angleOfSingle(float x, float y)
{
  const float ax = std::abs(x);
  const float low = ax < y ? ax : y;
  const float high = ax < y ? y : ax;
  const float t = low / high;
  const float q = t * t;
  float r = 0.0028662257F;
  r = r * q - 0.0161657367F;
  r = r * q + 0.0429096138F;
  r = r * q - 0.0752896400F;
  r = r * q + 0.1065626393F;
  r = r * q - 0.1420889944F;
  r = r * q + 0.1999355085F;
  r = r * q - 0.3333314528F;
  r = (r * q + 1.0F) * t;
  r = ax < y ? 0.5F * kSinglePi - r : r;
  return x < 0 ? kSinglePi - r : r;
}

/// Sine and cosine of an angle in [-pi/2, pi/2]; error 1e-7 [Abramowitz and Stegun 1964, 4.3.97 and 4.3.99].
inline float sineOf(float a)
{
  const float q = a * a;
  float r = -0.0000000239F;
  r = r * q + 0.0000027526F;
  r = r * q - 0.0001984090F;
  r = r * q + 0.0083333315F;
  r = r * q - 0.1666666664F;
  return (r * q + 1.0F) * a;
}
inline float cosineOf(float a)
{
  const float q = a * a;
  float r = -0.0000002605F;
  r = r * q + 0.0000247609F;
  r = r * q - 0.0013888397F;
  r = r * q + 0.0416666418F;
  r = r * q - 0.4999999963F;
  return r * q + 1.0F;
}

/// Continues an array of N values past its end.
template <std::size_t N, typename Lanes>
void goRound(Lanes& values)
{
  constexpr std::size_t lanes = (N + 3) / 4 * 4;
  for (std::size_t i = 0; i < lanes; ++i)
  {
    values[N + i] = values[i];
  }
}

constexpr std::size_t index(int i)
{
  return static_cast<std::size_t>(i);
}

} // namespace

void FreeStar::gather(Index v)
{
  vertex_ = v;
  size_ = mesh_.valence[v];
  Index h = mesh_.outgoing[v];
  for (std::size_t i = 0; i < index(size_); ++i)
  {
    slot_[i] = h;
    ring_[i] = mesh_.origin[Mesh::next(h)];
    h = mesh_.twin[Mesh::previous(h)];
  }
}

float FreeStar::shortestEdge(double unit)
{
  const double scale = 1 / unit;
  const Vector3 center = mesh_.position[vertex_];
  float shortest = kInfinityOfSingle;
  for (std::size_t i = 0; i < index(size_); ++i)
  {
    const Vector3& p = mesh_.position[ring_[i]];
    x_[i] = static_cast<float>((p.x() - center.x()) * scale);
    y_[i] = static_cast<float>((p.y() - center.y()) * scale);
    z_[i] = static_cast<float>((p.z() - center.z()) * scale);
    squared_[i] = x_[i] * x_[i] + y_[i] * y_[i] + z_[i] * z_[i];
    shortest = squared_[i] < shortest ? squared_[i] : shortest;
  }
  return std::sqrt(shortest);
}

bool FreeStar::hasDoubleVertex() const
{
  bool found = false;
  for (int i = 0; i < size_; ++i)
  {
    for (int j = i + 1; j < size_; ++j)
    {
      found = found | (ring_[index(i)] == ring_[index(j)]);
    }
  }
  return found;
}

FreeStar::Outcome FreeStar::plan()
{
  switch (size_)
  {
    case 3:
      return planRing<3>();
    case 4:
      return planRing<4>();
    case 5:
      return planRing<5>();
    case 6:
      return planRing<6>();
    case 7:
      return planRing<7>();
    case 8:
      return planRing<8>();
    case 9:
      return planRing<9>();
    case 10:
      return planRing<10>();
    default:
      return Outcome::Unsuited;
  }
}

template <int N>
FreeStar::Outcome FreeStar::planRing()
{
  if (hasDoubleVertex() || !measure<N>())
  {
    return Outcome::Unsuited;
  }
  if ((N == 3 && closesTetrahedron()) || !mapToPlane<N>())
  {
    return Outcome::Refused;
  }
  evaluateTriangles<N>();
  if (!triangulate<N>())
  {
    return Outcome::Refused;
  }
  const Outcome outcome = checkRing<N>();
  return outcome == Outcome::Planned && !locate() ? Outcome::Refused : outcome;
}

/// False for slivers and whatever is not a number.
template <int N>
bool FreeStar::measure()
{
  constexpr std::size_t lanes = RingTable<N>::kPaddedLanes;
  goRound<N>(x_);
  goRound<N>(y_);
  goRound<N>(z_);
  goRound<N>(squared_);
  for (std::size_t i = 0; i < lanes; ++i)
  {
    const std::size_t j = i + 1;
    const float nx = y_[i] * z_[j] - z_[i] * y_[j];
    const float ny = z_[i] * x_[j] - x_[i] * z_[j];
    const float nz = x_[i] * y_[j] - y_[i] * x_[j];
    const float doubled = std::sqrt(nx * nx + ny * ny + nz * nz);
    const float dot = x_[i] * x_[j] + y_[i] * y_[j] + z_[i] * z_[j];
    shape_[i] = kEquilateralSingle * doubled / (2 * (squared_[i] + squared_[j] - dot));
    angle_[i] = angleOfSingle(dot, doubled);
    nx_[i] = nx;
    ny_[i] = ny;
    nz_[i] = nz;
    u_[i] = 1 / doubled;
    length_[i] = std::sqrt(squared_[i]);
  }
  float worst = 1;
  bool sound = true;
  mean_ = {};
  for (std::size_t i = 0; i < N; ++i)
  {
    sound = sound & (shape_[i] > kFlattestFace);
    worst = shape_[i] < worst ? shape_[i] : worst;
    mean_[0] += nx_[i];
    mean_[1] += ny_[i];
    mean_[2] += nz_[i];
  }
  const float mean = std::sqrt(mean_[0] * mean_[0] + mean_[1] * mean_[1] + mean_[2] * mean_[2]);
  for (float& component : mean_)
  {
    component = mean > 0 ? component / mean : 0;
  }
  for (std::size_t i = 0; i < lanes; ++i)
  {
    nx_[i] *= u_[i];
    ny_[i] *= u_[i];
    nz_[i] *= u_[i];
  }
  leastDot_ = static_cast<float>(guards_.minimumNormalDot);
  for (std::size_t i = 0; guards_.allowOldFolds && i < N; ++i)
  {
    const float dot = nx_[i] * mean_[0] + ny_[i] * mean_[1] + nz_[i] * mean_[2];
    leastDot_ = dot < leastDot_ ? dot : leastDot_;
  }
  goRound<N>(nx_);
  goRound<N>(ny_);
  goRound<N>(nz_);
  leastPlanar_ =
    static_cast<float>(std::min(0.3 * double{ worst }, kSliverQuality)) / kEquilateralSingle;
  mostHarmonic_ = 1 / static_cast<float>(std::min(0.95 * double{ worst }, guards_.minimumQuality));
  return sound;
}

template <int N>
bool FreeStar::mapToPlane()
{
  constexpr std::size_t lanes = RingTable<N>::kPaddedLanes;
  alignas(64) std::array<float, lanes> direction{};
  float sum = 0;
  for (std::size_t i = 0; i < N; ++i)
  {
    direction[i] = sum;
    sum += angle_[i];
  }
  const float scale = 2 * kSinglePi / sum;
  bool fits = true;
  for (std::size_t i = 0; i < N; ++i)
  {
    const float step = scale * angle_[i];
    fits = fits & (step < 0.995F * kSinglePi) & (step > 1e-6F);
  }
  for (std::size_t i = 0; i < lanes; ++i)
  {
    // From half the angle, so that the polynomials serve the whole circle; how the plane is rotated does not matter.
    const float half = 0.5F * (scale * direction[i] - kSinglePi);
    const float sine = sineOf(half);
    const float cosine = cosineOf(half);
    u_[i] = length_[i] * (1 - 2 * sine * sine);
    v_[i] = length_[i] * (2 * sine * cosine);
  }
  goRound<N>(u_);
  goRound<N>(v_);
  return fits;
}

template <int N>
void FreeStar::evaluateTriangles()
{
  constexpr std::size_t lanes = RingTable<N>::kPaddedLanes;
  std::size_t out = 0;
  for (const auto& orbit : kRingTable<N>.orbit)
  {
    const std::size_t second = orbit.first;
    const std::size_t third = orbit.second;
    alignas(64) std::array<float, lanes> margin; // how far the normal is on the right side
    alignas(64) std::array<float, lanes> tx, ty, tz, least;
    for (std::size_t i = 0; i < lanes; ++i)
    {
      const std::size_t b = i + second;
      const std::size_t c = i + third;
      const float abx = x_[b] - x_[i], aby = y_[b] - y_[i], abz = z_[b] - z_[i];
      const float acx = x_[c] - x_[i], acy = y_[c] - y_[i], acz = z_[c] - z_[i];
      tx[i] = aby * acz - abz * acy;
      ty[i] = abz * acx - abx * acz;
      tz[i] = abx * acy - aby * acx;
      const float doubled = std::sqrt(tx[i] * tx[i] + ty[i] * ty[i] + tz[i] * tz[i]);
      const float squares = 2 *
        (abx * abx + aby * aby + abz * abz + acx * acx + acy * acy + acz * acz -
          (abx * acx + aby * acy + abz * acz));
      const float harmonic = squares / (kEquilateralSingle * doubled);
      const float abu = u_[b] - u_[i], abv = v_[b] - v_[i];
      const float acu = u_[c] - u_[i], acv = v_[c] - v_[i];
      const float planar = abu * acv - abv * acu;
      const float planarSquares =
        2 * (abu * abu + abv * abv + acu * acu + acv * acv - (abu * acu + abv * acv));
      least[i] = leastDot_ * doubled;
      margin[i] = tx[i] * mean_[0] + ty[i] * mean_[1] + tz[i] * mean_[2] - least[i];
      const bool good = (planar > leastPlanar_ * planarSquares) & (harmonic <= mostHarmonic_);
      cost_[out + i] = good ? harmonic : kInfinityOfSingle;
    }
    const auto compare = [&](std::size_t face)
    {
      for (std::size_t i = 0; i < lanes; ++i)
      {
        const float other =
          tx[i] * nx_[i + face] + ty[i] * ny_[i + face] + tz[i] * nz_[i + face] - least[i];
        margin[i] = other < margin[i] ? other : margin[i];
      }
    };
    // Faces of the star at the triangle's ring edges.
    if (second == 1)
    {
      compare(0);
    }
    if (third == second + 1)
    {
      compare(second);
    }
    if (third == N - 1)
    {
      compare(third);
    }
    for (std::size_t i = 0; i < lanes; ++i)
    {
      cost_[out + i] = margin[i] >= 0 ? cost_[out + i] : kInfinityOfSingle;
    }
    out += lanes;
  }
}

/// The triangulation of least cost by dynamic programming; best[a][c] is that of the ring from a to c.
template <int N>
bool FreeStar::triangulate()
{
  std::array<std::array<float, N>, N> best;
  std::array<std::array<std::uint8_t, N>, N> middle;
  for (std::size_t a = 0; a + 1 < N; ++a)
  {
    best[a][a + 1] = 0;
  }
  const std::uint8_t* position = kRingTable<N>.cost.data();
  for (std::size_t gap = 2; gap < N; ++gap)
  {
    for (std::size_t a = 0; a + gap < N; ++a)
    {
      const std::size_t c = a + gap;
      float least = kInfinityOfSingle;
      std::size_t by = a + 1;
      for (std::size_t b = a + 1; b < c; ++b)
      {
        const float cost = best[a][b] + best[b][c] + cost_[*position++];
        by = cost < least ? b : by;
        least = cost < least ? cost : least;
      }
      best[a][c] = least;
      middle[a][c] = static_cast<std::uint8_t>(by);
    }
  }
  if (!(best[0][N - 1] < kInfinityOfSingle))
  {
    return false;
  }
  std::array<std::array<std::uint8_t, 2>, N> open;
  std::size_t openCount = 1;
  std::size_t count = 0;
  open[0] = { 0, N - 1 };
  while (openCount > 0)
  {
    const std::uint8_t a = open[--openCount][0];
    const std::uint8_t c = open[openCount][1];
    const std::uint8_t b = middle[a][c];
    triangles_[count++] = { a, b, c };
    if (b - a > 1)
    {
      open[openCount++] = { a, b };
    }
    if (c - b > 1)
    {
      open[openCount++] = { b, c };
    }
  }
  return true;
}

/// Valences afterwards, and diagonals that the mesh has already.
template <int N>
FreeStar::Outcome FreeStar::checkRing()
{
  std::fill(diagonals_.begin(), diagonals_.begin() + N, std::uint8_t{ 0xFF });
  for (std::size_t t = 0; t < N - 2; ++t)
  {
    ++diagonals_[triangles_[t].a];
    ++diagonals_[triangles_[t].b];
    ++diagonals_[triangles_[t].c];
  }
  std::array<int, N> valence;
  bool fits = true;
  for (std::size_t i = 0; i < N; ++i)
  {
    const int before = mesh_.valence[ring_[i]];
    const int after = before + diagonals_[i] - 1;
    fits = fits & (after >= guards_.minimumValence || after >= before) & (after >= 2) &
      (after <= guards_.maximumValence || after <= before);
    valence[i] = before;
  }
  if (!fits)
  {
    return Outcome::Blocked;
  }
  for (std::size_t t = 1; t < N - 2; ++t)
  {
    // The first triangle closes the ring; each other one is seen through its diagonal a - c.
    const std::size_t a = triangles_[t].a;
    const std::size_t c = triangles_[t].c;
    if (valence[a] < valence[c] ? hasOuterEdge(a, c, valence[a]) : hasOuterEdge(c, a, valence[c]))
    {
      return Outcome::Unsuited; // VertexRemoval finds another triangulation
    }
  }
  return Outcome::Planned;
}

/// Whether ring vertices a and b have an edge outside the star, where a has `valence` - 3 edges.
bool FreeStar::hasOuterEdge(std::size_t a, std::size_t b, int valence) const
{
  const Index wanted = ring_[b];
  Index h = Mesh::next(slot_[a]); // from a along the ring
  bool found = false;
  const auto step = [&]()
  {
    h = Mesh::next(mesh_.twin[h]);
    found = found | (mesh_.origin[Mesh::next(h)] == wanted);
  };
  // Nearly always three are enough, and a fixed number is predicted well; the walk may go on through the star,
  // as b is not to be met there.
  step();
  step();
  step();
  for (int i = 6; i < valence; ++i)
  {
    step();
  }
  return found;
}

bool FreeStar::closesTetrahedron() const
{
  const auto outer = [&](std::size_t i) { return mesh_.twin[Mesh::next(slot_[i])] / 3; };
  const Index a = outer(0);
  const Index b = outer(1);
  const Index c = outer(2);
  return a == b || a == c || b == c;
}

bool FreeStar::locate()
{
  const auto cross = [&](std::size_t i, std::size_t j) { return u_[i] * v_[j] - v_[i] * u_[j]; };
  float bestInside = -kInfinityOfSingle;
  std::array<float, 3> weights{};
  Triangle home;
  for (std::size_t t = 0; t < index(size_ - 2) && bestInside < 0; ++t)
  {
    const Triangle& triangle = triangles_[t];
    const std::array<float, 3> w{ cross(triangle.b, triangle.c), cross(triangle.c, triangle.a),
      cross(triangle.a, triangle.b) };
    const float area = w[0] + w[1] + w[2];
    const float inside = std::min({ w[0], w[1], w[2] }) / area;
    if (inside > bestInside)
    {
      bestInside = inside;
      weights = { w[0] / area, w[1] / area, w[2] / area };
      home = triangle;
    }
  }
  // Single precision leaves gaps of 1e-7 times the ring between triangles.
  if (!(bestInside > -1e-5F))
  {
    return false;
  }
  // The heaviest vertex becomes the base, so that the stored weights stay below one.
  const std::array<std::uint8_t, 3> corner{ home.a, home.b, home.c };
  const std::size_t base = weights[0] >= weights[1] ? (weights[0] >= weights[2] ? 0 : 2)
                                                    : (weights[1] >= weights[2] ? 1 : 2);
  const std::size_t second = (base + 1) % 3;
  const std::size_t third = (base + 2) % 3;
  weightRing_ = { corner[base], corner[second], corner[third] };
  weight_ = { std::max(0.0F, weights[second]), std::max(0.0F, weights[third]) };
  return true;
}

int FreeStar::bestTarget() const
{
  // Every diagonal that ends at the target saves one flip.
  return static_cast<int>(
    std::max_element(diagonals_.begin(), diagonals_.begin() + size_) - diagonals_.begin());
}

CollapseRecord FreeStar::makeRecord(int target) const
{
  CollapseRecord record;
  record.faces = size_;
  record.vertex = vertex_;
  std::copy(slot_.begin() + target, slot_.begin() + size_, record.slot.begin());
  std::copy(slot_.begin(), slot_.begin() + target, record.slot.begin() + (size_ - target));
  for (std::size_t i = 0; i < 3; ++i)
  {
    const int position = weightRing_[i] - target;
    record.ring[i] = static_cast<std::uint8_t>(position < 0 ? position + size_ : position);
  }
  for (std::size_t i = 0; i < 2; ++i)
  {
    record.weight[i] =
      static_cast<std::uint32_t>(std::llround(double{ weight_[i] } * 4294967296.0));
  }
  return record;
}

void FreeStar::apply(RecordWriter& log)
{
  const int target = bestTarget();
  const CollapseRecord record = makeRecord(target);
  log.collapse(record);
  mesh_.collapse(record);
  mesh_.outgoing[vertex_] = kInvalidIndex;
  for (std::size_t i = 0; i < index(size_); ++i)
  {
    mesh_.valence[ring_[i]] =
      static_cast<std::uint16_t>(mesh_.valence[ring_[i]] + diagonals_[i] - 1);
  }
  if (diagonals_[index(target)] < size_ - 3)
  {
    const auto fromTarget = [&](int i)
    { return index(i < target ? i - target + size_ : i - target); };
    flips_.begin(record.slot.data() + 1, size_ - 2);
    for (std::size_t t = 0; t < index(size_ - 2); ++t)
    {
      const Triangle& triangle = triangles_[t];
      flips_.add(fromTarget(triangle.a), fromTarget(triangle.b), fromTarget(triangle.c));
    }
    flips_.carryOut(mesh_, size_, log);
  }
  for (std::size_t i = 1; i + 1 < index(size_); ++i)
  {
    // No vertex here is on a boundary, so that any half-edge will do.
    const Index face = record.slot[i] / 3;
    for (Index h = 3 * face; h < 3 * face + 3; ++h)
    {
      mesh_.outgoing[mesh_.origin[h]] = h;
    }
  }
}

} // namespace quadrille
