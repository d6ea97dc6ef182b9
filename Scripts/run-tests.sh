#!/bin/bash
# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs what is missing, builds, runs all tests. Ends with CTest's summary; the exit code is CTest's.
# Arguments go to ctest, for example -L core or -R Extraction.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

Scripts/install-dependencies.sh
Scripts/build.sh -DQUADRILLE_BUILD_TESTS=ON
exec ctest --preset release --parallel "$(nproc)" "$@"
