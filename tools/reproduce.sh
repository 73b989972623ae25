#!/usr/bin/env bash
# reproduce.sh [PAPER]... [--quick | --full] [--only SECTION]...: sets up, builds, runs what the three papers claim and writes results/papers.
# Papers: jensen1996, chuang1995, chen2011; without one, all. CAUSTICS_BENCH=PROGRAM takes a causticbench that is there.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
case " $* " in *" -h "* | *" --help "*) exec sed -n 's/^# //p' tools/reproduce.sh ;; esac

program=${CAUSTICS_BENCH:-build/release/bin/causticbench}
if [ -z "${CAUSTICS_BENCH:-}" ]; then
    # A wrong word ends it before a build that takes minutes.
    if [ -x /usr/bin/python3 ]; then /usr/bin/python3 tools/reproduce.py --check "$@" || exit; fi
    bash tools/build.sh release causticbench || exit
fi
exec /usr/bin/python3 tools/reproduce.py --program "$program" "$@"
