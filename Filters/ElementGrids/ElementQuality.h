// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quality of elements by Verdict, through vtkMeshQuality: measures, histogram, the worst, and limits. Of elements of
/// second order the quad of the corners counts.
#pragma once

#include "Base/Types.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

class vtkPolyData;
class vtkTable;
class vtkUnstructuredGrid;

namespace quadrille
{

constexpr std::size_t kMeasureCount = 8;

/// A measure of Verdict.
struct ElementMeasure
{
  const char* name;   ///< as users write it: scaled-jacobian
  const char* array;  ///< ScaledJacobian
  bool isBetterLarge; ///< whether the worst element is the one with the least value
};

/// scaled-jacobian, aspect-ratio, skew, warpage, taper, edge-ratio, minimum-angle, maximum-angle; angles in degrees. As
/// vtkMeshQuality has them, warpage is the cube of the least cosine between normals of opposite corners: 1 for a plane
/// quad.
const std::array<ElementMeasure, kMeasureCount>& elementMeasures();

/// A limit that all elements have to keep.
struct ElementRequirement
{
  enum class Relation
  {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual
  };

  std::size_t measure = 0;
  Relation relation = Relation::Greater;
  double limit = 0;
  std::string text; ///< as it was given

  /// What is no number keeps no limit.
  bool isKeptBy(double value) const;
  /// Whether small values are the bad ones.
  bool isLowBad() const;
};

/// "scaled-jacobian>0.2"; spaces do not count, and array names count as names. Throws InvalidInput that says what it
/// may be.
ElementRequirement parseRequirement(const std::string& text);

/// Values of one measure, an element each.
std::vector<double> measureElements(vtkUnstructuredGrid* grid, std::size_t measure, int threads);

/// Adds a value to each element as the cell array of the measure.
void addMeasure(vtkUnstructuredGrid* grid, std::size_t measure, const std::vector<double>& values);

/// Columns <Measure>From, <Measure>To and <Measure>Elements of `bins` equal parts of the range of the values. What is
/// no number, or without bound (Verdict: 1e30), is left out.
void addHistogram(
  vtkTable* table, std::size_t measure, const std::vector<double>& values, int bins);

/// The ids of the worst elements, the worst first; what is no number comes before all others, equal ones by id.
std::vector<vtkIdType> worstElements(
  const std::vector<double>& values, bool isLowBad, std::size_t count);

/// Mean of the corners.
Vector3 centreOfElement(vtkUnstructuredGrid* grid, vtkIdType element);

/// An element that is listed with one of its measures.
struct WorstElement
{
  vtkIdType element = 0;
  std::size_t measure = 0;
  double value = 0;
};

/// Vertices at the centres, with the point arrays ElementId, Measure (text) and Value.
void writeWorst(
  vtkUnstructuredGrid* grid, const std::vector<WorstElement>& worst, vtkPolyData* target);

} // namespace quadrille
