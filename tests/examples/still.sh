#!/bin/sh
# The smallest example saves a picture: as built here, and compiled against an installed weald.
#   still.sh STILL ROOT BUILD CC
set -eu
still=$1
root=$2
build=$3
compiler=$4
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

"$still" "$root/tests/viewer/tiny.json" "$scratch/built.png"
# width and height of the header: 640 and 360
[ "$(od -An -tx1 -j16 -N8 "$scratch/built.png" | tr -d ' ')" = 0000028000000168 ]
size=$(wc -c <"$scratch/built.png")
echo "the picture has $size bytes"
[ "$size" -gt 20000 ]

# shellcheck source=installed.sh
. "$root/tests/examples/installed.sh"
# shellcheck disable=SC2086  # one word a flag, and of the compiler
$compiler "$root/examples/still.c" $flags -o "$scratch/still"
LD_LIBRARY_PATH=$libraries "$scratch/still" "$root/tests/viewer/tiny.json" "$scratch/installed.png"
cmp "$scratch/built.png" "$scratch/installed.png"
echo "the installed library draws the same picture"

# fails SCENE OUT PART: it says what was wrong, and fails
fails() {
    status=0
    "$still" "$1" "$2" 2>"$scratch/log" || status=$?
    [ "$status" -eq 1 ]
    grep -q "$3" "$scratch/log"
}
fails "$scratch/nowhere.json" "$scratch/none.png" nowhere.json
fails "$root/tests/viewer/tiny.json" "$scratch/none.gif" none.gif
