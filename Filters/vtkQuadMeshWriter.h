// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadMeshWriter
 * @brief   quads as files for simulation and graphics, with sets
 *
 * Takes a vtkPolyData of quads or a vtkUnstructuredGrid of VTK_QUAD, VTK_QUADRATIC_QUAD or VTK_BIQUADRATIC_QUAD cells.
 * From these alone it makes sets: elements by patch; the boundary loops; feature curves, of the cell array
 * `FeatureEdges` (bit i: the edge from corner i to i + 1), cut at corners; the corners. Patches have the names of the
 * string array `PatchNames`, of the cells or in the field data, there with `PatchNumbers` for the patch that each name
 * is of; else PATCH_n. Boundary loops, feature curves and corners are BOUNDARY_n, CURVE_n and CORNER_n, from 1 on.
 *
 * | extension | format | sets |
 * |---|---|---|
 * | inp | Abaqus, CalculiX | element sets, node sets, surfaces; thickness and axes |
 * | msh | Gmsh 4.1 or 2.2 | physical groups of points, curves and surfaces |
 * | mesh | MEDIT | references; corners, ridges, required vertices |
 * | ex2, e, exo, exodus | Exodus II | element blocks, side sets, node sets |
 * | vtp | VTK | all arrays as they are |
 * | vtu | VTK | all arrays of numbers; with FileDetails all arrays |
 * | obj | Wavefront | groups, of patches that the user has given |
 * | ply | | with FileDetails a property of faces, the same |
 * | stl | binary STL | none; triangles |
 *
 * A file is written beside its place and renamed: what is there is whole. What is wrong with the mesh is an error that
 * names the cell.
 */
#ifndef vtkQuadMeshWriter_h
#define vtkQuadMeshWriter_h

#include "QuadrilleFiltersModule.h" // for the export macro
#include "vtkWriter.h"

#include <string> // for std::string
#include <vector> // for std::vector

class vtkDataSet;

class QUADRILLEFILTERS_EXPORT vtkQuadMeshWriter : public vtkWriter
{
public:
  static vtkQuadMeshWriter* New();
  vtkTypeMacro(vtkQuadMeshWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file to write; its extension says the format. Default: none.
   */
  void SetFileName(const char* name);
  const char* GetFileName() { return this->FileName.c_str(); }
  ///@}

  /// Whether the extension of the name is one of those above.
  static bool CanWriteFile(const char* name);
  /// Those above, with commas: "vtp, vtu, ...".
  static std::string GetExtensions();

  ///@{
  /**
   * The cell array of patches, whole numbers or strings. Default: empty, as is "(automatic)", which means `PatchId`, or
   * else `PatchNames`, or else `LayoutPatch` where it has at most 200 patches, whichever is there first; without any,
   * all elements are one set.
   */
  void SetPatchArrayName(const char* name);
  const char* GetPatchArrayName() { return this->PatchArrayName.c_str(); }
  ///@}

  ///@{
  /**
   * inp: the type of the elements. Of 4 nodes S4, S4R, CPS4, CPS4R, CPE4 or CPE4R, of 8 nodes S8R, S8, CPS8, CPS8R,
   * CPE8 or CPE8R, of 9 nodes S9R5. Default: empty, the first of these.
   */
  void SetElementType(const char* type);
  const char* GetElementType() { return this->ElementType.c_str(); }
  ///@}

  /// Whose input decks.
  enum Dialects
  {
    CALCULIX = 0,
    ABAQUS = 1
  };

  ///@{
  /**
   * inp: CalculiX (the default) and Abaqus differ in the names of sides of shells, and in how axes of elements are
   * given.
   */
  vtkSetClampMacro(Dialect, int, CALCULIX, ABAQUS);
  vtkGetMacro(Dialect, int);
  void SetDialectToCalculix() { this->SetDialect(CALCULIX); }
  void SetDialectToAbaqus() { this->SetDialect(ABAQUS); }
  ///@}

  ///@{
  /**
   * inp: the name of the material in sections, which are there where the mesh has the cell array `Thickness` or
   * `ElementAxis`. Default: MATERIAL.
   */
  void SetMaterial(const char* name);
  const char* GetMaterial() { return this->Material.c_str(); }
  ///@}

  /// Versions of Gmsh's format.
  enum MshVersions
  {
    MSH_4_1 = 0,
    MSH_2_2 = 1
  };

  ///@{
  /**
   * msh: the version of the format. Default: 4.1.
   */
  vtkSetClampMacro(MshVersion, int, MSH_4_1, MSH_2_2);
  vtkGetMacro(MshVersion, int);
  void SetMshVersionTo41() { this->SetMshVersion(MSH_4_1); }
  void SetMshVersionTo22() { this->SetMshVersion(MSH_2_2); }
  ///@}

  ///@{
  /**
   * vtu, ply: what many programs stop at, so that it is in the file only where this is on. vtu: arrays of texts and
   * bits, arrays without a name, and field data without values. ply: patches that the user has given, as a property of
   * faces, and comments with their names. Default: off.
   */
  vtkSetMacro(FileDetails, bool);
  vtkGetMacro(FileDetails, bool);
  vtkBooleanMacro(FileDetails, bool);
  ///@}

  /// How the last call of Write() went.
  enum Outcomes
  {
    Succeeded = 0,
    BadInput = 1,    ///< the mesh or a setting is at fault
    CannotWrite = 2, ///< the file is
    Stopped = 3
  };
  int GetOutcome() { return this->Outcome; }
  /// Why the last call of Write() wrote nothing; empty after success.
  const char* GetOutcomeText() { return this->OutcomeText.c_str(); }
  /// What else there is to know of it, one sentence a line.
  const char* GetNoticesText() { return this->NoticesText.c_str(); }

protected:
  vtkQuadMeshWriter();
  ~vtkQuadMeshWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

private:
  vtkQuadMeshWriter(const vtkQuadMeshWriter&) = delete;
  void operator=(const vtkQuadMeshWriter&) = delete;

  void SetText(std::string& member, const char* value);
  void WriteFile(vtkDataSet* mesh, const std::string& path);
  void WriteElements(vtkDataSet* mesh, const std::string& path);
  void AddNotices(const std::vector<std::string>& notices);

  std::string FileName;
  std::string PatchArrayName;
  std::string ElementType;
  int Dialect = CALCULIX;
  std::string Material = "MATERIAL";
  int MshVersion = MSH_4_1;
  bool FileDetails = false;
  int Outcome = Succeeded;
  std::string OutcomeText;
  std::string NoticesText;
};

#endif
