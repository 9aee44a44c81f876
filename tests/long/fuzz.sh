#!/usr/bin/env bash
# tests/long/fuzz.sh [SECONDS [TARGET...]]: every fuzz target, or those named, for SECONDS (3600) each on one core. First in a build without sanitizers, which
# does ten times as many executions; then what it kept is run once more with the address and undefined-behaviour sanitizers.
# Corpora and logs stay in build/fuzz-corpus (ISOPARM_FUZZ_CORPUS), and a second run goes on from there. Several at a time: a target each.
# ISOPARM_FUZZ_RUNS: executions of each after which it ends, too. The last line is "N passed, M failed".
set -euo pipefail
root=$(dirname -- "$(dirname -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")")")
# shellcheck source=../../cmake/setup.sh
source "$root/cmake/setup.sh"
# shellcheck source=../fuzz/targets.sh
source "$root/tests/fuzz/targets.sh"

seconds=${1:-3600}
if [[ ! $seconds =~ ^[1-9][0-9]*$ ]]; then
    say "found \"$seconds\" seconds, expected a whole number above 0: tests/long/fuzz.sh [SECONDS [TARGET...]]"
    exit 64
fi
shift $(($# > 0 ? 1 : 0))
known=$(fuzz_targets)
if (($# == 0)); then
    # shellcheck disable=SC2086  # words are wanted
    set -- $known
fi
for name in "$@"; do
    if ! grep -qx -- "$name" <<<"$known"; then
        say "there is no target \"$name\" (have: ${known//$'\n'/, })"
        exit 64
    fi
done
if ! has clang++; then
    say "libFuzzer needs clang++: apt-get install clang"
    exit $EX_UNAVAILABLE
fi
folder=${ISOPARM_FUZZ_CORPUS:-$root/build/fuzz-corpus}
mkdir -p "$folder"
if has ccache; then export CMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER:-ccache}; fi
targets=("${@/#/fuzz_}")
with_lock build fuzz-fast "${targets[@]}"
with_lock build fuzz "${targets[@]}"
export ASAN_OPTIONS=detect_leaks=1:intercept_tls_get_addr=0 LSAN_OPTIONS=suppressions=$root/tests/lsan.supp:print_suppressions=0
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1

passed=0 failed=0
for name in "$@"; do
    log=$folder/$name.log status=0
    say "$name: $seconds s without sanitizers; $log"
    fuzz_target "$root/build/fuzz-fast" "$name" "$folder/$name" -max_total_time="$seconds" -runs="${ISOPARM_FUZZ_RUNS:--1}" >"$log" 2>&1 || status=$?
    say "$name: what was kept, with sanitizers"
    if ((status == 0)); then fuzz_target "$root/build/fuzz" "$name" "$folder/$name" -runs=0 >>"$log" 2>&1 || status=$?; fi
    awk -v name="$name" '/stat::number_of_executed_units/ { n[++k] = $2 } END { printf "%-14s %12d executions, %d of them kept and run with sanitizers\n", name, n[1], n[2] }' "$log"
    if ((status == 0)); then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        tail -n 20 "$log" >&2
    fi
done
echo "$passed passed, $failed failed"
((failed == 0))
