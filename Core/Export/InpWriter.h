// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Input decks for Abaqus and CalculiX: nodes, elements, sets; sections where thickness or axes are known.
///
/// Source: Abaqus Keywords Reference, CalculiX CrunchiX User's Manual 2.20. Numbers have at most 20 characters, which
/// is what both read, so that some coordinates lose their last digits. What is in the file:
///
///   NALL, EALL     all nodes, all elements; both numbered from 1 in the order of the mesh
///   element sets   one a patch; of each boundary loop NAME_E1 to NAME_E4, the elements that have their side 1 to 4 on
///                  it, for *DLOAD with EDNOR1 to EDNOR4
///   node sets      one a boundary loop, feature curve and corner, with the nodes in the middle of edges; one a patch
///                  that has a name, of the name of its element set
///   surfaces       one a boundary loop, and one a curve with a name of its own, NAME_EDGES
///   thickness      up to 64 different values: a section each; more: *NODAL THICKNESS, of each node the average of its
///                  elements by area
///   axis           *ORIENTATION: the first direction is the axis, the second one the normal times the axis
#pragma once

#include "Base/Progress.h"
#include "Export/MeshSets.h"

#include <string>
#include <vector>

namespace quadrille
{

/// Where the two programs differ.
enum class InpDialect
{
  /// Sides of shells in surfaces are S3 to S6. Distributions of axes are for plane elements only, as those of shells
  /// are read and not used; shells have an orientation and a section for each pair of axis and normal.
  Calculix,
  Abaqus ///< Sides of shells in surfaces are E1 to E4. Axes are a *DISTRIBUTION with its table
};

struct InpOptions
{
  std::string elementType; ///< one of inpElementTypes; empty: S4, S8R, or S9R5 for 9 nodes
  InpDialect dialect = InpDialect::Calculix;
  std::string material = "MATERIAL"; ///< that sections name; the user's deck has to define it
  ProgressCallback progress;
};

/// The types for elements of 4, 8 or 9 nodes; the default comes first.
std::vector<std::string> inpElementTypes(int nodesPerElement, InpDialect dialect);

/// Returns what the user should know. Throws InvalidInput where the type does not have that many nodes, or a plane type
/// is asked for elements that are not in the plane z = 0 (to 1e-9 of the diagonal) or clockwise in it; WriteError.
std::vector<std::string> writeInp(const ElementMesh& mesh, const MeshSets& sets,
  const std::string& path, const InpOptions& options);

} // namespace quadrille
