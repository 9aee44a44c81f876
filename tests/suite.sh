# tests/suite.sh -- runs the suite of one build and counts. Sourced by ./tests/run and .ci/run, after cmake/setup.sh.
# shellcheck shell=bash

# run_suite PRESET [CTEST-ARGUMENTS...]: ends with a line "N passed, M failed"; fails if any did or there were none.
# ISOPARM_TEST_RUNNER: a command that ctest is run by.
run_suite() {
    # shellcheck disable=SC2154  # $root is the caller's
    local folder=$root/build/$1 log=$root/build/$1/ctest.log status=0 jobs
    shift
    jobs=$(nproc 2>/dev/null || getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2)
    # shellcheck disable=SC2086  # words are wanted
    (cd "$folder" && ${ISOPARM_TEST_RUNNER:-} ctest --output-on-failure --no-tests=error --parallel "$jobs" "$@") </dev/null 2>&1 | tee "$log" || status=$?
    awk '/tests passed, [0-9]+ tests? failed out of [0-9]+/ { for (i = 1; i < NF; ++i) { if ($i == "passed,") failed = $(i + 1); if ($i == "of") total = $(i + 1) } }
         /^ *[0-9]+\/[0-9]+ Test .*\*\*\*Skipped/ { ++skipped }
         END { printf "%d passed, %d failed%s\n", total - failed - skipped, failed, skipped ? ", " skipped " skipped" : "" }' "$log"
    return $status
}
