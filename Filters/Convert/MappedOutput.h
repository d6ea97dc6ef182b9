// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The mapped surface of a run as an output, and what is kept of it.
#pragma once

#include "Common/Stamps.h"
#include "Convert/PolyData.h"
#include "Pipeline/Pipeline.h"
#include "Pipeline/ResultStore.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <cstdint>
#include <vector>

class vtkPolyData;

namespace quadrille
{

/// What the surface's own arrays come from.
struct MappedSource
{
  vtkPolyData* input = nullptr;
  const ConvertedSurface* converted = nullptr;
  bool textureCoordinates = false;
  vtkPolyData* earlier = nullptr; ///< see writeMappedSurface
};

/// The second output of the last execution, and what it was made from.
struct MappedOutput
{
  vtkPolyData* input = nullptr;
  vtkMTimeType inputTime = 0;
  vtkTypeBool textureCoordinates = 0;
  ResultKey map = 0; ///< 0: there is none
  vtkSmartPointer<vtkPolyData> surface;
  std::uint64_t triangles = 0; ///< hash of the surface
  bool reversed = false;       ///< its faces against those of the input
  std::vector<Stamp> cells;    ///< of the input

  /// What was written, where another surface from the same cells has the same triangles.
  vtkPolyData* sameTriangles(const RemeshResult& result, vtkPolyData* from) const;
  static std::vector<Stamp> cellStamps(vtkPolyData* data);
  /// The map's key, where another output from the same input would be the same.
  ResultKey mapFor(vtkPolyData* other, vtkTypeBool withTextureCoordinates) const;
};

/// What a run made on its surface, with its map and its numbers, as the output `mapped`.
void writeMapped(const RemeshResult& result, const RemeshOptions& options,
  const MappedSource& source, vtkPolyData* mapped);

} // namespace quadrille
