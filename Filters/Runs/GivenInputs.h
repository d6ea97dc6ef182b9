// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A surface and what is asked for on it, as a filter was given them, and how Core reads them: without the filter, so
/// that any thread can do it.
#pragma once

#include "Convert/PolyData.h"
#include "Evaluation/ConstraintWords.h"
#include "Pipeline/Options.h"
#include "Pipeline/ResultStore.h"
#include "Prepare/InputPlaces.h"

#include <vtkSmartPointer.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

class vtkPolyData;

namespace quadrille
{

/// What is to be told of inputs.
struct ToldOfInputs
{
  std::string text;
  bool isWarning = false; ///< else a notice only
};

/// See vtkQuadrilleSurfaceAlgorithm for the ports and the properties.
struct GivenInputs
{
  std::vector<vtkSmartPointer<vtkPolyData>> ports; ///< null where there is nothing
  std::string patchArray;
  std::string guideArray; ///< empty: none
  double strokeWeight = 1;
  double strokeRadius = 0;
  int pointValence = 3;
  RemeshOptions options; ///< the size of the quads, and threads

  vtkPolyData* port(std::size_t i) const { return i < ports.size() ? ports[i] : nullptr; }
  /// Takes data objects of its own in place of these. Arrays are shared: a pipeline makes new ones.
  void detach();
};

/// The surface as Core has it, before anything is drawn on it.
struct ReadSurface
{
  ConvertedSurface converted;
  // The rest is made where something is drawn.
  std::unique_ptr<InputPlaces> places;
  std::optional<double> area; ///< of the polygons
  std::optional<double> diagonal;
};

/// The surface with what is asked of it; asked gets the constraints of all ports. told also has what was said before
/// an exception. Where store has what an earlier call has read of the same arrays it is not read again; null: no store.
/// read: null, or gets what lies under the surface. Throws InvalidInput naming what is at fault.
ConvertedSurface readInputs(const GivenInputs& inputs, std::vector<ToldOfInputs>& told,
  AskedConstraints& asked, ResultStore* store = nullptr,
  std::shared_ptr<ReadSurface>* read = nullptr);

/// What is told of a surface that Core reads by itself, without polygons and constraints.
ConvertedSurface readForPieces(const GivenInputs& inputs, std::vector<ToldOfInputs>& told);

} // namespace quadrille
