# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
# A whole build in three fifths of the time: much of what a source costs are the headers of Eigen, VTK and the standard
# library, so several sources of a target are compiled as one. Off by default, as a change of one file then costs its
# whole batch, and clang-tidy wants a file at a time; Scripts/build/build.sh turns it on for a fresh build folder.
#
# What stands in the anonymous namespaces of a batch is one scope. unity_groups.py therefore puts two sources with the
# same name in there into different batches. It looks when the folder is configured: after a new name that two sources
# share, configure again.
option(QUADRILLE_UNITY_BUILD "Compile several sources as one: whole builds are faster, single changes slower" OFF)
if(QUADRILLE_UNITY_BUILD)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
endif()

# quadrille_unity(TARGET BATCH): at most BATCH sources of the target are compiled as one. Called where it is made.
function(quadrille_unity target batch)
  if(NOT QUADRILLE_UNITY_BUILD)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "^[^$]*[.](cpp|cxx)$")
  set(present)
  foreach(source IN LISTS sources)
    get_filename_component(path "${source}" ABSOLUTE)
    if(NOT EXISTS "${path}")
      # Made by the build: wrappers, which have no anonymous namespaces.
      set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${batch})
      return()
    endif()
    list(APPEND present "${path}")
  endforeach()
  execute_process(COMMAND "${Python3_EXECUTABLE}" "${CMAKE_SOURCE_DIR}/CMake/unity_groups.py" ${batch} ${present}
    OUTPUT_VARIABLE groups RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "The sources of ${target} could not be put into batches; QUADRILLE_UNITY_BUILD=OFF does "
      "without.")
  endif()
  string(REGEX MATCHALL "[^\n]+" groups "${groups}")
  while(groups)
    list(POP_FRONT groups source number)
    set_source_files_properties("${source}" PROPERTIES UNITY_GROUP "${target}-${number}")
  endwhile()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
