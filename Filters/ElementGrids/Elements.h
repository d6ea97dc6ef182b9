// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// vtkPolyData or vtkUnstructuredGrid of quads -> ElementMesh.
#pragma once

#include "Export/ElementMesh.h"

#include <string>
#include <vector>

class vtkAbstractArray;
class vtkDataSet;

namespace quadrille
{

namespace arrays
{
constexpr const char* kThickness = "Thickness";
constexpr const char* kElementAxis = "ElementAxis";
constexpr const char* kPatchNames = "PatchNames";
constexpr const char* kPatchNumbers = "PatchNumbers";
}

/// The cell array that says which patch an element is of.
struct PatchSource
{
  vtkAbstractArray* array = nullptr; ///< whole numbers, or strings; null: there is none
  bool isAsked = false;              ///< the user's, and not LayoutPatch, which every result has
  int leftOut = 0; ///< patches of the layout, where these are more than kMostLayoutPatches
};

/// Sets nobody asked for: with more patches than this the layout is no division that a user works with, and VTK takes
/// 40 s for an Exodus file of 4,800 blocks.
constexpr int kMostLayoutPatches = 200;

/// name: the array of this name; empty: PatchId, or else PatchNames, or else LayoutPatch, whichever is there first;
/// LayoutPatch with at most kMostLayoutPatches. Throws InvalidInput where there is none of the name.
PatchSource patchSource(vtkDataSet* data, const std::string& name);

/// Points in double precision; cells VTK_QUAD, VTK_QUADRATIC_QUAD or VTK_BIQUADRATIC_QUAD, all of one kind; of the cell
/// arrays FeatureEdges, Thickness, ElementAxis, and the patches of the source. Names of patches come from the cell
/// array PatchNames (strings; where elements of a patch differ, the one of most of them, which a notice tells), or else
/// from the field data PatchNames (strings) with PatchNumbers; without PatchNumbers name i is of patch i, or, where
/// patch numbers go from 1 to the number of names, of patch i + 1. Throws InvalidInput naming the cell or array.
ElementMesh readElements(
  vtkDataSet* data, const PatchSource& patches, std::vector<std::string>& notices);

} // namespace quadrille
