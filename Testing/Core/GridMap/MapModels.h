// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Surfaces of all kinds, and their fields, for tests of maps.
#pragma once

#include "CrossField/CrossField.h"
#include "TestMeshes.h"

#include <functional>
#include <vector>

namespace quadrille::test
{

inline double areaOf(const Mesh& mesh)
{
  double area = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    area += mesh.edgeVector(3 * f).cross(mesh.edgeVector(3 * f + 1)).norm() / 2;
  }
  return area;
}

struct Model
{
  const char* name;
  std::function<Mesh()> make;
};

inline std::vector<Model> models()
{
  constexpr double kSharp = 0.7;
  return { { "sphere", [] { return sphere(3); } }, { "torus", [] { return torus(32, 16); } },
    { "smooth cube", [] { return unitCube(8); } },
    { "cube", [] { return markFeatures(unitCube(8), kSharp); } },
    { "cylinder", [] { return openCylinder(24, 12); } },
    { "plate", [] { return gridPlane(12, 8); } },
    { "plate with hole", [] { return plateWithHole(5); } }, { "L", [] { return plateL(6); } },
    { "genus 2", [] { return doubleTorus(3); } },
    { "sharp genus 2", [] { return markFeatures(doubleTorus(3), kSharp); } },
    { "sharp square torus", [] { return markFeatures(squareTorus(4), kSharp); } },
    { "two components", [] { return twoComponents(); } } };
}

inline CrossField fieldOf(const Mesh& mesh, double edgeLength)
{
  CrossFieldOptions options;
  options.targetEdgeLength = edgeLength;
  return computeCrossField(mesh, options);
}

} // namespace quadrille::test
