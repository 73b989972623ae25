#!/usr/bin/env bash
# quickstart.sh [--references rebuild] [--force] [--jobs N] [--threads N]: from a fresh Debian to both methods side
# by side in results/quickstart/report.html. It sets up, builds, sweeps ring, ball and pool by every method, and
# makes the page. Arguments are handed to the sweep (causticbench sweep --help).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
case " $* " in *" -h "* | *" --help "*) exec sed -n 's/^# //p' tools/quickstart.sh ;; esac
bench=build/release/bin/causticbench
results=results/quickstart

fail() { echo "quickstart: $*" >&2; exit 1; }

check_words() {  # before a build that takes minutes
    while [ $# -gt 0 ]; do
        case $1 in
            --force | --references=?* | --jobs=?* | --threads=?*) shift ;;
            --references | --jobs | --threads)
                [ $# -ge 2 ] || { echo "quickstart: $1 needs a value" >&2; exit 2; }
                shift 2
                ;;
            *)
                echo "quickstart: $1: no such option (known: --references, --force, --jobs, --threads)" >&2
                exit 2
                ;;
        esac
    done
}
check_words "$@"

bash tools/build.sh release causticbench || exit

status=0
"$bench" sweep experiments/sweeps/quickstart_*.json -o "$results" "$@" || status=$?
if [ "$status" != 0 ]; then
    echo "quickstart: the sweep ended with exit code $status (see above)" >&2
    exit "$status"
fi
"$bench" report "$results" -o "$results/report.html" --megabytes 40 --tables "$results/tables" ||
    fail "the page of $results failed (see above)"

echo "quickstart: done"
echo "  page      $results/report.html: one file, in any browser, without a network"
echo "  tables    $results/tables: CSV and LaTeX; every trial in $results/records.csv"
echo "  pictures  $results/trials/*/image.exr; reference | picture | error in $results/report/figures"
