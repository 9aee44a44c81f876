#!/usr/bin/env bash
# Installs isoparm into a fresh folder, builds this small project with find_package(isoparm), and runs it and the
# installed program. Run by ctest.
set -euo pipefail
folder=$ISOPARM_BUILD_DIR/package_test
rm -rf "$folder"
cmake --install "$ISOPARM_BUILD_DIR" --prefix "$folder/prefix" >/dev/null

generator=()
if command -v ninja >/dev/null; then generator=(-G Ninja); fi
cmake -S "$ISOPARM_SOURCE_DIR/tests/package" -B "$folder/build" ${generator[@]+"${generator[@]}"} \
    -DCMAKE_PREFIX_PATH="$folder/prefix" -DCMAKE_BUILD_TYPE=Debug
cmake --build "$folder/build" --parallel 2
"$folder/build/uses_isoparm"

"$folder/prefix/bin/isoparm" --version
# Nothing of ours may be seen as <mesh.h>, and the installed program is on its own.
if grep -rn '#include "' "$folder/prefix/include"; then echo "an installed header includes with quotes"; exit 1; fi
if grep -rlF "$ISOPARM_SOURCE_DIR" "$folder/prefix/include" "$folder/prefix"/lib*/cmake "$folder/prefix"/lib/*/cmake 2>/dev/null; then
    echo "an installed file names the folder of the sources"
    exit 1
fi
rm -rf "$folder"
