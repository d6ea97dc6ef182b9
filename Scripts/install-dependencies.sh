#!/bin/bash
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs what Quadrille needs on Debian 12: compiler, libraries, ParaView, and what the tests use.
# Does nothing, and needs no privileges, when everything is there already.
set -euo pipefail

packages=(
  g++ cmake ninja-build dpkg-dev
  paraview paraview-dev python3-paraview
  libopenmpi-dev openmpi-bin            # ParaView's CMake files ask for MPI::MPI_C
  libcgal-dev libeigen3-dev libsuitesparse-dev
  qttools5-dev qtxmlpatterns5-dev-tools # the pages behind the question mark in ParaView's panel
  libcli11-dev nlohmann-json3-dev       # options and reports of the commands, files of sessions
  libgtest-dev python3 python3-numpy python3-scipy
  python3-matplotlib                    # figures of quadrille-evaluate
  gmsh python3-gmsh python3-meshio calculix-ccx # the test of formats reads files back with them; the first and the last
                                        # are what Scripts/solved_example.py compares with and solves by
  valgrind                              # instructions, for Scripts/figures.py
  clang-format clang-tidy               # the tests hold the sources against them
  xvfb xauth libqt5svg5 libgl1-mesa-dri # pictures without a screen
  xdotool                               # mouse and keyboard for Testing/Plugin/count_actions.py
)

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query --show --showformat='${Status}' "$package" 2>/dev/null || true)
  [[ $status == "install ok installed" ]] || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
  echo "install-dependencies: nothing to install"
  exit 0
fi

as_root=()
if [[ $(id -u) -ne 0 ]]; then
  if ! command -v sudo >/dev/null; then
    echo "install-dependencies: run as root, or install sudo; missing: ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "install-dependencies: installing ${missing[*]}"
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -q -y --no-install-recommends "${missing[@]}"
