// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Files of quads by VTK's own writers; the formats without VTK are in Core/Export.
#pragma once

#include "Export/MeshSets.h"

#include <string>
#include <vector>

class vtkDataSet;
class vtkPolyData;

namespace quadrille
{

/// These throw WriteError.
void writeVtp(vtkPolyData* mesh, const std::string& path);
/// Of a vtkPolyData its polygons. withDetails: all arrays, else those that every reader takes: numbers, with a name.
/// Returns what the user should know.
std::vector<std::string> writeVtu(vtkDataSet* mesh, bool withDetails, const std::string& path);

/// Exodus II: an element block for each patch, a side set for each boundary loop and feature curve, node sets for
/// these, the corners and the patches with a name, and all arrays of numbers as variables. Elements go by blocks, and
/// an element map has their ids from 1. Returns what the user should know.
std::vector<std::string> writeExodus(
  vtkDataSet* mesh, const ElementMesh& elements, const MeshSets& sets, const std::string& path);

/// "'one', 'two'".
std::string quoted(const std::vector<std::string>& names);

} // namespace quadrille
