# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
# The VTK filters, the ParaView plugin, the Python package and the programs.

# ParaView's server manager was built with double-conversion and its package asks for it; nothing here includes or links
# it, so that the library with which ParaView runs is enough and its headers need not be there.
find_library(double-conversion_LIBRARY NAMES double-conversion libdouble-conversion.so.3)
if(NOT double-conversion_INCLUDE_DIR) # also where an earlier run has noted that it did not find it
  set(double-conversion_INCLUDE_DIR "/usr/include" CACHE PATH "Not used, but asked for by ParaView's package" FORCE)
endif()
# Naming components keeps Qt, GDAL and ffmpeg out of what a build needs.
find_package(ParaView 5.11 REQUIRED COMPONENTS RemotingCore RemotingServerManager)

set(_paraview_plugin_default_Quadrille ON)
paraview_plugin_scan(
  PLUGIN_FILES     "${CMAKE_SOURCE_DIR}/Plugin/paraview.plugin"
  PROVIDES_PLUGINS quadrille_plugins
  REQUIRES_MODULES quadrille_required_modules
  ENABLE_BY_DEFAULT ON
  HIDE_PLUGINS_FROM_CACHE ON)
foreach(module IN LISTS quadrille_required_modules)
  if(NOT TARGET "${module}")
    message(FATAL_ERROR "This ParaView lacks the module ${module}, which the plugin needs.")
  endif()
endforeach()
# The pages behind the question mark in the panel. ParaView's CMake functions compile them with the tools of Qt, and
# fail without; /usr/bin/xmlpatterns may be a link of qtchooser to nothing, so it is run.
set(QUADRILLE_HELP OFF)
find_program(qt_xmlpatterns_executable NAMES xmlpatterns-qt5 xmlpatterns) # the name that ParaView looks it up by
find_package(Qt5Help QUIET)
if(PARAVIEW_USE_QT AND qt_xmlpatterns_executable AND Qt5Help_FOUND AND TARGET Qt5::qhelpgenerator)
  execute_process(COMMAND "${qt_xmlpatterns_executable}" -version RESULT_VARIABLE result OUTPUT_QUIET ERROR_QUIET)
  if(result EQUAL 0)
    set(QUADRILLE_HELP ON)
  endif()
endif()
if(QUADRILLE_HELP)
  set(quadrille_no_help OFF)
else()
  message(STATUS
    "No help pages in ParaView: xmlpatterns (qtxmlpatterns5-dev-tools) or Qt5Help (qttools5-dev) is missing")
  set(quadrille_no_help ON)
endif()
paraview_plugin_build(
  RUNTIME_DESTINATION  "${CMAKE_INSTALL_BINDIR}"
  LIBRARY_DESTINATION  "${CMAKE_INSTALL_LIBDIR}"
  LIBRARY_SUBDIRECTORY "${PARAVIEW_PLUGIN_SUBDIR}"
  DISABLE_XML_DOCUMENTATION ${quadrille_no_help}
  PLUGINS_FILE_NAME    "quadrille.plugins.xml"
  PLUGINS              ${quadrille_plugins})

# python: `import quadrille`, in pvpython and in the system's own interpreter.
set(QUADRILLE_PYTHON_DIR "${CMAKE_INSTALL_LIBDIR}/python3/dist-packages")
if(PARAVIEW_USE_PYTHON)
  find_package(Python3 REQUIRED COMPONENTS Interpreter Development.Module)
  vtk_module_wrap_python(
    MODULES             Quadrille::QuadrilleFilters
    TARGET              Quadrille::Python
    PYTHON_PACKAGE      "quadrille"
    MODULE_DESTINATION  "${QUADRILLE_PYTHON_DIR}"
    LIBRARY_DESTINATION "${CMAKE_INSTALL_LIBDIR}/${PARAVIEW_PLUGIN_SUBDIR}/Quadrille"
    INSTALL_HEADERS     OFF
    BUILD_STATIC        OFF)
  foreach(file IN ITEMS __init__ _elements _errors _files _inputs _proxies _repair _session)
    configure_file("${CMAKE_SOURCE_DIR}/Filters/Python/${file}.py"
      "${CMAKE_BINARY_DIR}/${QUADRILLE_PYTHON_DIR}/quadrille/${file}.py" COPYONLY)
    install(FILES "${CMAKE_SOURCE_DIR}/Filters/Python/${file}.py"
      DESTINATION "${QUADRILLE_PYTHON_DIR}/quadrille")
  endforeach()
  foreach(file IN ITEMS __init__ meshes page study tools)
    configure_file("${CMAKE_SOURCE_DIR}/Filters/Python/evaluation/${file}.py"
      "${CMAKE_BINARY_DIR}/${QUADRILLE_PYTHON_DIR}/quadrille/evaluation/${file}.py" COPYONLY)
    install(FILES "${CMAKE_SOURCE_DIR}/Filters/Python/evaluation/${file}.py"
      DESTINATION "${QUADRILLE_PYTHON_DIR}/quadrille/evaluation")
  endforeach()
else()
  message(FATAL_ERROR "This ParaView was built without Python, which the package `quadrille` needs.")
endif()

# What VTK and ParaView generate for each class costs little beside their headers.
quadrille_unity(QuadrilleFiltersPython 16)
quadrille_unity(QuadrilleFiltersCS 16)

add_subdirectory("${CMAKE_SOURCE_DIR}/Programs")
