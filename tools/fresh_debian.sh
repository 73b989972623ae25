#!/usr/bin/env bash
# fresh_debian.sh RELEASE LINE...: runs bash lines as root, in a clone of this checkout's HEAD, on a
# minimal Debian of that release (bookworm, trixie), until one fails. That Debian is a throwaway chroot
# with namespaces of its own: nothing of it is left, however the script ends (after SIGKILL, from the
# next start on). It has this machine's mirrors, certificates and settings of apt's network; its first
# packages, and its folder of ccache, if a line installs that, are kept in $XDG_CACHE_HOME/causticbench
# (by default in ~/.cache). The exit code is that of the line, or
#   2   wrong usage
#   69  there can be no such chroot here: the message says why
#   75  packages could not be fetched, after several tries
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() { echo "fresh_debian: $2" >&2; exit "$1"; }

[ $# -ge 2 ] || fail 2 "usage: tools/fresh_debian.sh RELEASE LINE..."
export release=$1
shift
[[ $release =~ ^[a-z]+$ ]] || fail 2 "'$release' is no release of Debian; try bookworm or trixie"

# Each "URI suite" of this machine's apt that is Debian's own, with the other release's name. apt would
# fetch their lists from 'URI/dists/SUITE/InRelease'.
sources() {
    local codename
    codename=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
    apt-get --print-uris update |
        sed -nE "s#^'([^']*/)dists/$codename(-updates|-security)?/InRelease'.*#\1 $release\2#p"
}

# The functions from here to `run_lines` run in namespaces of their own.

fetch_packages() {
    local pause
    for pause in 0 15 60; do
        sleep "$pause"
        rm -rf "$work/fetch"  # of an earlier try: debootstrap wants it empty
        debootstrap --variant=minbase --make-tarball="$work/packages.tgz" "$release" "$work/fetch" \
            "$mirror" && mv "$work/packages.tgz" "$packages" && return
    done
}

carry_network() {
    cp -L /etc/resolv.conf /etc/hosts "$root/etc/"
    rm -f "$root/etc/apt/sources.list"
    awk '{print "deb", $0, "main"}' <<<"$sources" >"$root/etc/apt/sources.list.d/host.list"
    {
        apt-config dump | grep '^Acquire::' | grep -v '^Acquire::IndexTargets'
        echo 'APT::Update::Error-Mode "any";'
    } >"$root/etc/apt/apt.conf.d/90host"
    mkdir -p "$root/etc/ssl/certs" "$root/usr/local/share/ca-certificates"
    cp -L /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/" || true
    cp -RL /usr/local/share/ca-certificates "$root/usr/local/share/" || true
}

make_system() {
    debootstrap --variant=minbase --unpack-tarball="$packages" "$release" "$root" "$mirror"
    carry_network
    git clone --quiet . "$root/src/causticbench"
}

mount_all() {
    mkdir -p "$compiled" "$root/root/.cache/ccache" &&
        mount --bind "$compiled" "$root/root/.cache/ccache" &&
        mount -t proc proc "$root/proc" &&
        mount --rbind /sys "$root/sys" &&
        mount --rbind /dev "$root/dev" &&
        mount -t tmpfs -o mode=1777 shm "$root/dev/shm"
}

run_lines() {
    mount_all || return 69
    local environment=(PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8) name line
    for name in {http,https,no}_proxy {HTTP,HTTPS,NO}_PROXY; do
        [ -z "${!name:-}" ] || environment+=("$name=${!name}")
    done
    for line in "$@"; do
        local start=$SECONDS code=0
        echo "[$release] \$ $line"
        chroot "$root" env -i -C /src/causticbench "${environment[@]}" bash -c "$line" || code=$?
        echo "[$release] exit code $code after $((SECONDS - start)) s"
        [ "$code" = 0 ] || return "$code"
    done
}

# Runs one of these functions where its mounts and processes end with this script.
apart() {
    setpriv --pdeathsig KILL unshare --mount --pid --mount-proc --ipc --fork --kill-child \
        bash -c "$(declare -f); set -euo pipefail; \"\$@\"" fresh_debian "$@" </dev/null &
    child=$!
    local code=0
    wait "$child" || code=$?
    child=
    return "$code"
}

# The same, with nothing said where all goes well.
quietly() { apart "$@" >"$work/log" 2>&1 || { tail -n 20 "$work/log" >&2; return 1; }; }

clean_up() {
    [ -z "$child" ] || { kill -KILL "$child"; wait "$child" 2>/dev/null; } || true
    exec 9<&-
    flock "$work" rm -rf --one-file-system "$work"  # once the last process is gone
}

[ "$(id -u)" = 0 ] || fail 69 "only root can make a chroot"
command -v debootstrap >/dev/null || fail 69 "needs the Debian package debootstrap"
[ -e "/usr/share/debootstrap/scripts/$release" ] || fail 2 "debootstrap knows no release '$release'"
command -v git >/dev/null || fail 69 "needs the Debian package git"
unshare --mount --pid --ipc --fork true || fail 69 "this machine gives no namespaces (see above)"
sources=$(sources)
[ -n "$sources" ] || fail 69 "no mirror of Debian among apt's sources"
export sources mirror=${sources%% *}

cache=${XDG_CACHE_HOME:-$HOME/.cache}/causticbench
mkdir -p "$cache"
for stale in "$cache"/fresh-*/; do
    [ ! -d "$stale" ] || flock --nonblock "$stale" rm -rf --one-file-system "$stale" || true
done
work=$(mktemp -d "$cache/fresh-$release-XXXXXX")
export work root=$work/root packages=$cache/packages-$release.tgz compiled=$cache/ccache-$release
child=
exec 9<"$work"
flock 9
trap clean_up EXIT
trap 'exit 143' TERM INT HUP

[ -s "$packages" ] || quietly fetch_packages || fail 75 "the packages of $release could not be fetched"
quietly make_system || fail 69 "no system could be made of $packages (see above)"
apart run_lines "$@"
