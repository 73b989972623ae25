#!/usr/bin/env bash
# fuzz.sh MINUTES [TARGET...]        fuzzes each target (all of tests/fuzz without names) for its share of the time
# fuzz.sh --replay [SECONDS] [TARGET...]   runs every kept input once, then fuzzes each target for SECONDS (20)
# fuzz.sh --coverage [TARGET...]     lines of each reader that the inputs of all targets reach
#
# Builds preset `fuzz` first (clang++, its libFuzzer).
# Inputs come from tests/fuzz/corpus, from tests/fuzz/seeds.py and from build/fuzz/corpus, where new ones are kept;
# what fails is kept in build/fuzz/found. Ends with a table, and with exit code 1 where anything was found.
# FUZZ_JOBS: targets at a time (default 1).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

mode=fuzz
seconds=
case "${1:-}" in
    --replay) mode=replay; shift; seconds=20
        if [[ "${1:-}" =~ ^[0-9]+$ ]]; then seconds=$1; shift; fi ;;
    --coverage) mode=coverage; shift ;;
    '' | -* | *[!0-9]*) sed -n '2,4s/^# //p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
    *) minutes=$1; shift ;;
esac
known=()
for file in tests/fuzz/*_fuzzer.cpp; do known+=("$(basename "$file" _fuzzer.cpp)"); done
targets=("$@")
[ ${#targets[@]} != 0 ] || targets=("${known[@]}")
for target in "${targets[@]}"; do
    [ -f "tests/fuzz/${target}_fuzzer.cpp" ] || { echo "fuzz: no target $target (known: ${known[*]})" >&2; exit 2; }
done
[ "$mode" != fuzz ] || seconds=$((minutes * 60 / ${#targets[@]}))

bash tools/setup.sh clang llvm libclang-rt-dev
for target in "${targets[@]}"; do bash tools/build.sh fuzz "fuzz_$target"; done
place=$PWD/build/fuzz
work=$(mktemp -d "${TMPDIR:-/dev/shm}/causticbench_fuzz.XXXXXX")
trap 'rm -rf "$work"' EXIT
python3 tests/fuzz/seeds.py "$work/seeds"

export ASAN_OPTIONS=quarantine_size_mb=16:malloc_context_size=4 UBSAN_OPTIONS=print_stacktrace=1

# Limits of an input: 10 s, and 20 times its size plus 200 MB, beside what the program holds before.
limits=(-timeout=10 -rss_limit_mb=1024 -malloc_limit_mb=512 -max_len=20000)
# Its schedule by rare lines would take half of the time.
limits+=(-entropic=0)
# OpenEXR asks for memory that it never touches, and libpng leaves its callers by longjmp, with what they hold.
limits_of_pictures=(-malloc_limit_mb=100000 -detect_leaks=0)
# What is asked of a folder forks, which libFuzzer's thread that looks at the memory forbids; single allocations are limited.
limits_of_folders=(-rss_limit_mb=0)

# run TARGET ARGUMENTS...: in a folder of its own; its log is $work/TARGET.log.
run() {
    local target=$1 code=0 more=()
    shift
    [ "$target" != picture ] || more=("${limits_of_pictures[@]}")
    [ "$target" != folder ] || more=("${limits_of_folders[@]}")
    mkdir -p "$place/corpus/$target" "$place/found/$target" "$work/tmp/$target"
    (cd "$work/tmp/$target" && TMPDIR=$work/tmp/$target LLVM_PROFILE_FILE=$work/$target.profraw \
        "$place/fuzzers/fuzz_$target" "${limits[@]}" "${more[@]}" -artifact_prefix="$place/found/$target/" "$@" \
        >"$work/$target.log" 2>&1) || code=$?
    return "$code"
}
inputs() {
    local folder
    for folder in "$place/corpus/$1" "$work/seeds/$1" "$PWD/tests/fuzz/corpus/$1"; do
        [ ! -d "$folder" ] || echo "$folder"
    done
}
field() { sed -n "s/.*$2: *\([0-9]*\).*/\1/p" "$work/$1.log" | tail -n 1; }

# One target's time; a crash ends a process, and the next one goes on.
fuzz_target() {
    local target=$1 executions=0 crashes=0 end=$((SECONDS + seconds)) left folders processor
    mapfile -t folders < <(mkdir -p "$place/corpus/$target"; inputs "$target")
    while left=$((end - SECONDS)) && [ "$left" -gt 0 ]; do
        run "$target" -max_total_time="$left" -print_final_stats=1 -use_value_profile=0 "${folders[@]}" ||
            { crashes=$((crashes + 1)); cp "$work/$target.log" "$place/found/$target/log.$(date +%s)"; }
        executions=$((executions + $(field "$target" 'number_of_executed_units' || true) + 0))
        [ "$crashes" -lt 20 ] || break
    done
    times >"$work/$target.times"  # of this shell, and of what it waited for
    processor=$(awk 'NR == 2 {split($1 "m" $2, t, /[ms]+/); print int(60 * (t[1] + t[3]) + t[2] + t[4])}' "$work/$target.times")
    echo "$target $executions $processor $(ls "$place/corpus/$target" | wc -l) $crashes" >"$work/$target.row"
    cat "$work/$target.row" >>"$place/log"
}
replay_target() {
    local target=$1 folders
    mapfile -t folders < <(mkdir -p "$place/corpus/$target"; inputs "$target")
    if ! run "$target" -runs=0 "${folders[@]}"; then
        grep -m 3 -E 'FOUND|ERROR|SUMMARY|runtime error' "$work/$target.log" || tail -n 5 "$work/$target.log"
        echo "$target 0 0 0 1" >"$work/$target.row"
        return
    fi
    [ "$mode" = coverage ] || fuzz_target "$target"
}

for target in "${targets[@]}"; do
    while [ "$(jobs -rp | wc -l)" -ge "${FUZZ_JOBS:-1}" ]; do wait -n; done
    if [ "$mode" = fuzz ]; then fuzz_target "$target" & else replay_target "$target" & fi
done
wait

if [ "$mode" = coverage ]; then
    llvm-profdata merge -sparse "$work"/*.profraw -o "$work/all.profdata"
    python3 tests/fuzz/coverage.py "$work/all.profdata" "${targets[@]/#/$place/fuzzers/fuzz_}"
    exit
fi
found=0
printf '%-14s %12s %8s %8s %8s\n' target executions cpu_s inputs found
for target in "${targets[@]}"; do
    read -r name executions time kept crashes <"$work/$target.row"
    printf '%-14s %12s %8s %8s %8s\n' "$name" "$executions" "$time" "$kept" "$crashes"
    found=$((found + crashes))
done
[ "$found" = 0 ] || { echo "fuzz: what was found is in build/fuzz/found"; exit 1; }
