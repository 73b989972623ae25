#!/usr/bin/env bash
# build.sh PRESET [TARGET...]: sets up, configures and builds one preset, from any folder.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
[ $# -ge 1 ] || { echo "usage: tools/build.sh PRESET [TARGET...]" >&2; exit 2; }
preset=$1
shift

fail() { echo "build: $*" >&2; exit 1; }

bash tools/setup.sh || exit

# One compiler per core, but none without some 1.5 GB of free memory: some headers need that.
jobs=$(nproc)
by_memory=$(awk '/^MemAvailable:/ {print int($2 / 1500000)}' /proc/meminfo)
[ "$by_memory" -ge "$jobs" ] || jobs=$((by_memory > 1 ? by_memory : 1))

echo "build: preset $preset in build/$preset, $jobs at a time"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
cmake --preset "$preset" >"$log" 2>&1 ||
    { cat "$log" >&2 && fail "configuring preset $preset failed (see above)"; }
cmake --build --preset "$preset" --parallel "$jobs" ${1:+--target "$@"} </dev/null ||
    fail "building preset $preset failed (see above)"
