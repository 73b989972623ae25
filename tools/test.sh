#!/usr/bin/env bash
# Sets up, builds the preset `ci` and runs all tests. Arguments are handed to ctest (-L unit, -R name).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bash tools/build.sh ci || exit
ctest --preset ci --parallel "$(nproc)" "$@" </dev/null
