#!/usr/bin/env bash
# The scene in the README is a scene: it loads, and its surface is what the README says.
set -euo pipefail
scene="$ISOPARM_BUILD_DIR/readme_scene.json"
awk '/^```jsonc/ { on = 1; next } /^```/ { on = 0 } on' "$ISOPARM_SOURCE_DIR/README.md" > "$scene"
"$ISOPARM_PROGRAM" eval "$scene" --at 0,0 --at 1,1 --json | grep -q '"S": *\[3, *3, *0.4\]'
"$ISOPARM_PROGRAM" tessellate "$scene" -o "$ISOPARM_BUILD_DIR/readme_scene.ply" --tolerance 1e-3rel --quiet
echo "the README's scene loads and tessellates"
