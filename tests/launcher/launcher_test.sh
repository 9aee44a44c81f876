#!/usr/bin/env bash
# The launcher, in a copy of its own and with stand-ins for apt, dpkg, cmake and sudo that write down how they were
# called. Run by ctest; needs ISOPARM_SOURCE_DIR. Nothing is installed and nothing is compiled.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
clone="$work/a clone"
stubs=$work/stubs
export CALLS=$work/calls INSTALLED=$work/installed ROOT_ID=$work/id
unset ISOPARM_NO_INSTALL

# ------------------------------------------------------------------------------------------------ stand-ins
mkdir -p "$stubs" "$clone/lib" "$clone/render" "$clone/cmake"
for tool in bash env awk sed grep cat tail head sort paste find mkdir rm mv cp ln chmod touch readlink dirname basename \
    flock nproc getconf uname tr tee sleep stty printf date; do
    path=$(type -P "$tool") && ln -s "$path" "$stubs/$tool"
done
stub() { { echo '#!/usr/bin/env bash'; cat; } >"$stubs/$1" && chmod +x "$stubs/$1"; }
debian() {
    stub dpkg-query <<'END'
shift 3
for package in "$@"; do if grep -qx "$package" "$INSTALLED"; then echo "$package installed"; fi; done
END
    stub apt-get <<'END'
echo "apt-get $*" >>"$CALLS"
[[ ! -e $INSTALLED.broken ]] || { echo "E: Unable to locate package"; exit 100; }
if [[ $* == *" install "* ]]; then printf '%s\n' "$@" | grep -- '^[a-z]' | grep -vx install >>"$INSTALLED"; fi
END
}
stub id <<'END'
cat "$ROOT_ID"
END
cmake_stub() {
    stub cmake <<'END'
echo "cmake $*" >>"$CALLS"
case $1 in
--version) echo "cmake version ${CMAKE_STUB_VERSION:-3.25.1}" ;;
--preset)
    mkdir -p "build/$2"
    echo "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" >"build/$2/CMakeCache.txt" ;;
--build)
    sleep "${CMAKE_STUB_SECONDS:-0}"
    if grep -qs broken "$2"/../../lib/*; then echo "lib/curve.cpp:1: error: broken"; exit 1; fi
    printf '%s\n' '#!/usr/bin/env bash' 'echo "ran in $PWD with $#:"; printf "<%s>\n" "$@"; exit "${EXIT:-0}"' >"$2/isoparm"
    chmod +x "$2/isoparm" ;;
esac
END
}
fresh() {  # a new clone on a machine without packages, as root
    rm -rf "$clone"
    mkdir -p "$clone/lib" "$clone/render" "$clone/cmake"
    cp "$ISOPARM_SOURCE_DIR/isoparm" "$clone/"
    cp "$ISOPARM_SOURCE_DIR/cmake/setup.sh" "$ISOPARM_SOURCE_DIR/cmake/packages.txt" "$clone/cmake/"
    touch "$clone/CMakeLists.txt" "$clone/CMakePresets.json"
    rm -f "$stubs"/{cmake,g++,ninja,make,sudo} "$INSTALLED.broken"
    : >"$CALLS"
    : >"$INSTALLED"
    echo 0 >"$ROOT_ID"
    debian
    stub g++ </dev/null
    cmake_stub
}
bare() { rm -f "$stubs"/{cmake,g++,ninja,make}; }

# ------------------------------------------------------------------------------------------------ how it is checked
failures=0
launch() { status=0; (cd "$work" && PATH=$stubs "$@") >"$work/out" 2>"$work/err" </dev/null || status=$?; }
check() {  # check WHAT COMMAND...
    local what=$1
    shift
    if "$@"; then echo "ok       $what"; else
        echo "FAILED   $what"
        sed 's/^/    out: /' "$work/out"; sed 's/^/    err: /' "$work/err"; sed 's/^/    call: /' "$CALLS"
        failures=$((failures + 1))
    fi
}
exits() { [[ $status == "$1" ]]; }
said() { grep -qF -- "$1" "$work/err"; }
printed() { grep -qF -- "$1" "$work/out"; }
called() { grep -q -- "$1" "$CALLS"; }
not() { ! "$@"; }

needed=$(awk -F ' *[|] *' '$1 == "build" { print $2 }' "$ISOPARM_SOURCE_DIR/cmake/packages.txt")

# ------------------------------------------------------------------------------------------------ what must hold
fresh; bare
ISOPARM_NO_INSTALL=1 launch "$clone/isoparm" --version
check "NO_INSTALL with nothing there exits 69" exits 69
for package in $needed; do check "NO_INSTALL lists $package and why" grep -qE "^ +${package//+/[+]} +[A-Za-z]" "$work/err"; done
check "NO_INSTALL names the command" said "apt-get install --no-install-recommends ${needed//$'\n'/ }"
check "NO_INSTALL calls no apt" not called apt-get
check "NO_INSTALL prints nothing on stdout" test ! -s "$work/out"

fresh
echo "$needed" | grep -v -e libosd-dev >"$INSTALLED"
ISOPARM_NO_INSTALL=1 launch "$clone/isoparm"
check "NO_INSTALL lists only what is missing" said "apt-get install --no-install-recommends libosd-dev"
stub make </dev/null
echo "$needed" | grep -v -e ninja-build -e '^cmake' >"$INSTALLED"
ISOPARM_NO_INSTALL=1 launch "$clone/isoparm" x
check "make is as good as ninja, a cmake from elsewhere as Debian's" exits 0

fresh; bare; cmake_stub
launch "$clone/isoparm" "two words" "" '*'
check "a first call installs, builds and runs" exits 0
check "it refreshes the package list" called "apt-get .*update"
check "it installs without asking and without recommended packages" called "install --yes --no-install-recommends g++"
check "it says why" said "Embree traces the rays"
check "it builds" called "cmake --build .*/build/release"
check "arguments arrive as they are" diff "$work/out" <(printf '%s\n' "ran in $work with 3:" "<two words>" "<>" "<*>")

: >"$CALLS"
EXIT=65 launch "$clone/isoparm" x
check "a second call calls nothing" test ! -s "$CALLS"
check "the exit code is the program's" exits 65
check "a second call says nothing of its own" test ! -s "$work/err"
ln -s "$clone/isoparm" "$work/link"
mkdir -p "$work/elsewhere"
(cd "$work/elsewhere" && PATH=$stubs ../link >"$work/out")
check "through a link, from another folder" printed "ran in $work/elsewhere with 0:"

sleep 0.02; touch "$clone/lib/new.h"
launch "$clone/isoparm"
check "a new source builds again" called "cmake --build"
check "without another look at the first-time message" not said "first time"
: >"$CALLS"; launch "$clone/isoparm"
check "once" test ! -s "$CALLS"
sleep 0.02; rm "$clone/lib/new.h"; launch "$clone/isoparm"
check "a source that went away builds again" called "cmake --build"

sleep 0.02; echo broken >"$clone/lib/curve.cpp"
launch "$clone/isoparm"
check "a failed build exits 70" exits 70
check "shows the end of its log" said "lib/curve.cpp:1: error: broken"
check "and where the log is" said "$clone/build/release/build.log"
check "runs nothing" not printed "ran in"
echo fine >"$clone/lib/curve.cpp"
launch "$clone/isoparm"
check "and builds once the source is right" exits 0

mv "$clone" "$work/moved"; : >"$CALLS"
launch "$work/moved/isoparm"
check "a clone that was moved is configured afresh" called "cmake --preset release"
check "and runs" exits 0
mv "$work/moved" "$clone"

fresh; bare
echo 1000 >"$ROOT_ID"
launch "$clone/isoparm"
check "no root, no sudo: exits 69" exits 69
check "no root, no sudo: names the command" said "As root:"
check "no root, no sudo: calls no apt" not called apt-get
cmake_stub
stub sudo <<'END'
echo "sudo $*" >>"$CALLS"
[[ $1 == -v ]] || exec "$@"
END
launch "$clone/isoparm"
check "no root, sudo: installs through it" called "sudo env DEBIAN_FRONTEND=noninteractive apt-get"
check "no root, sudo: runs" exits 0
fresh; echo 1000 >"$ROOT_ID"; echo "$needed" >"$INSTALLED"
launch "$clone/isoparm"
check "no root is needed when nothing is missing" exits 0

fresh; touch "$INSTALLED.broken"
launch "$clone/isoparm"
check "apt fails: exits 69" exits 69
check "apt fails: shows why" said "Unable to locate package"

fresh; rm "$stubs/apt-get" "$stubs/dpkg-query"
launch "$clone/isoparm"
check "another system with compiler and cmake goes on" exits 0
check "another system is told the names" said "dnf install gcc-c++"
bare; fresh; bare; rm "$stubs/apt-get" "$stubs/dpkg-query"
launch "$clone/isoparm"
check "another system without them exits 69" exits 69
check "and is told the names" said "brew install"
fresh; echo "$needed" >"$INSTALLED"
CMAKE_STUB_VERSION=3.18.4 launch "$clone/isoparm"
check "an old cmake is named" said "cmake 3.21 or newer is needed; found: cmake version 3.18.4"

fresh; echo "$needed" >"$INSTALLED"
for i in 1 2 3; do (cd "$work" && CMAKE_STUB_SECONDS=0.3 PATH=$stubs "$clone/isoparm" >"$work/out$i" 2>"$work/err") & done
wait
check "three first calls at once build once" test "$(grep -c -- --build "$CALLS")" = 1
check "and all run" test "$(cat "$work"/out? | grep -c 'ran in')" = 3

echo "$failures failed"
((failures == 0))
