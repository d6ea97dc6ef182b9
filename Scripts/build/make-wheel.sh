#!/bin/bash
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
#
# Builds the wheel quadrille-mesh, `import quadrille` without VTK, for this machine's /usr/bin/python3 into out/wheels
# (or FOLDER). By scikit-build-core where it is installed (Debian 13); else by CMake and Scripts/build/pack_wheel.py,
# which make the same files. --with-cgal is refused: the wheel has nothing of Core/Repair. --with-cad: a wheel that
# reads CAD files by this machine's Open CASCADE, which whoever installs it has to have, in the same version; it is
# tagged as one of this system, and made by CMake.
#   Scripts/build/make-wheel.sh [--with-cad] [FOLDER]
# QUADRILLE_CORE_FROM=BUILD in the environment takes the libraries of Core from another build of these sources.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
if [[ ${1:-} == --with-cgal ]]; then
  echo "make-wheel: repair() and wrap() are not in the wheel, so there is nothing that CGAL would be used for" >&2
  exit 1
fi
cad=OFF
if [[ ${1:-} == --with-cad ]]; then
  cad=ON
  shift
fi
mkdir -p "${1:-out/wheels}"
wheels=$(cd "${1:-out/wheels}" && pwd)
python=/usr/bin/python3
options=()
[[ ${QUADRILLE_CORE_FROM:-} ]] && options+=("-DQUADRILLE_CORE_FROM=$(realpath "$QUADRILLE_CORE_FROM")")
if command -v ccache >/dev/null; then
  options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_C_COMPILER_LAUNCHER=ccache)
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if [[ $cad == OFF ]] && $python -c 'import scikit_build_core, build' 2>/dev/null; then
  # Debian's pybind11-dev is there for CMake, not as a package of Python.
  CMAKE_ARGS="${options[*]}" CMAKE_GENERATOR=Ninja \
    $python -m build --wheel --no-isolation --skip-dependency-check --outdir "$work" .
  $python Scripts/build/pack_wheel.py --retag "$work"/quadrille_mesh-*.whl "$wheels"
else
  build=build-wheel/$($python -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
  [[ $cad == OFF ]] || build+=-cad
  cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DPython3_EXECUTABLE=$python \
    -DQUADRILLE_BUILD_PLUGIN=OFF -DQUADRILLE_BUILD_TESTS=OFF -DQUADRILLE_BUILD_WHEEL=ON -DQUADRILLE_USE_CGAL=OFF \
    -DQUADRILLE_CAD=$cad \
    -DQUADRILLE_UNITY_BUILD=ON "${options[@]}"
  cmake --build "$build" --target quadrille_native
  cmake --install "$build" --component Wheel --strip --prefix "$work"
  $python Scripts/build/pack_wheel.py "$work" "$wheels"
fi
ls -l "$wheels"
