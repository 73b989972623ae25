#!/usr/bin/env bash
# setup.sh [PACKAGE...]: installs the Debian packages that the build, the tests and the plots need, and
# those named. It may be run again at any time: what is there is left alone, and with everything there
# neither root nor network is used. Exit code 75: packages could not be fetched, after several tries.
set -euo pipefail

packages=(
    git ca-certificates                             # the commit's name for the records
    g++ cmake ninja-build                           # build
    libembree-dev libtbb-dev                        # rays and threads
    libeigen3-dev libfmt-dev                        # vectors, text
    nlohmann-json3-dev                              # scene files
    libopenexr-dev libpng-dev                       # pictures of our own
    libopenimageio-dev openimageio-tools            # other pictures; its CMake files ask for the tools
    libcli11-dev                                    # command line
    libgtest-dev                                    # tests
    libbenchmark-dev libnanoflann-dev               # benchmarks
    python3 python3-numpy python3-matplotlib        # layering test, plots
    python3-scipy                                   # intervals of the tables
    "$@"
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
fetch() {
    local pause
    for pause in 5 30 0; do
        apt "$@" && return
        sleep "$pause"
    done
    echo "setup: 'apt-get $1' failed three times (see above)" >&2
    exit 75
}
install=(install -y --no-install-recommends "${missing[@]}")
fetch update
apt "${install[@]}" --simulate >/dev/null || fail "apt-get cannot install: ${missing[*]}"
fetch "${install[@]}" --download-only
apt "${install[@]}" || fail "'apt-get install' failed (see above); wanted: ${missing[*]}"
echo "setup: done"
