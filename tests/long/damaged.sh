#!/usr/bin/env bash
# tests/long/damaged.sh [N]: the program on N (100) damaged files of each kind and command, 19 pairs of them, and 4 N cut off, at each byte of small files. Minutes.
# Prints the largest time and memory of each; fails on a signal, more than 2 s of processor time or more than 1 GiB.
set -euo pipefail
root=$(dirname -- "$(dirname -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")")")
tests=$root/build/release/isoparm_tests
if [[ ! -x $tests ]]; then echo "build the tests first: tests/run" >&2; exit 69; fi
ISOPARM_DAMAGED=${1:-100} exec "$tests" --gtest_brief=1 --gtest_filter='Files/Damaged.*'
