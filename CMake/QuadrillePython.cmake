# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
# `import quadrille`, in the interpreter that has the VTK of this build: pvpython and the system's own one.
set(python_folder "lib/python3/dist-packages")
set(QUADRILLE_PRIVATE_PYTHON "")
if(QUADRILLE_PACKAGES AND QUADRILLE_WITH_PARAVIEW)
  # So that the packages for both VTKs can be installed; which one is imported decides _vtk.py.
  set(python_folder "${QUADRILLE_LIBRARY_DIR}/python")
  set(QUADRILLE_PRIVATE_PYTHON "/usr/${python_folder}")
  file(WRITE "${CMAKE_BINARY_DIR}/Packaging/paraview-quadrille.pth" "${QUADRILLE_PRIVATE_PYTHON}\n")
  install(FILES "${CMAKE_BINARY_DIR}/Packaging/paraview-quadrille.pth"
    DESTINATION "lib/python3/dist-packages" COMPONENT "${QUADRILLE_COMPONENT}")
endif()
set(QUADRILLE_PYTHON_DIR "${python_folder}" CACHE STRING
  "Where the Python package quadrille is installed, below the prefix")

find_package(Python3 REQUIRED COMPONENTS Interpreter Development.Module)
vtk_module_wrap_python(
  MODULES             Quadrille::QuadrilleFilters
  TARGET              Quadrille::Python
  PYTHON_PACKAGE      "quadrille"
  MODULE_DESTINATION  "${QUADRILLE_PYTHON_DIR}"
  LIBRARY_DESTINATION "${QUADRILLE_LIBRARY_DIR}"
  COMPONENT           "${QUADRILLE_COMPONENT}"
  INSTALL_HEADERS     OFF
  BUILD_STATIC        OFF)
foreach(file IN ITEMS __init__ _arrays _backend _backend_vtk _elements _errors _files _inputs _mesh _options _proxies
    _repair _session _vtk_data
    evaluation/__init__ evaluation/features evaluation/guided evaluation/layout evaluation/meshes evaluation/page
    evaluation/study evaluation/tools)
  get_filename_component(folder "${file}" DIRECTORY)
  configure_file("${CMAKE_SOURCE_DIR}/Filters/Python/${file}.py"
    "${CMAKE_BINARY_DIR}/${QUADRILLE_PYTHON_DIR}/quadrille/${file}.py" COPYONLY)
  install(FILES "${CMAKE_SOURCE_DIR}/Filters/Python/${file}.py"
    DESTINATION "${QUADRILLE_PYTHON_DIR}/quadrille/${folder}" COMPONENT "${QUADRILLE_COMPONENT}")
endforeach()
foreach(file IN ITEMS _version _vtk)
  configure_file("${CMAKE_SOURCE_DIR}/Filters/Python/${file}.py.in"
    "${CMAKE_BINARY_DIR}/${QUADRILLE_PYTHON_DIR}/quadrille/${file}.py" @ONLY)
  install(FILES "${CMAKE_BINARY_DIR}/${QUADRILLE_PYTHON_DIR}/quadrille/${file}.py"
    DESTINATION "${QUADRILLE_PYTHON_DIR}/quadrille" COMPONENT "${QUADRILLE_COMPONENT}")
endforeach()
foreach(file IN ITEMS __init__.pyi py.typed)
  configure_file("${CMAKE_SOURCE_DIR}/Filters/Python/${file}"
    "${CMAKE_BINARY_DIR}/${QUADRILLE_PYTHON_DIR}/quadrille/${file}" COPYONLY)
  install(FILES "${CMAKE_SOURCE_DIR}/Filters/Python/${file}"
    DESTINATION "${QUADRILLE_PYTHON_DIR}/quadrille" COMPONENT "${QUADRILLE_COMPONENT}")
endforeach()

# What VTK generates for each class costs little beside its headers.
quadrille_unity(QuadrilleFiltersPython 16)
