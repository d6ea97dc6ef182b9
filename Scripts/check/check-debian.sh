#!/bin/bash
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
#
# Both commands of the README in a clean minimal Debian of a release, made for it and thrown away: the demo, timed, and
# the tests. Then the runs of Scripts/check/gate.py, whose sums of quads and maps are compared with those of other
# releases. By hand, as it downloads a gigabyte and takes most of an hour; as root, with mmdebstrap.
#
#   Scripts/check/check-debian.sh bookworm|trixie [--demo-only] [--shared FOLDER]
#
# It takes the files that git knows, as they are in this checkout, and, where there is one, the folder shared/data
# beside it (or FOLDER). out/debian-SUITE/ has then what the demo made, the logs and the sums.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
usage() { echo "usage: check-debian.sh SUITE [--demo-only] [--shared FOLDER]" >&2; exit 2; }
[[ $# -ge 1 && $1 != -* ]] || usage
arguments=("$@")
suite=$1
shift
demo_only= shared=$here/../shared/data
while [[ $# -gt 0 ]]; do
  case $1 in
    --demo-only) demo_only=yes ;;
    --shared) [[ $# -ge 2 ]] || usage; shared=$2; shift ;;
    *) usage ;;
  esac
  shift
done
[[ $(id -u) -eq 0 ]] || { echo "check-debian: has to be run as root" >&2; exit 1; }
command -v mmdebstrap >/dev/null || { echo "check-debian: mmdebstrap is missing" >&2; exit 1; }
source "$here/Scripts/check/clean-debian.sh"

results=$here/out/debian-$suite
mkdir -p "$results"
make_base "$suite"
make_root clean
mkdir -p "$root/root/quadrille"
(cd "$here" && git ls-files -z | tar -c --null -T - --ignore-failed-read) | tar -x -C "$root/root/quadrille"
if [[ -d $shared ]]; then
  mkdir -p "$root/root/shared/data"
  mount --bind -o ro "$shared" "$root/root/shared/data"
fi

timed() # NAME COMMAND: its log is kept, and how long it took is told
{
  local begin=$SECONDS
  if ! run_inside "cd quadrille && $2" >"$results/$1.log" 2>&1; then
    tail -40 "$results/$1.log" >&2
    echo "check-debian: on $suite failed: $2 (all of it: $results/$1.log)" >&2
    return 1
  fi
  echo "$suite: $2: $((SECONDS - begin)) s"
}
keep() { cp -r "$root/root/quadrille/out/." "$results/"; }

timed demo Scripts/run-demo.sh
keep
[[ -z $demo_only ]] || exit 0
status=0
timed tests Scripts/run-tests.sh || status=1
grep -E '^[0-9]+% tests passed|^Total Test time|^-- Left out' "$results/tests.log" || true
timed gate "Scripts/check/gate.py record out/gate.json --python build" || status=1
keep
for other in "$here"/out/debian-*/gate.json; do
  if [[ $other != "$results/gate.json" && -f $other ]]; then
    echo "quads and maps of $(basename "$(dirname "$other")") and debian-$suite:"
    "$here/Scripts/check/gate.py" compare --common "$other" "$results/gate.json" | tee "$results/compared.log" ||
      status=1
  fi
done
exit $status
