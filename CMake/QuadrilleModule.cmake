# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
# The VTK filters with plain VTK.
set(QUADRILLE_LIBRARY_DIR "${CMAKE_INSTALL_LIBDIR}/quadrille")

vtk_module_scan(
  MODULE_FILES     "${CMAKE_SOURCE_DIR}/Filters/vtk.module"
  PROVIDES_MODULES quadrille_modules
  REQUIRES_MODULES quadrille_required_modules
  WANT_BY_DEFAULT  ON
  ENABLE_TESTS     OFF
  HIDE_MODULES_FROM_CACHE ON)
foreach(module IN LISTS quadrille_required_modules)
  if(NOT TARGET "${module}")
    message(FATAL_ERROR "This VTK lacks the module ${module}, which the filters need.")
  endif()
endforeach()
# Who links the library finds it beside the programs' libraries, not on the linker's path: no headers, no soname.
vtk_module_build(
  MODULES             ${quadrille_modules}
  LIBRARY_DESTINATION "${QUADRILLE_LIBRARY_DIR}"
  ARCHIVE_DESTINATION "${QUADRILLE_LIBRARY_DIR}"
  INSTALL_HEADERS     OFF
  TARGETS_COMPONENT   Command)
