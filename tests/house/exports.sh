#!/bin/sh
# The library exports each function that a public header names, and nothing else.
#   exports.sh ROOT LIBRARY
set -eu
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cat "$1"/include/weald/*.h | grep -oE '\bwd_[a-z0-9_]+\(' | tr -d '(' | LC_ALL=C sort -u >"$scratch/named"
# What linkers themselves put there begins with an underscore.
nm -D --defined-only "$2" | awk '$3 !~ /^_/ { print $3 }' | LC_ALL=C sort -u >"$scratch/exported"
[ -s "$scratch/named" ]
diff "$scratch/named" "$scratch/exported"
