# cmake/setup.sh -- what ./isoparm, ./tests/run and .ci/run share: packages, configure, build. Sourced by them, with
# $root the top of the clone. Works with bash 3.2 and a minimal Debian; everything it says goes to stderr.
# shellcheck shell=bash disable=SC2154  # $root

readonly EX_UNAVAILABLE=69  # something that must be installed is not
readonly EX_SOFTWARE=70     # the build failed

say() { printf 'isoparm: %s\n' "$*" >&2; }
has() { command -v "$1" >/dev/null 2>&1; }

# ---------------------------------------------------------------------------------------------------- packages

# table COLUMN NEED...: a column of packages.txt (2 Debian, 3 instead, 4 Fedora, 5 Arch, 6 Homebrew, 7 why).
table() {
    local column=$1
    shift
    awk -F '[[:space:]]*[|][[:space:]]*' -v column="$column" -v needs=" $* " \
        '!/^#/ && NF >= 7 && index(needs, " " $1 " ") { print $column }' "$root/cmake/packages.txt"
}

# one_line COLUMN NEED...: the same on one line, each name once.
one_line() { table "$@" | awk 'NF && !seen[$1]++ { printf "%s%s", sep, $0; sep = " " }'; }

# missing_packages NEED...: Debian packages that are neither installed nor made unnecessary by a command, one a line.
missing_packages() {
    local installed package instead command found
    # shellcheck disable=SC2046,SC2016  # words are wanted; ${...} is dpkg-query's
    installed=$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' $(table 2 "$@") 2>/dev/null || true)
    while IFS=$'\t' read -r package instead; do
        found=
        for command in $instead; do
            if has "$command"; then found=yes; fi
        done
        if [[ -z $found && $'\n'$installed$'\n' != *$'\n'"$package installed"$'\n'* ]]; then echo "$package"; fi
    done < <(paste <(table 2 "$@") <(table 3 "$@"))
}

# explain PACKAGE NEED...: why it is needed.
explain() {
    local package=$1
    shift
    paste <(table 2 "$@") <(table 7 "$@") | awk -F '\t' -v package="$package" '$1 == package { print $2 }'
}

# ensure_packages NEED...: returns once everything is there, or ends with EX_UNAVAILABLE.
ensure_packages() {
    if ! has dpkg-query || ! has apt-get; then
        advise_other_system "$@"
        return
    fi
    local missing package as=()
    missing=$(missing_packages "$@")
    if [[ -z $missing ]]; then return; fi

    say "these packages are missing:"
    for package in $missing; do
        printf '    %-20s %s\n' "$package" "$(explain "$package" "$@")" >&2
    done
    # shellcheck disable=SC2206  # one word each
    local packages=($missing)
    local line="apt-get install --no-install-recommends ${packages[*]}"
    if [[ ${ISOPARM_NO_INSTALL:-0} != 0 ]]; then
        say "ISOPARM_NO_INSTALL is set, so nothing was installed. As root:"
        printf '    %s\n' "$line" >&2
        exit $EX_UNAVAILABLE
    fi
    if [[ $(id -u) != 0 ]]; then
        if ! has sudo; then
            say "installing them needs root, and there is no sudo. As root:"
            printf '    %s\n' "$line" >&2
            exit $EX_UNAVAILABLE
        fi
        as=(sudo)
        sudo -v || true  # asks for the password now, where it can be seen
    fi

    local log=$root/build/packages.log
    : >"$log"
    # A package list that cannot be refreshed (a third-party source that is down) need not stop the installation.
    logged "$log" "refreshing the list of packages" \
        ${as[@]+"${as[@]}"} apt-get -o DPkg::Lock::Timeout=300 update || say "that failed; trying with the old list"
    if ! logged "$log" "installing ${#packages[@]} packages and what they need (once, a few minutes)" \
        ${as[@]+"${as[@]}"} env DEBIAN_FRONTEND=noninteractive \
        apt-get -o DPkg::Lock::Timeout=300 install --yes --no-install-recommends "${packages[@]}"; then
        show_log "$log"
        say "installing packages failed. As root:"
        printf '    %s\n' "apt-get update && $line" >&2
        exit $EX_UNAVAILABLE
    fi
}

# Not Debian: says what to install under which name, and goes on if there is a chance.
advise_other_system() {
    if has cmake && { has c++ || has g++ || has clang++; }; then
        say "not a Debian or Ubuntu system: packages are not installed automatically. If something is not found:"
    else
        say "cmake 3.21 and a C++20 compiler are needed, and packages are installed automatically on Debian and Ubuntu only."
    fi
    {
        printf '    Fedora:    dnf install %s\n' "$(one_line 4 "$@")"
        printf '    Arch:      pacman -S %s\n' "$(one_line 5 "$@")"
        printf '    Homebrew:  brew install %s\n' "$(one_line 6 "$@")"
    } >&2
    if ! has cmake || ! { has c++ || has g++ || has clang++; }; then exit $EX_UNAVAILABLE; fi
}

# ---------------------------------------------------------------------------------------------------- build

# logged LOG TITLE COMMAND...: the command's output goes to LOG; a terminal sees the line it is at.
logged() {
    local log=$1 title=$2 status=0 start=$SECONDS width=78
    shift 2
    if [[ -t 2 ]]; then
        width=$(stty size 2>/dev/null </dev/tty | awk '$2 > 20 { print $2 - 2 }' || true)
        printf 'isoparm: %s\n' "$title" >&2
        "$@" </dev/null 2>&1 9>&- | tee -a "$log" | while IFS= read -r text; do
            printf '\r\033[K%.*s' "${width:-78}" "$text" >&2
        done || status=$?
        printf '\r\033[K' >&2
    else
        say "$title"
        "$@" </dev/null >>"$log" 2>&1 9>&- || status=$?
    fi
    if ((SECONDS - start >= 10 && status == 0)); then say "done in $((SECONDS - start)) s"; fi
    return $status
}

show_log() {
    tail -n 40 "$1" >&2
    say "the whole log: $1"
}

# All cores, unless memory is short: the templates take up to 1.5 GB a compiler.
jobs_count() {
    local cores gigabytes
    cores=$(nproc 2>/dev/null || getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2)
    gigabytes=$(awk '/^MemAvailable/ { print int($2 / 1572864) }' /proc/meminfo 2>/dev/null || true)
    if [[ -n $gigabytes ]] && ((gigabytes < cores)); then cores=$((gigabytes > 1 ? gigabytes : 1)); fi
    echo "$cores"
}

# build PRESET TARGET...: configures and builds build/PRESET; build.log there; ends with EX_SOFTWARE on failure.
build() {
    local preset=$1 folder=$root/build/$1 generator=() log moved=
    shift
    log=$folder/build.log
    if ! has cmake || [[ $(printf '3.21\n%s\n' "$(cmake --version | awk 'NR == 1 { print $3 }')" | sort -V | head -n 1) != 3.21 ]]; then
        say "cmake 3.21 or newer is needed; found: $(cmake --version 2>/dev/null | head -n 1)"
        exit $EX_UNAVAILABLE
    fi
    mkdir -p "$folder"
    : >"$log"
    # A folder that was moved or copied from elsewhere is configured afresh.
    if ! grep -qsF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$folder/CMakeCache.txt"; then moved=yes; fi
    if [[ -n $moved ]]; then
        rm -rf "$folder/CMakeCache.txt" "$folder/CMakeFiles"
        if has ninja; then generator=(-G Ninja); fi
    fi
    if ! (cd "$root" && cmake --preset "$preset" ${generator[@]+"${generator[@]}"}) </dev/null >>"$log" 2>&1 9>&-; then
        show_log "$log"
        say "configuring failed"
        exit $EX_SOFTWARE
    fi
    if ! logged "$log" "building build/$preset${moved:+ (the first time takes a few minutes)}" \
        cmake --build "$folder" --parallel "$(jobs_count)" --target "$@"; then
        show_log "$log"
        say "building failed"
        exit $EX_SOFTWARE
    fi
}

# with_lock COMMAND...: one set-up at a time in this clone; the others wait for it. Descriptor 9 is the lock.
with_lock() {
    if ! { mkdir -p "$root/build" && exec 9>"$root/build/.lock"; } 2>/dev/null; then
        say "cannot write to $root/build, where the program is built"
        exit $EX_UNAVAILABLE
    fi
    if has flock && ! flock -n 9; then
        say "waiting for another isoparm that is being built here"
        flock 9
    fi
    "$@"
    exec 9>&-
}

# ---------------------------------------------------------------------------------------------------- the program

readonly program=$root/build/release/isoparm
readonly stamp=$root/build/release/.built  # holds $root; as old as the start of the last successful build

# Nothing that the program is built from is newer than the last build: a few milliseconds.
is_built() {
    local newer
    [[ -x $program && -f $stamp && $(<"$stamp") == "$root" ]] || return 1
    newer=$(find "$root/lib" "$root/render" "$root/cmake" "$root/CMakeLists.txt" "$root/CMakePresets.json" \
        -newer "$stamp" -print -quit 2>&1) || return 1
    [[ -z $newer ]]
}

# build_release TARGET...: the build of both `./isoparm` and `./tests/run`.
build_release() {
    mkdir -p "$root/build/release"
    printf '%s\n' "$root" >"$stamp.new"
    build release "$@"
    mv -f "$stamp.new" "$stamp"
}
