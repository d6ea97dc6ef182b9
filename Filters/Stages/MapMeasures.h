// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What vtkIntegerGridMapQuality and vtkIntegerGridMapComparison measure of a mapped surface, and their tables.
#pragma once

#include "Evaluation/MapQuality.h"
#include "Mesh/Mesh.h"

#include <vtkSmartPointer.h>

#include <map>
#include <string>
#include <vector>

class vtkPolyData;
class vtkTable;

namespace quadrille
{

struct MeasuredMap
{
  Mesh mesh; ///< of the input, in its units; its faces are the cells
  double edgeLength = 0;
  MapQuality quality;
  std::vector<int> turns;              ///< #V
  std::map<int, std::size_t> valences; ///< of inner vertices, regular ones left out
  std::string notice; ///< what had to be rounded in the map; empty where it was exact
};

/// edgeLength: that of the quads asked for, in units of the input; 0: the field data's TargetEdgeLength, else the one
/// with which the map has as many quads as squares of that size cover the surface. Throws InvalidInput.
MeasuredMap measureMap(vtkPolyData* data, double edgeLength, double textureScale, int threads);

/// All of MeasuredMap::valences.
std::size_t irregularCount(const MeasuredMap& map);

/// One of the three measures as users see it: shear in degrees.
struct MeasureColumn
{
  const char* name;
  const WeightedDistribution& distribution;
  std::vector<double> edges; ///< of the bins
  double unit;               ///< what a value is multiplied with to be shown
};
std::vector<MeasureColumn> measureColumns(const MapQuality& quality);

/// The middle of each bin, in the unit shown; of sizing in the middle of its ratios.
std::vector<double> binCentres(const MeasureColumn& column);

/// The share of the area in each bin, in percent.
std::vector<double> percentInBins(const MeasureColumn& column);

/// Adds a column of text, or of numbers.
void addTextColumn(vtkTable* table, const char* name, const std::vector<std::string>& values);
void addNumberColumn(vtkTable* table, const char* name, const std::vector<double>& values);

} // namespace quadrille
