#!/bin/sh
# The same sources give the same keys of code wherever they are built: they are read in the order of their names.
#   keys.sh BUILD
set -eu
for key in src/api/picture_key.h src/bake/code_key.h; do
    files=$(sed -n "s,\$ ,,g;s,^build $key: CUSTOM_COMMAND[^ ]* \([^|]*\)|.*,\1,p" "$1/build.ninja" | tr ' ' '\n' | sed '/^$/d')
    echo "$key: $(echo "$files" | wc -l) files"
    [ "$(echo "$files" | wc -l)" -gt 100 ]
    echo "$files" | LC_ALL=C sort -c
done
