#!/bin/sh
# The same worlds and trees from clang at -O0 as from the release compiler: the hashes stand in
# the tests.
set -eu
cd "$(dirname "$0")/.."
build="build-o0"

CC=clang CXX=clang++ scripts/build.sh configure "$build" -Dbuildtype=plain -Doptimization=0 \
    -Dtests=enabled
meson test -C "$build" --print-errorlogs --timeout-multiplier 10 world-terrain world-world tree-hashes
