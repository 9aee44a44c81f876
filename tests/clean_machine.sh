#!/usr/bin/env bash
# tests/clean_machine.sh FOLDER [COMMAND...] -- proves the claim of the README on a machine with none of the packages:
# makes a minimal Debian 12 in FOLDER (debootstrap; uses this machine's apt settings), clones this repository's HEAD
# into it, and runs in the clone, each as the first command of a fresh machine:
#     ./isoparm figures -o out
#     ./tests/run
# or the COMMAND that is given. As root. For maintainers: takes about 2 GB, and the time of two downloads and builds.
# Remove FOLDER afterwards with: rm -rf --one-file-system FOLDER
set -euo pipefail
if (($# < 1)); then sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//p}' "$0"; exit 64; fi
here=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd -P)
mkdir -p "$1"
folder=$(cd -- "$1" && pwd -P)
shift

base=$folder/base
if [[ ! -e $base/.complete ]]; then
    rm -rf --one-file-system "$base"
    debootstrap --variant=minbase bookworm "$base" "${DEBIAN_MIRROR:-http://deb.debian.org/debian}"
    # How this machine reaches its mirror: proxies, certificates, name server.
    cp -a /etc/apt/apt.conf.d/. "$base/etc/apt/apt.conf.d/" && rm -f "$base"/etc/apt/apt.conf.d/{20packagekit,50appstream}
    cp -L /etc/resolv.conf /etc/hosts "$base/etc/"
    touch "$base/.complete"
fi

try() {
    local machine=$folder/machine status=0 start=$SECONDS
    unmount "$machine"
    rm -rf --one-file-system "$machine"
    cp -a "$base" "$machine"
    git clone --quiet "$here" "$machine/root/isoparm"
    mount -t proc proc "$machine/proc"
    mount --bind /dev "$machine/dev"
    trap 'unmount "$folder/machine"' EXIT
    printf '\n== on a clean Debian 12: %s\n' "$*"
    env -i HOME=/root TERM=dumb LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin \
        ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
        chroot "$machine" bash -c 'cd /root/isoparm && "$@"' _ "$@" </dev/null || status=$?
    unmount "$machine"
    printf '== exit %d after %d s: %s\n' "$status" $((SECONDS - start)) "$*"
    return $status
}
unmount() {
    local place
    for place in "$1/proc" "$1/dev"; do
        if mountpoint -q "$place" 2>/dev/null; then umount "$place"; fi
    done
}

if (($# > 0)); then
    try "$@"
else
    try ./isoparm figures -o out
    ls -l "$folder/machine/root/isoparm/out"
    try ./tests/run
fi
