#!/usr/bin/env bash
# reproduce.sh [PAPER]... [--quick | --full | --smoke] [--only SECTION]... [-o DIR | --keep]: sets up, builds, runs what the three
# papers claim and writes a page for each into DIR (out/papers).
# Papers: jensen1996, chuang1995, chen2011; without one, all. --list prints their sections and builds nothing.
# --smoke: one section of one scene, less than five minutes on two cores, into out/papers-smoke.
# --keep: into results/papers, the pages that git keeps. CAUSTICS_BENCH=PROGRAM takes a causticbench that is there.
set -euo pipefail
export CAUSTICS_CALLED_FROM=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."
case " $* " in *" -h "* | *" --help "*) exec sed -n 's/^# //p' tools/reproduce.sh ;; esac

[ -x /usr/bin/python3 ] || bash tools/setup.sh || exit
case " $* " in *" --list "* | *" --check "* | *" --pages "* | *" --compare "*) exec /usr/bin/python3 tools/reproduce.py "$@" ;; esac
program=${CAUSTICS_BENCH:-build/release/bin/causticbench}
if [ -z "${CAUSTICS_BENCH:-}" ]; then
    # A wrong word ends it before a build that takes minutes.
    /usr/bin/python3 tools/reproduce.py --check "$@" || exit
    bash tools/build.sh release causticbench || exit
fi
exec /usr/bin/python3 tools/reproduce.py --program "$program" "$@"
