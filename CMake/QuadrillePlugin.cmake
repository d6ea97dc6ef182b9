# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
# The VTK filters and the plugin, with ParaView's VTK.
set(QUADRILLE_LIBRARY_DIR "${CMAKE_INSTALL_LIBDIR}/${PARAVIEW_PLUGIN_SUBDIR}/Quadrille")

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
# The drawing tools in the window, with the Qt that ParaView was built with.
set(QUADRILLE_QT 5)
if(PARAVIEW_QT_MAJOR_VERSION) # older ones have Qt 5 and do not say so
  set(QUADRILLE_QT "${PARAVIEW_QT_MAJOR_VERSION}")
endif()
set(quadrille_client_default OFF)
# The sources know Qt 6 as well, but were never tried in a window with it, so there they are built where asked for.
if(PARAVIEW_USE_QT AND TARGET ParaView::pqComponents AND QUADRILLE_QT EQUAL 5)
  find_package(Qt${QUADRILLE_QT} QUIET COMPONENTS Widgets)
  set(quadrille_client_default "${Qt${QUADRILLE_QT}_FOUND}")
endif()
option(QUADRILLE_CLIENT "Build the drawing tools of ParaView's window, with its Qt" ${quadrille_client_default})
if(QUADRILLE_CLIENT)
  if(NOT TARGET ParaView::pqComponents)
    message(FATAL_ERROR "QUADRILLE_CLIENT is ON, but this ParaView has no window; set QUADRILLE_CLIENT to OFF.")
  endif()
  find_package(Qt${QUADRILLE_QT} REQUIRED COMPONENTS Widgets)
  add_subdirectory(Client)
else()
  message(STATUS "No drawing tools in ParaView's window: QUADRILLE_CLIENT is OFF; they need Qt ${QUADRILLE_QT} "
    "(qtbase5-dev or qt6-base-dev)")
endif()

# The pages behind the question mark in the panel. ParaView's CMake functions compile them with the tools of Qt, and
# fail without; /usr/bin/xmlpatterns may be a link of qtchooser to nothing, so it is run.
quadrille_help_tools()
set(QUADRILLE_HELP OFF)
find_program(qt_xmlpatterns_executable NAMES xmlpatterns-qt5 xmlpatterns) # the name that ParaView looks it up by
find_package(Qt5Help QUIET)
if(PARAVIEW_USE_QT AND ParaView_VERSION VERSION_LESS 6 AND qt_xmlpatterns_executable AND Qt5Help_FOUND
    AND TARGET Qt5::qhelpgenerator)
  execute_process(COMMAND "${qt_xmlpatterns_executable}" -version RESULT_VARIABLE result OUTPUT_QUIET ERROR_QUIET)
  if(result EQUAL 0)
    set(QUADRILLE_HELP ON)
  endif()
endif()
if(QUADRILLE_HELP)
  set(quadrille_no_help OFF)
else()
  message(STATUS
    "No help pages in ParaView: xmlpatterns (qtxmlpatterns5-dev-tools) or Qt5Help (qttools5-dev) is missing, or it is "
    "ParaView 6, which makes them otherwise")
  set(quadrille_no_help ON)
endif()
paraview_plugin_build(
  RUNTIME_DESTINATION  "${CMAKE_INSTALL_BINDIR}"
  LIBRARY_DESTINATION  "${CMAKE_INSTALL_LIBDIR}"
  LIBRARY_SUBDIRECTORY "${PARAVIEW_PLUGIN_SUBDIR}"
  DISABLE_XML_DOCUMENTATION ${quadrille_no_help}
  PLUGINS_FILE_NAME    "quadrille.plugins.xml"
  AUTOLOAD             Quadrille
  PLUGINS_COMPONENT    Plugin
  TARGET_COMPONENT     Plugin
  PLUGINS              ${quadrille_plugins})

# What ParaView generates for each class costs little beside its headers.
quadrille_unity(QuadrilleFiltersCS 16)
