# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
# Whose VTK the filters, the Python package and the programs are built with. ParaView brings a VTK of its own; the two
# cannot be in one process, so a build folder has one of them.
set(QUADRILLE_VTK "auto" CACHE STRING
  "VTK to build with: ParaView's with the plugin, plain VTK, or auto: ParaView's where it is found, else plain VTK")
set_property(CACHE QUADRILLE_VTK PROPERTY STRINGS auto ParaView VTK)
if(NOT QUADRILLE_VTK MATCHES "^(auto|ParaView|VTK)$")
  message(FATAL_ERROR "QUADRILLE_VTK is \"${QUADRILLE_VTK}\", but it has to be auto, ParaView or VTK.")
endif()

include(CMake/QuadrilleVtkVersions.cmake)

set(quadrille_paraview_reason)
if(NOT QUADRILLE_VTK STREQUAL "VTK")
  # ParaView's server manager was built with double-conversion and its package asks for it; nothing here includes or
  # links it, so that the library with which ParaView runs is enough and its headers need not be there.
  find_library(double-conversion_LIBRARY NAMES double-conversion libdouble-conversion.so.3)
  if(NOT double-conversion_INCLUDE_DIR) # also where an earlier run has noted that it did not find it
    set(double-conversion_INCLUDE_DIR "/usr/include" CACHE PATH "Not used, but asked for by ParaView's package" FORCE)
  endif()
  set(quadrille_how REQUIRED)
  if(QUADRILLE_VTK STREQUAL "auto")
    set(quadrille_how QUIET)
  endif()
  quadrille_python_exports(ParaView vtk/VTKPython ParaViewPython ParaViewPythonIncubator)
  # Naming components keeps Qt, GDAL and ffmpeg out of what a build needs.
  find_package(ParaView 5.11 ${quadrille_how} COMPONENTS RemotingCore RemotingServerManager)
  if(NOT ParaView_FOUND)
    set(quadrille_paraview_reason ", as ParaView 5.11 is not there for builds (package paraview-dev)")
    if(ParaView_NOT_FOUND_MESSAGE)
      set(quadrille_paraview_reason ", as ParaView cannot be used: ${ParaView_NOT_FOUND_MESSAGE}")
    endif()
  endif()
endif()

set(QUADRILLE_WITH_PARAVIEW OFF)
if(ParaView_FOUND AND NOT QUADRILLE_VTK STREQUAL "VTK")
  set(QUADRILLE_WITH_PARAVIEW ON)
  message(STATUS "VTK: that of ParaView ${ParaView_VERSION}, with the plugin (QUADRILLE_VTK is ${QUADRILLE_VTK})")
else()
  quadrille_python_exports(VTK VTKPython)
  # Components alone keep the packages of all other modules (Java, MySQL, Qt, ...) out of what a build needs. Of the
  # modules for files only the libraries are linked, see Programs/CMakeLists.txt.
  find_package(VTK 9.1 REQUIRED COMPONENTS CommonCore CommonDataModel CommonExecutionModel FiltersCore FiltersGeometry
    ParallelCore Python WrappingPythonCore WrappingTools)
  message(STATUS "VTK: plain VTK ${VTK_VERSION} in ${VTK_PREFIX_PATH}, without the plugin of ParaView "
    "(QUADRILLE_VTK is ${QUADRILLE_VTK}${quadrille_paraview_reason})")
endif()
quadrille_find_mpi()
if(NOT PARAVIEW_USE_PYTHON AND NOT VTK_WRAP_PYTHON)
  message(FATAL_ERROR "This VTK was built without Python, which the package `quadrille` needs.")
endif()

# Where Python has the VTK of this build; empty with ParaView, which the system's interpreter and pvpython know.
set(QUADRILLE_VTK_PYTHON)
if(NOT QUADRILLE_WITH_PARAVIEW)
  set(QUADRILLE_VTK_PYTHON "${VTK_PREFIX_PATH}/${VTK_PYTHONPATH}")
endif()

# quadrille_link_files(TARGET MODULE...): the library of a module of VTK instead of its target. Linking VTK::IOExodus as
# a target asks for the headers of NetCDF and HDF5, the others for those of jsoncpp, expat, lz4 and double-conversion,
# which only VTK's own sources need.
function(quadrille_link_files target)
  foreach(module IN LISTS ARGN)
    target_link_libraries(${target} PRIVATE $<TARGET_FILE:VTK::${module}>)
  endforeach()
endfunction()
