// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Readers of VTK's XML files that read them with any libexpat. Since its repair of CVE-2023-52425 libexpat puts off
/// parsing until it has twice as much, and VTK up to 9.3.0 misses the begin of the appended data then (VTK's issue
/// 19258): files that ParaView writes by default are "not well-formed", on Debian 12 with its security updates too.
#pragma once

#include "vtkSmartPointer.h"

class vtkXMLPolyDataReader;
class vtkXMLUnstructuredGridReader;

namespace quadrille
{

vtkSmartPointer<vtkXMLPolyDataReader> newPolyDataReader();
vtkSmartPointer<vtkXMLUnstructuredGridReader> newUnstructuredGridReader();

} // namespace quadrille
