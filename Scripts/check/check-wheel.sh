#!/bin/bash
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs a wheel of Scripts/build/make-wheel.sh in a clean minimal Debian that has Python, pip and NumPy alone, and
# makes quads of Data/part.ply within 60 s from `pip install` on; they have to be those of the command, byte for byte.
# Then the tests of Testing/Native: a session with ten edits, 20 nonsense inputs, progress, stops. By hand, as root,
# with mmdebstrap.
#   Scripts/check/check-wheel.sh WHEEL [bookworm|trixie, by default that of the wheel's Python]
#                                [COMMAND, build/bin/quadrille]
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
wheel=$(realpath "${1:?"check-wheel: which wheel?"}")
case $(basename "$wheel") in *-cp311-*) suite=bookworm ;; *) suite=trixie ;; esac
suite=${2:-$suite}
command=${3:-$here/build/bin/quadrille}
[[ $(id -u) -eq 0 ]] || { echo "check-wheel: has to be run as root" >&2; exit 1; }
command -v mmdebstrap >/dev/null || { echo "check-wheel: mmdebstrap is missing" >&2; exit 1; }
arguments=("$wheel" "$suite" "$command")
source "$here/Scripts/check/clean-debian.sh"
make_base "$suite" python3,python3-pip,python3-numpy
make_root clean
cp -r "$wheel" "$here/Data/part.ply" "$here/Testing/Native/test_native.py" "$root/root/"
mkdir "$root/root/Data"
mv "$root/root/part.ply" "$root/root/Data/"
"$command" "$here/Data/part.ply" "$root/root/theirs.obj" --quads 2000 --quiet

echo "== $(basename "$wheel"), $(stat -c %s "$wheel") bytes, in a clean $suite"
begin=$(date +%s.%N)
inside "pip install --root-user-action=ignore --quiet --break-system-packages --no-index $(basename "$wheel")"
inside "python3 -c 'import quadrille
quadrille.write(quadrille.remesh(quadrille.read(\"Data/part.ply\"), quads=2000), \"ours.obj\")'"
seconds=$(echo "$(date +%s.%N) $begin" | awk '{ printf "%.1f", $1 - $2 }')
echo "from pip install to quads: $seconds s"
awk -v s="$seconds" 'BEGIN { exit !(s <= 60) }' || { echo "check-wheel: more than 60 s" >&2; exit 1; }
cmp "$root/root/ours.obj" "$root/root/theirs.obj" ||
  { echo "check-wheel: the quads are not those of the command" >&2; exit 1; }
echo "the same bytes as those of the command"
inside "python3 test_native.py Data 2>&1 | tail -4"
inside "pip check && pip uninstall --root-user-action=ignore --quiet --yes --break-system-packages quadrille-mesh"
echo "check-wheel: fine"
