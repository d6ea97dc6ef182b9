# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
# Debian packages by CPack, see Scripts/build/make-packages.sh: paraview-quadrille (component Plugin) from a build with
# ParaView's VTK, quadrille (Command) from one with plain VTK; from either libquadrille and the major version
# (SharedLibrary) and libquadrille-dev (Library).
set(QUADRILLE_PACKAGE_CONTACT "The Quadrille maintainers <maintainers@quadrille.invalid>" CACHE STRING
  "Name and address of who makes the packages, as Debian's field Maintainer wants them")

if(NOT QUADRILLE_PACKAGES)
  return()
endif()
if(NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr" OR NOT QUADRILLE_BUILD_PLUGIN)
  message(FATAL_ERROR "QUADRILLE_PACKAGES needs -DCMAKE_INSTALL_PREFIX=/usr and QUADRILLE_BUILD_PLUGIN.")
endif()
if(QUADRILLE_WITH_PARAVIEW AND NOT QUADRILLE_HELP)
  message(FATAL_ERROR "QUADRILLE_PACKAGES: the plugin of the package has its help pages; what they need is missing.")
endif()

set(CPACK_COMPONENTS_ALL "${QUADRILLE_COMPONENT}")
if(TARGET quadrille_api)
  list(APPEND CPACK_COMPONENTS_ALL SharedLibrary Library)
endif()

# Copyright and changelog of each package. What is built with Core/Repair is under the GPL as a whole.
set(GPL_PART "")
set(BINARY_LICENSE "BSD-3-Clause")
if(QUADRILLE_USE_CGAL)
  file(READ "${PROJECT_SOURCE_DIR}/Packaging/copyright-gpl.in" GPL_PART)
  set(BINARY_LICENSE "GPL-3+")
endif()
file(READ "${PROJECT_SOURCE_DIR}/LICENSE" LICENSE_TEXT)
string(FIND "${LICENSE_TEXT}" "Redistribution" begin) # name and holder before it stand in fields of their own
string(SUBSTRING "${LICENSE_TEXT}" ${begin} -1 LICENSE_TEXT)
string(STRIP "${LICENSE_TEXT}" LICENSE_TEXT)
string(REPLACE "\n\n" "\n.\n" LICENSE_TEXT "${LICENSE_TEXT}")
string(REPLACE "\n" "\n " LICENSE_TEXT " ${LICENSE_TEXT}")
string(TIMESTAMP PACKAGE_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
find_program(QUADRILLE_GZIP gzip REQUIRED)

# quadrille_package(COMPONENT NAME): its documents, and CPack's variables for it.
macro(quadrille_package component name)
  string(TOUPPER "${component}" upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME "${name}")
  set(package_gpl "${GPL_PART}")
  set(package_license "${BINARY_LICENSE}")
  if("${component}" MATCHES "Library") # has no part of Core/Repair
    set(package_gpl "")
    set(package_license "BSD-3-Clause")
  endif()
  set(package_folder "${CMAKE_BINARY_DIR}/Packaging/${name}")
  set(package_name "${name}")
  configure_file("${PROJECT_SOURCE_DIR}/Packaging/copyright.in" "${package_folder}/copyright" @ONLY)
  configure_file("${PROJECT_SOURCE_DIR}/Packaging/changelog.in" "${package_folder}/changelog.Debian" @ONLY)
  execute_process(COMMAND "${QUADRILLE_GZIP}" -9nf "${package_folder}/changelog.Debian" COMMAND_ERROR_IS_FATAL ANY)
  install(FILES "${package_folder}/copyright" "${package_folder}/changelog.Debian.gz"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/${name}" COMPONENT "${component}")
endmacro()

math(EXPR QUADRILLE_NEXT_PYTHON "${Python3_VERSION_MINOR} + 1")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME quadrille)
set(CPACK_PACKAGE_CONTACT "${QUADRILLE_PACKAGE_CONTACT}")
# CPack's own default, with which it begins no package's description: each has a first line of its own.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${CMAKE_PROJECT_NAME} built using CMake")
set(CPACK_PACKAGING_INSTALL_PREFIX "/usr")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${CMAKE_BINARY_DIR}/${QUADRILLE_LIBRARY_DIR}")

quadrille_package(${QUADRILLE_COMPONENT} "${QUADRILLE_PACKAGE}")
if(QUADRILLE_WITH_PARAVIEW)
  set(CPACK_DEBIAN_PLUGIN_DESCRIPTION "quad remeshing of triangle surfaces, plugin of ParaView
Turns a triangle surface of up to several million faces into a pure quad
mesh: filters, sources and readers in ParaView's menus and in its Python
modules. ParaView loads the plugin as it starts.")
  set(CPACK_DEBIAN_PLUGIN_PACKAGE_SECTION science)
  # The plugin is for the ParaView that it was built with, up to its next minor version.
  math(EXPR next_minor "${ParaView_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PLUGIN_PACKAGE_DEPENDS
    "paraview (>= ${ParaView_VERSION_SIMPLE}~), paraview (<< ${ParaView_VERSION_MAJOR}.${next_minor}~)")
  set(CPACK_DEBIAN_PLUGIN_PACKAGE_RECOMMENDS "python3-paraview, python3-numpy")
  set(CPACK_DEBIAN_PLUGIN_PACKAGE_SUGGESTS "quadrille")
else()
  set(CPACK_DEBIAN_COMMAND_DESCRIPTION "quad remeshing of triangle surfaces, command and Python module
Turns a triangle surface of up to several million faces into a pure quad
mesh: the command quadrille for files, the command quadrille-evaluate for
maps and meshes, and the Python package quadrille for data of VTK.

The Python package uses the VTK that Python has: that of python3-vtk9, or,
with paraview-quadrille, that of python3-paraview.")
  set(CPACK_DEBIAN_COMMAND_PACKAGE_SECTION science)
  # python3-vtk9 and python3-paraview exclude each other, so that one of them has to be enough.
  set(CPACK_DEBIAN_COMMAND_PACKAGE_DEPENDS "python3 (>= ${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}~), \
python3 (<< ${Python3_VERSION_MAJOR}.${QUADRILLE_NEXT_PYTHON}~), python3-numpy, python3-vtk9 | python3-paraview")
  set(CPACK_DEBIAN_COMMAND_PACKAGE_RECOMMENDS "python3-scipy, python3-matplotlib")
  set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS "paraview-quadrille, python3-vedo")
endif()
install(FILES "${PROJECT_SOURCE_DIR}/Documentation/UserGuide.md" "${PROJECT_SOURCE_DIR}/Documentation/Installation.md"
  "${PROJECT_SOURCE_DIR}/Documentation/Formats.md" "${PROJECT_SOURCE_DIR}/Documentation/Simulation.md"
  DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/${QUADRILLE_PACKAGE}" COMPONENT "${QUADRILLE_COMPONENT}")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/Documentation/Guide"
  DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/${QUADRILLE_PACKAGE}" COMPONENT "${QUADRILLE_COMPONENT}"
  FILES_MATCHING PATTERN "*.md")
# Byte code that Python has written belongs to no package, so each removes its own.
foreach(script IN ITEMS postinst prerm)
  configure_file("${PROJECT_SOURCE_DIR}/Packaging/${script}.in"
    "${CMAKE_BINARY_DIR}/Packaging/${QUADRILLE_PACKAGE}/${script}" @ONLY)
  string(TOUPPER "${QUADRILLE_COMPONENT}" upper)
  list(APPEND CPACK_DEBIAN_${upper}_PACKAGE_CONTROL_EXTRA
    "${CMAKE_BINARY_DIR}/Packaging/${QUADRILLE_PACKAGE}/${script}")
endforeach()

if(TARGET quadrille_api)
  set(shared_package "libquadrille${PROJECT_VERSION_MAJOR}")
  quadrille_package(SharedLibrary "${shared_package}")
  set(CPACK_DEBIAN_SHAREDLIBRARY_DESCRIPTION "quad remeshing of triangle surfaces, shared library
Turns a triangle surface of up to several million faces into a pure quad
mesh. What programs that use libquadrille-dev need to run.")
  set(CPACK_DEBIAN_SHAREDLIBRARY_PACKAGE_SECTION libs)
  # For dpkg-shlibdeps of others.
  file(WRITE "${CMAKE_BINARY_DIR}/Packaging/${shared_package}/shlibs"
    "libquadrille ${PROJECT_VERSION_MAJOR} ${shared_package} (>= ${PROJECT_VERSION})\n")
  set(CPACK_DEBIAN_SHAREDLIBRARY_PACKAGE_CONTROL_EXTRA "${CMAKE_BINARY_DIR}/Packaging/${shared_package}/shlibs")

  quadrille_package(Library libquadrille-dev)
  set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "quad remeshing of triangle surfaces, for C++ programs
Turns a triangle surface of up to several million faces into a pure quad
mesh: one function with its options and result, in types of the standard
library. The header and the files for CMake's find_package(Quadrille); an
example is in the folder of documents.")
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS OFF) # no program or library is in it
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS
    "${shared_package} (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/Documentation/Examples/library"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/libquadrille-dev/examples" COMPONENT Library)
endif()

include(CPack)
