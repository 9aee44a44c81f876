#!/usr/bin/env bash
# tests/long/valgrind.sh [PROGRAM]: the program's commands under valgrind's memcheck, on small scenes: reads of what was never set or no longer is there, and
# writes beyond. Half an hour on an idle core. Any finding counts, in libraries too. Leaks are the address sanitizer's.
# PROGRAM: another than build/release/isoparm. Valgrind 3.19 knows no AVX-512 and says so to programs: they take AVX2, as Embree does.
# The last line is "N passed, M failed".
set -euo pipefail
root=$(dirname -- "$(dirname -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")")")
program=$(readlink -f -- "${1:-$root/build/release/isoparm}")
if ! command -v valgrind >/dev/null; then echo "valgrind is missing: apt-get install valgrind" >&2; exit 69; fi
if [[ ! -x $program ]]; then echo "build the program first: ./isoparm --version" >&2; exit 69; fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
scenes=$root/scenes cages=$root/tests/data/cages

passed=0 failed=0
# try CODE ARGUMENTS...: ends with that exit code, and nothing is found.
try() {
    local expected=$1 code=0 start=$SECONDS
    shift
    valgrind -q --error-exitcode=99 --leak-check=no --log-file=log "$program" "$@" --quiet --threads 2 >out 2>err </dev/null || code=$?
    if ((code == expected)) && [[ ! -s log ]]; then
        passed=$((passed + 1))
        printf 'passed  %4d s  %s\n' $((SECONDS - start)) "$*"
    else
        failed=$((failed + 1))
        printf 'FAILED  %4d s  %s: exit code %d\n' $((SECONDS - start)) "$*" "$code"
        head -n 40 err log
    fi
}
cp "$scenes/coons.json" "$scenes/cone.json" "$scenes/side_vertex.json" .
printf '{"isoparm": 1, "surfaces": {"s": {"type": "nosuch"}}}\n' >bad.json
try 0 info coons.json
try 65 info bad.json
try 0 eval coons.json --surface S --at 0.25,0.5
try 0 check side_vertex.json
try 0 tessellate coons.json --tolerance 0.02 -o a.ply --certificate c.json --report r.json
try 0 tessellate coons.json --tolerance 0.02 -o a.glb
try 0 tessellate cone.json --tolerance 0.02rel --quality optimal -o a.obj
try 0 verify a.ply --against coons.json --max-triangles 2000 --gap 0.5
try 0 verify a.glb --against coons.json --max-triangles 2000 --gap 0.5
try 0 verify --certificate c.json --against coons.json a.ply
try 0 render coons.json --size 24x16 --samples 2 -o a.png
try 0 render coons.json --size 24x16 --samples 2 --aov all -o a.exr
try 0 render coons.json --size 24x16 --samples 1 --exact -o b.png
try 0 render coons.json --size 96x64 -o a.pdf
try 0 limit "$cages/semisharp.obj"
try 0 study coons.json --methods fast,uniform --tolerances 5e-2,3e-2 --size 64x48 -o study
try 0 diff a.exr a.exr --html d.html --junit d.xml
try 2 diff a.png b.png -fail 0 --json
echo "$passed passed, $failed failed"
((failed == 0))
