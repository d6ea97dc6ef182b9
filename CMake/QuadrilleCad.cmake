# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
# CAD files (room Cad), where Open CASCADE is at hand. Without it everything else is the same, and who gives a CAD file
# is told what to install.
set(cad_missing)
find_package(OpenCASCADE QUIET)
foreach(target IN ITEMS TKXCAF TKMesh TKBRep TKShHealing)
  if(NOT TARGET ${target})
    set(cad_missing "Open CASCADE is not there for builds (package libocct-data-exchange-dev)")
  endif()
endforeach()
if(NOT cad_missing AND OpenCASCADE_VERSION VERSION_LESS 7.6)
  set(cad_missing "Open CASCADE ${OpenCASCADE_VERSION} is older than 7.6")
endif()
set(cad_is_possible ON)
if(cad_missing)
  set(cad_is_possible OFF)
endif()
# Not an option: what "auto" leads to changes when Open CASCADE is installed later.
set(QUADRILLE_CAD "auto" CACHE STRING "Read CAD files, with Open CASCADE: ON, OFF, or auto: where it is there")
set_property(CACHE QUADRILLE_CAD PROPERTY STRINGS auto ON OFF)
set(QUADRILLE_WITH_CAD ${QUADRILLE_CAD})
if(QUADRILLE_CAD STREQUAL "auto")
  set(QUADRILLE_WITH_CAD ${cad_is_possible})
endif()
if(QUADRILLE_WITH_CAD AND NOT cad_is_possible)
  message(FATAL_ERROR "QUADRILLE_CAD is on, but ${cad_missing}: install libocct-data-exchange-dev, or turn it off.")
endif()
# quadrille_link_occt(TARGET LIBRARY...): libraries of Open CASCADE by their files. Linking them as targets asks for the
# headers of TBB, FreeType and others, which only Open CASCADE's own sources need.
function(quadrille_link_occt target)
  target_include_directories(${target} SYSTEM PRIVATE "${OpenCASCADE_INCLUDE_DIR}")
  foreach(library IN LISTS ARGN)
    target_link_libraries(${target} PRIVATE $<TARGET_FILE:${library}>)
  endforeach()
endfunction()
set(cad_files TKXDESTEP TKXDEIGES TKSTEP TKIGES)
if(TARGET TKDESTEP) # from 7.8 on
  set(cad_files TKDESTEP TKDEIGES)
endif()

if(QUADRILLE_WITH_CAD)
  message(STATUS "CAD files: read with Open CASCADE ${OpenCASCADE_VERSION} (QUADRILLE_CAD is ${QUADRILLE_CAD})")
  add_subdirectory(Cad)
elseif(cad_missing)
  message(STATUS "Without CAD files (QUADRILLE_CAD is ${QUADRILLE_CAD}), as ${cad_missing}")
else()
  message(STATUS "Without CAD files (QUADRILLE_CAD is ${QUADRILLE_CAD})")
endif()
