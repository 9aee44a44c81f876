#!/usr/bin/env bash
# tests/long/coverage.sh [GTEST-FILTER]: which lines of lib/ the suite runs, in a build of their own (build/coverage). Half an hour.
# Prints lines, lines that ran and the percentage of each file, the whole at the end; lines that never ran are in build/coverage/lines.txt.
# Exit code 1 below 90 %. Tests whose faults would hit the counting too (Faults) are left out.
set -euo pipefail
root=$(dirname -- "$(dirname -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")")")
# shellcheck source=../../cmake/setup.sh
source "$root/cmake/setup.sh"
readonly least=90

if ! has gcovr; then
    say "gcovr counts the lines: apt-get install gcovr"
    exit $EX_UNAVAILABLE
fi
if has ccache; then export CMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER:-ccache}; fi
with_lock build coverage all isoparm_tests
folder=$root/build/coverage
find "$folder" -name '*.gcda' -delete

# Each in its own process, what forks apart from what has threads; tests that fail are told, but count what they ran.
status=0 jobs=$(jobs_count) running=()
for ((k = 0; k < jobs; ++k)); do
    GTEST_TOTAL_SHARDS=$jobs GTEST_SHARD_INDEX=$k "$folder/isoparm_tests" --gtest_brief=1 --gtest_filter="${1:-*}:-Faults.*:AtomicFile.*" \
        </dev/null >"$folder/tests-$k.log" 2>&1 &
    running+=($!)
done
for id in "${running[@]}"; do wait "$id" || status=1; done
if [[ -z ${1:-} ]]; then "$folder/isoparm_tests" --gtest_brief=1 --gtest_filter='AtomicFile.*' </dev/null >"$folder/tests-fork.log" 2>&1 || status=1; fi
if ((status != 0)); then
    say "some tests failed; what they ran is counted. See $folder/tests-*.log:"
    grep -h '^\[  FAILED  \]' "$folder"/tests-*.log | sort -u >&2 || true
fi

# gcc's own table of lines a file: "name lines run percentage missing".
gcovr --root "$root" --filter "$root/lib/" --exclude-throw-branches --exclude-unreachable-branches --gcov-ignore-parse-errors \
    --txt "$folder/lines.txt" --json-summary "$folder/lines.json" "$folder/CMakeFiles/isoparm_lib.dir" >/dev/null
cut -c 1-80 "$folder/lines.txt"
gcovr --version >/dev/null
awk -v least=$least 'match($0, /"line_percent": [0-9.]+/) { percent = substr($0, RSTART + 16, RLENGTH - 16) } END { exit !(percent >= least) }' "$folder/lines.json" || {
    say "less than $least % of the lines of lib/ ran"
    exit 1
}
