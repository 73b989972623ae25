#!/usr/bin/env bash
# cruel_scenes.sh bits|light FIRST COUNT [SECONDS [TABLE]]: random scenes by the seeds FIRST to FIRST + COUNT - 1 through
# tests/cruel, built with preset ci, or by the program that CAUSTICS_CRUEL_PROGRAM names. Each scene of `light` has a process
# of its own; of `bits` 25 share one, and are tried again one by one where one crashes, fails or takes more CPU seconds than
# SECONDS (600). Prints each failure, what was compared (with Python 3), and, last, how many scenes passed. TABLE keeps a
# line for each scene and method, and is added to where it is there. With CAUSTICS_CRUEL_SHRINK=1 a scene of `light`
# that fails is printed with everything left out that does not matter, which takes a hundred times as long.
# Exit codes: 0 all passed, 1 some did not, 2 bad usage.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
program=${CAUSTICS_CRUEL_PROGRAM:-build/ci/tests/test_cruel_scenes}

usage() { echo "usage: tools/reliability/cruel_scenes.sh bits|light FIRST COUNT [SECONDS [TABLE]]" >&2; exit 2; }
case "${1:-}" in
    bits) filter='CruelBits.*' batch=25 ;;
    light) filter='CruelLight.IsTheSameByEveryMethod' batch=1 ;;
    *) usage ;;
esac
[[ ${2:-} =~ ^[0-9]+$ && ${3:-} =~ ^[0-9]+$ && ${4:-600} =~ ^[0-9]+$ ]] || usage
[ -x "$program" ] || { echo "cruel_scenes: $program is not built" >&2; exit 2; }
end=$(($2 + $3)) seconds=${4:-600}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
table=${5:-$folder/table}
touch "$table"

# FIRST COUNT: what these scenes say; their lines join the table unless they are tried again.
try() {
    local passed=0
    rm -f "$folder/lines"
    (ulimit -t "$seconds" && CAUSTICS_CRUEL_TABLE=$folder/lines CAUSTICS_CRUEL_FIRST=$1 CAUSTICS_CRUEL_COUNT=$2 \
        exec timeout $((60 * seconds)) "$program" --gtest_filter="$filter" >"$folder/said" 2>&1) || passed=1
    if [ -e "$folder/lines" ] && { [ "$passed" -eq 0 ] || [ "$2" -eq 1 ]; }; then cat "$folder/lines" >>"$table"; fi
    return "$passed"
}

failed=0
for ((first = $2; first < end; first += batch)); do
    last=$((first + batch < end ? first + batch : end))
    [ "$batch" -eq 1 ] || ! try "$first" $((last - first)) || continue
    for ((seed = first; seed < last; ++seed)); do
        ! try "$seed" 1 || continue
        failed=$((failed + 1))
        printf 'seed %s failed:\n' "$seed"
        cat "$folder/said"
    done
done
python3 tools/reliability/cruel_table.py "$1" "$table"
echo "$(($3 - failed)) of $3 scenes passed"
[ "$failed" -eq 0 ]
