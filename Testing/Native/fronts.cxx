// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads of a surface by the library and by vtkQuadRemesh, for test_fronts.py to compare:
///
///   fronts FOLDER QUADS EDGE_LENGTH FEATURE_ANGLE SYMMETRY
///
/// FOLDER has points (64 bits) and triangles (32 bits), and may have feature_edges, patch_ids, guiding_direction and
/// sizing; library.points, library.quads, filter.points and filter.quads are put beside them. One of QUADS and
/// EDGE_LENGTH is 0, and FEATURE_ANGLE 0 is none. SYMMETRY: 0 none, 1 a mirror plane that is found, else the order of a
/// rotation about an axis that is found; the library, which has none, makes no quads then.
#include "vtkQuadRemesh.h"

#include <quadrille/quadrille.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkLongLongArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace
{

std::filesystem::path folder;

template <class Value>
std::vector<Value> valuesOf(const char* name)
{
  const std::filesystem::path file = folder / name;
  std::vector<Value> values;
  if (std::filesystem::exists(file))
  {
    values.resize(std::filesystem::file_size(file) / sizeof(Value));
    std::ifstream stream(file, std::ios::binary);
    stream.read(reinterpret_cast<char*>(values.data()),
      static_cast<std::streamsize>(values.size() * sizeof(Value)));
  }
  return values;
}

template <class Value>
void write(const std::string& name, const std::vector<Value>& values)
{
  std::ofstream stream(folder / name, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(values.data()),
    static_cast<std::streamsize>(values.size() * sizeof(Value)));
}

struct Wanted
{
  std::size_t quads = 0;
  double edgeLength = 0, featureAngle = 0;
  int symmetry = 0;
};

void makeByLibrary(const Wanted& wanted)
{
  quadrille::TriangleMesh mesh;
  mesh.points = valuesOf<std::array<double, 3>>("points");
  mesh.triangles = valuesOf<std::array<quadrille::PointId, 3>>("triangles");
  mesh.featureEdges = valuesOf<std::uint8_t>("feature_edges");
  mesh.patchIds = valuesOf<std::int64_t>("patch_ids");
  mesh.guidingDirections = valuesOf<std::array<double, 3>>("guiding_direction");
  mesh.sizing = valuesOf<float>("sizing");
  quadrille::QuadOptions options;
  if (wanted.quads > 0)
  {
    options.quads = wanted.quads;
  }
  else
  {
    options.edgeLength = wanted.edgeLength;
  }
  options.featureAngle.reset();
  if (wanted.featureAngle > 0)
  {
    options.featureAngle = wanted.featureAngle;
  }
  const quadrille::QuadResult made = quadrille::makeQuads(mesh, options);
  write("library.points", made.points);
  write("library.quads", made.quads);
}

template <class Array, class Value>
vtkSmartPointer<Array> arrayOf(
  const char* name, const std::vector<Value>& values, int components = 1)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()) / components);
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}

vtkSmartPointer<vtkPolyData> surfaceOfFolder()
{
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetData(arrayOf<vtkDoubleArray>("", valuesOf<double>("points"), 3));
  const std::vector<std::uint32_t> ids = valuesOf<std::uint32_t>("triangles");
  vtkNew<vtkCellArray> triangles;
  triangles->SetData(3, arrayOf<vtkIdTypeArray>("", ids));
  surface->SetPoints(points);
  surface->SetPolys(triangles);
  const auto add = [](vtkDataSetAttributes* data, vtkDataArray* array)
  {
    if (array->GetNumberOfTuples() > 0)
    {
      data->AddArray(array);
    }
  };
  vtkCellData* cells = surface->GetCellData();
  add(
    cells, arrayOf<vtkUnsignedCharArray>("FeatureEdges", valuesOf<std::uint8_t>("feature_edges")));
  add(cells, arrayOf<vtkLongLongArray>("PatchId", valuesOf<std::int64_t>("patch_ids")));
  add(cells, arrayOf<vtkDoubleArray>("GuidingDirection", valuesOf<double>("guiding_direction"), 3));
  add(surface->GetPointData(), arrayOf<vtkFloatArray>("Sizing", valuesOf<float>("sizing")));
  return surface;
}

bool makeByFilter(const Wanted& wanted)
{
  vtkNew<vtkQuadRemesh> filter;
  filter->SetInputData(surfaceOfFolder());
  filter->SetFailedComponents(vtkQuadRemesh::FAIL_WITH_FAILED_COMPONENTS);
  filter->ComputeMappedSurfaceOff();
  filter->KeepLevelsOff();
  filter->SetTargetType(
    wanted.quads > 0 ? vtkQuadRemesh::TARGET_NUMBER_OF_QUADS : vtkQuadRemesh::TARGET_EDGE_LENGTH);
  filter->SetNumberOfQuads(static_cast<vtkIdType>(wanted.quads > 0 ? wanted.quads : 1));
  filter->SetEdgeLength(wanted.edgeLength);
  filter->SetDetectFeatures(wanted.featureAngle > 0);
  if (wanted.featureAngle > 0)
  {
    filter->SetFeatureAngle(wanted.featureAngle);
  }
  if (wanted.symmetry > 0)
  {
    filter->SetSymmetry(
      wanted.symmetry == 1 ? vtkQuadRemesh::SYMMETRY_FOUND : vtkQuadRemesh::SYMMETRY_AXIS_FOUND);
    filter->SetRotationOrder(wanted.symmetry == 1 ? 2 : wanted.symmetry);
  }
  filter->Update();
  if (filter->GetOutcome() != vtkQuadrilleAlgorithm::Succeeded)
  {
    std::cerr << filter->GetOutcomeText() << '\n';
    return false;
  }
  vtkPolyData* quads = filter->GetOutput();
  auto* const points = vtkDoubleArray::SafeDownCast(quads->GetPoints()->GetData());
  vtkDataArray* const corners = quads->GetPolys()->GetConnectivityArray();
  std::vector<std::uint32_t> ids;
  for (vtkIdType i = 0; i < corners->GetNumberOfTuples(); ++i)
  {
    ids.push_back(static_cast<std::uint32_t>(corners->GetTuple1(i)));
  }
  write("filter.points",
    std::vector<double>(
      points->GetPointer(0), points->GetPointer(0) + points->GetNumberOfValues()));
  write("filter.quads", ids);
  return true;
}

} // namespace

int main(int count, char** arguments)
{
  if (count != 6)
  {
    std::cerr << "usage: fronts FOLDER QUADS EDGE_LENGTH FEATURE_ANGLE SYMMETRY\n";
    return 2;
  }
  folder = arguments[1];
  const Wanted wanted{ std::strtoul(arguments[2], nullptr, 10), std::strtod(arguments[3], nullptr),
    std::strtod(arguments[4], nullptr), std::atoi(arguments[5]) };
  try
  {
    if (wanted.symmetry == 0)
    {
      makeByLibrary(wanted);
    }
    return makeByFilter(wanted) ? 0 : 1;
  }
  catch (const quadrille::QuadError& error)
  {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
