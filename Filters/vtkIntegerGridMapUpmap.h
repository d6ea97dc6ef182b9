// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkIntegerGridMapUpmap
 * @brief   carries the map of the coarse level to the input surface: the decimation log backwards
 *
 * Inputs: 0 the coarse level with `IGM` (vtkIntegerGridMap); 1 the surface that vtkDecimationHierarchy had;
 * 2 its log port; 3, where guides are to be followed between the levels, its intermediate level. A log of another
 * surface is refused. Output: the surface, repaired, with
 * `IGM`, `Matching`, `Determinant`, `Turns`, `Index`, `SourceCellId`, `SourcePointIds`, every array of the surface,
 * and, with TextureCoordinates, points doubled at the cuts. Field data: certificate, stage times, counts of the replay.
 */
#ifndef vtkIntegerGridMapUpmap_h
#define vtkIntegerGridMapUpmap_h

#include "vtkQuadrilleAlgorithm.h"

namespace quadrille
{
class StageLaps;
struct SharedLevels;
struct SurfaceInput;
struct SurfaceRecipe;
}

class QUADRILLEFILTERS_EXPORT vtkIntegerGridMapUpmap : public vtkQuadrilleAlgorithm
{
public:
  static vtkIntegerGridMapUpmap* New();
  vtkTypeMacro(vtkIntegerGridMapUpmap, vtkQuadrilleAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  void SetSurfaceConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(1, output); }
  void SetLogConnection(vtkAlgorithmOutput* output) { this->SetInputConnection(2, output); }
  /**
   * The intermediate level of vtkDecimationHierarchy: optional. Where it has guides, the map is turned along them there,
   * with the same integers, as Quad Remesh does.
   */
  void SetIntermediateConnection(vtkAlgorithmOutput* output)
  {
    this->SetInputConnection(3, output);
  }

  ///@{
  /**
   * Whether the output has texture coordinates; its points are then doubled where the map is cut. Default: on.
   */
  vtkSetMacro(TextureCoordinates, vtkTypeBool);
  vtkGetMacro(TextureCoordinates, vtkTypeBool);
  vtkBooleanMacro(TextureCoordinates, vtkTypeBool);
  ///@}

protected:
  vtkIntegerGridMapUpmap();
  ~vtkIntegerGridMapUpmap() override;

  PortRole GetPortRole(int port) const override;
  void Execute(quadrille::Block& block) override;

private:
  /// The finest level: what a filter of this process holds, else made from the surface, whose conversion is let go.
  void FindOrPrepare(quadrille::SurfaceInput& input, const quadrille::SurfaceRecipe& recipe,
    quadrille::StageLaps& laps, quadrille::SharedLevels& held);

  vtkIntegerGridMapUpmap(const vtkIntegerGridMapUpmap&) = delete;
  void operator=(const vtkIntegerGridMapUpmap&) = delete;

  vtkTypeBool TextureCoordinates = 1;
};

#endif
