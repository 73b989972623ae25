#!/usr/bin/env bash
# duel.sh [--quick] [--only SCENE]...: sets up, builds, runs the duel of the methods and writes results/duel.
# --quick: two scenes, at most 15 minutes on two quiet cores. CAUSTICS_BENCH=PROGRAM takes a causticbench that is there.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
case " $* " in *" -h "* | *" --help "*) exec sed -n 's/^# //p' tools/duel.sh ;; esac

program=${CAUSTICS_BENCH:-build/release/bin/causticbench}
if [ -z "${CAUSTICS_BENCH:-}" ]; then
    # A wrong word ends it before a build that takes minutes.
    if [ -x /usr/bin/python3 ]; then /usr/bin/python3 tools/measure_duel.py --check "$@" || exit; fi
    bash tools/build.sh release causticbench || exit
fi
exec /usr/bin/python3 tools/measure_duel.py --program "$program" "$@"
