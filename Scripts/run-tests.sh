#!/bin/bash
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs what is missing, builds, runs all tests. Ends with CTest's summary, before which stand the slowest tests and
# what is left out as this machine has not what only those tests need; the exit code is CTest's.
# Arguments go to ctest: -L quick for what a change is tried with, in two minutes on two cores, or -R Extraction, say.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

Scripts/build/install-dependencies.sh --tests
begin=$SECONDS
Scripts/build/build.sh -DQUADRILLE_BUILD_TESTS=ON
mkdir -p build/Testing
echo $((SECONDS - begin)) >build/Testing/build-seconds.txt
if [[ -s build/Testing/left-out.txt ]]; then
  cat build/Testing/left-out.txt
fi
times=$PWD/build/Testing/times.xml
rm -f "$times"
# One more than there are processors, as tests of the window wait more than they work.
ctest --preset release --parallel "$(($(nproc) + 1))" --output-junit "$times" "$@" |
  Scripts/check/test_times.py "$times" build/Testing/build-seconds.txt
