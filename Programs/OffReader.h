// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Reader of the Object File Format in text form, for which VTK 9.2 has none.
#pragma once

#include <vtkSmartPointer.h>

#include <string>

class vtkPolyData;

namespace quadrille
{

/// Reads OFF, COFF, NOFF, STOFF and their mixtures: comments, any white space, colours after vertices and
/// faces are skipped. Throws FileError naming the vertex or face that is damaged.
vtkSmartPointer<vtkPolyData> readOff(const std::string& path);

} // namespace quadrille
