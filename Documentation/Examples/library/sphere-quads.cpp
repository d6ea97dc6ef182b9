// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads on a sphere of triangles, as a Wavefront OBJ: sphere-quads OUT.obj [QUADS]
#include <quadrille/quadrille.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

namespace
{

constexpr double kPi = 3.14159265358979323846;

/// The unit sphere: rings of triangles between two poles.
quadrille::TriangleMesh makeSphere(std::uint32_t rings, std::uint32_t around)
{
  quadrille::TriangleMesh mesh;
  mesh.points.push_back({ 0, 0, 1 });
  for (std::uint32_t r = 1; r < rings; ++r)
  {
    for (std::uint32_t a = 0; a < around; ++a)
    {
      const double polar = kPi * r / rings;
      const double turn = 2 * kPi * a / around;
      mesh.points.push_back(
        { std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar) });
    }
  }
  mesh.points.push_back({ 0, 0, -1 });
  const auto point = [&](std::uint32_t r, std::uint32_t a)
  { return 1 + (r - 1) * around + a % around; };
  const auto last = static_cast<std::uint32_t>(mesh.points.size() - 1);
  for (std::uint32_t a = 0; a < around; ++a)
  {
    mesh.triangles.push_back({ 0, point(1, a), point(1, a + 1) });
    for (std::uint32_t r = 1; r + 1 < rings; ++r)
    {
      mesh.triangles.push_back({ point(r, a), point(r + 1, a), point(r + 1, a + 1) });
      mesh.triangles.push_back({ point(r, a), point(r + 1, a + 1), point(r, a + 1) });
    }
    mesh.triangles.push_back({ point(rings - 1, a), last, point(rings - 1, a + 1) });
  }
  return mesh;
}

void writeObj(const quadrille::QuadResult& result, const std::string& path)
{
  std::ofstream file(path);
  for (const auto& p : result.points)
  {
    file << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  }
  for (const auto& q : result.quads)
  {
    file << "f " << q[0] + 1 << ' ' << q[1] + 1 << ' ' << q[2] + 1 << ' ' << q[3] + 1 << '\n';
  }
}

} // namespace

int main(int argc, char* argv[])
{
  if (argc < 2)
  {
    std::fprintf(stderr, "usage: sphere-quads OUT.obj [QUADS]\n");
    return 2;
  }
  quadrille::QuadOptions options;
  options.quads = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 1000;
  options.progress = [](double fraction, const std::string& what)
  {
    std::fprintf(stderr, "%3.0f %% %s\n", 100 * fraction, what.c_str());
    return true; // false would stop the run
  };
  try
  {
    const quadrille::QuadResult result = quadrille::makeQuads(makeSphere(60, 120), options);
    for (const std::string& notice : result.notices)
    {
      std::printf("%s\n", notice.c_str());
    }
    writeObj(result, argv[1]);
    std::printf("quadrille %s: %zu quads, %zu points, edge length %g\n",
      quadrille::libraryVersion(), result.quads.size(), result.points.size(), result.edgeLength);
    return 0;
  }
  catch (const quadrille::QuadError& error)
  {
    std::fprintf(stderr, "sphere-quads: %s\n", error.what());
    return 3;
  }
}
