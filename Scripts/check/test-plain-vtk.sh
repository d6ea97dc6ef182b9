#!/bin/bash
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
#
# The second variant: filters, Python module and commands with plain VTK (9.1 in Debian 12, 9.3 in 13) into build-vtk/,
# and their tests. Core is that of build/, which Scripts/build/build.sh or Scripts/run-tests.sh has made. Arguments go
# to ctest.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
[[ -f build/QuadrilleCore.cmake ]] || { echo "test-plain-vtk: run Scripts/build/build.sh first" >&2; exit 1; }

options=(-G Ninja -DCMAKE_BUILD_TYPE=Release -DQUADRILLE_VTK=VTK -DQUADRILLE_CORE_FROM="$PWD/build"
  -DQUADRILLE_BUILD_TESTS=ON)
[[ -f build-vtk/CMakeCache.txt ]] || options+=(-DQUADRILLE_UNITY_BUILD=ON)
if command -v ccache >/dev/null; then
  options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_C_COMPILER_LAUNCHER=ccache)
fi
with_vtk=(Scripts/build/plain-vtk.sh build-vtk/plain-vtk)
# Debian's package has no tools for Java, which CMake tells of at length.
"${with_vtk[@]}" cmake -S . -B build-vtk "${options[@]}"
"${with_vtk[@]}" cmake --build build-vtk --parallel "$(nproc)"
exec "${with_vtk[@]}" ctest --test-dir build-vtk --output-on-failure --parallel "$(nproc)" "$@"
