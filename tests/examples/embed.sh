#!/bin/sh
# The example of embedding draws a forest: as built here, and compiled against an installed weald.
#   embed.sh EMBED ROOT BUILD CC
set -eu
embed=$1
root=$2
build=$3
compiler=$4
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

"$embed" "$root/tests/viewer/tiny.json" "$scratch/built.ppm"
[ "$(head -c 14 "$scratch/built.ppm")" = 'P6 640 360 255' ]
colors=$(tail -c +16 "$scratch/built.ppm" | od -An -v -w3 -tx1 | sort -u | wc -l)
echo "the picture has $colors colours"
[ "$colors" -gt 500 ]

# shellcheck source=installed.sh
. "$root/tests/examples/installed.sh"
# shellcheck disable=SC2086  # one word a flag, and of the compiler
$compiler "$root/examples/embed.c" $flags -lvulkan -o "$scratch/embed"
# Under validation, which says what it finds and goes on.
VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation \
    VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT \
    LD_LIBRARY_PATH=$libraries "$scratch/embed" "$root/tests/viewer/tiny.json" \
    "$scratch/installed.ppm" >"$scratch/said" 2>&1 || { cat "$scratch/said" && exit 1; }
if grep 'Validation Error' "$scratch/said"; then
    exit 1
fi
cmp "$scratch/built.ppm" "$scratch/installed.ppm"
echo "the installed library draws the same picture"

! "$embed" "$scratch/nowhere.json" "$scratch/none.ppm" 2>"$scratch/log"
grep -q nowhere.json "$scratch/log"
