// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Arrays and polygons as bytes between ranks. VTK's own way, its legacy writer, changes types of arrays and their
/// names, so that arrays of two ranks would not fit each other any more.
#pragma once

#include <vtkSmartPointer.h>

class vtkAbstractArray;
class vtkFieldData;
class vtkPolyData;

namespace quadrille
{

class Packer;
class Unpacker;

/// Numbers, bits and strings can.
bool canBePacked(vtkAbstractArray* array);

/// The arrays with their names, types, components and the components' names; those that cannot be packed are left out.
/// Which are active is not told.
void packArrays(vtkFieldData* data, Packer& packer);
/// Adds what packArrays wrote.
void unpackArrays(Unpacker& unpacker, vtkFieldData* data);

/// Points and polygons with their arrays, and field data. Other cells are not told, and there must be none where there
/// are cell arrays.
void packSurface(vtkPolyData* surface, Packer& packer);
vtkSmartPointer<vtkPolyData> unpackSurface(Unpacker& unpacker);

} // namespace quadrille
