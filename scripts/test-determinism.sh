#!/bin/sh
# The same worlds and trees from clang at -O0 as from the release compiler: the hashes stand in
# the tests.
set -eu
cd "$(dirname "$0")/.."
build="build-o0"

CC=clang CXX=clang++ scripts/build.sh configure "$build" -Dbuildtype=plain -Doptimization=0 \
    -Dtests=enabled
# Without those that hold no hash and take as long as all the rest.
# shellcheck disable=SC2046  # one word a test
meson test -C "$build" --print-errorlogs --timeout-multiplier 10 \
    $(scripts/select-tests.sh "$build" base world tree | grep -Ev '(tree-(forms|grow|import|limits|points|texture|young)|world-(csv|raster|terrain_raster))')
