#!/bin/bash
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs what Quadrille needs on Debian 12 and 13: what it is built and run with, and with --tests what tests and
# examples use, too. Does nothing, and needs no privileges, when everything is there already.
set -euo pipefail

needed=(
  g++ cmake ninja-build dpkg-dev file
  paraview paraview-dev python3-paraview
  libopenmpi-dev openmpi-bin            # ParaView's CMake files ask for MPI::MPI_C
  libcgal-dev libeigen3-dev libsuitesparse-dev
  libocct-data-exchange-dev             # STEP, IGES and BREP files, by Open CASCADE
  qttools5-dev qtxmlpatterns5-dev-tools # the pages behind the question mark in ParaView's panel, also where its window
                                        # is of Qt 6, see CMake/QuadrilleVtkVersions.cmake
  libcli11-dev nlohmann-json3-dev       # options and reports of the commands, files of sessions
  python3-dev python3-numpy python3-scipy
  python3-matplotlib                    # figures of quadrille-evaluate
  xvfb xauth libgl1-mesa-dri            # pictures without a screen
)
# Icons of the window, and what the drawing tools in it are built with, by the Qt that ParaView is built with.
if grep -q '^VERSION_ID="\?12"\?$' /etc/os-release; then
  needed+=(libqt5svg5 qtbase5-dev)
else
  needed+=(qt6-svg-plugins)
fi
# Where a release of Debian lacks one of them, CMake leaves the tests out that need it, and says so.
for_tests=(
  libgtest-dev
  gmsh python3-gmsh python3-meshio      # the tests of formats read files back with them, and with CalculiX, by which
  python3-netcdf4 admesh calculix-ccx   # Scripts/figures/solved_example.py solves; meshio reads Exodus files by netcdf4
  valgrind                              # instructions, for Scripts/check/figures.py
  pybind11-dev                          # the Python package without VTK
  clang-format clang-tidy               # the tests hold the sources against them
  xdotool openbox                       # mouse and keyboard in the window, under a window manager
)

tests=
if [[ ${1:-} == --tests ]]; then
  tests=yes
elif [[ $# -gt 0 ]]; then
  echo "usage: install-dependencies.sh [--tests]" >&2
  exit 2
fi

missing=()
absent_of() # PACKAGE...: those that are not installed become `missing`
{
  missing=()
  local package
  for package in "$@"; do
    [[ $(dpkg-query --show --showformat='${Status}' "$package" 2>/dev/null || true) == "install ok installed" ]] ||
      missing+=("$package")
  done
}
in_release() { [[ -n $(apt-cache show --no-all-versions "$1" 2>/dev/null) ]]; }
have_lists() { compgen -G '/var/lib/apt/lists/*_Packages*' >/dev/null; }
as_root() # COMMAND...
{
  if [[ $(id -u) -eq 0 ]]; then
    env DEBIAN_FRONTEND=noninteractive "$@"
  elif command -v sudo >/dev/null; then
    sudo env DEBIAN_FRONTEND=noninteractive "$@"
  else
    echo "install-dependencies: run as root, or install sudo; missing: ${missing[*]}" >&2
    exit 1
  fi
}

# Only what tests use may be left out, and only where the release is known not to have it.
wanted=("${needed[@]}")
if [[ $tests ]]; then
  absent_of "${for_tests[@]}"
  if [[ ${#missing[@]} -gt 0 ]] && ! have_lists; then
    as_root apt-get update -q
  fi
  for package in ${missing[@]+"${missing[@]}"}; do
    if in_release "$package"; then
      wanted+=("$package")
    else
      echo "install-dependencies: this release of Debian has no $package; the tests that need it are left out"
    fi
  done
fi
absent_of "${wanted[@]}"
if [[ ${#missing[@]} -eq 0 ]]; then
  echo "install-dependencies: nothing to install"
  exit 0
fi
echo "install-dependencies: installing ${missing[*]}"
as_root apt-get update -q
as_root apt-get install -q -y --no-install-recommends "${missing[@]}"
