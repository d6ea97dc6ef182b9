#!/bin/bash
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs the packages of Scripts/make-packages.sh in clean minimal Debian 12, once beside ParaView and once without,
# uses what they bring, and purges them: nothing may be left. By hand, as it downloads some hundred megabytes; as root,
# with mmdebstrap. Prints each command that runs in there (Documentation/Installation.md has them) and what it says.
#   Scripts/check-packages.sh [FOLDER with the packages, default out/packages]
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
packages=$(cd "${1:-$here/out/packages}" && pwd)
[[ $(id -u) -eq 0 ]] || { echo "check-packages: has to be run as root" >&2; exit 1; }
command -v mmdebstrap >/dev/null || { echo "check-packages: mmdebstrap is missing" >&2; exit 1; }
# Mounts of its own, which end with the script.
[[ ${CHECK_PACKAGES_MOUNTS:-} ]] || CHECK_PACKAGES_MOUNTS=1 exec unshare --mount --fork "$0" "$packages"

work=$(mktemp -d)
trap 'umount -R -l -q "$work"/*/proc "$work"/*/dev "$work"/*/sys || true; rm -rf --one-file-system "$work"' EXIT
# The sources of this machine, which has to be Debian 12.
sources=()
for file in /etc/apt/sources.list /etc/apt/sources.list.d/debian.sources; do
  [[ -f $file ]] && sources+=("$file")
done
mmdebstrap --quiet --variant=minbase --include=ca-certificates bookworm "$work/base.tar" "${sources[@]}"

make_root() # NAME: a clean system, which `inside` uses from here on
{
  root=$work/$1
  mkdir "$root"
  tar -x -f "$work/base.tar" -C "$root"
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  mount -t proc proc "$root/proc"
  mount --rbind /dev "$root/dev"
  mount --rbind /sys "$root/sys"
  cp "$packages"/*.deb "$root/root/"
  cp "$here/Data/part.ply" "$root/root/"
  echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/fast" # it is thrown away: no need to wait for the disk
  quietly apt-get update
}
run_inside() { chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
  DEBIAN_FRONTEND=noninteractive bash -c "cd /root && $1"; }
inside() { echo "# $1"; run_inside "$1"; }
quietly() { echo "# $*"; run_inside "$*" >"$work/log" 2>&1 || { tail -40 "$work/log" >&2; return 1; }; }
# All that is there but caches, logs and the folders of this script; what dpkg knows of packages is in it. Some packages
# of Debian that come along add a system group and leave the copy of the list that was before.
files() { run_inside 'find / -xdev \( -path /proc -o -path /dev -o -path /sys -o -path /run -o -path /tmp -o \
  -path /root -o -path /var/cache -o -path /var/log -o -path /var/lib/apt -o -path "/etc/*shadow-" -o \
  -path "/etc/group-" \) -prune -o -print | sort'; }
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
make_root paraview
quietly apt-get install -y --no-install-recommends paraview python3-paraview xvfb xauth libgl1-mesa-dri
files >"$work/before"
quietly apt-get install -y --no-install-recommends ./paraview-quadrille_*.deb ./quadrille_*.deb ./libquadrille-dev_*.deb
cat >"$root/root/lists.py" <<'PY'
import sys
from paraview import simple
import quadrille
missing = {"QuadRemesh", "IntegerGridMap", "QuadExtraction", "QuadrillePLYReader", "QuadStroke"} - set(dir(simple))
if missing:
    sys.exit(f"not listed: {missing}")
quads = simple.QuadRemesh(Input=simple.Sphere(ThetaResolution=64, PhiResolution=64), NumberOfQuads=500)
quadrille.check(quads)
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
  inside 'python3 -c "import quadrille; print(quadrille.remesh(quadrille.read(\"part.ply\"), quads=500))" | grep Cells'
  inside "quadrille-evaluate --help | head -1"
}
use_commands
nothing_left quadrille paraview-quadrille libquadrille-dev

echo "== without ParaView"
make_root plain
quietly apt-get install -y --no-install-recommends g++ cmake make
files >"$work/before"
quietly apt-get install -y --no-install-recommends ./quadrille_*.deb ./libquadrille-dev_*.deb
use_commands
inside "cmake -S /usr/share/doc/libquadrille-dev/examples/library -B build && cmake --build build"
inside "build/sphere-quads sphere.obj 500 2>/dev/null"
nothing_left quadrille libquadrille-dev
echo "check-packages: fine"
