// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Writes the CAD files of the tests in Python: named.step (a box with a hole, see namesOfBox),
/// rounded.step, assembly.step.
///
///   cad_shapes FOLDER
#include "Shapes.h"

#include <cstdio>
#include <exception>
#include <filesystem>

int main(int argc, char* argv[])
{
  if (argc != 2)
  {
    std::fprintf(stderr, "usage: cad_shapes FOLDER\n");
    return 2;
  }
  try
  {
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    quadrille::writeStep(
      quadrille::boxWithHole(), (folder / "named.step").string(), quadrille::namesOfBox());
    quadrille::writeStep(quadrille::roundedCylinder(), (folder / "rounded.step").string());
    quadrille::writeAssembly(quadrille::boxWithHole(), (folder / "assembly.step").string());
    return 0;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "cad_shapes: %s\n", error.what());
    return 2;
  }
}
