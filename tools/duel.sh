#!/usr/bin/env bash
# duel.sh [--quick | --smoke] [--only SCENE]... [-o DIR | --keep]: sets up, builds, runs the duel of the methods and writes its
# pages into DIR (out/duel).
# --quick: two scenes, at most 15 minutes on two quiet cores, into out/duel-quick. --list prints the scenes and builds nothing.
# --smoke: one scene, less than five minutes on two cores, into out/duel-smoke.
# --keep: into results/duel, the pages that git keeps. CAUSTICS_BENCH=PROGRAM takes a causticbench that is there.
set -euo pipefail
export CAUSTICS_CALLED_FROM=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."
case " $* " in *" -h "* | *" --help "*) exec sed -n 's/^# //p' tools/duel.sh ;; esac

[ -x /usr/bin/python3 ] || bash tools/setup.sh || exit
case " $* " in *" --list "* | *" --check "* | *" --page "*) exec /usr/bin/python3 tools/measure_duel.py "$@" ;; esac
program=${CAUSTICS_BENCH:-build/release/bin/causticbench}
if [ -z "${CAUSTICS_BENCH:-}" ]; then
    # A wrong word ends it before a build that takes minutes.
    /usr/bin/python3 tools/measure_duel.py --check "$@" || exit
    bash tools/build.sh release causticbench || exit
fi
exec /usr/bin/python3 tools/measure_duel.py --program "$program" "$@"
