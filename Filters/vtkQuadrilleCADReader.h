// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadrilleCADReader
 * @brief   reads STEP, IGES and BREP files as triangles that know their faces, edges and the exact shape
 *
 * Output 0 is a vtkPolyData where the file has one part, or JoinParts is on; else a vtkMultiBlockDataSet with a block
 * for each instance of the assembly, at its place and with its name. Cell arrays: `CadFaceId`, `PatchNames` (names of
 * the faces, of which writers of files for simulation make sets), `FeatureEdges` (see Follow), `CadColour`. Field data:
 * `CadShape`, from which vtkQuadCADProjection takes the exact shape, `CadFaceNames` and `CadSurfaceKinds` by id of the
 * face, `CadUnitOfFile`. Coordinates are in millimetres. Filters do not look for features on such a surface.
 *
 * Output 1 has the edges as polylines, with `CadPart`, `CadEdgeId`, `CadEdgeKind` (sharp, tangent, seam, free, wire),
 * `CadEdgeAngle` (degrees) and `CadEdgeName`.
 *
 * Shapes are healed by Open CASCADE, which is told in the notices. A file that is damaged is an error; the outputs are
 * empty then. There where Open CASCADE was at hand for the build.
 */
#ifndef vtkQuadrilleCADReader_h
#define vtkQuadrilleCADReader_h

#include "QuadrilleFiltersModule.h" // for the export macro
#include "vtkDataObjectAlgorithm.h"

#include <memory> // for std::unique_ptr
#include <string> // for std::string

class vtkPolyData;

class QUADRILLEFILTERS_EXPORT vtkQuadrilleCADReader : public vtkDataObjectAlgorithm
{
public:
  static vtkQuadrilleCADReader* New();
  vtkTypeMacro(vtkQuadrilleCADReader, vtkDataObjectAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Whether the extension is that of a CAD file: stp, step, igs, iges, brep or brp.
  static int CanReadFile(const char* name);

  ///@{
  /**
   * The file to read. Default: none.
   */
  void SetFileName(const char* name);
  const char* GetFileName() { return this->FileName.c_str(); }
  ///@}

  ///@{
  /**
   * By how much triangles may lie off the shape, as part of the diagonal of the part; 1e-6 to 0.1. Default: 0.0005.
   */
  vtkSetClampMacro(ChordError, double, 1e-6, 0.1);
  vtkGetMacro(ChordError, double);
  ///@}

  ///@{
  /**
   * Edges whose faces meet at a larger angle than this are sharp; degrees from 0.1 to 179. Default: 5.
   */
  vtkSetClampMacro(SharpAngle, double, 0.1, 179.0);
  vtkGetMacro(SharpAngle, double);
  ///@}

  enum Follows
  {
    FOLLOW_SHARP = 0,
    FOLLOW_ALL = 1,
    FOLLOW_NONE = 2
  };

  ///@{
  /**
   * Which edges of the shape become features, a Follows: the sharp ones; tangent ones, too; none. Seams and poles never
   * do. Default: FOLLOW_SHARP.
   */
  vtkSetClampMacro(Follow, int, FOLLOW_SHARP, FOLLOW_NONE);
  vtkGetMacro(Follow, int);
  ///@}

  ///@{
  /**
   * Whether all parts become one surface, whose faces are called "part/face". Default: off.
   */
  vtkSetMacro(JoinParts, vtkTypeBool);
  vtkGetMacro(JoinParts, vtkTypeBool);
  vtkBooleanMacro(JoinParts, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Seconds after which a file is refused; 0: 20, and 10 more for each megabyte. Default: 0.
   */
  vtkSetClampMacro(TimeLimit, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(TimeLimit, double);
  ///@}

  /// The edges, output 1.
  vtkPolyData* GetEdges();

  /// Why the last execution gave nothing; empty after success.
  const char* GetOutcomeText() { return this->OutcomeText.c_str(); }
  /// What was repaired, and in which unit the file is, a sentence a line.
  const char* GetNoticesText() { return this->NoticesText.c_str(); }

protected:
  vtkQuadrilleCADReader();
  ~vtkQuadrilleCADReader() override;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkQuadrilleCADReader(const vtkQuadrilleCADReader&) = delete;
  void operator=(const vtkQuadrilleCADReader&) = delete;

  struct Parts;
  void Read();
  std::string StampOfFile() const;

  std::string FileName;
  double ChordError = 0.0005;
  double SharpAngle = 5;
  int Follow = FOLLOW_SHARP;
  vtkTypeBool JoinParts = 0;
  double TimeLimit = 0;
  std::string OutcomeText;
  std::string NoticesText;
  std::unique_ptr<Parts> Found; ///< of the last reading
};

#endif
