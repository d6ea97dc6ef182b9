# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
# Core from another build folder of the same sources, in place of Core/CMakeLists.txt: the targets that it exports, and
# the packages that they name.
if(NOT EXISTS "${QUADRILLE_CORE_FROM}/QuadrilleCore.cmake")
  message(FATAL_ERROR "QUADRILLE_CORE_FROM: ${QUADRILLE_CORE_FROM} is no build folder of Quadrille.")
endif()
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Threads REQUIRED)
find_package(nlohmann_json REQUIRED)
include("${QUADRILLE_CORE_FROM}/QuadrilleCore.cmake")
# As it is there.
set(QUADRILLE_USE_CGAL OFF)
if(TARGET QuadrilleRepair)
  find_package(CGAL 5.5 REQUIRED)
  set(QUADRILLE_USE_CGAL ON)
endif()
message(STATUS "Core: the libraries in ${QUADRILLE_CORE_FROM}")
