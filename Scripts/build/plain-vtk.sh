#!/bin/bash
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
#
# Debian's VTK (9.1 in Debian 12, 9.3 in 13) beside ParaView: python3-vtk9, which libvtk9-dev asks for, and
# python3-paraview exclude each other on a machine, so the packages are unpacked into a folder, and nothing is
# installed. Needs no privileges.
#
#   Scripts/build/plain-vtk.sh FOLDER           downloads and unpacks; does nothing where that has been done
#   Scripts/build/plain-vtk.sh FOLDER CMD...    and runs a command with it, as cmake, ninja, ctest or python3
#
# For example, with QUADRILLE_VTK=VTK, as it finds ParaView too:
#   Scripts/build/plain-vtk.sh build-vtk/vtk cmake -B build-vtk -G Ninja -DQUADRILLE_VTK=VTK
#   Scripts/build/plain-vtk.sh build-vtk/vtk cmake --build build-vtk
#   Scripts/build/plain-vtk.sh build-vtk/vtk ctest --test-dir build-vtk
set -euo pipefail
[[ $# -ge 1 ]] || { echo "usage: plain-vtk.sh FOLDER [COMMAND ...]" >&2; exit 2; }
mkdir -p "$1"
folder=$(cd "$1" && pwd)
shift

libraries=$folder/usr/lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH)

if [[ ! -f $folder/complete ]]; then
  mkdir -p "$folder/packages"
  # The package of the libraries bears their version.
  vtk_library() { apt-cache depends libvtk9-dev 2>/dev/null | awk '$2 ~ /^libvtk9[.][0-9]+$/ && !seen++ { print $2 }'; }
  download()
  {
    local library
    library=$(vtk_library)
    # libtbb-dev: VTK's package asks for TBB::tbb. python3-vedo, python3-deprecated and python3-wrapt: for the example.
    [[ $library ]] && apt-get download -q libvtk9-dev "$library" "$library-qt" vtk9 python3-vtk9 libtbb-dev libtbb12 \
      libtbbbind-2-5 libtbbmalloc2 python3-vedo python3-deprecated python3-wrapt python3-pygments
  }
  # Where the lists of packages are missing or old, root can renew them.
  (cd "$folder/packages" && { download || { [[ $(id -u) -eq 0 ]] && apt-get update -q && download; }; }) || {
    echo "plain-vtk: the packages cannot be downloaded; sudo apt-get update may help" >&2
    exit 1
  }
  for package in "$folder"/packages/*.deb; do
    dpkg -x "$package" "$folder"
  done
  # dpkg-shlibdeps takes from there which package the libraries are of.
  dpkg -e "$folder/packages/$(vtk_library)"_*.deb "$folder/DEBIAN"
  rm -r "$folder/packages"
  # What the libraries need beside each other is not unpacked: ParaView depends on nearly all of it.
  missing=$(for library in "$libraries"/libvtk{Common,Filters,IO,Parallel,Wrapping}*.so.1; do
    LD_LIBRARY_PATH=$libraries ldd "$library" | awk '/not found/ { print $1 }'; done | sort -u)
  if [[ -n $missing ]]; then
    echo "plain-vtk: libraries that VTK needs are missing:" $missing >&2
    echo "plain-vtk: install what the library of libvtk9-dev depends on: apt-cache depends libvtk9-dev" >&2
    exit 1
  fi
  touch "$folder/complete"
fi
[[ $# -eq 0 ]] && exit 0
export CMAKE_PREFIX_PATH=$folder/usr${CMAKE_PREFIX_PATH:+:$CMAKE_PREFIX_PATH}
export LD_LIBRARY_PATH=$libraries${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
export PYTHONPATH=$folder/usr/lib/python3/dist-packages${PYTHONPATH:+:$PYTHONPATH}
exec "$@"
