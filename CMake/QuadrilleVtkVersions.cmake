# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
# What differs between the versions of VTK and ParaView that the sources are built with, and what their Debian packages
# lack. The same for C++ is in Filters/Common/VtkVersions.h. Included before either is looked for.

# quadrille_python_exports(PACKAGE FILE...): Debian 13's CMake files of VTK and ParaView name modules of Python
# (vtkCommonCore.so) that are installed under the interpreter's name for them (vtkCommonCore.cpython-313-...so), and
# CMake stops where a file that is named is missing. A file of exported targets is left at once where all of its targets
# are there, so a copy of it in the build folder, with the names of the files that exist, goes before it. FILE: the
# exports, as "vtk/VTKPython" for vtk/VTKPython-targets.cmake, beside the configuration of the package. Nothing is done
# where the names are right.
macro(quadrille_python_exports package)
  # No package has this version, so none is read, but CMake tells where it would have found one.
  find_package(${package} 9999 QUIET CONFIG)
  foreach(quadrille_config IN LISTS ${package}_CONSIDERED_CONFIGS)
    get_filename_component(quadrille_config "${quadrille_config}" DIRECTORY)
    foreach(quadrille_export IN ITEMS ${ARGN})
      quadrille_mended_export("${quadrille_config}/${quadrille_export}-targets.cmake" quadrille_mended)
      if(quadrille_mended)
        include("${quadrille_mended}")
      endif()
    endforeach()
  endforeach()
endmacro()

# quadrille_mended_export(FILE RESULT): the copy of a file of exported targets, or empty where it needs none.
function(quadrille_mended_export file result)
  set(${result} "" PARENT_SCOPE)
  string(REGEX REPLACE "[.]cmake$" "" stem "${file}")
  file(GLOB by_configuration "${stem}-*.cmake")
  if(NOT EXISTS "${file}" OR NOT by_configuration)
    return()
  endif()
  get_filename_component(folder "${file}" DIRECTORY)
  file(READ "${file}" text)
  # As the export itself goes up from where it is to its prefix.
  string(REGEX MATCHALL "_IMPORT_PREFIX \"[$]{_IMPORT_PREFIX}\" PATH" steps "${text}")
  set(prefix "${folder}")
  foreach(step IN LISTS steps)
    get_filename_component(prefix "${prefix}" DIRECTORY)
  endforeach()

  set(copy "${CMAKE_BINARY_DIR}/CMakeFiles/QuadrilleExports${folder}")
  set(renamed OFF)
  foreach(configuration IN LISTS by_configuration)
    file(READ "${configuration}" locations)
    string(REGEX MATCHALL "LOCATION[A-Z_]* \"[$]{_IMPORT_PREFIX}/[^\"]+[.]so\"" modules "${locations}")
    foreach(module IN LISTS modules)
      string(REGEX REPLACE ".*[$]{_IMPORT_PREFIX}/([^\"]+)[.]so\"" "\\1" module "${module}")
      file(GLOB installed "${prefix}/${module}.*.so")
      list(LENGTH installed count)
      if(NOT EXISTS "${prefix}/${module}.so" AND count EQUAL 1)
        get_filename_component(name "${installed}" NAME)
        get_filename_component(module_name "${module}" NAME)
        string(REPLACE "/${module_name}.so\"" "/${name}\"" locations "${locations}")
        set(renamed ON)
      endif()
    endforeach()
    get_filename_component(name "${configuration}" NAME)
    file(WRITE "${copy}/${name}" "${locations}")
  endforeach()
  if(NOT renamed)
    return()
  endif()
  # Its place is that of the original; the files of the configurations are those beside the copy.
  string(REPLACE "\${CMAKE_CURRENT_LIST_FILE}" "${file}" text "${text}")
  get_filename_component(name "${file}" NAME)
  file(WRITE "${copy}/${name}" "${text}")
  set(${result} "${copy}/${name}" PARENT_SCOPE)
endfunction()

# Pages of help in ParaView's panel: ParaView 5.12 and 5.13 compile those of plugins with the tools of Qt 5 only, also
# where their window is one of Qt 6, which reads them. The plugin itself has no part of Qt, so nothing else is decided
# by the version that their functions see.
macro(quadrille_help_tools)
  if(PARAVIEW_USE_QT AND PARAVIEW_QT_MAJOR_VERSION VERSION_GREATER 5)
    set(PARAVIEW_QT_MAJOR_VERSION 5)
  endif()
endmacro()

# The target MPI::MPI_C, which VTK's targets name in what links them; not each of its packages looks for it. In the
# folder that includes this, so that all below it see the target.
macro(quadrille_find_mpi)
  if(TARGET VTK::mpi)
    find_package(MPI REQUIRED COMPONENTS C)
  endif()
endmacro()

# quadrille_link_mpi(MODULE): MPI beyond what vtkMultiProcessController has. The library of VTK::ParallelMPI in place of
# the target, which asks for more; its header includes mpi.h, whose folder the target of MPI knows.
function(quadrille_link_mpi module)
  if(TARGET VTK::ParallelMPI)
    vtk_module_link(${module} PRIVATE $<TARGET_FILE:VTK::ParallelMPI> $<BUILD_INTERFACE:MPI::MPI_C>)
    vtk_module_definitions(${module} PRIVATE QUADRILLE_HAS_MPI)
  endif()
endfunction()
