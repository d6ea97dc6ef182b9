// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkIntegerGridMapQuality
 * @brief   sizing, anisotropy and shear of a map, face by face and as histograms
 *
 * Input: a surface with a map as vtkQuadExtraction takes it. Of the map g from the parameter domain, whose unit is a
 * quad, to the surface, with the target edge length s [Ebke et al. 2016, Section 8]:
 *
 * - `Sizing`: det(grad g) / s^2, the area of a quad there over that of a square of edge length s;
 * - `Anisotropy`: the larger singular value of grad g over the smaller one;
 * - `Shear`: the angle at which isolines cross, in degrees, 90 at best; negative in an inverted triangle.
 *
 * Outputs:
 *
 * 0. the surface with these cell arrays;
 * 1. a table with 36 bins: for each measure the middle of the bin (`SizingBin`, ...) and the share of the area in it
 *    (`SizingShare`, ...), in percent; what lies beyond the ends counts in the first and the last bin;
 * 2. a table with a row for each measure: `Mean`, `Minimum`, `Percent5`, `Median`, `Percent95`, `Maximum`, by area;
 * 3. a table of the irregular inner vertices: `Valence` and `Count`.
 *
 * Triangles that are inverted or have no area count in no share and no mean; field data `InvertedTriangles` and
 * `DegenerateTriangles` of output 0 have their number, `EdgeLength` has s.
 */
#ifndef vtkIntegerGridMapQuality_h
#define vtkIntegerGridMapQuality_h

#include "vtkQuadrilleAlgorithm.h"

class vtkTable;

class QUADRILLEFILTERS_EXPORT vtkIntegerGridMapQuality : public vtkQuadrilleAlgorithm
{
public:
  static vtkIntegerGridMapQuality* New();
  vtkTypeMacro(vtkIntegerGridMapQuality, vtkQuadrilleAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The edge length s of the quads asked for, in units of the input. 0, the default: the field data's
   * `TargetEdgeLength`, or else the one with which the map has as many quads as squares of that size cover the surface.
   */
  vtkSetClampMacro(EdgeLength, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(EdgeLength, double);
  ///@}

  ///@{
  /**
   * Quads per unit of the texture coordinates, where the map is read from these. Default: 1.
   */
  vtkSetMacro(TextureScale, double);
  vtkGetMacro(TextureScale, double);
  ///@}

  ///@{
  /// Outputs 1 to 3; null for composite data.
  vtkTable* GetHistograms();
  vtkTable* GetSummary();
  vtkTable* GetValences();
  ///@}

protected:
  vtkIntegerGridMapQuality();
  ~vtkIntegerGridMapQuality() override;

  PortRole GetPortRole(int) const override { return PortRole::Mesh; }
  const char* GetBlockType(int outputPort) const override;
  void AddSettings(std::ostream& os) const override;
  void Execute(quadrille::Block& block) override;

private:
  vtkIntegerGridMapQuality(const vtkIntegerGridMapQuality&) = delete;
  void operator=(const vtkIntegerGridMapQuality&) = delete;

  double EdgeLength = 0;
  double TextureScale = 1;
};

#endif
