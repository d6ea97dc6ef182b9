// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleSymmetryAlgorithm.h"

//------------------------------------------------------------------------------
vtkQuadrilleSymmetryAlgorithm::vtkQuadrilleSymmetryAlgorithm() = default;

vtkQuadrilleSymmetryAlgorithm::~vtkQuadrilleSymmetryAlgorithm() = default;

//------------------------------------------------------------------------------
void vtkQuadrilleSymmetryAlgorithm::AddSettings(std::ostream& os) const
{
  this->Superclass::AddSettings(os);
  const double* origin = this->SymmetryOrigin;
  const double* normal = this->SymmetryNormal;
  os << "Symmetry " << this->Symmetry << '\n'
     << "PlaneCurve " << this->PlaneCurve << '\n'
     << "SymmetryOrigin " << origin[0] << ' ' << origin[1] << ' ' << origin[2] << '\n'
     << "SymmetryNormal " << normal[0] << ' ' << normal[1] << ' ' << normal[2] << '\n'
     << "RotationOrder " << this->RotationOrder << '\n';
}

//------------------------------------------------------------------------------
void vtkQuadrilleSymmetryAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Symmetry: " << this->Symmetry << "\n";
  os << indent << "PlaneCurve: " << this->PlaneCurve << "\n";
  os << indent << "SymmetryOrigin: " << this->SymmetryOrigin[0] << " " << this->SymmetryOrigin[1]
     << " " << this->SymmetryOrigin[2] << "\n";
  os << indent << "SymmetryNormal: " << this->SymmetryNormal[0] << " " << this->SymmetryNormal[1]
     << " " << this->SymmetryNormal[2] << "\n";
  os << indent << "RotationOrder: " << this->RotationOrder << "\n";
}
