#!/bin/bash
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs the packages of Scripts/build/make-packages.sh in a clean minimal Debian, once beside ParaView and once
# without, uses what they bring, and purges them: nothing may be left. By hand, as it downloads some hundred megabytes;
# as root, with mmdebstrap. Prints each command that runs in there (Documentation/Installation.md has them) and what it
# says.
#   Scripts/check/check-packages.sh [FOLDER with the packages, default out/packages] [SUITE that they are made on, by
#                                   default that of this machine]
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
packages=$(cd "${1:-$here/out/packages}" && pwd)
suite=${2:-$(. /etc/os-release && echo "$VERSION_CODENAME")}
arguments=("$packages" "$suite")
[[ $(id -u) -eq 0 ]] || { echo "check-packages: has to be run as root" >&2; exit 1; }
command -v mmdebstrap >/dev/null || { echo "check-packages: mmdebstrap is missing" >&2; exit 1; }
source "$here/Scripts/check/clean-debian.sh"
make_base "$suite"

make_system() # NAME
{
  make_root "$1"
  cp "$packages"/*.deb "$root/root/"
  cp "$here/Data/part.ply" "$here/Data/bracket.step" "$root/root/"
  quietly apt-get update
}
# All that is there but caches, logs and the folders of this script; what dpkg knows of packages is in it. Some packages
# of Debian that come along add a system group and leave the copy of the list that was before; netbase makes /etc/hosts.
files() { run_inside 'find / -xdev \( -path /proc -o -path /dev -o -path /sys -o -path /run -o -path /tmp -o \
  -path /root -o -path /var/cache -o -path /var/log -o -path /var/lib/apt -o -path "/etc/*shadow-" -o \
  -path "/etc/group-" -o -path /etc/hosts \) -prune -o -print | sort'; }
nothing_left()
{
  quietly apt-get purge -y "$@"
  quietly apt-get autoremove --purge -y
  files >"$work/after"
  if ! diff "$work/before" "$work/after"; then
    echo "check-packages: the purge has left the above (>), or taken what was there before (<)" >&2
    exit 1
  fi
  echo "purged: the same $(wc -l <"$work/before") files and folders as before"
}

echo "== beside ParaView"
make_system paraview
quietly apt-get install -y --no-install-recommends paraview python3-paraview xvfb xauth libgl1-mesa-dri
files >"$work/before"
quietly apt-get install -y --no-install-recommends ./paraview-quadrille_*.deb ./quadrille_*.deb ./libquadrille*.deb
cat >"$root/root/lists.py" <<'PY'
import sys
from paraview import simple
import quadrille
missing = {"QuadRemesh", "IntegerGridMap", "QuadExtraction", "QuadrillePLYReader", "QuadStroke"} - set(dir(simple))
if missing:
    sys.exit(f"not listed: {missing}")
quads = simple.QuadRemesh(Input=simple.Sphere(ThetaResolution=64, PhiResolution=64), NumberOfQuads=500)
quadrille.check(quads)
part = simple.OpenDataFile("bracket.step")
nodes = simple.QuadNodesOnCADGeometry(Input=simple.QuadRemesh(Input=part, NumberOfQuads=800))
print(nodes.GetDataInformation().GetNumberOfCells(), "quads on the exact shape of a STEP file")
print("ParaView lists the filters;", quads.GetDataInformation().GetNumberOfCells(), "quads on a sphere")
PY
inside "xvfb-run -a pvpython lists.py"
inside "xvfb-run -a pvbatch lists.py"
cat >"$root/root/window.py" <<'PY'
import os
from paraview import simple
with open("window", "w") as file:
    file.write(str("QuadRemesh" in dir(simple)))
os._exit(0)
PY
inside "timeout 120 xvfb-run -a paraview --dr --script=window.py >/dev/null 2>&1; cat window; echo"
[[ $(<"$root/root/window") == True ]] || { echo "check-packages: ParaView's window has no Quad Remesh" >&2; exit 1; }
use_commands()
{
  inside "quadrille --version"
  inside "quadrille part.ply quads.vtp --quads 2000 --quiet && ls -s quads.vtp"
  inside "quadrille bracket.step bracket.inp --quads 800 --quiet && grep -i elset=bore bracket.inp"
  inside 'python3 -c "import quadrille; print(quadrille.remesh(quadrille.read(\"part.ply\"), quads=500))" | grep Cells'
  inside "quadrille-evaluate --help | head -1"
}
use_commands
nothing_left quadrille paraview-quadrille "'libquadrille*'"

echo "== without ParaView"
make_system plain
# What needs adduser brings it along, and autoremove leaves it on Debian 13.
quietly apt-get install -y --no-install-recommends g++ cmake make adduser
files >"$work/before"
quietly apt-get install -y --no-install-recommends ./quadrille_*.deb ./libquadrille*.deb
use_commands
inside "cmake -S /usr/share/doc/libquadrille-dev/examples/library -B build && cmake --build build"
inside "build/sphere-quads sphere.obj 500 2>/dev/null"
nothing_left quadrille "'libquadrille*'"
echo "check-packages: fine"
