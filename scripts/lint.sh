#!/bin/sh
# Static checks: include rules and words that must not stand in the tree, cppcheck on every C
# source, shellcheck on every script.
set -eu
cd "$(dirname "$0")/.."
build=${1:-build}
scripts/build.sh "$build"
failed=0

tests/house/includes.sh . || failed=1
tests/house/words.sh . || failed=1
# The compiler's own -Wuninitialized is right where cppcheck's is not: arrays filled by memcpy.
# Compiled shaders (build/shaders/*.inc) are left out: it chews for hours on half a million words.
cppcheck --quiet --error-exitcode=1 --inline-suppr --std=c11 --enable=warning,portability \
    --suppress=missingIncludeSystem --suppress=invalidPointerCast --suppress=unknownMacro \
    --suppress=uninitvar --suppress=legacyUninitvar --suppress=internalAstError -j "$(nproc)" \
    -I include -I src -I shaders src cli viewer examples bench || failed=1
find tests scripts .ci/run bench/run -type f \( -name '*.sh' -o -name run \) \
    -exec shellcheck -x -P SCRIPTDIR --severity=warning {} + || failed=1
[ "$failed" -eq 0 ] && echo "lint: nothing found"
exit "$failed"
