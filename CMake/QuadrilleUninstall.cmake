# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
# Takes away what the last `cmake --install` of a build folder has put somewhere, and folders that are empty then:
#   cmake -DBUILD=build -P CMake/QuadrilleUninstall.cmake, or cmake --build build --target uninstall
file(GLOB manifests "${BUILD}/install_manifest*.txt")
if(NOT manifests)
  message(FATAL_ERROR "${BUILD} has no install_manifest.txt: nothing was installed from it.")
endif()
set(folders)
foreach(manifest IN LISTS manifests)
  file(STRINGS "${manifest}" files)
  foreach(file IN LISTS files)
    file(REMOVE "${file}")
    get_filename_component(folder "${file}" DIRECTORY)
    if(file MATCHES "[.]py$")
      file(REMOVE_RECURSE "${folder}/__pycache__") # what Python has made of it
    endif()
    list(APPEND folders "${folder}")
  endforeach()
  file(REMOVE "${manifest}")
endforeach()
list(REMOVE_DUPLICATES folders)
foreach(folder IN LISTS folders)
  # Upwards as long as there is nothing else in it.
  while(IS_DIRECTORY "${folder}")
    file(GLOB rest LIST_DIRECTORIES true "${folder}/*" "${folder}/.*")
    if(rest)
      break()
    endif()
    file(REMOVE_RECURSE "${folder}")
    get_filename_component(folder "${folder}" DIRECTORY)
  endwhile()
endforeach()
message(STATUS "Uninstalled.")
