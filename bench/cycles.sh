#!/usr/bin/env bash
# isoparm beside Blender's Cycles on the teapot, from the start of the process to the PNG, in turn: bench/cycles.sh [PROGRAM] [REPETITIONS]
# Needs blender (Debian); without it, it says so and ends. 1024 x 768 pixels, 64 samples, on the processor: the same triangles and camera, a light
# with soft shadows, and a sky that what is near hides (ambient occlusion), without further bounces. Cycles neither denoises nor stops
# early. Both take 64 samples of every pixel. Prints medians: wall seconds, processor seconds, MiB; and what Cycles itself took without Blender's start and reading.
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
program=$(realpath "${1:-$here/../build/release/isoparm}")
repetitions=${2:-3}
if ! command -v blender >/dev/null; then
    echo "cycles.sh: skipped, as there is no blender (Debian: apt-get install --no-install-recommends blender)"
    exit 0
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# The surface alone, without the lines on it, which the other does not draw, and its camera.
sed -e 's/"boundary": true, "radius": 0.012, "isolines": {[^}]*}/"boundary": false/' -e 's/"eye": \[[^]]*\]/"eye": [4.93, -8.8, 4.91]/' -e 's/, "fit": true//' "$here"/../scenes/teapot.json >"$folder"/teapot.json
cp "$here"/../scenes/teapot.bv "$folder"
cd "$folder"
"$program" tessellate teapot.json -o teapot.obj --quiet

cat >teapot.py <<'PY'
import bpy, math, mathutils, time
points, faces = [], []
for line in open("teapot.obj"):
    w = line.split()
    if w and w[0] == "v": points.append(tuple(map(float, w[1:4])))
    if w and w[0] == "f": faces.append(tuple(int(x.split("/")[0]) - 1 for x in w[1:]))
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
mesh = bpy.data.meshes.new("teapot")
mesh.from_pydata(points, [], faces)
mesh.polygons.foreach_set("use_smooth", [True] * len(faces))
matter = bpy.data.materials.new("matter")
matter.use_nodes = True
matter.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.7, 0.58, 0.39, 1)
mesh.materials.append(matter)
scene.collection.objects.link(bpy.data.objects.new("teapot", mesh))

def looking(name, data, eye, target):
    thing = bpy.data.objects.new(name, data)
    thing.location = eye
    thing.rotation_euler = (mathutils.Vector(target) - mathutils.Vector(eye)).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(thing)
    return thing

camera = bpy.data.cameras.new("camera")
camera.angle = math.radians(36.8)
scene.camera = looking("camera", camera, (4.93, -8.8, 4.91), (0.2, 0, 1.5))
key = bpy.data.lights.new("key", "SUN")
key.energy, key.angle = 2, math.radians(15)
looking("key", key, (-20, -30, 40), (0, 0, 0))
scene.world = bpy.data.worlds.new("sky")
scene.world.use_nodes = True
scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.4, 0.4, 0.4, 1)

scene.render.engine = "CYCLES"
cycles = scene.cycles
cycles.device, cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = "CPU", 64, False, False
cycles.max_bounces = 0
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 1024, 768, 100
scene.render.film_transparent = True
scene.render.image_settings.file_format = "PNG"
scene.render.filepath = "cycles.png"
begin = time.time()
bpy.ops.render.render(write_still=True)
print("rendered-in", time.time() - begin)
PY

median() { sort -g | awk '{ x[NR] = $1 } END { print x[int((NR + 1) / 2)] }'; }
run() { /usr/bin/time -a -o "$1" -f '%e %U %S %M' "${@:2}" >>"$1.out" 2>&1; }
for ((i = 0; i < repetitions; ++i)); do
    run cycles.log blender --background --factory-startup --python-exit-code 1 --python teapot.py
    run isoparm.log "$program" render teapot.json -o isoparm.png --size 1024x768 --samples 64 --quiet
done
printf '%-10s %8s %10s %8s\n' program wall processor MiB
for name in cycles isoparm; do
    printf '%-10s %8s %10s %8s\n' "$name" "$(awk '{ print $1 }' $name.log | median)" "$(awk '{ print $2 + $3 }' $name.log | median)" "$(awk '{ print int($4 / 1024) }' $name.log | median)"
done
echo "Cycles without Blender's start: $(awk '/^rendered-in/ { print $2 }' cycles.log.out | median) s wall"
if [[ -n ${ISOPARM_KEEP:-} ]]; then cp cycles.png isoparm.png "$ISOPARM_KEEP"; fi
