# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
# The Python package without VTK, for the wheel, where pybind11 is at hand.
find_package(Python3 COMPONENTS Interpreter Development.Module)
set(PYBIND11_FINDPYTHON ON)
find_package(pybind11 2.10 CONFIG QUIET)
set(native_is_possible OFF)
if(pybind11_FOUND AND Python3_Development.Module_FOUND)
  set(native_is_possible ON)
endif()
# Not an option: what "auto" leads to changes when pybind11 is installed later.
set(QUADRILLE_BUILD_WHEEL "auto" CACHE STRING
  "Build the Python package without VTK, which the wheel packs: ON, OFF, or auto: where pybind11 is there")
set_property(CACHE QUADRILLE_BUILD_WHEEL PROPERTY STRINGS auto ON OFF)
set(QUADRILLE_WITH_WHEEL ${QUADRILLE_BUILD_WHEEL})
if(QUADRILLE_BUILD_WHEEL STREQUAL "auto")
  set(QUADRILLE_WITH_WHEEL ${native_is_possible})
  if(QUADRILLE_CORE_FROM) # which has it
    set(QUADRILLE_WITH_WHEEL OFF)
  endif()
endif()
if(QUADRILLE_WITH_WHEEL AND NOT native_is_possible)
  message(FATAL_ERROR "QUADRILLE_BUILD_WHEEL is on, but there is no pybind11 2.10 or newer, or no headers of Python: "
    "install pybind11-dev and python3-dev, or turn it off.")
endif()
if(NOT QUADRILLE_WITH_WHEEL)
  message(STATUS "Without the Python package of the wheel (QUADRILLE_BUILD_WHEEL is ${QUADRILLE_BUILD_WHEEL})")
  return()
endif()
add_subdirectory(Native)
