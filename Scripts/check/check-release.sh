#!/bin/bash
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
#
# Makes the Debian packages and the wheel of a release in a clean minimal system of it, and checks both in others
# (Scripts/check/check-packages.sh, check-wheel.sh). By hand, as it downloads a gigabyte and takes half an hour; as
# root, with mmdebstrap.
#
#   Scripts/check/check-release.sh bookworm|trixie [COMMAND, build/bin/quadrille]
#
# It takes the files that git knows, as they are in this checkout. out/release-SUITE/ has then packages, wheel and logs.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
suite=${1:?"check-release: which release, bookworm or trixie?"}
command=$(realpath "${2:-$here/build/bin/quadrille}")
arguments=("$suite" "$command")
[[ -x $command ]] || { echo "check-release: $command is missing (Scripts/build/build.sh makes it)" >&2; exit 1; }
[[ $(id -u) -eq 0 ]] || { echo "check-release: has to be run as root" >&2; exit 1; }
command -v mmdebstrap >/dev/null || { echo "check-release: mmdebstrap is missing" >&2; exit 1; }
source "$here/Scripts/check/clean-debian.sh"

results=$here/out/release-$suite
rm -rf "$results"
mkdir -p "$results"
make_base "$suite"
make_root clean
mkdir -p "$root/root/quadrille"
(cd "$here" && git ls-files -z | tar -c --null -T - --ignore-failed-read) | tar -x -C "$root/root/quadrille"

timed() # NAME COMMAND: its log is kept, and how long it took is told
{
  local begin=$SECONDS
  if ! run_inside "cd quadrille && $2" >"$results/$1.log" 2>&1; then
    tail -40 "$results/$1.log" >&2
    echo "check-release: on $suite failed: $2 (all of it: $results/$1.log)" >&2
    return 1
  fi
  echo "$suite: $2: $((SECONDS - begin)) s"
}
checked() # NAME SCRIPT ARGUMENT...: in mounts of its own
{
  local name=$1 begin=$SECONDS
  shift
  if ! env -u CLEAN_DEBIAN_MOUNTS "$@" >"$results/$name.log" 2>&1; then
    tail -40 "$results/$name.log" >&2
    echo "check-release: on $suite failed: $* (all of it: $results/$name.log)" >&2
    return 1
  fi
  tail -2 "$results/$name.log"
  echo "$suite: $(basename "$1"): $((SECONDS - begin)) s"
}

timed install "Scripts/build/install-dependencies.sh --tests"
timed packages "Scripts/build/make-packages.sh"
timed alone "/usr/bin/python3 Testing/Repository/check_alone.py . c++ build-alone /usr/include/eigen3"
timed wheel "QUADRILLE_CORE_FROM=build-packages/paraview Scripts/build/make-wheel.sh"
cp -r "$root/root/quadrille/out/packages" "$root/root/quadrille/out/wheels" "$results/"
status=0
checked check-packages "$here/Scripts/check/check-packages.sh" "$results/packages" "$suite" || status=1
checked check-wheel "$here/Scripts/check/check-wheel.sh" "$results"/wheels/*.whl "$suite" "$command" || status=1
ls -l "$results"/packages/*.deb "$results"/wheels/*.whl
exit $status
