# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Whether the VTK of this machine reads XML files with appended data, by which ParaView's own filters send data from
rank to rank. Exit code 1 where it does not: VTK up to 9.3.0 with a libexpat that puts off parsing (VTK's issue 19258).

  probe_appended.py FOLDER
"""
import pathlib
import sys

from vtkmodules.vtkCommonCore import vtkLogger, vtkObject
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPolyDataWriter

vtkObject.GlobalWarningDisplayOff()
vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
path = pathlib.Path(sys.argv[1]) / "probe_appended.vtp"
sphere = vtkSphereSource()
sphere.SetThetaResolution(20)
sphere.Update()
writer = vtkXMLPolyDataWriter()
writer.SetInputData(sphere.GetOutput())
writer.SetFileName(str(path))
writer.SetDataModeToAppended()
writer.SetEncodeAppendedData(False)
writer.Write()
reader = vtkXMLPolyDataReader()
reader.SetFileName(str(path))
reader.Update()
path.unlink()
sys.exit(reader.GetOutput().GetNumberOfPoints() != sphere.GetOutput().GetNumberOfPoints())
