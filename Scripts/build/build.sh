#!/bin/bash
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
#
# Configures and builds the "release" preset into build/. Arguments go to the configure step, for example
# -DQUADRILLE_BUILD_TESTS=OFF. A fresh folder is built with QUADRILLE_UNITY_BUILD; one that is there keeps its setting.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

options=()
[[ -f build/CMakeCache.txt ]] || options+=(-DQUADRILLE_UNITY_BUILD=ON)
if command -v ccache >/dev/null; then
  options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_C_COMPILER_LAUNCHER=ccache)
fi
cmake --preset release "${options[@]}" "$@"

# A translation unit of several sources takes up to 2 GB, so memory bounds the jobs too.
memory_gb=$(awk '/^MemAvailable:/ { print int($2 / 1048576) }' /proc/meminfo 2>/dev/null || echo 4)
jobs=$((${memory_gb:-4} / 2))
[[ $jobs -ge 1 ]] || jobs=1
[[ $jobs -le $(nproc) ]] || jobs=$(nproc)
cmake --build --preset release --parallel "$jobs"
