#!/usr/bin/env bash
# isoparm diff beside idiff on pairs of 3840 x 2160 pixels, in turn: bench/diff_speed.sh [PROGRAM] [REPETITIONS]
# Needs oiiotool and idiff (openimageio-tools). Prints medians: wall seconds, processor seconds, MiB of the largest process.
set -euo pipefail
program=$(realpath "${1:-$(dirname "$0")/../build/release/isoparm}")
repetitions=${2:-9}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

fill=fill:topleft=.1,.2,.3,1:topright=.9,.1,.3,1:bottomleft=.1,.9,.2,.5:bottomright=.8,.8,.9,.7
noise() { echo "noise:type=gaussian:mean=0:stddev=$1:seed=$2:mono=0"; }
oiiotool --pattern "$fill" 3840x2160 4 --pattern "$(noise .02 5)" 3840x2160 4 --add -d half --compression zip -o a.exr
oiiotool a.exr --pattern "$(noise .001 9)" 3840x2160 4 --add -d half --compression zip -o b.exr
cp a.exr same.exr  # idiff would decode one name once
oiiotool a.exr --ch R,G,B -d uint8 -o a.png
oiiotool b.exr --ch R,G,B -d uint8 -o b.png

median() { sort -g | awk '{ x[NR] = $1 } END { print x[int((NR + 1) / 2)] }'; }
run() { /usr/bin/time -a -o "$1" -f '%e %U %S %M' "${@:2}" >/dev/null 2>&1 || true; }
printf '%-16s %-14s %8s %10s %8s\n' pair program wall processor MiB
for pair in "a.exr b.exr" "a.exr same.exr" "a.png b.png"; do
    rm -f idiff.log diff.log
    for ((i = 0; i < repetitions; ++i)); do
        # shellcheck disable=SC2086
        { run idiff.log idiff $pair; run diff.log "$program" diff $pair; }
    done
    for name in idiff diff; do
        grep -v status $name.log >numbers
        printf '%-16s %-14s %8s %10s %8s\n' "$pair" "$name" "$(awk '{ print $1 }' numbers | median)" "$(awk '{ print $2 + $3 }' numbers | median)" "$(awk '{ print int($4 / 1024) }' numbers | median)"
    done
done
