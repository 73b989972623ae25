#!/usr/bin/env bash
# Installs the Debian packages that the build, the tests and the plots need. It may be run again at
# any time: what is there is left alone, and with everything there neither root nor network is used.
set -euo pipefail

packages=(
    git ca-certificates                             # the commit's name for the records
    g++ cmake ninja-build                           # build
    libembree-dev libtbb-dev                        # rays and threads
    libeigen3-dev libfmt-dev                        # vectors, text
    nlohmann-json3-dev libassimp-dev                # scene and mesh files
    libopenimageio-dev openimageio-tools            # images; its CMake files ask for the tools
    libcli11-dev                                    # command line
    libgtest-dev                                    # tests
    libbenchmark-dev libnanoflann-dev               # benchmarks
    python3 python3-numpy python3-matplotlib        # layering test, plots
)

fail() { echo "setup: $*" >&2; exit 1; }

command -v dpkg-query >/dev/null && command -v apt-get >/dev/null ||
    fail "this is not Debian: README.md, 'Other systems', lists what is needed and the plain CMake lines"

missing=()
for package in "${packages[@]}"; do
    status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$status" = installed ] || missing+=("$package")
done
if [ ${#missing[@]} = 0 ]; then
    echo "setup: all ${#packages[@]} packages are there"
    exit 0
fi

as_root=()
if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null ||
        fail "needs root or sudo for: apt-get install --no-install-recommends ${missing[*]}"
    as_root=(sudo)
fi
echo "setup: installing with apt-get: ${missing[*]}"
apt() {
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get -q -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0 "$@" </dev/null
}
apt update || fail "'apt-get update' failed (see above)"
apt install -y --no-install-recommends "${missing[@]}" ||
    fail "'apt-get install' failed (see above); wanted: ${missing[*]}"
echo "setup: done"
