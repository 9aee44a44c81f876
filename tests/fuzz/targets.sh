# tests/fuzz/targets.sh -- how the targets are run. Sourced by .ci/run and tests/long/fuzz.sh, after cmake/setup.sh.
# shellcheck shell=bash disable=SC2154  # $root

# fuzz_targets: their names, one a line.
fuzz_targets() {
    local source
    for source in "$root"/tests/fuzz/*.cpp; do basename "$source" .cpp; done
}

# fuzz_target FOLDER NAME CORPUS OPTIONS...: runs FOLDER/fuzz_NAME on CORPUS, where new inputs are kept, and on the corpora of the clone.
# Entropic scheduling takes longer to keep its books than the targets take to run. What a target does not read need not be long: short inputs are what makes it quick.
fuzz_target() {
    local folder=$1 name=$2 corpus=$3 length=4096 more=()
    shift 3
    case $name in
    scene*) length=2500 more=("$root/tests/bad_scenes" "$root/scenes") ;;
    surface) length=200 ;;
    esac
    mkdir -p "$corpus" "$root/tests/fuzz/corpus"
    "$folder/fuzz_$name" -max_len="$length" -timeout=30 -entropic=0 -print_final_stats=1 -artifact_prefix="$folder/fuzz_$name-" "$@" \
        "$corpus" "$root/tests/fuzz/corpus" ${more[@]+"${more[@]}"}
}
