#!/bin/sh
# The tests that need no GPU, under AddressSanitizer and UndefinedBehaviorSanitizer. By clang, whose
# sanitized tests take three quarters of the time of gcc's, and whose worlds and trees must be those of the release's
# compiler; what draws is hardly run here and compiled at -O0, which takes a third of the time.
set -eu
cd "$(dirname "$0")/.."
build="build-asan"

CC=clang CXX=clang++ scripts/build.sh configure "$build" -Dbuildtype=plain -Doptimization=0 \
    -Dbusy_o1=true -Dc_args=-g1 -Dcpp_args=-g1 -Db_sanitize=address,undefined \
    -Db_lundef=false -Dtests=enabled
export ASAN_OPTIONS=abort_on_error=1:detect_stack_use_after_return=1
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
# Libraries of others keep what they keep for the life of the process.
export LSAN_OPTIONS=suppressions=$PWD/scripts/leaks-of-others.txt:print_suppressions=0

log=$(mktemp)
trap 'rm -f "$log"' EXIT
# tests NAME...: without thousands of lines of the linker about the sanitizers' own symbols
tests() {
    status=0
    meson test -C "$build" --print-errorlogs --timeout-multiplier 5 "$@" >"$log" 2>&1 || status=$?
    grep -v 'Cannot export local symbol' "$log"
    return $status
}
# tree-forms and tree-grow grow some hundreds of ordinary trees; tree-hashes has one of each kind,
# tree-limits the odd ones.
# shellcheck disable=SC2046  # one word a test
tests $(scripts/select-tests.sh "$build" base scene world tree output viewer | grep -Ev 'viewer-keys|tree-(forms|grow)')
# The program asks Vulkan for its devices, and the drivers keep memory when they are unloaded.
export ASAN_OPTIONS="$ASAN_OPTIONS:detect_leaks=0"
tests cli-usage cli-scenes
