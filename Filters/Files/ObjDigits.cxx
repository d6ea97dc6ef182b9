// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/ObjDigits.h"

#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <map>
#include <vector>

namespace quadrille
{

namespace
{

using Coordinates = std::array<double, 3>;

/// Of the lines "v x y z".
std::vector<Coordinates> readObjPoints(const std::string& path)
{
  std::vector<Coordinates> points;
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line))
  {
    Coordinates p{};
    if (std::sscanf(line.c_str(), " v %lf %lf %lf", &p[0], &p[1], &p[2]) == 3)
    {
      points.push_back(p);
    }
  }
  return points;
}

std::array<float, 3> inSinglePrecision(const Coordinates& p)
{
  return { static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]) };
}

/// Points of the file by those of the reader: in their order where the reader keeps it, else by their values, as it
/// makes copies at seams of textures. Empty where two points of the file are one in single precision.
std::vector<Coordinates> matchObjPoints(const std::vector<Coordinates>& inFile, vtkPoints* read)
{
  const auto count = static_cast<std::size_t>(read->GetNumberOfPoints());
  std::vector<std::array<float, 3>> values(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    Coordinates p{};
    read->GetPoint(static_cast<vtkIdType>(i), p.data());
    values[i] = inSinglePrecision(p);
  }
  const auto fits = [&](std::size_t i) { return inSinglePrecision(inFile[i]) == values[i]; };
  bool inOrder = count == inFile.size();
  for (std::size_t i = 0; inOrder && i < count; ++i)
  {
    inOrder = fits(i);
  }
  if (inOrder)
  {
    return inFile;
  }
  std::map<std::array<float, 3>, Coordinates> byValue;
  for (const Coordinates& p : inFile)
  {
    if (byValue.emplace(inSinglePrecision(p), p).first->second != p)
    {
      return {};
    }
  }
  std::vector<Coordinates> matched(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto found = byValue.find(values[i]);
    if (found == byValue.end())
    {
      return {};
    }
    matched[i] = found->second;
  }
  return matched;
}

} // namespace

//------------------------------------------------------------------------------
bool restoreObjDigits(vtkPolyData* surface, const std::string& path)
{
  if (surface->GetNumberOfPoints() == 0 || surface->GetPoints()->GetDataType() == VTK_DOUBLE)
  {
    return true;
  }
  const std::vector<Coordinates> points = matchObjPoints(readObjPoints(path), surface->GetPoints());
  if (points.empty())
  {
    return false;
  }
  vtkNew<vtkPoints> inDouble;
  inDouble->SetDataTypeToDouble();
  inDouble->SetNumberOfPoints(static_cast<vtkIdType>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    inDouble->SetPoint(static_cast<vtkIdType>(i), points[i].data());
  }
  surface->SetPoints(inDouble);
  return true;
}

} // namespace quadrille
