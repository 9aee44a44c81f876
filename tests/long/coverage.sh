#!/usr/bin/env bash
# tests/long/coverage.sh [GTEST-FILTER]: which lines of lib/ the suite runs, in a build of their own (build/coverage). Half an hour.
# Prints lines, lines that ran and the percentage of each file, the whole at the end; lines that never ran are in build/coverage/lines.txt.
# Exit code 1 below 90 %. Tests that make calls fail (Faults) would hit the counting too, and are left out.
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

# A process for each suite of tests, so that one that fails or hangs (ISOPARM_COVERAGE_SECONDS, 1200) keeps its lines only from the whole. Counts are written when a process ends.
one_suite() {
    timeout "$3" "$1" --gtest_brief=1 --gtest_filter="$2" </dev/null >"$4/tests-${2//[^A-Za-z0-9_]/_}.log" 2>&1 || echo "$2"
}
export -f one_suite
failed=$("$folder/isoparm_tests" --gtest_list_tests --gtest_filter="${1:-*}:-Faults.*" | sed -n 's/^\([^ ].*\.\).*/\1*/p' |
    xargs -d '\n' -P "$(jobs_count)" -I {} bash -c 'one_suite "$@"' _ "$folder/isoparm_tests" {} "${ISOPARM_COVERAGE_SECONDS:-1200}" "$folder")
if [[ -n $failed ]]; then say "these failed, or took too long, see $folder/tests-*.log: ${failed//$'\n'/ }"; fi

gcovr --root "$root" --filter "$root/lib/" --exclude-throw-branches --exclude-unreachable-branches --gcov-ignore-parse-errors \
    --txt "$folder/lines.txt" "$folder/CMakeFiles/isoparm_lib.dir"
cut -c 1-79 "$folder/lines.txt"
awk -v least=$least '/^TOTAL/ { percent = $4 + 0 } END { exit !(percent >= least) }' "$folder/lines.txt" || {
    say "less than $least % of the lines of lib/ ran"
    exit 1
}
