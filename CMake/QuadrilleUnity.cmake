# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
# A whole build in three fifths of the time: much of what a source costs are the headers of Eigen, VTK and the standard
# library, so several sources of a target are compiled as one. Off by default, as a change of one file then costs its
# whole batch, and clang-tidy wants a file at a time; Scripts/build/build.sh turns it on for a fresh build folder.
#
# What stands in the anonymous namespaces of a target is one scope then. A name that stands in two of its files does not
# compile (or, with another signature, would be an overload of the other), so Testing/Repository/check_unity.py holds
# that each name stands once in a target.
option(QUADRILLE_UNITY_BUILD "Compile several sources as one: whole builds are faster, single changes slower" OFF)

# quadrille_unity(TARGET BATCH): at most BATCH sources of the target are compiled as one.
function(quadrille_unity target batch)
  if(QUADRILLE_UNITY_BUILD)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${batch})
  endif()
endfunction()
