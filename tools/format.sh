#!/usr/bin/env bash
# format.sh [--check]: formats the C++ sources with the pinned clang-format, or says which differ.
# Versions of clang-format disagree with one another, so the pinned one is kept in .venv (from PyPI).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
wanted=tools/format-requirements.txt
version=$(sed -n 's/^clang-format==\([0-9.]*\).*/\1/p' "$wanted")
format=.venv/bin/clang-format

fail() { echo "format: $*" >&2; exit 1; }

arguments=(-i)
case "${1:-}" in
    "") ;;
    --check) arguments=(--dry-run -Werror) ;;
    *) echo "usage: tools/format.sh [--check]" >&2; exit 2 ;;
esac
if ! [ -x "$format" ] || [[ $("$format" --version) != *" $version"* ]]; then
    /usr/bin/python3 -m venv .venv || fail "needs the Debian package python3-venv"
    .venv/bin/pip install --quiet --require-hashes -r "$wanted" || fail "could not install clang-format $version"
fi
git ls-files -z --cached --others --exclude-standard -- '*.h' '*.cpp' |
    xargs -0 "$format" "${arguments[@]}"
