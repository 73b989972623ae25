#!/usr/bin/env bash
# cruel_scenes.sh bits|light FIRST COUNT [SECONDS]: random scenes by the seeds FIRST to FIRST + COUNT - 1 through
# tests/cruel, built with preset ci. Each scene has a process of its own and so many seconds (default: 600), so that
# a crash or a hang is one failed seed. Prints each failure and, last, how many scenes passed.
# Exit codes: 0 all passed, 1 some did not, 2 bad usage.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
program=build/ci/tests/test_cruel_scenes

usage() { echo "usage: tools/reliability/cruel_scenes.sh bits|light FIRST COUNT [SECONDS]" >&2; exit 2; }
case "${1:-}" in
    bits) filter='CruelBits.*' ;;
    light) filter='CruelLight.IsTheSameByEveryMethod' ;;
    *) usage ;;
esac
[[ ${2:-} =~ ^[0-9]+$ && ${3:-} =~ ^[0-9]+$ ]] || usage
[ -x "$program" ] || { echo "cruel_scenes: $program is not built" >&2; exit 2; }

failed=0
for ((seed = $2; seed < $2 + $3; ++seed)); do
    if said=$(CAUSTICS_CRUEL_FIRST=$seed CAUSTICS_CRUEL_COUNT=1 timeout "${4:-600}" "$program" --gtest_filter="$filter" 2>&1); then
        continue
    fi
    failed=$((failed + 1))
    printf 'seed %s failed:\n%s\n' "$seed" "$said"
done
echo "$(($3 - failed)) of $3 scenes passed"
[ "$failed" -eq 0 ]
