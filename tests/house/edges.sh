#!/bin/sh
# GLSL leaves smoothstep undefined where its first edge is not below the second.
#   edges.sh ROOT
set -eu
cd "$1"
number='-?[0-9]+\.?[0-9]*f?'
found=$(grep -rnoE "(smoothstep|WD_SMOOTH)\($number, $number," shaders |
    awk -F '[(,]' '{ if ($2 + 0 >= $3 + 0) print }')
[ -z "$found" ] || {
    echo "$found"
    echo "the first edge must be below the second in the lines above"
    exit 1
}
