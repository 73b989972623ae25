#!/usr/bin/env bash
# Sets up, builds the preset `ci` and runs all tests. Arguments are handed to ctest (-L unit, -R name).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bash tools/build.sh ci || exit
# Tests make and sync thousands of small files, and run a few: in memory, where there is room for them.
shm_serves() {
    [ -w /dev/shm ] && [ "$(df --output=avail /dev/shm | tail -n 1)" -gt 2000000 ] &&
        ! findmnt --noheadings --output OPTIONS /dev/shm | grep -qw noexec
}
if [ -z "${TMPDIR:-}" ] && shm_serves; then export TMPDIR=/dev/shm; fi
ctest --preset ci --parallel "$(nproc)" "$@" </dev/null
