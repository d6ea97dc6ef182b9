#!/bin/bash
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
#
# On a fresh Debian 12 or 13: installs the packages, builds, and remeshes a mesh of Data/. Leaves in out/ the
# quads as .vtp and .obj, a picture and the report. Another mesh and other options:
#   Scripts/run-demo.sh MESH [options of the quadrille command]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

mesh=${1:-Data/part.ply}
[[ $# -eq 0 ]] || shift
options=("$@")
[[ ${#options[@]} -gt 0 ]] || options=(--quads 5000)
[[ -f $mesh ]] || { echo "run-demo: no file $mesh" >&2; exit 2; }

Scripts/build/install-dependencies.sh
Scripts/build/build.sh -DQUADRILLE_BUILD_TESTS=OFF

name=$(basename "${mesh%.*}")
mkdir -p out
build/bin/quadrille "$mesh" "out/$name-quads.vtp" "${options[@]}" --report "out/$name-report.json"
build/bin/quadrille "$mesh" "out/$name-quads.obj" "${options[@]}"
xvfb-run -a pvpython --force-offscreen-rendering Scripts/figures/render.py "out/$name-quads.vtp" "out/$name-quads.png"
echo
echo "run-demo: done"
ls -l "out/$name-quads.vtp" "out/$name-quads.obj" "out/$name-quads.png" "out/$name-report.json"
