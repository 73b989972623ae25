#!/usr/bin/env bash
# From a fresh Debian to a table, plots and pictures in results/quickstart: sets up, builds, sweeps the
# quick-start scenes and plots. Arguments are handed to the sweep (--references rebuild, --force).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
results=results/quickstart

fail() { echo "quickstart: $*" >&2; exit 1; }

bash tools/build.sh release causticbench || exit

sweeps=()
for scene in ring ring_area pool ball; do
    sweeps+=("experiments/sweeps/quickstart_$scene.json")
done
status=0
build/release/bin/causticbench sweep "${sweeps[@]}" -o "$results" "$@" || status=$?
if [ "$status" != 0 ]; then
    echo "quickstart: the sweep ended with exit code $status (see above)" >&2
    exit "$status"
fi
/usr/bin/python3 tools/plot_records.py "$results" || fail "plotting $results failed (see above)"

echo "quickstart: done"
echo "  table     $results/records.csv, medians and ranges in $results/report/summary.md"
echo "  plots     $results/report/plots/*.svg"
echo "  pictures  $results/report/figures/"
echo "  page      $results/report/index.html"
