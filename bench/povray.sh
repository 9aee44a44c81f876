#!/usr/bin/env bash
# isoparm beside POV-Ray on the teapot, from the start of the process to the PNG, in turn: bench/povray.sh [PROGRAM] [REPETITIONS]
# Needs povray (Debian). 1024 x 768 pixels, anti-aliased, shadows; the same patches, camera and one light. Prints medians: wall seconds,
# processor seconds, MiB.
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
program=$(realpath "${1:-$here/../build/release/isoparm}")
repetitions=${2:-5}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# The surface alone, without the lines on it, which the other does not draw, and its camera.
sed -e 's/"boundary": true, "radius": 0.012, "isolines": {[^}]*}/"boundary": false/' -e 's/"eye": \[[^]]*\]/"eye": [4.93, -8.8, 4.91]/' -e 's/, "fit": true//' "$here"/../scenes/teapot.json >"$folder"/teapot.json
cp "$here"/../scenes/teapot.bv "$folder"
cd "$folder"

# POV-Ray is left-handed: y and z change places.
{
    cat <<'POV'
#version 3.7;
global_settings { assumed_gamma 1 }
background { color rgb 1 }
camera { location <4.93, 4.91, -8.8> look_at <0.2, 1.5, 0> up y right x*image_width/image_height angle 36.8 }
light_source { <-20, 40, -30> color rgb 1 }
#declare Look = texture { pigment { color rgb <0.7, 0.58, 0.39> } finish { ambient 0.3 diffuse 0.7 specular 0.2 } }
POV
    # BV: a line "5" begins a patch, "3 3" its degrees, then 16 points.
    awk 'NF == 3 && $1 != "Group" { p[n++] = "<" $1 "," $3 "," $2 ">" }
         n == 16 { printf "bicubic_patch { type 1 flatness 0.001 u_steps 4 v_steps 4"; for (i = 0; i < 16; ++i) printf ",%s", p[i]; print " texture { Look } }"; n = 0 }' teapot.bv
} >teapot.pov

median() { sort -g | awk '{ x[NR] = $1 } END { print x[int((NR + 1) / 2)] }'; }
run() { /usr/bin/time -a -o "$1" -f '%e %U %S %M' "${@:2}" >/dev/null 2>&1; }
for ((i = 0; i < repetitions; ++i)); do
    run povray.log povray +Iteapot.pov +Opovray.png +W1024 +H768 +A0.3 -D
    run isoparm.log "$program" render teapot.json -o isoparm.png --size 1024x768 --samples 4 --quiet
done
printf '%-10s %8s %10s %8s\n' program wall processor MiB
for name in povray isoparm; do
    printf '%-10s %8s %10s %8s\n' "$name" "$(awk '{ print $1 }' $name.log | median)" "$(awk '{ print $2 + $3 }' $name.log | median)" "$(awk '{ print int($4 / 1024) }' $name.log | median)"
done
if [[ -n ${ISOPARM_KEEP:-} ]]; then cp povray.png isoparm.png "$ISOPARM_KEEP"; fi
