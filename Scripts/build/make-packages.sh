#!/bin/bash
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
#
# Builds the Debian packages into out/packages (or FOLDER): paraview-quadrille with ParaView's VTK, quadrille with plain
# VTK, the library and libquadrille-dev. Both builds are in build-packages, with one Core. Other arguments go to CMake.
#   Scripts/build/make-packages.sh [FOLDER] [-DQUADRILLE_USE_CGAL=OFF ...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
packages=$PWD/out/packages
if [[ $# -gt 0 && $1 != -* ]]; then
  mkdir -p "$1"
  packages=$(cd "$1" && pwd)
  shift
fi
mkdir -p "$packages"
for tool in dpkg-shlibdeps apt-get gzip file; do
  command -v "$tool" >/dev/null ||
    { echo "make-packages: $tool is missing (packages dpkg-dev, apt, gzip, file)" >&2; exit 1; }
done

options=(-G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DQUADRILLE_PACKAGES=ON
  -DQUADRILLE_BUILD_TESTS=OFF -DQUADRILLE_BUILD_WHEEL=OFF -DQUADRILLE_UNITY_BUILD=ON "$@")
if command -v ccache >/dev/null; then
  options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_C_COMPILER_LAUNCHER=ccache)
fi
paraview=build-packages/paraview vtk=build-packages/vtk
cmake -S . -B "$paraview" -DQUADRILLE_VTK=ParaView "${options[@]}"
cmake --build "$paraview"
(cd "$paraview" && cpack -B "$packages")

with_vtk=(Scripts/build/plain-vtk.sh build-packages/plain-vtk)
"${with_vtk[@]}" cmake -S . -B "$vtk" -DQUADRILLE_VTK=VTK -DQUADRILLE_CORE_FROM="$PWD/$paraview" "${options[@]}"
"${with_vtk[@]}" cmake --build "$vtk"
(cd "$vtk" && ../../Scripts/build/plain-vtk.sh ../plain-vtk cpack -B "$packages")
rm -rf "$packages/_CPack_Packages"

vtk_library=$(cd build-packages/plain-vtk/DEBIAN && sed -n 's/^Package: //p' control)
# CPack leaves a library out of which it does not know the package.
for need in paraview-quadrille:paraview "quadrille:$vtk_library" "libquadrille[0-9]*:libstdc++6"; do
  package=("$packages"/${need%%:*}_*.deb)
  dpkg-deb -f "${package[0]}" Depends | grep -q "${need##*:} (>=" || {
    echo "make-packages: ${package[0]} does not depend on ${need##*:}" >&2; exit 1; }
done
for package in "$packages"/*.deb; do
  ! dpkg-deb -c "$package" | grep -q Cad/QuadrilleCad.so || dpkg-deb -f "$package" Depends | grep -q libocct || {
    echo "make-packages: $package reads CAD files, and does not depend on Open CASCADE" >&2; exit 1; }
done
version=$(sed -n 's/^project(Quadrille VERSION \([0-9.]*\) .*/\1/p' CMakeLists.txt)
for package in "$packages"/*.deb; do
  [[ $(dpkg-deb -f "$package" Version) == "$version"-* ]] || {
    echo "make-packages: $package is not of version $version; remove it" >&2; exit 1; }
done
ls -l "$packages"/*.deb
